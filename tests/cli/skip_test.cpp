// The tool's options for what is skipped: masks, statistics, and the same file without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

class SkipTool : public testing::Test {
 protected:
  SkipTool() {
    // Black below line 16, and alpha 0 in its left half.
    test::Picture picture = test::blank(128, 64);
    int channel = 0;
    for (const char* name : {"R", "G", "B"}) {
      const int c = channel++;
      picture.add(name, Imf::HALF,
                  [=](int x, int y) { return y < 16 ? 0.1 + 0.8 * test::noise(x, y, c) : 0; });
    }
    picture.add("A", Imf::HALF, [](int x, int) { return x < 64 ? 0 : 1; });
    test::write_scanlines(in_, picture);
    test::Picture mask = test::blank(128, 64);
    mask.add("Y", Imf::FLOAT, [](int x, int y) { return x == 3 && y == 5 ? 0 : 1; });
    test::write_scanlines(mask_, mask);
  }

  test::Outcome upsample(const std::vector<std::string>& options) const {
    std::vector<std::string> all = {"upsample", in_, "-o", out_};
    all.insert(all.end(), options.begin(), options.end());
    return run_tool(all);
  }

  nlohmann::json skipped(std::vector<std::string> options) const {
    options.push_back("--json");
    const auto outcome = upsample(options);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    return nlohmann::json::parse(outcome.out).at("skipped");
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string mask_ = folder_ / "mask.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(SkipTool, JsonAlwaysSaysWhatWasSkipped) {
  const nlohmann::json found = skipped({"--mask", "alpha"});
  EXPECT_EQ(found.at("masked_pixels"), 64 * 64);
  EXPECT_EQ(found.at("black_pixels"), 64 * 48);
  EXPECT_EQ(found.at("constant_pixels"), 0);
  EXPECT_EQ(found.at("chunks"), 4);
  EXPECT_EQ(found.at("chunks_reused"), 2);
  const nlohmann::json nothing = skipped({"--no-skip"});
  for (const auto& [name, number] : nothing.items()) EXPECT_EQ(number, 0) << name;
}

TEST_F(SkipTool, StatsAreText) {
  const auto plain = upsample({"--mask", "alpha"});
  ASSERT_EQ(plain.exit, 0) << plain;
  EXPECT_THAT(plain.out, testing::Not(HasSubstr("skipped")));
  EXPECT_THAT(plain.out, HasSubstr("1024 pixels of alpha 0 with a colour"));
  const auto stats = upsample({"--mask", "alpha", "--stats"});
  EXPECT_THAT(stats.out, HasSubstr("skipped: 4096 pixels masked, 3072 black, 0 in blocks of one colour"));
  EXPECT_THAT(stats.out, HasSubstr("2 of 4 chunks reused"));
}

TEST_F(SkipTool, MasksAreAlphaNoneOrAFile) {
  EXPECT_EQ(skipped({}).at("masked_pixels"), 0);
  EXPECT_EQ(skipped({"--mask", "none"}).at("masked_pixels"), 0);
  EXPECT_EQ(skipped({"--mask", mask_}).at("masked_pixels"), 1);
  const auto missing = upsample({"--mask", folder_ / "missing.exr"});
  EXPECT_EQ(missing.exit, 1);
  EXPECT_TRUE(missing.one_line());
  EXPECT_THAT(missing.err, HasSubstr("missing.exr"));
}

TEST_F(SkipTool, SameFileWithout) {
  for (const std::string method : {"smits-exact", "sigmoid"}) {
    ASSERT_EQ(upsample({"--method", method}).exit, 0);
    const std::string bytes = test::file_bytes(out_);
    ASSERT_EQ(upsample({"--method", method, "--no-skip"}).exit, 0);
    EXPECT_TRUE(test::file_bytes(out_) == bytes);
  }
}

}  // namespace
}  // namespace spectile
