// Tables of spectra as every command takes them: one meaning, notes in text and JSON, and what is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

constexpr double kGrey = 0.8;

/// Linear sRGB of a grey under a light, by sums at every twentieth of a nanometre over the observer's range,
/// and the matrix of IEC 61966-2-1.
std::array<double, 3> grey_under(const std::function<double(double)>& light) {
  const Spectrum bars[] = {*named_spectrum("cie1931-x"), *named_spectrum("cie1931-y"),
                           *named_spectrum("cie1931-z")};
  std::array<double, 3> xyz{};
  for (double nm = 360.025; nm < 830; nm += 0.05) {
    for (std::size_t k = 0; k < 3; ++k) xyz[k] += light(nm) * bars[k](nm);
  }
  const double scale = kGrey / xyz[1];
  for (double& v : xyz) v *= scale;
  constexpr double kToSrgb[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                    {-0.9692660, 1.8760108, 0.0415560},
                                    {0.0556434, -0.2040259, 1.0572252}};
  std::array<double, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb[i] += kToSrgb[i][k] * xyz[k];
  }
  return rgb;
}

/// The published FL11 from 380 to 780 nm, in steps of 5 nm; straight lines between, 0 beyond.
double fl11(double nm) {
  static const Spectrum table = *named_spectrum("FL11");
  if (nm < 380 || nm > 780) return 0;
  const double below = std::min(std::floor(nm / 5) * 5, 775.0);
  const double t = (nm - below) / 5;
  return (1 - t) * table(below) + t * table(below + 5);
}

class SpectrumTablesCommand : public testing::Test {
 protected:
  SpectrumTablesCommand() {
    test::Picture grey = test::blank(2, 2);
    for (const char* name : {"R", "G", "B"}) grey.add(name, Imf::FLOAT, [](int, int) { return kGrey; });
    test::write_scanlines(grey_, grey);
  }
  std::string table(const std::string& name, const std::function<std::string(double, double)>& line,
                    const std::string& heading = {}) {
    std::string text = heading;
    for (int nm = 380; nm <= 780; nm += 5) text += line(nm, fl11(nm));
    test::write_text(folder_ / name, text);
    return folder_ / name;
  }
  void expect_seen(const std::string& light, const std::array<double, 3>& rgb, double tolerance,
                   const std::vector<std::string>& more = {}) {
    std::vector<std::string> relight = {"relight", grey_,     "-o",    out_,      "--illuminant",
                                        light,     "--pixel", "float", "--bands", "360:830:5"};
    relight.insert(relight.end(), more.begin(), more.end());
    const auto outcome = run_tool(relight);
    ASSERT_EQ(outcome.exit, 0) << outcome;
    expect_picture(rgb, tolerance, light + " relit");
    ASSERT_EQ(run_tool({"upsample", grey_, "-o", spectral_, "--bands", "360:830:5", "--pixel", "float"}).exit,
              0);
    std::vector<std::string> project = {"project", spectral_, "-o", out_, "--illuminant", light};
    project.insert(project.end(), more.begin(), more.end());
    ASSERT_EQ(run_tool(project).exit, 0) << light;
    expect_picture(rgb, tolerance, light + " projected");
  }
  void expect_picture(const std::array<double, 3>& rgb, double tolerance, const std::string& what) {
    const auto picture = test::read_picture(out_);
    constexpr const char* kNames[] = {"R", "G", "B"};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(picture.at(kNames[i], 1, 1), rgb[i], tolerance * std::max(1.0, std::abs(rgb[i])))
          << what << " " << kNames[i];
    }
  }
  test::TempFolder folder_;
  const std::string grey_ = folder_ / "grey.exr";
  const std::string out_ = folder_ / "out.exr";
  const std::string spectral_ = folder_ / "spectral.exr";
};

TEST_F(SpectrumTablesCommand, UnitsAndWritingsGiveOneLight) {
  const std::array<double, 3> rgb = grey_under(fl11);
  EXPECT_NEAR(rgb[0], 1.1318, 3e-3);
  EXPECT_NEAR(rgb[1], 0.7388, 3e-3);
  EXPECT_NEAR(rgb[2], 0.4263, 3e-3);
  const auto csv = [](double nm, double v) { return fmt::format("{},{}\n", nm, v); };
  const std::string nm = table("nm.csv", csv);
  expect_seen(nm, rgb, 1e-3);
  const std::string samples = run_tool({"spectra", nm, "--csv"}).out;
  const auto comma = [](double v) {
    std::string text = fmt::format("{}", v);
    std::ranges::replace(text, '.', ',');
    return text;
  };
  const std::vector<std::string> others = {
      table(
          "um.csv", [](double w, double v) { return fmt::format("{},{}\n", w / 1000, v); },
          "Wavelength (micrometers),Power\n"),
      table("decimalcomma_tab.txt", [&](double w, double v) { return fmt::format("{}\t{}\n", w, comma(v)); }),
      table(
          "quoted.csv", [](double w, double v) { return fmt::format("\"{}\",\"{}\"\n", w, v); },
          "\"Wavelength\",\"Value\"\n"),
      table("pbrt_inline.spd", [](double w, double v) { return fmt::format("{} {} ", w, v); }),
      table("mitsuba_colon.spd", [](double w, double v) { return fmt::format("{}:{}, ", w, v); }),
      table("unit_nm.txt", [](double w, double v) { return fmt::format("{}nm\t{}\n", w, v); }),
      table("trailing_comma.csv", [](double w, double v) { return fmt::format("{},{},\n", w, v); }),
      table("hash_comment_inline.spd",
            [](double w, double v) { return fmt::format("{} {} # peak\n", w, v); })};
  for (const std::string& other : others)
    EXPECT_EQ(run_tool({"spectra", other, "--csv"}).out, samples) << other;
  // A cell is empty: straight lines bridge it.
  const std::string empty = table("empty_cells.csv", [](double w, double v) {
    return w == 600 ? "600,\n" : fmt::format("{},{}\n", w, v);
  });
  const auto bridged = run_tool({"spectra", empty, "--at", "600"});
  EXPECT_THAT(bridged.out, HasSubstr(fmt::format("{:.10g}", (fl11(595) + fl11(605)) / 2)));
  EXPECT_THAT(bridged.out, HasSubstr("note: " + empty + ": 1 missing sample"));
}

TEST_F(SpectrumTablesCommand, LightIsZeroBeyondItsDataEverywhere) {
  const std::string cut = folder_ / "blue_led_cut.csv";
  test::write_text(cut, "400,0\n430,1\n460,2\n470,1.5\n");
  const auto led = [](double nm) {
    if (nm < 400 || nm > 470) return 0.0;
    if (nm < 430) return (nm - 400) / 30;
    return nm < 460 ? 1 + (nm - 430) / 30 : 2 - (nm - 460) / 20;
  };
  const std::array<double, 3> rgb = grey_under(led);
  // The straight line ends at 470 nm: sums at every nanometre give 2.06, -2.82, 32.99.
  EXPECT_NEAR(rgb[0], 2.1335, 1e-3);
  EXPECT_NEAR(rgb[1], -2.8949, 1e-3);
  EXPECT_NEAR(rgb[2], 33.482, 1e-2);
  expect_seen(cut, rgb, 1e-3);
  EXPECT_THAT(run_tool({"spectra", cut, "--at", "550"}).out, HasSubstr("550 nm  0\n"));
  EXPECT_THAT(run_tool({"spectra", cut}).out,
              HasSubstr("0 beyond its ends as a light, held as a reflectance"));
  // Held by option, and said.
  const auto held = [&](double nm) { return nm > 470 ? 1.5 : nm < 400 ? 0.0 : led(nm); };
  expect_seen(cut, grey_under(held), 1e-3, {"--ends", "held"});
  const auto outcome = run_tool({"relight", grey_, "-o", out_, "--illuminant", cut, "--ends", "held"});
  EXPECT_THAT(outcome.out, HasSubstr("note: " + cut + ": held beyond its ends"));
  EXPECT_THAT(run_tool({"spectra", cut, "--ends", "held", "--at", "550"}).out, HasSubstr("550 nm  1.5\n"));
}

TEST_F(SpectrumTablesCommand, NotesStandInTextOnceAndInJson) {
  const std::string um =
      table("um.csv", [](double w, double v) { return fmt::format("{},{}\n", w / 1000, v); });
  ASSERT_EQ(run_tool({"upsample", grey_, "-o", spectral_}).exit, 0);
  const std::string note = um + ": wavelengths taken as um";
  const std::vector<std::vector<std::string>> commands = {
      {"relight", grey_, "-o", out_, "--illuminant", um},
      {"relight", grey_, "-o", out_, "--illuminant", "A", "--white", um},
      {"project", spectral_, "-o", out_, "--illuminant", um},
      {"upsample", grey_, "-o", out_, "--white", um},
      {"verify", grey_, "--white", um},
      {"spectra", um},
      {"plan", "--illuminant", um, "--bands", "4", "--folds", "0", "-o", folder_ / "p.json"}};
  for (auto command : commands) {
    const auto text = run_tool(command);
    ASSERT_EQ(text.exit, 0) << command[0] << text;
    const auto at = text.out.find("note: " + note);
    EXPECT_NE(at, std::string::npos) << text;
    EXPECT_EQ(text.out.find("note: " + note, at + 1), std::string::npos) << text;
    command.emplace_back("--json");
    const auto json = test::json_lines(run_tool(command).out);
    ASSERT_EQ(json.size(), 1U) << command[0];
    EXPECT_THAT(json[0]["notes"].dump(), HasSubstr(note)) << command[0];
  }
}

TEST_F(SpectrumTablesCommand, LightsThatAreNoneAreRefusedEverywhere) {
  test::write_text(folder_ / "infrared.csv", "900,1\n1000,2\n2500,3\n");
  test::write_text(folder_ / "dark.csv", "400,0\n700,0\n");
  ASSERT_EQ(run_tool({"upsample", grey_, "-o", spectral_}).exit, 0);
  const std::pair<std::string, std::string> lights[] = {
      {"BK7-eta", "is a refractive index, not a light"},
      {"colorchecker-blue", "is a reflectance, not a light"},
      {folder_ / "infrared.csv", "no sample lies within 360 to 830 nm"},
      {folder_ / "dark.csv", "no energy"},
      {"constant:0", "no energy"}};
  for (const auto& [light, message] : lights) {
    for (const auto& command :
         std::vector<std::vector<std::string>>{{"relight", grey_, "-o", out_, "--illuminant", light},
                                               {"project", spectral_, "-o", out_, "--illuminant", light},
                                               {"upsample", grey_, "-o", out_, "--white", light},
                                               {"plan", "--bands", "4", "-o", out_, "--illuminant", light}}) {
      const auto outcome = run_tool(command);
      EXPECT_NE(outcome.exit, 0) << command[0] << " " << light;
      EXPECT_TRUE(outcome.one_line()) << outcome;
      EXPECT_THAT(outcome.err, HasSubstr(message)) << command[0];
      EXPECT_FALSE(std::filesystem::exists(out_));
    }
  }
}

/// The ColorChecker from 380 to 730 nm, a column a patch.
std::string chart(double per_nm, double per_value, const std::string& heading) {
  std::string text = heading;
  for (int patch = 1; patch <= 24; ++patch) text += fmt::format(",{}", patch);
  text += "\n";
  for (int nm = 380; nm <= 730; nm += 10) {
    text += fmt::format("{}", nm * per_nm);
    for (const NamedSpectrumInfo& info : named_spectra()) {
      if (info.kind == "reflectance")
        text += fmt::format(",{:.9g}", (*named_spectrum(info.name))(nm)*per_value);
    }
    text += "\n";
  }
  return text;
}

TEST_F(SpectrumTablesCommand, PlansTakeOneMeaningOrRefuse) {
  const auto plan = [&](const std::string& text, std::vector<std::string> more = {}) {
    test::write_text(folder_ / "patches.csv", text);
    std::vector<std::string> arguments = {"plan",
                                          "--illuminant",
                                          "D65",
                                          "--bands",
                                          "6",
                                          "--folds",
                                          "2",
                                          "-o",
                                          folder_ / "plan.json",
                                          "--reflectances",
                                          folder_ / "patches.csv",
                                          "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  };
  const auto errors = [](const test::Outcome& outcome) {
    auto json = test::json_lines(outcome.out).at(0);
    json.erase("notes");
    return json.dump();
  };
  const auto known = plan(chart(1, 1, "wavelength"));
  ASSERT_EQ(known.exit, 0) << known;
  const auto um = plan(chart(1e-3, 1, "wavelength (um)"));
  ASSERT_EQ(um.exit, 0) << um;
  EXPECT_EQ(errors(um), errors(known));
  EXPECT_THAT(um.out, HasSubstr("wavelengths in um"));
  const auto percent = plan(chart(1, 100, "wavelength"));
  EXPECT_EQ(percent.exit, 1) << percent;
  EXPECT_TRUE(percent.one_line()) << percent;
  EXPECT_THAT(percent.err, HasSubstr("lie far outside 0 to 1"));
  EXPECT_THAT(percent.err, HasSubstr("--values fraction, percent"));
  const auto stated = plan(chart(1, 100, "wavelength"), {"--values", "percent"});
  ASSERT_EQ(stated.exit, 0) << stated;
  EXPECT_EQ(plan(chart(1, 1, "wavelength"), {"--values", "much"}).exit, 2);
}

TEST_F(SpectrumTablesCommand, ColumnIsChosenBehindAColon) {
  test::write_text(folder_ / "lamps.csv", "nm,a,b\n400,1,0\n550,1,2\n700,1,0\n");
  const std::string lamps = folder_ / "lamps.csv";
  EXPECT_THAT(run_tool({"relight", grey_, "-o", out_, "--illuminant", lamps}).err,
              HasSubstr("holds 2 spectra: a, b; choose one"));
  EXPECT_EQ(run_tool({"relight", grey_, "-o", out_, "--illuminant", lamps + ":b"}).exit, 0);
  EXPECT_EQ(run_tool({"spectra", lamps, "--column", "b", "--csv"}).out,
            run_tool({"spectra", lamps + ":1", "--csv"}).out);
  EXPECT_EQ(run_tool({"spectra", lamps, "--column", "c"}).exit, 2);
  // The file is what an output depends on.
  EXPECT_THAT(run_tool({"relight", grey_, "-o", lamps, "--illuminant", lamps + ":b"}).err,
              HasSubstr("which it is made from"));
}

}  // namespace
}  // namespace spectile
