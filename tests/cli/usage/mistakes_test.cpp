// Mistakes of users in a hurry: each message names the file, what is wrong and the remedy, and nothing is written.
// written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;
using Words = std::vector<std::string>;

class Mistakes : public testing::Test {
 protected:
  Mistakes() {
    test::Picture picture = test::blank(4, 4);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(in_, picture);
    test::write_text(empty_, "");
    std::filesystem::create_directory(directory_);
  }
  void expect_refused(const Words& arguments, int exit, const Words& said) {
    const auto names = folder_.names();
    const auto outcome = run_tool(arguments);
    std::string all;
    for (const std::string& word : arguments) all += word + " ";
    EXPECT_EQ(outcome.exit, exit) << all << outcome;
    EXPECT_TRUE(outcome.one_line()) << all << outcome;
    for (const std::string& words : said) EXPECT_THAT(outcome.err, HasSubstr(words)) << all;
    EXPECT_EQ(folder_.names(), names) << all;
  }
  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
  const std::string plan_ = folder_ / "plan.json";
  const std::string none_ = folder_ / "none.exr";
  const std::string empty_ = folder_ / "empty.exr";
  const std::string directory_ = folder_ / "directory";
};

TEST_F(Mistakes, InputsThatAreNoneAreNamedByEveryCommand) {
  const auto commands = [&](const std::string& input) {
    return std::vector<Words>{
        {"upsample", input, "-o", out_},
        {"relight", input, "-o", out_, "--illuminant", "A"},
        {"project", input, "-o", out_},
        {"expand", input, "-o", out_},
        {"verify", input},
        {"info", input},
        {"film", "average", in_, input, "-o", out_},
        {"film", "merge", input, "-o", out_},
        {"film", "develop", input, "-o", out_},
        {"upsample", in_, "-o", out_, "--mask", input},
        {"plan", "--illuminant", "D65", "--count", "4", "-o", plan_, "--texture", input}};
  };
  for (const auto& [input, said] : {std::pair{none_, "cannot read: No such file or directory"},
                                    {empty_, "not an OpenEXR file: it is empty"},
                                    {directory_, "cannot read: is a directory"}}) {
    for (const Words& command : commands(input)) expect_refused(command, 1, {input + ": " + said});
  }
}

TEST_F(Mistakes, TablesThatAreNoneAreNamedByEveryCommand) {
  const std::string spectral = folder_ / "spectral.exr";
  ASSERT_EQ(run_tool({"upsample", in_, "-o", spectral}).exit, 0);
  const std::string missing = folder_ / "none.csv";
  for (const auto& [table, said] : {std::pair{missing, "cannot read: No such file or directory"},
                                    {empty_, "holds no sample"},
                                    {directory_, "cannot read: not a plain file"},
                                    {in_, "this is no text"}}) {
    for (const Words& command :
         {Words{"relight", in_, "-o", out_, "--illuminant", table},
          {"project", spectral, "-o", out_, "--illuminant", table},
          {"upsample", in_, "-o", out_, "--white", table},
          {"verify", in_, "--white", table},
          {"spectra", table},
          {"plan", "--illuminant", table, "--count", "4", "-o", plan_},
          {"plan", "--illuminant", "A", "--count", "4", "-o", plan_, "--reflectances", table},
          {"bench", "--only", "half to float", "--reflectances", table}}) {
      // A name without a point or slash would be one of a spectrum; these are files.
      expect_refused(command, 1, {table + ": ", said});
    }
  }
  expect_refused({"project", in_, "-o", out_, "--channels", missing}, 1,
                 {missing + ": cannot read: No such file or directory"});
  expect_refused({"project", in_, "-o", out_, "--channels", empty_}, 1,
                 {empty_ + ": names no channel", "NAME,LOWER,UPPER"});
  expect_refused({"upsample", in_, "-o", out_, "--bands", folder_ / "none.json"}, 1,
                 {"none.json: cannot read"});
  expect_refused({"upsample", in_, "-o", out_, "--bands", directory_ + "/x.json"}, 1,
                 {"x.json: cannot read"});
}

TEST_F(Mistakes, TheWrongCommandForAnImageNamesTheRightOne) {
  expect_refused({"project", in_, "-o", out_}, 1,
                 {in_ + ": has no spectral channels", "upsample makes spectra of its colours", "--channels"});
  expect_refused({"expand", in_, "-o", out_}, 1,
                 {in_ + ": holds no coefficients", "which upsample --store coefficients writes"});
  for (const char* command : {"merge", "develop"}) {
    expect_refused({"film", command, in_, "-o", out_}, 1,
                   {in_ + ": not a partial film, as film simulate writes; film average averages images"});
  }
}

TEST_F(Mistakes, ChoicesThatAreNotThereListThoseThatAre) {
  expect_refused({"upsample", in_, "-o", out_, "--layer", "diffuse"}, 1,
                 {in_ + ": has no colour of layer \"diffuse\"; it has colour R, G, B"});
  expect_refused({"relight", in_, "-o", out_, "--illuminant", "A", "--view", "left"}, 1,
                 {"has no colour of view \"left\"; it has colour R, G, B"});
  expect_refused({"verify", in_, "--part", "3"}, 1, {in_ + ": has no part \"3\"; it has 0\n"});
  expect_refused({"info", in_, "--pixel", "50,50"}, 2,
                 {in_ + ": pixel 50,50 lies outside the image of 4 x 4"});
  expect_refused({"upsample", in_, "-o", out_, "--region", "9,9,12,12"}, 2,
                 {in_ + ": the region 9,9,12,12 lies outside of the data window 0,0,3,3"});
  expect_refused({"upsample", in_, "-o", out_, "--input-space", "acesgc"}, 2,
                 {"\"acesgc\" is unknown; there are", "acescg"});
  expect_refused({"upsample", in_, "-o", out_, "--method", "sigmiod"}, 2, {"sigmiod", "sigmoid"});
  expect_refused({"relight", in_, "-o", out_, "--illuminant", "D66"}, 2,
                 {"\"D66\" is unknown; near it: D60, D65"});
  expect_refused({"verify", in_, "--alpha", "strait"}, 2, {"strait", "straight"});
}

TEST_F(Mistakes, OutputsThatCannotBeAreRefusedByEveryCommand) {
  const auto commands = [&](const std::string& output) {
    return std::vector<Words>{{"upsample", in_, "-o", output},
                              {"relight", in_, "-o", output, "--illuminant", "A"},
                              {"film", "average", in_, "-o", output}};
  };
  for (const Words& command : commands(folder_ / "out.png"))
    expect_refused(command, 2,
                   {"out.png: images are written as OpenEXR only, not as png; name it", "out.exr"});
  for (const Words& command : commands("-"))
    expect_refused(command, 2, {"- would be standard output", "name a file"});
  for (const Words& command : commands(in_))
    expect_refused(command, 2, {in_ + ": input and output are the same file"});
  for (const Words& command : commands(folder_ / "none/out.exr"))
    expect_refused(command, 1, {"none/out.exr: cannot write: No such file or directory"});
}

TEST_F(Mistakes, APlanForAnotherObserverSaysFileAndRemedy) {
  ASSERT_EQ(run_tool({"plan", "--illuminant", "D65", "--count", "4", "--folds", "0", "-o", plan_}).exit, 0);
  const std::string spectral = folder_ / "spectral.exr";
  ASSERT_EQ(run_tool({"upsample", in_, "-o", spectral, "--bands", plan_}).exit, 0);
  const std::string said =
      ": its plan is for the 1931 observer, not the 1964; choose the plan's observer, or another";
  expect_refused({"project", spectral, "-o", out_, "--observer", "1964"}, 2,
                 {spectral + said, "plan --observer"});
  for (const Words& command :
       {Words{"relight", in_, "-o", out_, "--illuminant", "D65", "--observer", "1964", "--bands", plan_},
        {"upsample", in_, "-o", out_, "--white-observer", "1964", "--bands", plan_},
        {"verify", in_, "--white-observer", "1964", "--bands", plan_},
        {"film", "simulate", "--size", "4", "4", "-o", out_, "--observer", "1964", "--input", "bands",
         "--bands", plan_}}) {
    expect_refused(command, 2, {plan_ + said, "plan --observer"});
  }
}

/// Of alpha as upsample takes it; every value holds its bound.
TEST_F(Mistakes, VerifyTakesAlpha) {
  test::Picture picture = test::blank(70, 3);
  test::add_rgb_noise(picture, Imf::FLOAT, 0.5);
  picture.add("A", Imf::FLOAT, [](int x, int y) { return test::noise(x, y, 7); });
  test::write_scanlines(in_, picture);
  for (const char* alpha : {"premultiplied", "straight", "ignore"}) {
    for (const char* isa : {"scalar", ""}) {
      Words words = {"verify", in_, "--method", "sigmoid", "--alpha", alpha};
      if (*isa != '\0') words.insert(words.end(), {"--isa", isa});
      const auto outcome = run_tool(words);
      EXPECT_EQ(outcome.exit, 0) << outcome;
      EXPECT_THAT(outcome.out, HasSubstr("210 pixels: ok")) << alpha;
    }
  }
}

}  // namespace
}  // namespace spectile
