// Units of wavelengths and values of tables, what is said of them, and tables that are refused.
#include <gmock/gmock.h>

#include "tests/io/text/spectrum_table_support.hpp"

namespace spectile::test {
namespace {

class SpectrumUnits : public SpectrumTableFile {};

/// The lamp with wavelengths in another unit.
std::string scaled(double factor) {
  return lamp_text([&](double nm, double v) { return fmt::format("{:.9g},{}\n", nm * factor, v); });
}
std::string wavenumbers() {
  return lamp_text([](double nm, double v) { return fmt::format("{:.17g},{}\n", 1e7 / nm, v); });
}

SpectrumFileOptions reflectances() {
  SpectrumFileOptions out;
  out.use = SpectrumUse::kReflectance;
  return out;
}

TEST_F(SpectrumUnits, HeadingsNameThem) {
  for (const char* heading : {"Wavelength (micrometers),Power", "wavelength_um,value", "\xC2\xB5m,W",
                              "# wavelength in microns", "X Units: Wavelength (micrometers)", "lambda [um],E",
                              "Wavelength /um,W/m2/nm", "\xCE\xBB/\xC2\xB5m;E"}) {
    expect_lamp(std::string(heading) + "\n" + scaled(1e-3), "wavelengths in um, as its heading says");
  }
  for (const char* heading : {"Wavelength (m),E", "wavelength [metres];E"}) {
    expect_lamp(std::string(heading) + "\n" + scaled(1e-9), "wavelengths in m, as its heading says");
  }
  for (const char* heading : {"Angstrom,E", "Wavelength [\xC3\x85],E", "wavelength (A),E"}) {
    expect_lamp(std::string(heading) + "\n" + scaled(10), "wavelengths in angstrom, as its heading says");
  }
  for (const char* heading : {"Wavelength (nm),Power", "nm,E", "wavelength_nm,value"})
    expect_lamp(std::string(heading) + "\n" + scaled(1));
}

TEST_F(SpectrumUnits, NumbersNameThemWhereThereIsNoDoubt) {
  expect_lamp(scaled(1));
  expect_lamp(scaled(1e-3), "wavelengths taken as um, by their numbers, 0.4 to 0.76");
  expect_lamp(scaled(1e-9), "wavelengths taken as m, by their numbers");
  expect_lamp(scaled(10), "wavelengths taken as angstrom, by their numbers, 4000 to 7600");
}

TEST_F(SpectrumUnits, WavenumbersDescend) {
  for (const char* heading : {"", "wavenumber (cm-1),E\n", "cm^-1,E\n", "sigma [1/cm];E\n"}) {
    const auto table = load(heading + wavenumbers());
    ASSERT_TRUE(table) << table.error().message;
    const auto& linear = std::get<PiecewiseLinearSpectrum>(table->spectra.front().kind());
    for (std::size_t i = 0; i < kLamp.size(); ++i) {
      EXPECT_NEAR(linear.wavelengths_nm()[i], kLampNm[i], 1e-9);
      EXPECT_EQ(linear.values()[i], kLamp[i]);
    }
    EXPECT_THAT(table->notes, testing::Contains(testing::HasSubstr("cm^-1")));
  }
}

TEST_F(SpectrumUnits, OptionsWinOverHeadingsAndNumbers) {
  SpectrumFileOptions um;
  um.wavelengths = WavelengthUnit::kUm;
  expect_lamp("nm,E\n" + scaled(1e-3), "", um);
}

TEST_F(SpectrumUnits, DoubtIsAnError) {
  // 1000 to 2000 nm, or 400 to 800 nm as either angstrom or wavenumbers.
  std::string both;
  for (int w = 4000; w <= 25000; w += 1000) both += fmt::format("{},1\n", w);
  expect_refused(both, "could be in more than one");
  SpectrumFileOptions stated;
  stated.wavelengths = WavelengthUnit::kPerCm;
  EXPECT_TRUE(load(both, stated));
  // From X-rays to light in nm, or from 0.4 um to 600 um.
  expect_refused("0.4,1\n0.6,1\n3,1\n40,1\n600,1\n", "could be in more than one");
  expect_refused("wavelength (THz),E\n400,1\n500,1\n", "wavelengths in THz are not read");
  expect_refused("energy [eV], wavelength (eV)\n1.6,1\n3.2,1\n", "");
}

TEST_F(SpectrumUnits, TableWithoutVisibleSampleSaysWhatItHolds) {
  expect_refused("900,1\n1000,2\n2500,3\n",
                 "no sample lies within 360 to 830 nm; wavelengths are 900 to 2500 nm");
  expect_refused("wavelength (um),E\n400,1\n500,2\n700,3\n",
                 "wavelengths are 400 to 700 um (400000 to 700000 nm)");
  expect_refused("0.1,1\n0.2,2\n0.3,1\n0.31,1\n0.32,1\n", "wavelengths are 0.1 to 0.32 nm");
  expect_refused("a,400,1\na,500,1\nb,900,1\nb,1000,1\n",
                 "no sample of \"b\" lies within 360 to 830 nm; its wavelengths are 900 to 1000 nm");
  EXPECT_TRUE(load("300,1\n900,1\n"));  // covers it
}

TEST_F(SpectrumUnits, FewNumbersAreNotGuessed) {
  expect_refused("0.4,1\n0.5,2\n0.6,3\n", "no sample lies within 360 to 830 nm");
}

TEST_F(SpectrumUnits, UnitsStandBehindNumbers) {
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{}nm\t{}\n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{} nm, {} mW\n", nm, v); }));
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{}um;{}\n", nm / 1000, v); }),
              "wavelengths in um, as its numbers say");
  expect_refused("400nm,1\n0.5um,2\n", "line 2, column 1");
  expect_refused("400nm,1mW\n500nm,2W\n", "line 2, column 7: \"2W\" has another unit than the first value");
}

TEST_F(SpectrumUnits, PercentIsReadFromHeadings) {
  const std::string percent =
      lamp_text([](double nm, double v) { return fmt::format("{},{}\n", nm, v * 100); });
  expect_lamp("nm,R%\n" + percent, "values in percent");
  expect_lamp("nm,Reflectance (percent)\n" + percent, "values in percent");
  expect_lamp("Y Units: Reflectance (percent)\n" + percent, "values in percent");
  expect_lamp(lamp_text([](double nm, double v) { return fmt::format("{},{}%\n", nm, v * 100); }),
              "values in percent");
  expect_lamp("panel of 99 %\n" +
              lamp_text([](double nm, double v) { return fmt::format("{},{}\n", nm, v); }));
  SpectrumFileOptions fraction = reflectances();
  fraction.one = 1;
  EXPECT_EQ((*load("nm,R%\n400,0.5\n700,0.5\n", fraction)).spectra[0](500), 0.5);
  expect_refused("nm,R%\n400,0.5\n700,0.5\n", "a heading says percent, but no value is above 0.5",
                 reflectances());
}

TEST_F(SpectrumUnits, HeaderOfAnInstrumentIsRead) {
  const auto table = load(
      "Sample: Oak\nDate: 2021\nX Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\nFirst X "
      "Value: 0.4\n"
      "Last X Value: 14.0\nNumber of X Values: 5\n\n0.4\t12.5\n0.5\t12.5\n0.6\t25\n0.7\t12.5\n14.0\t12.5\n",
      reflectances());
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_DOUBLE_EQ(table->spectra[0](600), 0.25);
  EXPECT_DOUBLE_EQ(table->spectra[0](550), 0.1875);
}

TEST_F(SpectrumUnits, ReflectancesFarOutsideZeroToOneAreRefused) {
  expect_refused("400,5.5,60\n700,1.2,90\n", "3 of 4 values lie far outside 0 to 1, from 1.2 to 90; --values",
                 reflectances());
  expect_refused("400,12000\n700,40000\n", "2 of 2 values lie far outside", reflectances());
  expect_refused("400,0.5\n500,-1.23e34\n700,0.5\n",
                 "1 of 3 values are marks of missing samples, like -1.23e+34; --missing", reflectances());
  SpectrumFileOptions counts = reflectances();
  counts.one = 40000;
  EXPECT_DOUBLE_EQ((*load("400,12000\n700,40000\n", counts)).spectra[0](400), 0.3);
  SpectrumFileOptions marked = reflectances();
  marked.missing = -1.23e34;
  const auto table = load("400,0.5\n500,-1.23e34\n700,0.7\n", marked);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_DOUBLE_EQ(table->spectra[0](550), 0.6);
  EXPECT_THAT(table->notes, testing::ElementsAre(testing::HasSubstr("1 missing sample, left out")));
  EXPECT_TRUE(load("400,-0.01\n700,1.3\n", reflectances()));  // noise, fluorescence
}

TEST_F(SpectrumUnits, EmptyCellsAreMissingSamples) {
  const auto table = load("nm,a,b\n400,1,5\n500,,6\n600,3,\n700,4,8\n");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_DOUBLE_EQ(table->spectra[0](500), 2);
  EXPECT_DOUBLE_EQ(table->spectra[1](600), 7);
  EXPECT_THAT(table->notes, testing::ElementsAre(testing::HasSubstr("2 missing samples")));
  expect_refused("nm,a,b\n400,1,\n500,,\n", "a spectrum needs two wavelengths");
}

TEST_F(SpectrumUnits, LightsThatAreNoneAreRefused) {
  const auto refused = [&](const std::string& what, const std::string& part) {
    const auto light = find_light(what);
    ASSERT_FALSE(light) << what;
    EXPECT_THAT(light.error().message, testing::HasSubstr(part));
  };
  refused("BK7-eta", "BK7-eta is a refractive index, not a light");
  refused("Cu-k", "Cu-k is an absorption index, not a light");
  refused("gold-eta", "is a refractive index");
  refused("colorchecker-blue", "colorchecker-blue is a reflectance, not a light");
  refused("constant:0", "has no energy within 360 to 830 nm");
  refused("constant:-1", "values are below 0");
  write_text(path_, "400,1\n500,-0.5\n700,1\n");
  refused(path_, "1 of 3 values are below 0, down to -0.5; a light has no negative emission");
  write_text(path_, "400,0\n700,0\n");
  refused(path_, "has no energy within 360 to 830 nm");
  // Dark noise is said.
  write_text(path_, "400,1\n500,-0.001\n700,1\n");
  EXPECT_THAT(find_light(path_)->notes,
              testing::ElementsAre(testing::HasSubstr("1 of 3 values are below 0")));
  EXPECT_THAT(find_light("cie1931-y")->notes, testing::ElementsAre(testing::HasSubstr("kind observer")));
  write_text(path_, "nm,Reflectance\n400,0.5\n700,0.5\n");
  EXPECT_THAT(find_light(path_)->notes,
              testing::ElementsAre(testing::HasSubstr("a heading says reflectance")));
  EXPECT_FALSE(find_reflectances("D65"));
  EXPECT_TRUE(find_reflectances("colorchecker-blue"));
}

}  // namespace
}  // namespace spectile::test
