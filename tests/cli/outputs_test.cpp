// Output of the tool when all goes well: text, JSON and files.
#include <OpenEXR/ImfIntAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/isa.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
namespace fs = std::filesystem;

class Outputs : public testing::Test {
 protected:
  Outputs() {
    test::Picture picture = test::blank(333, 77, {-17, 23});
    test::add_rgb_noise(picture, Imf::HALF, 1.5);
    test::write_scanlines(good_, picture);
  }

  test::TempFolder folder_;
  const std::string good_ = folder_ / "good.exr";
  const std::string out_ = folder_ / "out.exr";
};

constexpr const char* kReportFields[] = {
    "input",           "output",          "width",          "height",
    "bands",           "quantity",        "color_space",    "nonfinite_pixels",
    "negative_pixels", "over_one_pixels", "clamped_pixels", "bytes_written",
    "seconds",         "mpixel_per_s",    "notes"};

TEST_F(Outputs, BatchGoesOnAfterABadFile) {
  test::Picture bad = test::read_picture(good_);
  bad.planes.at("R").set(0, std::numeric_limits<double>::quiet_NaN());
  test::write_scanlines(folder_ / "bad.exr", bad);
  fs::copy_file(good_, folder_ / "last.exr");
  const auto outcome = run_tool({"upsample", good_, folder_ / "bad.exr", folder_ / "missing.exr",
                                 folder_ / "last.exr", "-o", folder_ / "made", "--json"});
  EXPECT_EQ(outcome.exit, 1) << outcome;
  EXPECT_EQ(test::lines(outcome.err).size(), 2U) << outcome;
  const auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 4U);
  EXPECT_FALSE(objects[0].contains("error"));
  EXPECT_THAT(objects[1]["error"].get<std::string>(), testing::HasSubstr("non-finite"));
  EXPECT_TRUE(objects[2].contains("error"));
  EXPECT_FALSE(objects[3].contains("error"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "made"), fs::directory_iterator()), 2);
  EXPECT_TRUE(test::read_picture(folder_ / "made/good.exr").planes ==
              test::read_picture(folder_ / "made/last.exr").planes);
}

TEST_F(Outputs, ClashOfNamesIsWrongUsageBeforeAnythingIsWritten) {
  fs::create_directory(folder_ / "a");
  fs::create_directory(folder_ / "made");
  fs::copy_file(good_, folder_ / "a/good.exr");
  const auto outcome = run_tool({"upsample", good_, folder_ / "a/good.exr", "-o", folder_ / "made"});
  EXPECT_EQ(outcome.exit, 2) << outcome;
  EXPECT_TRUE(outcome.one_line()) << outcome;
  EXPECT_TRUE(fs::is_empty(folder_ / "made"));
}

TEST_F(Outputs, FolderIsMadeForANameThatEndsInASlash) {
  EXPECT_EQ(run_tool({"upsample", good_, "-o", folder_ / "new/folder/"}).exit, 0);
  EXPECT_TRUE(fs::is_regular_file(folder_ / "new/folder/good.exr"));
}

TEST_F(Outputs, JsonReportHasEveryField) {
  const auto up = run_tool({"upsample", good_, "-o", out_, "--json"});
  ASSERT_EQ(up.exit, 0) << up;
  EXPECT_EQ(up.err, "");
  const auto made = test::json_lines(up.out);
  ASSERT_EQ(made.size(), 1U);
  for (const char* field : kReportFields) EXPECT_TRUE(made[0].contains(field)) << field;
  EXPECT_EQ(made[0]["width"], 333);
  EXPECT_EQ(made[0]["height"], 77);
  EXPECT_EQ(made[0]["bands"], 60);
  EXPECT_EQ(made[0]["quantity"], "reflectance");
  EXPECT_EQ(made[0]["bytes_written"], fs::file_size(out_));
  EXPECT_GT(made[0]["over_one_pixels"], 0);
  const auto down = run_tool({"project", out_, "-o", folder_ / "back.exr", "--json"});
  ASSERT_EQ(down.exit, 0) << down;
  const auto back = test::json_lines(down.out);
  ASSERT_EQ(back.size(), 1U);
  for (const char* field : kReportFields) EXPECT_TRUE(back[0].contains(field)) << field;
}

TEST_F(Outputs, QuietPrintsNothing) {
  for (const auto& arguments : {std::vector<std::string>{"upsample", good_, "-o", out_, "--quiet"},
                                {"project", out_, "-o", folder_ / "back.exr", "--quiet"},
                                {"info", out_, "--quiet"},
                                {"verify", good_, "--quiet"}}) {
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    EXPECT_EQ(outcome.out + outcome.err, "");
  }
  const auto failure = run_tool({"info", folder_ / "missing.exr", "--quiet"});
  EXPECT_TRUE(failure.one_line()) << failure;
}

TEST_F(Outputs, TextReportSaysWhatWasFound) {
  const auto outcome = run_tool({"upsample", good_, "-o", out_});
  EXPECT_EQ(outcome.err, "") << "no progress bar where stderr is no terminal";
  EXPECT_THAT(outcome.out, testing::HasSubstr("333 x 77"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("60 bands"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("Rec.709 assumed"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("above 1"));
}

TEST_F(Outputs, InfoDrawsTheSpectrumOfAPixel) {
  ASSERT_EQ(run_tool({"upsample", good_, "-o", out_}).exit, 0);
  const auto outcome = run_tool({"info", out_, "--pixel", "332,76"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, testing::HasSubstr("60 bands of reflectance"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("pixel 332,76"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("700 nm"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("█"));
}

TEST_F(Outputs, InfoJsonHoldsThePixelAsItIsInTheFile) {
  ASSERT_EQ(run_tool({"upsample", good_, "-o", out_}).exit, 0);
  const auto outcome = run_tool({"info", out_, "--pixel", "5,9", "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  const auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 1U);
  const auto& info = objects[0];
  for (const char* field : {"file", "width", "height", "data_window", "display_window", "parts", "tiled",
                            "compression", "nonfinite_samples", "negative_samples", "channels", "attributes",
                            "quantity", "bands", "centres_nm", "pixel"}) {
    EXPECT_TRUE(info.contains(field)) << field;
  }
  EXPECT_EQ(info["data_window"], (std::vector<int>{-17, 23, 315, 99}));
  EXPECT_EQ(info["compression"], "zip");
  EXPECT_EQ(info["attributes"]["spectralLayoutVersion"], "1.0");
  EXPECT_EQ(info["channels"].size(), 63U);
  const test::Picture picture = test::read_picture(out_);
  ASSERT_EQ(info["pixel"].size(), 60U);
  ASSERT_EQ(info["centres_nm"].size(), 60U);
  EXPECT_EQ(info["centres_nm"][0], 402.5);
  EXPECT_EQ(info["pixel"][0].get<double>(), picture.at("T.402,500000nm", 5, 9));
  EXPECT_EQ(info["pixel"][59].get<double>(), picture.at("T.697,500000nm", 5, 9));
}

TEST_F(Outputs, InfoCountsWhatIsNotFinite) {
  test::Picture picture = test::read_picture(good_);
  picture.planes.at("R").set(3, -HUGE_VAL);
  picture.planes.at("G").set(4, -1);
  test::write_scanlines(folder_ / "odd.exr", picture);
  const auto outcome = run_tool({"info", folder_ / "odd.exr", "--json"});
  const auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 1U) << outcome;
  EXPECT_EQ(objects[0]["nonfinite_samples"], 1);
  EXPECT_EQ(objects[0]["negative_samples"], 1);
  EXPECT_FALSE(objects[0].contains("bands"));
}

TEST_F(Outputs, VerifyFindsNoDifference) {
  ASSERT_EQ(run_tool({"upsample", good_, "-o", out_}).exit, 0);
  const auto outcome = run_tool({"verify", good_, out_, "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  const auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 2U);
  for (const auto& object : objects) {
    EXPECT_EQ(object["ok"], true);
    EXPECT_EQ(object["pixels"], 333 * 77);
    EXPECT_EQ(object["different_samples"], 0);
    EXPECT_GT(object["oracle_bound"], 0.0);
    EXPECT_LE(object["max_oracle_difference"].get<double>(), object["oracle_bound"].get<double>());
    EXPECT_GT(object["max_oracle_difference"], 0.0) << "float and double are not one";
  }
}

TEST_F(Outputs, LongNamesPassThrough) {
  // Longer than the 31 bytes of the format's first version, within the 255 of its second.
  const std::string attribute = "theAttributeWithANameOfMoreThanThirtyOneBytes";
  const std::string channel = "beauty.reflections.secondBounce.coefficient";
  test::Picture named = test::read_picture(good_);
  named.header.insert(attribute, Imf::IntAttribute(7));
  test::write_scanlines(folder_ / "attribute.exr", named);
  test::Picture layered = test::read_picture(good_);
  layered.add(channel, Imf::HALF, [](int x, int y) { return test::noise(x, y, 3); });
  test::write_scanlines(folder_ / "channel.exr", layered);
  for (const char* input : {"attribute.exr", "channel.exr"}) {
    const auto outcome =
        test::Tool({"upsample", folder_ / input, "-o", out_}, {}).finish(std::chrono::seconds(10));
    EXPECT_FALSE(outcome.late) << input << " hangs";
    EXPECT_EQ(outcome.exit, 0) << input << "\n" << outcome;
    if (outcome.exit != 0) continue;
    const test::Picture out = test::read_picture(out_);
    if (input == std::string("channel.exr")) {
      EXPECT_TRUE(out.planes.at(channel) == layered.planes.at(channel));
    } else {
      EXPECT_TRUE(out.header.find(attribute) != out.header.end());
    }
  }
}

TEST_F(Outputs, DemoMakesThreeImages) {
  const auto outcome = run_tool({"demo", folder_ / "demo", "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  const auto objects = test::json_lines(outcome.out);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0]["different_samples"], 0);
  for (const char* field : {"chart", "spectral", "back"}) {
    EXPECT_TRUE(fs::is_regular_file(objects[0][field].get<std::string>())) << field;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "demo"), fs::directory_iterator()), 3);
  EXPECT_LT(objects[0]["round_trip_mean"].get<double>(), objects[0]["round_trip_max"].get<double>());
}

TEST_F(Outputs, HelpNamesTheDefaults) {
  const std::pair<const char*, std::vector<const char*>> expected[] = {
      {"upsample", {"400:700:5", "smits", "zip:1", "half by default", "65536", "error", "clip", "plan.json"}},
      {"project", {"srgb", "D65 by default", "1931", "float by default", "zip:1"}},
      {"info", {"--pixel"}},
      {"verify", {"400:700:5", "smits", "reflectance"}},
      {"demo", {"spectile-demo"}}};
  for (const auto& [command, words] : expected) {
    const auto outcome = run_tool({command, "--help"});
    EXPECT_EQ(outcome.exit, 0) << outcome;
    EXPECT_EQ(outcome.err, "");
    for (const char* word : words) EXPECT_THAT(outcome.out, testing::HasSubstr(word)) << command;
  }
  const auto all = run_tool({"--help"});
  EXPECT_EQ(all.exit, 0);
  for (const char* word : {"demo", "upsample", "project", "info", "verify", "Exit codes"}) {
    EXPECT_THAT(all.out, testing::HasSubstr(word));
  }
}

TEST_F(Outputs, VersionIsANumber) {
  const auto outcome = run_tool({"--version"});
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_THAT(outcome.out, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(Outputs, SameBytesWhateverRunsThem) {
  for (const char* compression : {"none", "zip:2", "piz", "dwab"}) {
    const std::vector<std::string> up = {"upsample", good_, "-o", out_, "--compression", compression};
    const auto plain = run_tool(up);
    ASSERT_EQ(plain.exit, 0) << plain;
    const std::string expected = test::file_bytes(out_);
    const std::vector<std::string> down = {"project",       out_,       "-o", folder_ / "back.exr",
                                           "--compression", compression};
    ASSERT_EQ(run_tool(down).exit, 0);
    const std::string expected_back = test::file_bytes(folder_ / "back.exr");
    int run = 0;
    for (const std::string& isa : available_isas()) {
      const std::vector<std::string> execution = {
          "--isa",     isa,
          "--threads", run % 2 == 0 ? "1" : "3",
          "--lanes",   run % 3 == 0 ? "64" : run % 3 == 1 ? "100" : "65536"};
      ++run;
      for (const auto& [arguments, bytes] : {std::pair{up, expected}, {down, expected_back}}) {
        // Into another file, so that the spectral one stays the input.
        std::vector<std::string> all = arguments;
        all[3] = folder_ / "other.exr";
        all.insert(all.end(), execution.begin(), execution.end());
        const auto outcome = run_tool(all);
        ASSERT_EQ(outcome.exit, 0) << outcome;
        EXPECT_TRUE(test::file_bytes(folder_ / "other.exr") == bytes) << testing::PrintToString(all);
      }
    }
  }
}

}  // namespace
}  // namespace spectile
