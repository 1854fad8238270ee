// spectile spectra: lists, draws and prints spectra; other commands take the same ones as lights.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

constexpr const char* kLampColumns =
    "wavelength_nm,value\n400,1\n500,0.1\n500,3\n600.5,0.30000000000000004\n";
constexpr const char* kLampCgats =
    "SPECT\nSPECTRAL_START_NM 400\nSPECTRAL_END_NM 700\nSPECTRAL_BANDS 4\nBEGIN_DATA\n1 2 3 4\n8 6 4 2\n"
    "END_DATA\n";

class SpectraCommand : public testing::Test {
 protected:
  SpectraCommand() {
    test::write_text(columns_, kLampColumns);
    test::write_text(cgats_, kLampCgats);
  }
  void expect_failure(const std::vector<std::string>& arguments, int exit, const std::string& named) {
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, exit) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(named));
  }
  test::TempFolder folder_;
  const std::string columns_ = folder_ / "lamp.csv";
  const std::string cgats_ = folder_ / "lamp.sp";
};

TEST_F(SpectraCommand, ListsEveryNameUnderItsKind) {
  const auto outcome = run_tool({"spectra"});
  EXPECT_EQ(outcome.exit, 0) << outcome;
  const auto lines = test::lines(outcome.out);
  EXPECT_EQ(lines.at(0), "illuminant");
  for (const NamedSpectrumInfo& info : named_spectra()) {
    const auto line = std::find_if(lines.begin(), lines.end(), [&](const std::string& text) {
      return text.starts_with("  " + info.name + " ");
    });
    ASSERT_NE(line, lines.end()) << info.name;
    EXPECT_THAT(*line, HasSubstr(info.about));
    EXPECT_THAT(*line, HasSubstr(info.alias));
    EXPECT_NE(std::find(lines.begin(), line, info.kind), line) << info.name;
  }
}

TEST_F(SpectraCommand, ListsAsJsonAndAsCsv) {
  const auto objects = test::json_lines(run_tool({"spectra", "--json"}).out);
  ASSERT_EQ(objects.size(), named_spectra().size());
  EXPECT_EQ(objects[5]["name"], "D65");
  EXPECT_EQ(objects[5]["kind"], "illuminant");
  EXPECT_EQ(objects[5]["source"], "CIE 015:2018");
  const auto lines = test::lines(run_tool({"spectra", "--csv"}).out);
  ASSERT_EQ(lines.size(), named_spectra().size() + 1);
  EXPECT_EQ(lines[0], "name,kind,about,source,alias");
  EXPECT_EQ(lines[6], "D65,\"illuminant\",\"daylight, 6504 K\",\"CIE 015:2018\",");
}

TEST_F(SpectraCommand, DrawsWithinATerminalAndSaysTheFacts) {
  for (const std::string& what : {std::string("d65"), std::string("copper-k"), std::string("blackbody:3200"),
                                  std::string("constant:0.5"), columns_, cgats_}) {
    const auto outcome = run_tool({"spectra", what});
    ASSERT_EQ(outcome.exit, 0) << outcome;
    const auto lines = test::lines(outcome.out);
    ASSERT_GE(lines.size(), 21U) << outcome;
    for (std::size_t i = 1; i <= 18; ++i) {
      const auto columns = std::count_if(lines[i].begin(), lines[i].end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
      });
      EXPECT_LE(columns, 79) << lines[i];
    }
    EXPECT_THAT(lines[18], testing::EndsWith(" nm"));
    EXPECT_THAT(outcome.out, HasSubstr("maximum "));
    EXPECT_THAT(outcome.out, HasSubstr("average over 400 to 700 nm "));
  }
}

TEST_F(SpectraCommand, SaysWhatIsPublishedOfD65) {
  const auto outcome = run_tool({"spectra", "d65"});
  EXPECT_THAT(outcome.out, testing::StartsWith("D65: illuminant, daylight, 6504 K (CIE 015:2018)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("300 to 830 nm, 107 samples\n"));
  EXPECT_THAT(outcome.out, HasSubstr("maximum 117.812 at 460 nm"));
  EXPECT_THAT(outcome.out, HasSubstr("chromaticity x 0.3127, y 0.3290"));
}

TEST_F(SpectraCommand, WhatIsNoLightHasNoChromaticity) {
  for (const char* name : {"Cu-eta", "gold-k", "cie1931-y", "canon-eos-5d-mkii-g", "colorchecker-red"}) {
    EXPECT_THAT(run_tool({"spectra", name}).out, testing::Not(HasSubstr("chromaticity"))) << name;
  }
}

TEST_F(SpectraCommand, AliasIsTheSpectrumByItsName) {
  EXPECT_EQ(run_tool({"spectra", "copper-eta"}).out, run_tool({"spectra", "Cu-eta"}).out);
}

TEST_F(SpectraCommand, CsvLoadsAsTheSameNumbers) {
  for (const std::string what : {"A", "FL12", "Ag-k", "cie1964-z", "blackbody:3200", "daylight:5003.25"}) {
    const auto first = run_tool({"spectra", what, "--csv"});
    ASSERT_EQ(first.exit, 0) << first;
    test::write_text(folder_ / "again.csv", first.out);
    EXPECT_EQ(run_tool({"spectra", folder_ / "again.csv", "--csv"}).out, first.out) << what;
    const auto loaded = load_spectrum(folder_ / "again.csv");
    const auto known = named_spectrum(what);
    ASSERT_TRUE(loaded && known);
    for (int nm = 300; nm <= 830; nm += 5) EXPECT_EQ((*loaded)(nm), (*known)(nm)) << what << " " << nm;
  }
  EXPECT_EQ(run_tool({"spectra", columns_, "--csv"}).out, kLampColumns);
}

TEST_F(SpectraCommand, FormulasAreTabulatedEveryNanometre) {
  const auto lines = test::lines(run_tool({"spectra", "constant:2", "--csv"}).out);
  ASSERT_EQ(lines.size(), 532U);
  EXPECT_EQ(lines[1], "300,2");
  EXPECT_EQ(lines[531], "830,2");
}

TEST_F(SpectraCommand, JsonHoldsTheSamplesAndTheFacts) {
  const auto objects = test::json_lines(run_tool({"spectra", "D65", "--json", "--at", "462.5"}).out);
  ASSERT_EQ(objects.size(), 1U);
  const auto& o = objects[0];
  EXPECT_EQ(o["name"], "D65");
  EXPECT_EQ(o["wavelengths_nm"].size(), 107U);
  EXPECT_EQ(o["values"].size(), 107U);
  EXPECT_EQ(o["maximum"], 117.812);
  EXPECT_EQ(o["maximum_at_nm"], 460);
  EXPECT_NEAR(o["chromaticity"][0], 0.31272, 2e-5);
  EXPECT_EQ(o["at"].size(), 1U);
  EXPECT_NEAR(o["at"][0]["value"], 117.074, 1e-9);
  const auto file = test::json_lines(run_tool({"spectra", columns_, "--json"}).out);
  EXPECT_EQ(file.at(0)["kind"], "file");
}

TEST_F(SpectraCommand, ValuesAreGivenWhereAsked) {
  EXPECT_EQ(run_tool({"spectra", "--at", "550", "D65", "--at", "552.5", "--csv"}).out.substr(0, 28),
            "wavelength_nm,value\n550,104.");
  const auto text = run_tool({"spectra", columns_, "--at", "450", "--at", "500", "--at", "399"});
  EXPECT_THAT(text.out, HasSubstr("  450 nm  0.55\n  500 nm  3\n  399 nm  0\n"));
}

TEST_F(SpectraCommand, ColumnPicksARowOfCgats) {
  EXPECT_EQ(run_tool({"spectra", cgats_, "--csv"}).out, "wavelength_nm,value\n400,1\n500,2\n600,3\n700,4\n");
  EXPECT_EQ(run_tool({"spectra", cgats_, "--csv", "--column", "1"}).out,
            "wavelength_nm,value\n400,8\n500,6\n600,4\n700,2\n");
}

TEST_F(SpectraCommand, QuietSaysNothing) {
  EXPECT_EQ(run_tool({"spectra", "D65", "--quiet"}).out, "");
  EXPECT_EQ(run_tool({"spectra", "--quiet"}).out, "");
}

TEST_F(SpectraCommand, WhatIsWrongIsSaidInOneLine) {
  test::write_text(folder_ / "bad.csv", "400,1\n500,x\n");
  expect_failure({"spectra", "D66"}, 2, "near it: D60, D65");
  expect_failure({"spectra", ""}, 2, "is unknown");
  expect_failure({"spectra", "daylight:3000"}, 2, "4000 to 25000 K");
  expect_failure({"spectra", folder_ / "bad.csv"}, 1, "line 2");
  expect_failure({"spectra", folder_ / "missing.csv"}, 1, "missing.csv: cannot read");
  expect_failure({"spectra", folder_.path().string()}, 1, "not a plain file");
  expect_failure({"spectra", "/dev/zero"}, 1, "not a plain file");
  expect_failure({"spectra", cgats_, "--column", "2"}, 2, "has 2 data rows");
  expect_failure({"spectra", cgats_, "--column", "-1"}, 2, "-1");
  expect_failure({"spectra", "D65", "--column", "0"}, 2, "--column is for files");
  expect_failure({"spectra", "D65", "--at", "blue"}, 2, "blue is not a wavelength");
  expect_failure({"spectra", "D65", "--at", "nan"}, 2, "nan is not a wavelength");
  expect_failure({"spectra", "--at", "500"}, 2, "SPECTRUM");
  expect_failure({"spectra", "D65", "--csv", "--json"}, 2, "--json");
  expect_failure({"spectra", "D65", "D50"}, 2, "D50");
}

TEST_F(SpectraCommand, OtherCommandsTakeEverySpectrumAsALight) {
  test::Picture picture = test::blank(8, 4);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder_ / "in.exr", picture);
  ASSERT_EQ(run_tool({"upsample", folder_ / "in.exr", "-o", folder_ / "spectral.exr"}).exit, 0);
  for (const std::string& light : {std::string("daylight:5003"), std::string("blackbody:3200"),
                                   std::string("constant:1"), columns_, cgats_}) {
    const auto relit =
        run_tool({"relight", folder_ / "in.exr", "-o", folder_ / "lit.exr", "--illuminant", light});
    EXPECT_EQ(relit.exit, 0) << relit;
    const auto seen =
        run_tool({"project", folder_ / "spectral.exr", "-o", folder_ / "seen.exr", "--illuminant", light});
    EXPECT_EQ(seen.exit, 0) << seen;
  }
  // A formula is its table.
  test::write_text(folder_ / "3200.csv", run_tool({"spectra", "blackbody:3200", "--csv"}).out);
  const auto seen_under = [&](const std::string& light) {
    const std::string out = folder_ / "seen.exr";
    const auto outcome = run_tool({"project", folder_ / "spectral.exr", "-o", out, "--illuminant", light});
    EXPECT_EQ(outcome.exit, 0) << outcome;
    return test::read_picture(out).planes;
  };
  EXPECT_EQ(seen_under("blackbody:3200"), seen_under(folder_ / "3200.csv"));
  EXPECT_NE(seen_under("blackbody:3200"), seen_under("blackbody:3300"));
}

}  // namespace
}  // namespace spectile
