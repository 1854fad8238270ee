// Plans through the tool: plan, upsample with it, project, relight, expand, a film; and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/image/plan_file.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

class PlannedBandsTool : public testing::Test {
 protected:
  void SetUp() override {
    const auto made = run_tool({"plan", "--illuminant", "D65", "--illuminant", "FL11", "--bands", "7",
                                "--sample", "bands", "--folds", "0", "-o", plan_});
    ASSERT_EQ(made.exit, 0) << made;
    test::Picture picture = test::blank(40, 21);
    test::add_rgb_noise(picture, Imf::FLOAT);
    test::write_scanlines(in_, picture);
  }

  test::TempFolder folder_;
  const std::string plan_ = folder_ / "plan.json";
  const std::string in_ = folder_ / "in.exr";
  const std::string spectral_ = folder_ / "spectral.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(PlannedBandsTool, ImagesComeBackWithoutTheirPlansFile) {
  const auto up = run_tool({"upsample", in_, "-o", spectral_, "--bands", plan_, "--pixel", "float"});
  ASSERT_EQ(up.exit, 0) << up;
  EXPECT_THAT(up.out, HasSubstr("7 bands"));
  std::filesystem::remove(plan_);
  const auto back = run_tool({"project", spectral_, "-o", out_, "--pixel", "float"});
  ASSERT_EQ(back.exit, 0) << back;
  const test::Picture before = test::read_picture(in_);
  const test::Picture after = test::read_picture(out_);
  for (const char* name : {"R", "G", "B"}) {
    for (std::size_t i = 0; i < 40 * 21; ++i) {
      ASSERT_NEAR(after.planes.at(name).at(i), before.planes.at(name).at(i), 4e-6) << name << i;
    }
  }
  const auto info = run_tool({"info", spectral_});
  EXPECT_EQ(info.exit, 0) << info;
  EXPECT_THAT(info.out, HasSubstr("spectilePlan: {\"wavelengths_nm\":["));
}

TEST_F(PlannedBandsTool, LightsOfThePlanCanBeSeenUnderOthersNot) {
  ASSERT_EQ(run_tool({"upsample", in_, "-o", spectral_, "--bands", plan_}).exit, 0);
  const auto fl11 = run_tool({"project", spectral_, "-o", out_, "--illuminant", "FL11"});
  EXPECT_EQ(fl11.exit, 0) << fl11;
  const auto relit = run_tool({"relight", in_, "-o", out_, "--illuminant", "FL11", "--bands", plan_});
  EXPECT_EQ(relit.exit, 0) << relit;
  const auto other = run_tool({"project", spectral_, "-o", out_, "--illuminant", "A"});
  EXPECT_NE(other.exit, 0) << other;
  EXPECT_TRUE(other.one_line()) << other;
  EXPECT_THAT(other.err, HasSubstr("only for D65, FL11"));
  const auto white = run_tool({"upsample", in_, "-o", out_, "--bands", plan_, "--white", "HP1"});
  EXPECT_NE(white.exit, 0);
  EXPECT_TRUE(white.one_line()) << white;
}

TEST_F(PlannedBandsTool, ANewPlanMakesOldOutputsOutOfDate) {
  const std::vector<std::string> command = {"upsample", in_, "-o", spectral_, "--bands", plan_, "--update"};
  ASSERT_EQ(run_tool(command).exit, 0);
  EXPECT_THAT(run_tool(command).out, HasSubstr("up to date"));
  Plan plan = *load_plan(plan_);
  plan.weights.lights[0].emission[2] *= 1.01;
  ASSERT_TRUE(save_plan(plan, plan_));
  const auto again = run_tool(command);
  EXPECT_EQ(again.exit, 0) << again;
  EXPECT_THAT(again.out, HasSubstr("7 bands"));
}

TEST_F(PlannedBandsTool, CoefficientsExpandAndFilmsTakeThem) {
  ASSERT_EQ(run_tool({"upsample", in_, "-o", spectral_, "--store", "coefficients"}).exit, 0);
  const auto expanded = run_tool({"expand", spectral_, "-o", out_, "--bands", plan_});
  EXPECT_EQ(expanded.exit, 0) << expanded;
  EXPECT_THAT(expanded.out, HasSubstr("7 bands"));
}

TEST_F(PlannedBandsTool, WhatIsNoPlanIsOneLine) {
  test::write_text(folder_ / "bad.json", "{\"wavelengths_nm\": [500]}");
  for (const std::string& bands : {folder_ / "bad.json", folder_ / "missing.json", in_}) {
    const auto outcome = run_tool({"upsample", in_, "-o", out_, "--bands", bands});
    EXPECT_NE(outcome.exit, 0) << bands;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

}  // namespace
}  // namespace spectile
