// Messages that help: the nearest name, the command whose help explains, what was done and which option
// changes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class Messages : public testing::Test {
 protected:
  Messages() {
    test::Picture picture = test::blank(4, 4);
    picture.add("R", Imf::FLOAT, [](int x, int) { return x == 0 ? -0.5 : x == 1 ? 1.5 : 0.3; });
    picture.add("G", Imf::FLOAT, [](int, int) { return 0.2; });
    picture.add("B", Imf::FLOAT, [](int, int) { return 0.4; });
    test::write_scanlines(in_, picture);
  }
  void expect_usage(const std::vector<std::string>& arguments, const std::string& start,
                    const std::string& end) {
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("spectile: " + start), EndsWith(end + "\n")));
  }
  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(Messages, AnUnknownOptionNamesTheNearest) {
  expect_usage({"relight", in_, "-o", out_, "--ilumiant", "D65"},
               "unknown option --ilumiant; did you mean --illuminant?", "(see spectile relight --help)");
  expect_usage({"upsample", in_, "-o", out_, "--compresion=zip"},
               "unknown option --compresion; did you mean --compression?", "(see spectile upsample --help)");
  expect_usage({"film", "merge", in_, "--otuput", out_}, "unknown option --otuput; did you mean --output?",
               "(see spectile film merge --help)");
  // The start of a name, a name like no other, and a letter.
  expect_usage({"upsample", in_, "-o", out_, "--comp", "zip"},
               "unknown option --comp; did you mean --compression?", "(see spectile upsample --help)");
  expect_usage({"info", in_, "--frobnicate"}, "unknown option --frobnicate (see",
               "(see spectile info --help)");
  expect_usage({"info", in_, "-z"}, "unknown option -z (see", "(see spectile info --help)");
}

TEST_F(Messages, AnUnknownCommandNamesTheNearest) {
  expect_usage({"upsmaple", in_}, "unknown command \"upsmaple\"; did you mean upsample?",
               "(see spectile --help)");
  expect_usage({"film", "simulat"}, "unknown command \"simulat\"; did you mean simulate?",
               "(see spectile film --help)");
  expect_usage({"paint", in_}, "unknown command \"paint\"; there are demo, upsample",
               "(see spectile --help)");
}

TEST_F(Messages, WrongUsageNamesTheCommandWhoseHelpExplainsIt) {
  expect_usage({"upsample", in_}, "--output is required", "(see spectile upsample --help)");
  expect_usage({"upsample", in_, "-o", out_, "--region", "1"}, "--region", "(see spectile upsample --help)");
  expect_usage({"upsample", in_, "-o", out_, "--shard", "3"}, "--shard", "(see spectile upsample --help)");
  expect_usage({"info", in_, "--pixel", "1;2"}, "--pixel", "(see spectile info --help)");
  expect_usage({"project", in_, "-o", out_, "--illuminant", "D66"}, "", "(see spectile project --help)");
  expect_usage({"film", "simulate", "-o", out_, "--shard", "3"}, "--shard",
               "(see spectile film simulate --help)");
  expect_usage({"spectra", "--at", "500"}, "SPECTRUM", "(see spectile spectra --help)");
  expect_usage({}, "", "(see spectile --help)");
}

TEST_F(Messages, ANumberOfBandsSaysHowToAskForThem) {
  for (const char* const command : {"upsample", "verify"}) {
    std::vector<std::string> arguments = {command, in_, "--bands", "8"};
    if (arguments[0] == "upsample") arguments.insert(arguments.end(), {"-o", out_});
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("400:700:37.5"), HasSubstr("plan --count 8")));
  }
  // The text that it gives is taken.
  for (const int n : {1, 2, 7, 8, 13, 60, 300}) {
    const auto said = run_tool({"upsample", in_, "-o", out_, "--bands", std::to_string(n)});
    const std::size_t at = said.err.find("such as ") + 8;
    const std::string bands = said.err.substr(at, said.err.find_first_of(", ", at) - at);
    const auto outcome = run_tool({"upsample", in_, "-o", out_, "--method", "smits", "--bands", bands});
    EXPECT_EQ(outcome.exit, 0) << said << outcome;
    EXPECT_THAT(outcome.out, HasSubstr(", " + std::to_string(n) + (n == 1 ? " band," : " bands,"))) << said;
  }
}

TEST_F(Messages, APlanWithoutALightSaysFileLightAndRemedy) {
  const std::string plan = folder_ / "plan.json";
  const std::string spectral = folder_ / "spectral.exr";
  ASSERT_EQ(run_tool({"plan", "--illuminant", "D65", "--count", "4", "--folds", "0", "-o", plan}).exit, 0);
  ASSERT_EQ(run_tool({"upsample", in_, "-o", spectral, "--bands", plan}).exit, 0);
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"project", spectral, "-o", out_, "--illuminant", "A"}, spectral},
      {{"upsample", in_, "-o", out_, "--bands", plan, "--white", "A"}, plan},
      {{"relight", in_, "-o", out_, "--bands", plan, "--illuminant", "A"}, plan},
      {{"relight", in_, "-o", out_, "--bands", plan, "--illuminant", "D65", "--white", "A"}, plan},
      {{"verify", in_, "--bands", plan, "--white", "A"}, plan}};
  for (const auto& [arguments, file] : cases) {
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr(file + ": its plan holds no emission values for the light A, only for D65"),
                      HasSubstr("add --illuminant A to spectile plan")));
  }
}

TEST_F(Messages, ReportsSayWhatBecameOfUnusualColors) {
  const auto said = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"upsample", in_, "-o", out_});
    return run_tool(more).out;
  };
  EXPECT_THAT(
      said({}),
      AllOf(HasSubstr("4 pixels with a component below 0, treated as colours out of gamut; --negative"),
            HasSubstr("4 pixels above 1, which no real reflectance is: kept, so that spectra exceed "
                      "1; --quantity unbounded"),
            HasSubstr("outside the method's gamut, clipped towards the grey of their luminance; "
                      "--out-of-gamut keep")));
  EXPECT_THAT(said({"--method", "sigmoid"}),
              HasSubstr("which no real reflectance is: clipped to the method's gamut"));
  EXPECT_THAT(said({"--out-of-gamut", "keep"}),
              HasSubstr("method's gamut, kept as they are; --out-of-gamut clip"));
  EXPECT_THAT(said({"--negative", "clip"}), HasSubstr("below 0, clipped to 0; --negative gamut or keep"));
  EXPECT_THAT(said({"--negative", "keep"}), HasSubstr("below 0, kept as they are; --negative gamut or clip"));
}

TEST_F(Messages, CountsOfAQuietRunAreInItsJson) {
  const auto outcome = run_tool({"upsample", in_, "-o", out_, "--quiet", "--json"});
  const auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 1U) << outcome;
  EXPECT_EQ(objects[0]["negative_pixels"], 4);
  EXPECT_EQ(objects[0]["over_one_pixels"], 4);
  EXPECT_GT(objects[0]["out_of_gamut_pixels"], 0);
}

TEST_F(Messages, ASlurmTaskOfOneInputOrOneOutputIsRefused) {
  const test::Tool::Options task = {
      .environment = {{"SLURM_ARRAY_TASK_ID", "1"}, {"SLURM_ARRAY_TASK_COUNT", "4"}}};
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"upsample", in_, "-o", out_}, {"upsample", in_, "-o", folder_ / "new/"}}) {
    const auto outcome = run_tool(arguments, task);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("task 1/4 of a Slurm array"), HasSubstr("--shard none")));
  }
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"in.exr"});
  EXPECT_EQ(run_tool({"upsample", in_, "-o", out_, "--shard", "none"}, task).exit, 0);
  EXPECT_TRUE(std::filesystem::exists(out_));
}

TEST_F(Messages, InfoPointsFromCoefficientsToTheirExpansion) {
  ASSERT_EQ(run_tool({"upsample", in_, "-o", out_, "--store", "coefficients", "--method", "sigmoid"}).exit,
            0);
  EXPECT_THAT(run_tool({"info", out_}).out, HasSubstr("coefficients of sigmoid; spectile expand"));
  EXPECT_EQ(test::json_lines(run_tool({"info", out_, "--json"}).out).at(0)["coefficients_of"], "sigmoid");
  EXPECT_THAT(run_tool({"info", in_}).out, Not(HasSubstr("coefficients")));
}

TEST_F(Messages, OneWordHasOneMeaning) {
  const auto bytes = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"upsample", in_, "-o", out_});
    EXPECT_EQ(run_tool(more).exit, 0);
    return test::file_bytes(out_);
  };
  EXPECT_TRUE(bytes({"--depth", "float"}) == bytes({"--pixel", "float"}));
  EXPECT_FALSE(bytes({"--depth", "float"}) == bytes({}));
  const auto plan = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"plan", "--illuminant", "D65", "--folds", "0", "-o", folder_ / "plan.json"});
    EXPECT_EQ(run_tool(more).exit, 0);
    return nlohmann::json::parse(test::file_bytes(folder_ / "plan.json"));
  };
  const auto bands = plan({"--count", "4"});
  EXPECT_EQ(bands, plan({"--bands", "4"}));
  EXPECT_EQ(bands["bands_nm"].size(), 4U) << "bands by default, as files hold them";
  EXPECT_FALSE(plan({"--count", "4", "--sample", "points"}).contains("bands_nm"));
  for (const char* const command : {"upsample", "relight", "project", "expand", "plan"}) {
    const std::string help = run_tool({command, "--help"}).out;
    EXPECT_THAT(help, Not(HasSubstr("--pixel"))) << command;
    EXPECT_THAT(help, Not(HasSubstr("--bands N"))) << command;
  }
  EXPECT_THAT(run_tool({"plan", "--help"}).out, HasSubstr("--count N"));
}

TEST_F(Messages, PixelsCountFromTheDataWindowsOrigin) {
  test::Picture picture = test::blank(8, 6, {-20, 10});
  picture.add("R", Imf::FLOAT, [](int x, int y) { return x == 3 && y == 2 ? HUGE_VAL : 0.25; });
  picture.add("G", Imf::FLOAT, [](int x, int y) { return x == 5 && y == 4 ? -1 : 0.5; });
  picture.add("B", Imf::FLOAT, [](int, int) { return 0.75; });
  test::write_scanlines(in_, picture);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"upsample", in_, "-o", out_},
        {"relight", in_, "-o", out_, "--illuminant", "A"},
        {"plan", "-o", out_, "--illuminant", "A", "--count", "4", "--texture", in_},
        {"upsample", in_, "-o", out_, "--region", "-18,11,-14,15"}}) {
    EXPECT_THAT(run_tool(command).err, HasSubstr("the first at 3,2")) << command[0];
  }
  const auto info = run_tool({"info", in_, "--pixel", "3,2", "--json"});
  ASSERT_EQ(info.exit, 0) << info;
  EXPECT_TRUE(test::json_lines(info.out).at(0)["pixel"][2].is_null()) << info.out;
  const auto negative = run_tool({"upsample", in_, "-o", out_, "--nonfinite", "zero", "--negative", "error"});
  EXPECT_THAT(negative.err, HasSubstr("the first at 5,4"));
}

}  // namespace
}  // namespace spectile
