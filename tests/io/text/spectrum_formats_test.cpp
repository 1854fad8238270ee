// Writings of one lamp: separators, decimal commas, quotation marks, comments, pairs, rows, meters, CGATS,
// XML.
#include <gmock/gmock.h>

#include "tests/io/text/spectrum_table_support.hpp"

namespace spectile::test {
namespace {

using testing::HasSubstr;

class SpectrumFormats : public SpectrumTableFile {};

std::string columns(const std::string& between, const std::string& behind = "\n") {
  return lamp_text([&](double nm, double v) { return fmt::format("{}{}{}{}", nm, between, v, behind); });
}

TEST_F(SpectrumFormats, DecimalCommasAreReadWhereACommaCannotSeparate) {
  for (const char* between : {"\t", ";", "  ", " ; "}) {
    expect_lamp(with_commas(columns(between)), "numbers have decimal commas");
    expect_lamp("nm" + std::string(between) + "W\n" + with_commas(columns(between)),
                "numbers have decimal commas");
  }
  expect_lamp(
      with_commas(lamp_text([](double nm, double v) { return fmt::format("\"{}\";\"{}\"\n", nm, v); })),
      "numbers have decimal commas");
  expect_lamp(lamp_text([](double nm, double v) {
                return fmt::format("\"{}\",\"{}\"\n", nm, with_commas(fmt::format("{}", v)));
              }),
              "numbers have decimal commas");
  expect_refused("400;1.234,5\n500;2\n", "line 1, column 5");
}

TEST_F(SpectrumFormats, QuotationMarksAreNoPartOfCells) {
  expect_lamp("\"Wavelength\",\"Value\"\n" +
              lamp_text([](double nm, double v) { return fmt::format("\"{}\",\"{}\"\n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("\"{}\"\t\"{}\"\n", nm, v); }));
}

TEST_F(SpectrumFormats, CommentsStandAnywhere) {
  expect_lamp(columns(" ", " # peak\n"));
  expect_lamp(columns(",", " // peak 3\n"));
  expect_lamp(columns(" ", " ; peak\n"));
  expect_lamp("; a lamp\n// of 2021\n# in nm\n" + columns(",") + "# the end\n");
}

TEST_F(SpectrumFormats, SeparatorsMayEndLines) {
  expect_lamp(columns(",", ",\n"));
  expect_lamp(columns(";", ";\r\n"));
  expect_lamp(columns("\t", "\t\n"));
  expect_lamp("\n\n" + columns("\t\t"));
}

TEST_F(SpectrumFormats, PairsStandOnOneLineOrMore) {
  expect_lamp(columns(" ", " "));
  expect_lamp(columns(", ", ", "));
  expect_lamp(columns(":", ", "));
  expect_lamp(columns(":", ",\n"));
  expect_lamp(columns(":", " "));
  // Four samples a line.
  int count = 0;
  expect_lamp(lamp_text(
      [&](double nm, double v) { return fmt::format("{} {}{}", nm, v, ++count % 4 == 0 ? "\n" : " "); }));
  expect_refused("400:1, 500:2, 600\n", "a wavelength without its value");
}

TEST_F(SpectrumFormats, Utf16IsRead) {
  for (const bool little : {true, false}) {
    const std::string text = "\xEF\xBB\xBF";
    std::string out = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char c : std::string("nm,E\r\n") + columns(",", "\r\n")) {
      out += little ? std::string{c, '\0'} : std::string{'\0', c};
    }
    expect_lamp(out);
  }
}

TEST_F(SpectrumFormats, DescendingSamplesAreSorted) {
  std::string text;
  for (std::size_t i = kLamp.size(); i-- > 0;) text += fmt::format("{},{}\n", kLampNm[i], kLamp[i]);
  expect_lamp(text);
}

TEST_F(SpectrumFormats, RowsUnderWavelengthsAreSpectra) {
  std::string heading = "patch";
  std::string row = "A1";
  for (std::size_t i = 0; i < kLamp.size(); ++i) {
    heading += fmt::format(",{}", kLampNm[i]);
    row += fmt::format(",{}", kLamp[i]);
  }
  expect_lamp(heading + "\n" + row + "\n", "a spectrum in each row");
  expect_lamp(heading.substr(5) + "\n" + row + "\n", "a spectrum in each row");
  const auto table = load(heading + "\n" + row + "\nB2" + row.substr(2) + "\n");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->names, testing::ElementsAre("A1", "B2"));
  // Numbers as names; prefixes in the heading; no corner.
  EXPECT_TRUE(load("no,nm400,nm500,nm600\n1,0.1,0.2,0.3\n2,0.4,0.5,0.6\n"));
  const auto nameless = load("400,500,600\n0.1,0.2,0.3\n0.4,0.5,0.6\n");
  ASSERT_TRUE(nameless) << nameless.error().message;
  EXPECT_EQ(nameless->spectra.size(), 2U);
  EXPECT_EQ(nameless->spectra[1](500), 0.5);
  // A heading of numbers that are no wavelengths names columns.
  const auto numbered = load("wavelength,1,2,3\n400,0.1,0.2,0.3\n500,0.4,0.5,0.6\n");
  ASSERT_TRUE(numbered) << numbered.error().message;
  EXPECT_THAT(numbered->names, testing::ElementsAre("1", "2", "3"));
}

TEST_F(SpectrumFormats, RowsWithoutWavelengthsAreRefused) {
  expect_refused("patch,a,b,c\nA1,0.1,0.2,0.3\nA2,0.1,0.2,0.3\n",
                 "line 2: a name and values, but no heading row of wavelengths");
  expect_refused("0.1,0.2,0.3\n0.5,0.3,0.3\n", "no sample lies within 360 to 830 nm");
  expect_refused("x,400,500,600\n400,1,2,3\n500,4,5,6\n600,7,8,9\n",
                 "both the first row and the first column");
  EXPECT_TRUE(load("wavelength,400,500,600\n400,1,2,3\n500,4,5,6\n600,7,8,9\n"));
}

TEST_F(SpectrumFormats, ColumnsAreChosenByNameOrNumber) {
  write_text(path_, "nm,FL 2,LED,3\n400,1,2,3\n700,4,5,6\n");
  EXPECT_EQ(find_light(path_ + ":LED")->spectrum.at(400), 2);
  EXPECT_EQ(find_light(path_ + ":FL 2")->spectrum.at(400), 1);
  EXPECT_EQ(find_light(path_ + ":1")->spectrum.at(400), 2);
  EXPECT_EQ(find_light(path_ + ":3")->spectrum.at(400), 3);
  EXPECT_EQ(find_light(path_ + ":LED")->name, "lamp.txt:LED");
  EXPECT_THAT(find_light(path_).error().message, HasSubstr("holds 3 spectra: FL 2, LED, 3; choose one"));
  EXPECT_THAT(find_light(path_ + ":D65").error().message,
              HasSubstr("has no column \"D65\"; there are FL 2, LED, 3"));
  // A name wins over a number, and that is said.
  write_text(path_, "nm,1,2\n400,1,2\n700,4,5\n");
  EXPECT_EQ(find_light(path_ + ":1")->spectrum.at(400), 1);
  EXPECT_THAT(find_light(path_ + ":1")->notes, testing::ElementsAre(HasSubstr("column 1 by its name")));
}

TEST_F(SpectrumFormats, TextExportsOfMetersAreRead) {
  const auto upr = columns("\t", "\n");
  expect_lamp(
      "Model "
      "Name\tMK350\nTime\t2021/01/"
      "04_23:14:46\nLUX\t695.15\nCCT\t5198\nCIE1931\nx\t0.34\n\xCE\xBBp\t456\n[CRI]\nRa\t95\n\n" +
      lamp_text([](double nm, double v) { return fmt::format("{}nm\t{}\n", nm, v); }));
  expect_lamp("Date Saved,2016/10/12 13:55\nTitle,x\nTcp [K],5600\nPeak Wavelength [nm],560\n" +
              lamp_text([](double nm, double v) { return fmt::format("Spectral Data {}[nm],{}\n", nm, v); }) +
              "TM30,90\n");
  expect_lamp("i1 Pro\nEmission\nnm\tmW/nm/m\xC2\xB2\n" + upr);
  // Two runs, of which the finer counts.
  std::string text;
  for (int nm = 400; nm <= 700; nm += 5) text += fmt::format("Spectral Data {}[nm],{}\n", nm, 7);
  for (int nm = 400; nm <= 700; ++nm) text += fmt::format("Spectral Data {}[nm],{}\n", nm, nm);
  const auto runs = load(text);
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_EQ(runs->spectra[0](503), 503);
  EXPECT_THAT(runs->notes,
              testing::ElementsAre(HasSubstr("2 runs of wavelengths; the one of 301 samples is read")));
}

TEST_F(SpectrumFormats, CgatsNeedsNoKeywordsOfArgyll) {
  for (const char* prefix : {"nm", "SPECTRAL_NM", "SPECTRAL_NM_", "SPEC_", "R_"}) {
    std::string fields = "SAMPLE_ID LAB_L";
    std::string row = "A1 50";
    for (std::size_t i = 0; i < kLamp.size(); ++i) {
      fields += fmt::format(" {}{}", prefix, kLampNm[i]);
      row += fmt::format(" {}", kLamp[i]);
    }
    expect_lamp("CGATS.17\nBEGIN_DATA_FORMAT\n" + fields + "\nEND_DATA_FORMAT\nBEGIN_DATA\n" + row +
                "\nEND_DATA\n");
    expect_lamp("BEGIN_DATA_FORMAT\n" + fields + "\nEND_DATA_FORMAT\nBEGIN_DATA\n" + with_commas(row) +
                    "\nEND_DATA\n",
                "decimal commas");
  }
  expect_refused("CGATS.17\nBEGIN_DATA_FORMAT\nLAB_L LAB_A\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2\nEND_DATA\n",
                 "has no SPECTRAL_BANDS, and no fields like SPECTRAL_NM380");
}

TEST_F(SpectrumFormats, Tm27IsRead) {
  const auto spdx = [](const std::string& prefix, const std::string& quantity) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<" + prefix + "IESTM2714 version=\"1.0\">\n<" +
           prefix + "Header/>\n<" + prefix + "SpectralDistribution>\n<" + prefix + "SpectralQuantity>" +
           quantity + "</" + prefix + "SpectralQuantity>\n" + lamp_text([&](double nm, double v) {
             return fmt::format("<{}SpectralData wavelength=\"{}\"> {} </{}SpectralData>\n", prefix, nm, v,
                                prefix);
           }) +
           "</" + prefix + "SpectralDistribution>\n</" + prefix + "IESTM2714>\n";
  };
  expect_lamp(spdx("", "flux"));
  expect_lamp(spdx("ies:", "relative"));
  write_text(path_, spdx("", "Transmittance"));
  EXPECT_THAT(find_light(path_)->notes, testing::ElementsAre(HasSubstr("says transmittance")));
  std::string damaged = spdx("", "flux");
  damaged.replace(damaged.find("wavelength=\"480\""), 16, "wavelength=\"4x0\"");
  expect_refused(damaged, "line 8: \"4x0\" is not a wavelength in nm");
  expect_refused(spdx("", "flux").substr(0, 300), "the XML is damaged");
  expect_refused("<?xml version=\"1.0\"?>\n<html/>\n", "without a SpectralDistribution");
}

TEST_F(SpectrumFormats, WideFilesAreReadInTheirSize) {
  // 500 columns of 400 lines, and 200 000 pairs on one line.
  std::string wide;
  for (int nm = 380; nm < 780; ++nm) {
    wide += std::to_string(nm);
    for (int i = 0; i < 500; ++i) wide += ",0.5";
    wide += "\n";
  }
  EXPECT_EQ(load(wide)->spectra.size(), 500U);
  std::string pairs;
  for (int i = 0; i < 200000; ++i) pairs += fmt::format("{:.3f} 1 ", 300 + i * 2e-3);
  EXPECT_TRUE(load(pairs));
  EXPECT_FALSE(load(std::string(4000000, ';') + "x"));
  EXPECT_FALSE(load(std::string(4000000, '"')));
}

}  // namespace
}  // namespace spectile::test
