// Options of project that say which light: both quantities, candelas, polarisation; and what does not go
// together.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

using testing::HasSubstr;

class ProjectOptions : public testing::Test {
 protected:
  ProjectOptions() {
    Picture picture = blank(4, 2);
    for (int nm = 400; nm <= 700; nm += 10) {
      const auto add = [&](const char* kind, double value) {
        picture.add(fmt::format("{}.{},000000nm", kind, nm), Imf::FLOAT, [=](int, int) { return value; });
      };
      add("T", 0.5);
      add("S0", 0.25);
      add("S1", -0.125);
      add("S2", 0);
    }
    write_scanlines(in_, picture);
  }
  Outcome project(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"project", in_, "-o", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  double pixel(const char* channel) const { return read_picture(out_).at(channel, 0, 0); }

  TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(ProjectOptions, ChooseTheLight) {
  const auto reflected = project({"--to", "luminance"});
  EXPECT_THAT(reflected.out, HasSubstr("left out: 31 bands of emission"));
  EXPECT_NEAR(pixel("Y"), 0.5, 1e-6);
  for (const char* name : {"illuminant", "emission"}) {
    ASSERT_EQ(project({"--to", "luminance", "--quantity", name}).exit, 0) << name;
    EXPECT_NEAR(pixel("Y"), 0.25, 1e-6);
  }
  const auto both = project({"--to", "luminance", "--quantity", "both", "--emission-scale", "2"});
  EXPECT_THAT(both.out, HasSubstr("reflected and emitted light are added"));
  EXPECT_NEAR(pixel("Y"), 1.0, 1e-6);
  const auto candelas = project({"--to", "luminance", "--quantity", "emission", "--photometric"});
  EXPECT_THAT(candelas.out, HasSubstr("cd/m2"));
  // The sum of y-bar over the visible range is 106.857; over these bands a little less.
  EXPECT_NEAR(pixel("Y"), 0.25 * 683 * 106.857, 0.25 * 683 * 0.2);
}

TEST_F(ProjectOptions, ShowPolarisation) {
  ASSERT_EQ(project({"--to", "dop"}).exit, 0);
  EXPECT_NEAR(pixel("DOLP"), 0.5, 1e-6);
  const auto angle = project({"--to", "aolp", "--json"});
  ASSERT_EQ(angle.exit, 0) << angle;
  EXPECT_NEAR(pixel("AOLP"), 90, 1e-4);
  const auto notes = nlohmann::json::parse(angle.out)["notes"].dump();
  EXPECT_THAT(notes, HasSubstr("has no angle"));
  EXPECT_THAT(notes, HasSubstr("left out: 31 bands of reflectance"));
}

TEST_F(ProjectOptions, ThatDoNotGoTogetherAreWrongUsage) {
  const std::vector<std::string> wrong[] = {{"--emission-scale", "2"},
                                            {"--to", "dop", "--illuminant", "A"},
                                            {"--to", "aolp", "--adapt", "bradford"},
                                            {"--to", "dop", "--quantity", "both"},
                                            {"--to", "dop", "--photometric"},
                                            {"--photometric"},
                                            {"--to", "dop", "--mipmap"}};
  for (const auto& more : wrong) {
    const auto outcome = project(more);
    EXPECT_EQ(outcome.exit, 2) << fmt::format("{}: ", fmt::join(more, " ")) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

}  // namespace
}  // namespace spectile::test
