// Memory, open files and pixels limited by the user or by the system: the tool says so and leaves nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class Limits : public testing::Test {
 protected:
  Limits() {
    test::Picture picture = test::blank(kWidth, kHeight);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(in_, picture);
  }
  std::vector<std::string> upsample(const std::vector<std::string>& more) const {
    std::vector<std::string> out = {"upsample", in_, "-o", folder_ / "out.exr"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  /// True if nothing but the input is in the folder.
  bool nothing_left() const {
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder_.path())) ++files;
    return files == 1;
  }

  static constexpr int kWidth = 400;
  static constexpr int kHeight = 300;
  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
};

TEST_F(Limits, Pixels) {
  for (const std::string command : {"info", "upsample", "verify", "validate"}) {
    std::vector<std::string> arguments = {command, in_, "--max-pixels", "119999"};
    if (command == "upsample") arguments.insert(arguments.end(), {"-o", folder_ / "out.exr"});
    const auto outcome = test::run_tool(arguments);
    EXPECT_EQ(outcome.exit, 1) << command << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr("has 400 x 300 pixels, more than 119999 (--max-pixels)"));
    EXPECT_TRUE(nothing_left());
  }
  EXPECT_EQ(test::run_tool({"info", in_, "--max-pixels", "120000"}).exit, 0);
  EXPECT_EQ(test::run_tool({"info", in_, "--max-pixels", "0"}).exit, 0);
}

TEST_F(Limits, Memory) {
  if (test::kSanitized) GTEST_SKIP() << "a sanitizer's own memory is beyond any limit";
  const auto refused = test::run_tool(upsample({"--max-memory", "0.001"}));
  EXPECT_EQ(refused.exit, 3) << refused;
  EXPECT_TRUE(refused.one_line()) << refused;
  EXPECT_THAT(refused.err, HasSubstr("not enough memory"));
  EXPECT_TRUE(nothing_left());
  EXPECT_EQ(test::run_tool(upsample({"--max-memory", "0"})).exit, 0);
  EXPECT_EQ(test::run_tool(upsample({"--max-memory", "1"})).exit, 0);
  EXPECT_EQ(test::run_tool(upsample({"--max-memory", "-1"})).exit, 2);
}

TEST_F(Limits, FewerThreadsWhereStacksDoNotFit) {
  if (test::kSanitized) GTEST_SKIP() << "a sanitizer's own memory is beyond any limit";
  int done = 0;
  int fewer = 0;
  for (rlim_t mib = 60; mib <= 6000; mib += mib < 700 ? 40 : 2600) {
    test::Tool::Options options;
    options.before = [mib] { return test::limit_memory(mib << 20U); };
    test::Tool tool(upsample({"--threads", "12"}), options);
    const auto outcome = tool.finish(std::chrono::seconds(20));
    ASSERT_FALSE(outcome.late) << mib << outcome;
    ASSERT_EQ(outcome.signal, 0) << mib << outcome;
    EXPECT_TRUE(outcome.exit == 0 || outcome.exit == 3) << mib << outcome;
    EXPECT_EQ(outcome.err.find("bad_alloc"), std::string::npos) << outcome;
    done += outcome.exit == 0 ? 1 : 0;
    fewer += outcome.err.find("the system makes only") != std::string::npos ? 1 : 0;
    std::filesystem::remove(folder_ / "out.exr");
  }
  EXPECT_GT(done, 0);
  EXPECT_GT(fewer, 0);
}

TEST_F(Limits, OpenFiles) {
  int refused = 0;
  for (rlim_t files = 3; files <= 12; ++files) {
    test::Tool::Options options;
    options.before = [files] {
      const rlimit limit = {files, files};
      return ::setrlimit(RLIMIT_NOFILE, &limit) == 0;
    };
    const auto outcome = test::run_tool(upsample({}), options);
    if (outcome.exit == 0 || outcome.exit == 127) continue;  // 127: too few for its libraries
    ++refused;
    EXPECT_EQ(outcome.exit, 3) << files << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr("Too many open files"));
    EXPECT_TRUE(nothing_left());
  }
  EXPECT_GT(refused, 0);
}

TEST_F(Limits, AHelpThatCannotBeWritten) {
  test::Tool::Options options;
  options.stdout_path = "/dev/full";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"upsample", "--help"}, {"--version"}}) {
    const auto outcome = test::run_tool(arguments, options);
    EXPECT_EQ(outcome.exit, 3) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
  }
}

TEST_F(Limits, EmptyNames) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"upsample", in_, "-o", ""},
                                                    {"plan", "-o", ""},
                                                    {"film", "simulate", "-o", ""}}) {
    const auto outcome = test::run_tool(arguments);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr("the name of a file is empty"));
  }
  const auto outcome = test::run_tool({"upsample", "", "-o", folder_ / "out.exr"});
  EXPECT_EQ(outcome.exit, 2) << outcome;
  EXPECT_TRUE(outcome.one_line()) << outcome;
}

}  // namespace
}  // namespace spectile
