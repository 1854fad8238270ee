// The tool stores coefficients and expands them to what it would have written directly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
namespace fs = std::filesystem;

class ExpandTool : public testing::Test {
 protected:
  ExpandTool() {
    test::Picture picture = test::blank(75, 33);
    test::add_rgb_noise(picture, Imf::HALF);
    picture.add("A", Imf::HALF, [](int x, int y) { return test::noise(x, y, 5); });
    test::write_scanlines(in_, picture);
  }

  /// Runs and expects one line on stderr, nothing on stdout, the exit code, and no output file.
  void expect_failure(const std::vector<std::string>& arguments, int exit, const std::string& named) const {
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, exit) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, testing::HasSubstr(named));
    EXPECT_FALSE(fs::exists(out_));
  }

  /// Attributes but the settings, which say how each was made, and all samples.
  static std::pair<std::map<std::string, std::string>, std::map<std::string, test::Plane>> without_settings(
      const std::string& path) {
    const test::Picture picture = test::read_picture(path);
    std::map<std::string, std::string> attributes;
    for (auto it = picture.header.begin(); it != picture.header.end(); ++it) {
      attributes[it.name()] = test::attribute_bytes(it.attribute());
    }
    EXPECT_EQ(attributes.erase("spectileSettings"), 1U);
    return {attributes, picture.planes};
  }
  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string compact_ = folder_ / "compact.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(ExpandTool, GivesTheFileThatUpsampleWrites) {
  for (const std::string method : {"sigmoid", "smits-exact"}) {
    for (const std::string pixel : {"half", "float"}) {
      ASSERT_EQ(
          run_tool({"upsample", in_, "-o", folder_ / "direct.exr", "--method", method, "--pixel", pixel})
              .exit,
          0);
      // A compact image is float whatever is asked for.
      ASSERT_EQ(run_tool({"upsample", in_, "-o", compact_, "--method", method, "--store", "coefficients",
                          "--pixel", "half"})
                    .exit,
                0);
      const auto outcome = run_tool({"expand", compact_, "-o", out_, "--pixel", pixel, "--threads", "2"});
      ASSERT_EQ(outcome.exit, 0) << outcome;
      EXPECT_THAT(outcome.out, testing::HasSubstr("75 x 33, 60 bands"));
      EXPECT_TRUE(without_settings(out_) == without_settings(folder_ / "direct.exr"))
          << method << " " << pixel;
      EXPECT_LT(fs::file_size(compact_), fs::file_size(out_) / 3);
    }
  }
}

TEST_F(ExpandTool, TakesBandsCompressionAndSeveralInputs) {
  ASSERT_EQ(
      run_tool({"upsample", in_, "-o", compact_, "--method", "sigmoid", "--store", "coefficients"}).exit, 0);
  fs::copy_file(compact_, folder_ / "other.exr");
  const auto outcome = run_tool({"expand", compact_, folder_ / "other.exr", "-o", folder_ / "many/",
                                 "--bands", "450:650:50", "--compression", "piz", "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  const auto reports = test::json_lines(outcome.out);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports[1]["bands"], 4);
  const test::Picture out = test::read_picture(folder_ / "many/other.exr");
  EXPECT_EQ(out.header.compression(), Imf::PIZ_COMPRESSION);
  EXPECT_EQ(out.planes.size(), 8U);
  EXPECT_TRUE(out.planes.contains("T.475,000000nm"));
}

TEST_F(ExpandTool, SaysWhatIsWrongInOneLine) {
  ASSERT_EQ(run_tool({"upsample", in_, "-o", compact_, "--store", "coefficients"}).exit, 0);
  expect_failure({"expand", in_, "-o", out_}, 1, in_ + ": holds no coefficients");
  expect_failure({"expand", folder_ / "none.exr", "-o", out_}, 1, "none.exr");
  expect_failure({"expand", compact_, "-o", out_, "--bands", "400:700"}, 2, "400:700");
  expect_failure({"expand", compact_, "-o", out_, "--bands", "900:1000:50"}, 2, "900:1000:50");
  expect_failure({"expand", compact_, "-o", out_, "--pixel", "uint"}, 2, "uint");
  expect_failure({"expand", compact_}, 2, "output");
  expect_failure({"upsample", in_, "-o", out_, "--store", "both"}, 2, "both");
  expect_failure({"expand", compact_, "-o", folder_ / "missing/out.exr"}, 1, "missing");
}

TEST_F(ExpandTool, NonFiniteCoefficientsStopOrBecomeBlack) {
  ASSERT_EQ(run_tool({"upsample", in_, "-o", compact_, "--store", "coefficients"}).exit, 0);
  test::Picture picture = test::read_picture(compact_);
  picture.planes.at("spectile.c1").set(picture.index(7, 5), HUGE_VAL);
  test::write_scanlines(folder_ / "inf.exr", picture);
  expect_failure({"expand", folder_ / "inf.exr", "-o", out_}, 1, "1 non-finite pixel, the first at 7,5");
  const auto outcome = run_tool({"expand", folder_ / "inf.exr", "-o", out_, "--nonfinite", "zero"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, testing::HasSubstr("1 non-finite pixel made black"));
}

}  // namespace
}  // namespace spectile
