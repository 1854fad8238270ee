// Names of RGB spaces: the stated one wins, linear spaces are called so, and a guess is said once.
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class SpaceNames : public testing::Test {
 protected:
  SpaceNames() {
    write(in_, {});
    write(folder_ / "second.exr", {});
  }
  void write(const std::string& path, const std::string& tag) {
    test::Picture picture = test::blank(8, 6);
    test::add_rgb_noise(picture, Imf::HALF);
    if (!tag.empty()) picture.header.insert("colorInteropID", Imf::StringAttribute(tag));
    test::write_scanlines(path, picture);
  }
  /// Channels of an upsampled image.
  std::map<std::string, test::Plane> upsampled(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"upsample", in_, "-o", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    return test::read_picture(out_).planes;
  }
  static constexpr const char* kAssumed =
      "linear Rec.709 assumed, as the file names no colour space; --input-space";
  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(SpaceNames, LinearOnesSaySo) {
  const auto plain = upsampled({});
  for (const char* const name : {"lin_rec709", "lin_srgb", "LIN_SRGB", "rec709", "srgb"}) {
    EXPECT_TRUE(upsampled({"--input-space", name}) == plain) << name;
  }
  for (const auto& [name, other] : {std::pair{"lin_p3d65", "display-p3"},
                                    {"lin_rec2020", "rec2020"},
                                    {"lin_adobergb", "adobe-rgb"},
                                    {"lin_ap1", "acescg"},
                                    {"lin_ap0", "aces2065-1"},
                                    {"lin_ciexyzd65", "xyz"}}) {
    EXPECT_TRUE(upsampled({"--input-space", name}) == upsampled({"--input-space", other})) << name;
  }
  EXPECT_THAT(run_tool({"upsample", "--help"}).out, HasSubstr("lin_rec709"));
}

TEST_F(SpaceNames, ABareSrgbIsSaidAsLinearRec709) {
  const std::vector<std::string> command = {"upsample", in_, "-o", out_, "--input-space", "srgb"};
  EXPECT_THAT(run_tool(command).out,
              HasSubstr("  input space srgb is taken as linear Rec.709 (lin_rec709)\n"));
  std::vector<std::string> json = command;
  json.emplace_back("--json");
  EXPECT_THAT(test::json_lines(run_tool(json).out).at(0)["notes"].dump(),
              HasSubstr("taken as linear Rec.709"));
  EXPECT_THAT(run_tool({"upsample", in_, "-o", out_, "--input-space", "lin_srgb"}).out,
              Not(HasSubstr("taken as")));
}

TEST_F(SpaceNames, EncodedOnesAreRefusedInASentence) {
  for (const char* const name : {"srgb_texture", "srgb_rec709"}) {
    const auto outcome = run_tool({"upsample", in_, "-o", out_, "--input-space", name});
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err,
                testing::AllOf(HasSubstr(name), HasSubstr("is not linear"), HasSubstr("lin_rec709")));
  }
  const auto unknown = run_tool({"upsample", in_, "-o", out_, "--input-space", "rec601"});
  EXPECT_EQ(unknown.exit, 2) << unknown;
  EXPECT_THAT(unknown.err, HasSubstr("there are lin_rec709, display-p3"));
}

TEST_F(SpaceNames, TheStatedOneWinsWhateverTheFileSays) {
  const auto plain = upsampled({"--input-space", "acescg"});
  for (const char* const tag : {"srgb_rec709_scene", "data", "lin_unheard_of", "lin_rec2020_scene"}) {
    write(in_, tag);
    EXPECT_TRUE(upsampled({"--input-space", "acescg"}) == plain) << tag;
    EXPECT_EQ(run_tool({"relight", in_, "-o", out_, "--illuminant", "A", "--input-space", "acescg"}).exit, 0)
        << tag;
    EXPECT_EQ(run_tool({"verify", in_, "--input-space", "acescg"}).exit, 0) << tag;
    EXPECT_EQ(run_tool({"plan", "--illuminant", "A", "--count", "4", "--folds", "0", "-o",
                        folder_ / "plan.json", "--texture", in_, "--input-space", "acescg"})
                  .exit,
              0)
        << tag;
  }
}

TEST_F(SpaceNames, AGuessIsSaidOncePerRunAndInEveryJsonReport) {
  const auto count = [](const std::string& text) {
    std::size_t n = 0;
    for (std::size_t at = text.find(kAssumed); at != std::string::npos; at = text.find(kAssumed, at + 1)) ++n;
    return n;
  };
  const std::string second = folder_ / "second.exr";
  const std::vector<std::vector<std::string>> commands = {
      {"upsample", in_, second, "-o", folder_ / "up/"},
      {"relight", in_, second, "-o", folder_ / "lit/", "--illuminant", "A"},
      {"verify", in_, second},
      {"plan", "--illuminant", "A", "--count", "4", "--folds", "0", "-o", folder_ / "plan.json", "--texture",
       in_, "--texture", second}};
  for (const auto& command : commands) {
    EXPECT_EQ(count(run_tool(command).out), 1U) << command[0];
    std::vector<std::string> json = command;
    json.emplace_back("--json");
    const auto reports = test::json_lines(run_tool(json).out);
    EXPECT_EQ(reports.size(), command[0] == "plan" ? 1U : 2U);
    for (const auto& report : reports) EXPECT_THAT(report["notes"].dump(), HasSubstr(kAssumed)) << command[0];
    std::vector<std::string> stated = command;
    stated.insert(stated.end(), {"--input-space", "lin_rec709"});
    EXPECT_EQ(count(run_tool(stated).out), 0U) << command[0];
  }
  write(in_, "lin_rec709_scene");
  EXPECT_EQ(count(run_tool({"upsample", in_, "-o", out_}).out), 0U);
}

}  // namespace
}  // namespace spectile
