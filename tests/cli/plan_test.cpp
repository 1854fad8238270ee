// spectile plan: from lights and reflectances, or textures, to a plan file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/plan_file.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;
using testing::Not;

class PlanCommand : public testing::Test {
 protected:
  std::vector<std::string> plan(std::vector<std::string> more) const {
    std::vector<std::string> out = {"plan", "-o", output_};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  void expect_failure(const std::vector<std::string>& more, int exit, const std::string& named) {
    const auto outcome = run_tool(plan(more));
    EXPECT_EQ(outcome.exit, exit) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(named));
    EXPECT_FALSE(std::filesystem::exists(output_));
  }
  test::TempFolder folder_;
  const std::string output_ = folder_ / "plan.json";
};

TEST_F(PlanCommand, NeverReplacesADependency) {
  std::string table;
  for (int nm = 380; nm <= 730; nm += 50) {
    table += std::to_string(nm);
    for (int i = 0; i < 10; ++i) table += "," + std::to_string(0.5 + 0.4 * std::sin(nm * 0.01 + i));
    table += "\n";
  }
  test::write_text(output_, table);
  for (const char* const option : {"--reflectances", "--illuminant", "--texture"}) {
    const auto outcome =
        run_tool(plan({"--illuminant", "D65", option, output_, "--bands", "3", "--folds", "0"}));
    EXPECT_EQ(outcome.exit, 2) << option << outcome;
    EXPECT_THAT(outcome.err, HasSubstr("which it is made from")) << option;
    EXPECT_TRUE(test::file_bytes(output_) == table) << option;
  }
}

TEST_F(PlanCommand, WritesAPlanAndReportsItsPromise) {
  const auto outcome =
      run_tool(plan({"--illuminant", "d65", "--illuminant", "FL11", "--reflectances", folder_ / "patches.csv",
                     "--bands", "8", "--folds", "2", "--bounces", "2"}));
  EXPECT_EQ(outcome.exit, 1) << outcome;  // no such file yet
  std::string table;
  for (int nm = 380; nm <= 730; nm += 10) {
    table += std::to_string(nm);
    for (int i = 0; i < 20; ++i) {
      table += "," + std::to_string(0.5 + 0.4 * std::sin(nm * 0.01 * (1 + i % 5) + i));
    }
    table += "\n";
  }
  test::write_text(folder_ / "patches.csv", table);
  const auto again =
      run_tool(plan({"--illuminant", "d65", "--illuminant", "FL11", "--reflectances", folder_ / "patches.csv",
                     "--bands", "8", "--folds", "2", "--bounces", "2"}));
  ASSERT_EQ(again.exit, 0) << again;
  EXPECT_THAT(again.out, HasSubstr(output_ + ": 8 wavelengths"));
  EXPECT_THAT(again.out, HasSubstr("planned for 20 reflectances"));
  EXPECT_THAT(again.out, HasSubstr("under D65, 1 bounce "));
  EXPECT_THAT(again.out, HasSubstr("under FL11, 2 bounces "));
  const auto plan = load_plan(output_);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->count(), 8U);
  ASSERT_EQ(plan->weights.lights.size(), 2U);
  EXPECT_EQ(plan->weights.lights[0].name, "D65");
  EXPECT_EQ(plan->report.errors.size(), 4U);
  // The published lights are kept by name alone.
  EXPECT_THAT(test::file_bytes(output_), testing::Not(HasSubstr("\"spectrum\"")));
}

TEST_F(PlanCommand, PrintsThePlanAsJson) {
  const auto outcome = run_tool(plan({"--illuminant", "A", "--bands", "6", "--folds", "0", "--json"}));
  ASSERT_EQ(outcome.exit, 0) << outcome;
  auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].erase("notes"), 1U);
  EXPECT_EQ(objects[0]["wavelengths_nm"].size(), 6U);
  EXPECT_EQ(objects[0], nlohmann::json::parse(test::file_bytes(output_)));
}

TEST_F(PlanCommand, PlansForTheColorsOfATexture) {
  test::Picture picture = test::blank(64, 64);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder_ / "in.exr", picture);
  const auto outcome = run_tool(plan({"--illuminant", "D65", "--texture", folder_ / "in.exr", "--colors",
                                      "30", "--bands", "6", "--folds", "0"}));
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, HasSubstr("planned for 30 colours of textures"));
  EXPECT_THAT(outcome.out, HasSubstr("no cross-validated error"));
  const auto plan = load_plan(output_);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_TRUE(plan->report.errors.empty());
}

TEST_F(PlanCommand, OneBounceIsSaidToBeAssumed) {
  const auto one = run_tool(plan({"--illuminant", "D65", "--bands", "4", "--folds", "0"}));
  ASSERT_EQ(one.exit, 0) << one;
  EXPECT_THAT(one.out, HasSubstr("light meets one material"));
  const auto two = run_tool(plan({"--illuminant", "D65", "--bands", "4", "--folds", "0", "--bounces", "2"}));
  ASSERT_EQ(two.exit, 0) << two;
  EXPECT_THAT(two.out, Not(HasSubstr("light meets one material")));
  const auto given =
      run_tool(plan({"--illuminant", "D65", "--bands", "4", "--folds", "0", "--bounces", "1"}));
  EXPECT_THAT(given.out, Not(HasSubstr("light meets one material")));
  const auto json = run_tool(plan({"--illuminant", "D65", "--bands", "4", "--folds", "0", "--json"}));
  EXPECT_THAT(test::json_lines(json.out).at(0)["notes"].dump(), HasSubstr("light meets one material"));
}

TEST_F(PlanCommand, AnErrorThatCannotBeMetIsSaidInOneLine) {
  std::vector<std::string> more = {"--illuminant", "FL11", "--max-error",   "1e-9",
                                   "--folds",      "2",    "--reflectances"};
  const auto names = run_tool({"spectra", "--json"});
  int taken = 0;
  for (const auto& one : test::json_lines(names.out)) {
    if (one["kind"] == "reflectance" && taken++ < 12) more.push_back(one["name"]);
  }
  expect_failure(more, 1, "the best there is");
}

TEST_F(PlanCommand, WrongUsageIsTwo) {
  expect_failure({"--bands", "8"}, 2, "--illuminant");
  expect_failure({"--illuminant", "D65"}, 2, "--count or --max-error");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--max-error", "1"}, 2, "--count or --max-error");
  expect_failure({"--illuminant", "D65", "--bands", "2"}, 2, "--bands");
  expect_failure({"--illuminant", "D66", "--bands", "8"}, 2, "D66");
  expect_failure({"--illuminant", "D65", "--illuminant", "d65", "--bands", "8"}, 2,
                 "two illuminants are called D65");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--bounces", "5"}, 2, "--bounces");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--folds", "1"}, 2, "1 folds");
  expect_failure({"--illuminant", "D65", "--max-error", "-1"}, 2, "-1");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--reflectances", "no-such-name"}, 2,
                 "no-such-name");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--reflectances", "constant:0.5"}, 2,
                 "10 reflectances");
}

TEST_F(PlanCommand, FilesThatCannotBeUsedAreOne) {
  test::write_text(folder_ / "bad.csv", "400,1,2\n500,1\n");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--reflectances", folder_ / "bad.csv"}, 1, "line 2");
  expect_failure({"--illuminant", "D65", "--bands", "8", "--texture", folder_ / "none.exr"}, 1, "none.exr");
}

}  // namespace
}  // namespace spectile
