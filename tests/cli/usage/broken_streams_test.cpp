// Standard streams that are closed or full, and manifests that were cut short: nothing is written where it
// does not belong, and the batch goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class BrokenStreams : public testing::Test {
 protected:
  BrokenStreams() {
    test::Picture picture = test::blank(40, 3);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(in_, picture);
  }
  static std::string text_of(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<std::string> upsample(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> out = {"upsample", in_, "-o", folder_ / "out.exr"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }

  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
};

TEST_F(BrokenStreams, ClosedOnesAreNoFiles) {
  const std::string manifest = folder_ / "manifest.jsonl";
  for (const int closed : {0, 1, 2}) {
    std::filesystem::remove(manifest);
    test::Tool::Options options;
    options.before = [closed] { return ::close(closed) == 0; };
    const auto outcome = test::run_tool(upsample({"--manifest", manifest}), options);
    EXPECT_EQ(outcome.exit, 0) << closed << " " << outcome;
    const auto lines = test::json_lines(text_of(manifest));
    ASSERT_EQ(lines.size(), 1U) << text_of(manifest);
    EXPECT_EQ(lines[0]["status"], "converted");
  }
}

TEST_F(BrokenStreams, AFullLogLosesMessagesOnly) {
  // Two inputs, the first of which cannot be used: its message is lost, the second is converted.
  test::Tool::Options options;
  options.before = [] {
    const int full = ::open("/dev/full", O_WRONLY);
    return full >= 0 && ::dup2(full, 2) == 2;
  };
  const std::string manifest = folder_ / "manifest.jsonl";
  const auto outcome = test::run_tool(
      {"upsample", folder_ / "none.exr", in_, "-o", folder_ / "out/", "--manifest", manifest}, options);
  EXPECT_EQ(outcome.exit, 1) << outcome;
  const auto lines = test::json_lines(text_of(manifest));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["status"], "failed");
  EXPECT_EQ(lines[1]["status"], "converted");
}

TEST_F(BrokenStreams, FullOutputKeepsTheManifestTrue) {
  test::Tool::Options options;
  options.stdout_path = "/dev/full";
  const std::string manifest = folder_ / "manifest.jsonl";
  const auto outcome = test::run_tool(upsample({"--manifest", manifest}), options);
  EXPECT_EQ(outcome.exit, 3) << outcome;
  EXPECT_THAT(outcome.err, HasSubstr("cannot write to standard output"));
  ASSERT_TRUE(std::filesystem::exists(folder_ / "out.exr"));
  const auto lines = test::json_lines(text_of(manifest));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["status"], "converted");
}

TEST_F(BrokenStreams, LinesThatWereCutShortStayAlone) {
  const std::string manifest = folder_ / "manifest.jsonl";
  std::ofstream(manifest) << "{\"input\":\"a.exr\"}\n{\"input\":\"b.ex";
  const auto outcome = test::run_tool(upsample({"--manifest", manifest}));
  EXPECT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.err, HasSubstr("was cut short"));
  const auto lines = test::lines(text_of(manifest));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1], "{\"input\":\"b.ex");
  EXPECT_EQ(nlohmann::json::parse(lines[2])["status"], "converted");
  const auto again = test::run_tool(upsample({"--manifest", manifest}));
  EXPECT_EQ(again.err, "");
}

}  // namespace
}  // namespace spectile
