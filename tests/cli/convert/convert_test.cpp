// spectile convert and spectile validate: exit codes, what they print, wrong usage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::json_lines;
using test::run_tool;
using testing::HasSubstr;

class ConvertTool : public testing::Test {
 protected:
  ConvertTool() {
    // Reflectances in percent, of a program that names edges.
    test::Picture picture = test::blank(9, 7);
    for (int nm = 400; nm < 700; nm += 10) {
      picture.add(std::to_string(nm) + "-" + std::to_string(nm + 10) + "nm", Imf::HALF,
                  [=](int x, int y) { return 100 * test::noise(x, y, nm); });
    }
    test::write_scanlines(in_, picture);
  }
  test::Outcome convert(std::vector<std::string> options) const {
    options.insert(options.begin(), {"convert", in_, "-o", out_});
    return run_tool(options);
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(ConvertTool, PercentOfAnotherDialectFollowsTheLayout) {
  const auto before = run_tool({"validate", in_});
  EXPECT_EQ(before.exit, 1) << before;
  EXPECT_THAT(before.out, HasSubstr(in_ + ": dialect: "));
  EXPECT_THAT(before.out, HasSubstr(in_ + ": remark: preview: "));
  EXPECT_THAT(before.out, testing::Not(HasSubstr("follows")));

  const auto done = convert({"--quantity", "reflectance", "--scale", "0.01", "--bands", "400:700:20"});
  EXPECT_EQ(done.exit, 0) << done;
  EXPECT_THAT(done.out, HasSubstr("15 bands"));
  const test::Picture got = test::read_picture(out_);
  EXPECT_EQ(got.planes.size(), 15U);
  EXPECT_EQ(got.planes.begin()->second.type, Imf::HALF);
  EXPECT_NEAR(got.at("T.410,000000nm", 3, 2), (test::noise(3, 2, 400) + test::noise(3, 2, 410)) / 2, 1e-3);

  const auto after = run_tool({"validate", out_});
  EXPECT_EQ(after.exit, 0) << after;
  EXPECT_THAT(after.out, HasSubstr(out_ + ": follows the layout\n"));
}

TEST_F(ConvertTool, UpdatePassesOverWhatIsUpToDate) {
  ASSERT_EQ(convert({"--quantity", "reflectance"}).exit, 0);
  EXPECT_THAT(convert({"--quantity", "reflectance", "--update"}).out, HasSubstr("up to date"));
  EXPECT_THAT(convert({"--quantity", "reflectance", "--update", "--depth", "half"}).out,
              HasSubstr("1 converted"));
}

TEST_F(ConvertTool, ValidatePrintsJson) {
  ASSERT_EQ(convert({"--quantity", "reflectance", "--quiet"}).exit, 0);
  const auto outcome = run_tool({"validate", in_, out_, folder_ / "none.exr", "--json"});
  EXPECT_EQ(outcome.exit, 1) << outcome;
  const auto lines = json_lines(outcome.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0]["file"], in_);
  EXPECT_EQ(lines[0]["follows_layout"], false);
  EXPECT_EQ(lines[0]["violations"][0]["rule"], "dialect");
  EXPECT_EQ(lines[1]["follows_layout"], true);
  EXPECT_TRUE(lines[1]["violations"].empty());
  EXPECT_TRUE(lines[2].contains("error"));
  const auto quiet = run_tool({"validate", in_, "--quiet"});
  EXPECT_EQ(quiet.exit, 1);
  EXPECT_EQ(quiet.out, "");
}

TEST_F(ConvertTool, WrongUsageIsSaid) {
  const struct {
    std::vector<std::string> options;
    const char* message;
  } kCases[] = {
      {{"--dialect", "mitsuba"},
       "--dialect mitsuba is none of layout, mitsuba06, indigo, ocean; did you mean "
       "mitsuba06?"},
      {{"--dialect", "ocaen"}, "did you mean ocean?"},
      {{"--quantity", "reflectance", "--units", "lx"}, "has no emission, whose units --units would state"},
      {{"--quantity", "reflectance", "--dialect", "indigo"}, "reflectances would be read as that"},
      {{"--scale", "0"}, "scale 0 is not a positive number"},
      {{"--bands", "31"}, "is a wavelength alone"},
      {{"--quantity", "both"}, "both not in {reflectance,illuminant}"},
  };
  for (const auto& c : kCases) {
    const auto outcome = convert(c.options);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
  }
  const auto png = run_tool({"convert", in_, "-o", folder_ / "out.png"});
  EXPECT_EQ(png.exit, 2) << png;
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"in.exr"});
  EXPECT_EQ(run_tool({"convert", in_, "-o", in_}).exit, 2);
  EXPECT_EQ(run_tool({"validate"}).exit, 2);
}

}  // namespace
}  // namespace spectile
