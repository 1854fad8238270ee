// The tool averages renders, and says what is wrong in one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

class FilmAverage : public testing::Test {
 protected:
  FilmAverage() {
    for (int i = 0; i < 3; ++i) {
      test::Picture picture = test::blank(12, 7);
      for (const char* name : {"R", "G"}) {
        picture.add(name, Imf::HALF, [=](int x, int y) { return (i + 1) * (1 + x + y); });
      }
      in_.push_back(folder_ / ("in" + std::to_string(i) + ".exr"));
      test::write_scanlines(in_.back(), picture);
    }
  }
  test::Outcome average(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"film", "average", in_[0], in_[1], in_[2], "-o", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  void expect_failure(const test::Outcome& outcome, int exit, const std::string& named) const {
    EXPECT_EQ(outcome.exit, exit) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(named));
    EXPECT_FALSE(std::filesystem::exists(out_));
  }

  test::TempFolder folder_;
  std::vector<std::string> in_;
  std::string out_ = folder_ / "out.exr";
};

TEST_F(FilmAverage, WritesTheWeightedAverage) {
  const auto equal = average({});
  ASSERT_EQ(equal.exit, 0) << equal;
  EXPECT_THAT(equal.out, HasSubstr("3 images -> " + out_ + ": 12 x 7"));
  EXPECT_EQ(equal.err, "");
  test::Picture out = test::read_picture(out_);
  EXPECT_EQ(out.at("R", 4, 2), 14);
  EXPECT_EQ(out.planes.at("R").type, Imf::HALF);

  const auto weighted =
      average({"--weights", "64,64,128", "--pixel", "float", "--compression", "piz", "--quiet"});
  ASSERT_EQ(weighted.exit, 0) << weighted;
  EXPECT_EQ(weighted.out, "");
  out = test::read_picture(out_);
  EXPECT_EQ(out.at("G", 4, 2), 7 * 2.25);
  EXPECT_EQ(out.planes.at("R").type, Imf::FLOAT);
  EXPECT_EQ(out.header.compression(), Imf::PIZ_COMPRESSION);
}

TEST_F(FilmAverage, TakesImagesAfterTheWeights) {
  const auto outcome =
      run_tool({"film", "average", "--weights", "1,3", "-o", out_, in_[0], in_[2], "--threads", "1"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(test::read_picture(out_).at("R", 0, 0), 2.5);
}

TEST_F(FilmAverage, ReportsAsJson) {
  const auto outcome = average({"--weights", "1,2.5,0", "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  const auto reports = test::json_lines(outcome.out);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0]["inputs"], nlohmann::json(in_));
  EXPECT_EQ(reports[0]["weights"], nlohmann::json({1, 2.5, 0}));
  EXPECT_EQ(reports[0]["output"], out_);
  EXPECT_EQ(reports[0]["width"], 12);
  EXPECT_EQ(reports[0]["nonfinite_pixels"], 0);
  const auto failed = average({"--weights", "1,2", "--json"});
  EXPECT_EQ(failed.exit, 2);
  EXPECT_THAT(test::json_lines(failed.out)[0]["error"], HasSubstr("2 weights for 3 images"));
}

TEST_F(FilmAverage, SaysWhatIsWrongInOneLine) {
  expect_failure(average({"--weights", "1,2"}), 2, "2 weights for 3 images");
  expect_failure(average({"--weights", "1,2,x"}), 2, "1,2,x");
  expect_failure(average({"--weights", "1,2,"}), 2, "1,2,");
  expect_failure(average({"--weights", ""}), 2, "weights");
  expect_failure(average({"--weights=-1,1,1"}), 2, "weight -1");
  expect_failure(average({"--weights", "0,0,0"}), 2, "all weights are 0");
  expect_failure(average({"--pixel", "uint"}), 2, "uint");
  expect_failure(average({"--compression", "gif"}), 2, "gif");
  expect_failure(average({folder_ / "none.exr"}), 1, "none.exr");
  expect_failure(run_tool({"film", "average", in_[0]}), 2, "output");
  expect_failure(run_tool({"film", "average", "-o", out_}), 2, "IN");
  expect_failure(run_tool({"film"}), 2, "subcommand");
  expect_failure(run_tool({"film", "average", in_[0], "-o", folder_ / "missing/out.exr"}), 1, "missing");
  const auto itself = run_tool({"film", "average", in_[0], in_[1], "-o", in_[1]});
  expect_failure(itself, 2, in_[1] + ": input and output are the same file");

  test::Picture other = test::blank(12, 8);
  test::add_rgb_noise(other, Imf::HALF);
  test::write_scanlines(folder_ / "other.exr", other);
  expect_failure(average({folder_ / "other.exr"}), 1,
                 "its display window is 0,0 to 11,7, but that of " + in_[0]);
}

TEST_F(FilmAverage, NonFiniteSamplesStopOrAreLeftOut) {
  test::Picture picture = test::read_picture(in_[1]);
  picture.planes.at("G").set(picture.index(7, 5), HUGE_VAL);
  test::write_scanlines(in_[1], picture);
  expect_failure(average({}), 1, in_[1] + ": 1 non-finite pixel, the first at 7,5; --nonfinite zero");
  const auto outcome = average({"--nonfinite", "zero"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, HasSubstr("1 pixel with non-finite samples"));
  EXPECT_EQ(test::read_picture(out_).at("G", 7, 5), 26);
}

/// More images than the system lets a process open.
TEST_F(FilmAverage, OpensNoMoreFilesThanItMay) {
  std::vector<std::string> arguments = {"film", "average", "-o", out_};
  for (int i = 0; i < 90; ++i) arguments.push_back(in_[static_cast<std::size_t>(i) % 3]);
  const auto at_most = [](rlim_t files) {
    return [files] {
      const rlimit limit = {files, files};
      return ::setrlimit(RLIMIT_NOFILE, &limit) == 0;
    };
  };
  const auto outcome = run_tool(arguments, {.before = at_most(40)});
  EXPECT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(test::read_picture(out_).at("R", 1, 1), 6);
  std::filesystem::remove(out_);
  expect_failure(run_tool(arguments, {.before = at_most(5)}), 3, "Too many open files");
}

TEST_F(FilmAverage, InterruptLeavesNothing) {
  // Takes some seconds with the slowest compression.
  test::Picture picture = test::blank(2048, 1024);
  picture.header.compression() = Imf::NO_COMPRESSION;
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(in_[0], picture);
  std::filesystem::create_directory(folder_ / "target");
  for (const int signal : {SIGINT, SIGKILL}) {
    test::Tool tool({"film", "average", in_[0], in_[0], in_[0], in_[0], "-o", folder_ / "target/out.exr",
                     "--compression", "zip:9", "--pixel", "float"},
                    {});
    ASSERT_TRUE(tool.wait_until_converting());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::kill(tool.pid(), signal);
    const auto outcome = tool.finish(std::chrono::seconds(20));
    if (signal == SIGINT) {
      EXPECT_EQ(outcome.exit, 130) << outcome;
    } else {
      EXPECT_EQ(outcome.signal, SIGKILL);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "target"));
  }
}

}  // namespace
}  // namespace spectile
