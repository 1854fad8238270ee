// Tables as programs and people write them, beside the usual ones: all of the same ten samples, or refused
// with the place and the reason.
#include <fmt/format.h>

#include "tests/io/text/spectrum_table_support.hpp"

namespace spectile::test {
namespace {

class SpectrumVariants : public SpectrumTableFile {};

std::string csv(double per_nm = 1, double per_value = 1, const char* separator = ",") {
  return lamp_text(
      [&](double nm, double v) { return fmt::format("{}{}{}\n", nm * per_nm, separator, v * per_value); });
}

std::string utf16(const std::string& ascii, bool little) {
  std::string out = little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : ascii) out += little ? std::string{c, '\0'} : std::string{'\0', c};
  return out;
}

TEST_F(SpectrumVariants, OfSpreadsheetsAreRead) {
  expect_lamp("sep=;\nWellenl\xC3\xA4nge;Wert\n" + with_commas(csv(1, 1, ";")), "decimal commas");
  // Latin-1 is no UTF-8, and no sample either.
  expect_lamp("Wellenl\xE4nge;Wert\n" + csv(1, 1, ";"));
  expect_lamp("nm,R,,\n" + lamp_text([](double nm, double v) { return fmt::format("{},{},,\n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("\"{}\";\"{}\"\r\n", nm, v); }));
  expect_lamp("Instrument,Foo 3000\nDate,2024-01-01\nIntegration time (ms),100\n\nWavelength,Value\n" +
              csv());
  expect_lamp(utf16("nm;W\r\n" + with_commas(csv(1, 1, ";")), true), "decimal commas");
  expect_lamp(utf16("nm,W\n" + csv(), false));
}

TEST_F(SpectrumVariants, OfWritingAreRead) {
  std::string text = csv();
  for (char& c : text) c = c == '\n' ? '\r' : c;
  expect_lamp(text);
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{:.3e}\t{:.5E}\n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("   +{}    +{}   \n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{} nm, {}\n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{}: {}\n", nm, v); }));
  std::string heading = "Sample";
  std::string values = "A";
  for (std::size_t i = 0; i < kLamp.size(); ++i) {
    heading += fmt::format(",{} nm", kLampNm[i]);
    values += fmt::format(",{}", kLamp[i]);
  }
  expect_lamp(heading + "\n" + values + "\n", "a spectrum in each row");
  // Without names too.
  expect_lamp(heading.substr(7) + "\n" + values.substr(2) + "\n", "a spectrum in each row");
}

TEST_F(SpectrumVariants, OfUnitsAreRead) {
  const auto in = [](const char* unit, double per_nm) {
    return fmt::format("Wavelength {},R\n", unit) +
           lamp_text([&](double nm, double v) { return fmt::format("{:.10g},{}\n", nm * per_nm, v); });
  };
  // The micro sign and the Greek letter.
  for (const char* unit : {"(\xC2\xB5m)", "(\xCE\xBCm)", "[microns]"})
    expect_lamp(in(unit, 1e-3), "wavelengths in um");
  for (const char* unit : {"[\xC3\x85]", "(angstrom)"}) expect_lamp(in(unit, 10), "wavelengths in angstrom");
  const auto percent = [](const char* behind) {
    return lamp_text(
        [&](double nm, double v) { return fmt::format("{}\t{:.10g}{}\n", nm, v * 100, behind); });
  };
  expect_lamp(percent("%"), "values in percent");
  expect_lamp(percent(" %"), "values in percent");
  expect_lamp("nm\t%R\n" + percent(""), "values in percent, as the file says, divided by 100");
}

TEST_F(SpectrumVariants, InDoubtAreRefusedWithTheirPlace) {
  expect_refused("Energy (eV),R\n" + csv(1e-2), "wavelengths in eV are not read, only nm, um");
  expect_refused(csv() + "\nInstrument: x\n", "line 12, column 1: \"Instrument: x\" is not a wavelength");
  expect_refused("400 2.5D-01\n500 3D-01\n", "line 1, column 5");
  expect_refused("400|0.25\n500|0.5\n", "line 1, column 1");
  expect_refused(csv() + "770,NaN\n", "line 11, column 5: \"770,NaN\" is not finite");
  expect_refused(csv() + "770,N/A\n", "line 11, column 5");
  expect_refused("#,nm,R\n0,400,1\n1,500,1\n", "a wavelength of 0 nm is not above 0");
  expect_refused("{\"wavelengths\":[400,500],\"values\":[1,2]}", "holds no sample");
  expect_refused("<html><body>404</body></html>\n", "holds no sample");
  expect_refused("[400, 1, 500, 1]\n", "no heading row of wavelengths");
}

}  // namespace
}  // namespace spectile::test
