// --region: what it may be, and what the report says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

class RegionOption : public testing::Test {
 protected:
  RegionOption() {
    test::Picture picture = test::blank(40, 30, {-20, 10});
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(in_, picture);
  }
  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(RegionOption, IsTakenByEveryCommand) {
  const auto upsampled = run_tool({"upsample", in_, "-o", out_, "--region", "-15,12,4,31"});
  EXPECT_EQ(upsampled.exit, 0) << upsampled;
  EXPECT_THAT(upsampled.out, HasSubstr(": 20 x 20, "));
  const auto lit =
      run_tool({"relight", in_, "-o", folder_ / "lit.exr", "--illuminant", "A", "--region=-15,12,4,31"});
  EXPECT_THAT(lit.out, HasSubstr(": 20 x 20, ")) << lit;
  const auto projected = run_tool({"project", out_, "-o", folder_ / "rgb.exr", "--region", "0,20,0,20"});
  EXPECT_THAT(projected.out, HasSubstr(": 1 x 1, ")) << projected;
  const std::string compact = folder_ / "compact.exr";
  ASSERT_EQ(run_tool({"upsample", in_, "-o", compact, "--store", "coefficients"}).exit, 0);
  const auto expanded =
      run_tool({"expand", compact, "-o", folder_ / "full.exr", "--region", "-100,30,100,100"});
  EXPECT_THAT(expanded.out, HasSubstr(": 40 x 10, ")) << expanded;
  EXPECT_THAT(expanded.out, HasSubstr("  the region -100,30,100,100 is limited to -20,30,19,39"));
}

TEST_F(RegionOption, WhatItCannotBeIsWrongUsage) {
  for (const char* bad : {"1,2,3", "1,2,3,4,5", "a,b,c,d", "1,2,0,4", "1,5,3,4", "1.5,2,3,4", "1,2,3,",
                          "1, 2,3,4", "1,2,3,99999999999", "100,100,200,200"}) {
    const auto outcome = run_tool({"upsample", in_, "-o", out_, "--region", bad});
    EXPECT_EQ(outcome.exit, 2) << bad << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

TEST_F(RegionOption, IsASetting) {
  EXPECT_EQ(run_tool({"upsample", in_, "-o", out_, "--region", "0,20,9,29"}).exit, 0);
  const auto other = run_tool({"upsample", in_, "-o", out_, "--region", "0,20,9,30", "-u"});
  EXPECT_THAT(other.out, HasSubstr("1 converted, 0 up to date")) << other;
}

}  // namespace
}  // namespace spectile
