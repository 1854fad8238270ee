// Named spectra against what is published about them, and the errors of names that there are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <spectile/color/colorimetry.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <string>

namespace spectile {
namespace {

using testing::HasSubstr;

Spectrum spectrum(const std::string& name) {
  auto s = named_spectrum(name);
  EXPECT_TRUE(s) << name;
  return s ? *std::move(s) : Spectrum(ConstantSpectrum(0));
}

std::vector<std::string> names_of(const std::string& kind) {
  std::vector<std::string> out;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == kind) out.push_back(info.name);
  }
  return out;
}

std::string error_of(const std::string& name) {
  const auto s = named_spectrum(name);
  EXPECT_FALSE(s) << name;
  return s ? "" : s.error().message;
}

const std::array<Spectrum, 3>& observer() {
  static const std::array<Spectrum, 3> bars = {spectrum("cie1931-x"), spectrum("cie1931-y"),
                                               spectrum("cie1931-z")};
  return bars;
}

std::array<double, 2> chromaticity(const std::array<double, 3>& xyz) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / sum, xyz[1] / sum};
}

/// By sums at 5 nm over 380 to 780 nm, as the CIE computes those it prints.
std::array<double, 2> chromaticity_by_sums(const Spectrum& light) {
  std::array<double, 3> xyz{};
  for (int nm = 380; nm <= 780; nm += 5) {
    for (std::size_t i = 0; i < 3; ++i) xyz[i] += light(nm) * observer()[i](nm);
  }
  return chromaticity(xyz);
}

std::array<double, 2> chromaticity_by_integrals(const Spectrum& light) {
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < 3; ++i) xyz[i] = inner_product(light, observer()[i]);
  return chromaticity(xyz);
}

/// At normal incidence from air. Source: Fresnel's equations.
double reflectance(const std::string& metal, double nm) {
  const double n = spectrum(metal + "-eta")(nm);
  const double k = spectrum(metal + "-k")(nm);
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

struct White {
  const char* name;
  double x, y;
};

// CIE 015:2018. Those of the daylights, A and C have five decimals, those of lamps four.
const White kSmooth[] = {{"A", 0.44758, 0.40745},   {"C", 0.31006, 0.31616},   {"D50", 0.34567, 0.35850},
                         {"D55", 0.33242, 0.34743}, {"D60", 0.32162, 0.33762}, {"D65", 0.31272, 0.32903},
                         {"D75", 0.29902, 0.31485}, {"E", 1.0 / 3, 1.0 / 3}};
const White kLamps[] = {{"FL1", 0.3131, 0.3371},     {"FL2", 0.3721, 0.3751},    {"FL3", 0.4091, 0.3941},
                        {"FL4", 0.4402, 0.4031},     {"FL5", 0.3138, 0.3452},    {"FL6", 0.3779, 0.3882},
                        {"FL7", 0.3129, 0.3292},     {"FL8", 0.3458, 0.3586},    {"FL9", 0.3741, 0.3727},
                        {"FL10", 0.3458, 0.3588},    {"FL11", 0.3805, 0.3769},   {"FL12", 0.4370, 0.4042},
                        {"HP1", 0.5330, 0.4150},     {"LED-B1", 0.4560, 0.4078}, {"LED-B3", 0.3756, 0.3723},
                        {"LED-RGB1", 0.4557, 0.4211}};

TEST(NamedSpectra, IlluminantsHaveThePublishedChromaticities) {
  EXPECT_EQ(std::size(kSmooth) + std::size(kLamps), names_of("illuminant").size());
  for (const White& white : kSmooth) {
    const auto xy = chromaticity_by_sums(spectrum(white.name));
    EXPECT_NEAR(xy[0], white.x, 4e-5) << white.name;
    EXPECT_NEAR(xy[1], white.y, 4e-5) << white.name;
  }
  for (const White& white : kLamps) {
    const auto xy = chromaticity_by_sums(spectrum(white.name));
    EXPECT_NEAR(xy[0], white.x, 9e-5) << white.name;
    EXPECT_NEAR(xy[1], white.y, 9e-5) << white.name;
  }
}

TEST(NamedSpectra, ChromaticitiesByExactIntegralsDifferByWhatLinesDo) {
  // Between the samples of 5 nm a lamp is linear here, and the observer has every nanometre: a line at one
  // sample is then weighted by a triangle of the observer. The CIE sums at the samples. The largest
  // difference found is 2.3e-4, of FL11; of smooth lights 6e-5, of C.
  for (const White& white : kSmooth) {
    const auto xy = chromaticity_by_integrals(spectrum(white.name));
    EXPECT_NEAR(xy[0], white.x, 7e-5) << white.name;
    EXPECT_NEAR(xy[1], white.y, 7e-5) << white.name;
  }
  for (const White& white : kLamps) {
    const auto xy = chromaticity_by_integrals(spectrum(white.name));
    EXPECT_NEAR(xy[0], white.x, 2.5e-4) << white.name;
    EXPECT_NEAR(xy[1], white.y, 2.5e-4) << white.name;
  }
}

TEST(NamedSpectra, IlluminantsAreThoseOfIlluminant) {
  EXPECT_EQ(names_of("illuminant"), illuminant_names());
  for (const std::string& name : illuminant_names()) {
    const auto table = illuminant(name);
    ASSERT_TRUE(table);
    const Spectrum s = spectrum(name);
    for (std::size_t i = 0; i < table->values().size(); ++i) {
      EXPECT_EQ(s(table->wavelengths_nm()[i]), table->values()[i]) << name;
    }
  }
}

TEST(NamedSpectra, DaylightFormulaMakesTheDaylights) {
  // The CIE's tables are of the temperatures 5000, 5500 and so on of the scale of 1948, times 1.4388
  // / 1.4380; their last digit is 0.001, and 0.0005 off is rounding. Whole temperatures may round M1 or M2
  // otherwise.
  const double scale = 1.4388 / 1.4380;
  for (const auto& [name, kelvin] :
       {std::pair("D50", 5000.0), {"D55", 5500.0}, {"D60", 6000.0}, {"D65", 6500.0}, {"D75", 7500.0}}) {
    const auto s = daylight_spectrum(kelvin * scale);
    ASSERT_TRUE(s);
    for (int nm = 300; nm <= 780; nm += 5) EXPECT_NEAR((*s)(nm), spectrum(name)(nm), 0.0011) << name << nm;
    const Spectrum whole = spectrum("daylight:" + std::to_string(std::lround(kelvin * scale)));
    for (int nm = 300; nm <= 780; nm += 5) EXPECT_NEAR(whole(nm), spectrum(name)(nm), 0.05) << name << nm;
  }
}

TEST(NamedSpectra, DaylightHasThePublishedChromaticity) {
  // CIE 015:2018, of the illuminants' spectra; the locus of daylight passes their y at 1e-4.
  const auto d65 = daylight_chromaticity(6504);
  const auto d50 = daylight_chromaticity(5003);
  ASSERT_TRUE(d65 && d50);
  EXPECT_NEAR((*d65)[0], 0.31272, 2e-5);
  EXPECT_NEAR((*d65)[1], 0.32903, 1.2e-4);
  EXPECT_NEAR((*d50)[0], 0.34567, 3e-5);
  EXPECT_NEAR((*d50)[1], 0.35850, 1.2e-4);
  // The two formulas meet at 7000 K.
  const auto below = daylight_chromaticity(7000);
  const auto above = daylight_chromaticity(std::nextafter(7000.0, 8000.0));
  ASSERT_TRUE(below && above);
  EXPECT_NEAR((*below)[0], (*above)[0], 1e-4);
}

TEST(NamedSpectra, DaylightIs100At560NmAndEndsAt25000K) {
  for (const double kelvin : {4000.0, 6504.0, 25000.0}) {
    const auto s = daylight_spectrum(kelvin);
    ASSERT_TRUE(s);
    EXPECT_EQ((*s)(560), 100);
    EXPECT_EQ((*s)(299), 0);
  }
  for (const double kelvin : {3999.9, 25000.1, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_FALSE(daylight_spectrum(kelvin));
    EXPECT_FALSE(daylight_chromaticity(kelvin));
  }
}

TEST(NamedSpectra, GlassesHaveTheirCataloguesIndices) {
  // Schott's catalogue at the lines d, C, F; samples every 21 nm lie up to 5e-5 above the curve in between.
  EXPECT_NEAR(spectrum("BK7-eta")(587.56), 1.51680, 3e-5);
  EXPECT_NEAR(spectrum("BK7-eta")(656.27), 1.51432, 3e-5);
  EXPECT_NEAR(spectrum("BK7-eta")(486.13), 1.52238, 5e-5);
  EXPECT_NEAR(spectrum("SF10-eta")(587.56), 1.72825, 5e-5);
  EXPECT_NEAR(spectrum("SF10-eta")(656.27), 1.72085, 5e-5);
  EXPECT_NEAR(spectrum("SF10-eta")(486.13), 1.74648, 1e-4);
}

TEST(NamedSpectra, GlassesDisperseNormally) {
  for (const char* glass : {"BK7-eta", "SF10-eta"}) {
    const Spectrum s = spectrum(glass);
    for (int nm = 400; nm < 900; nm += 10) EXPECT_GT(s(nm), s(nm + 10)) << glass << nm;
  }
}

TEST(NamedSpectra, MetalsReflectAsTheyLook) {
  EXPECT_NEAR(reflectance("Au", 450), 0.39, 0.02);
  EXPECT_GT(reflectance("Au", 700), 0.9);
  EXPECT_NEAR(reflectance("Cu", 500), 0.6, 0.02);
  EXPECT_GT(reflectance("Cu", 700), 0.9);
  for (int nm = 450; nm <= 850; nm += 10) {
    EXPECT_GT(reflectance("Ag", nm), 0.9) << nm;
    EXPECT_NEAR(reflectance("Al", nm), 0.9, 0.05) << nm;
  }
  // Silver lets ultraviolet through at its plasma edge.
  EXPECT_LT(reflectance("Ag", 318), 0.1);
}

TEST(NamedSpectra, AbsorptionOfSilverGrowsWithWavelength) {
  const Spectrum k = spectrum("Ag-k");
  for (int nm = 400; nm < 880; nm += 10) EXPECT_LT(k(nm), k(nm + 10)) << nm;
}

TEST(NamedSpectra, AliasesAreTheSameSpectra) {
  for (const auto& [alias, name] : {std::pair("copper-eta", "Cu-eta"),
                                    {"gold-k", "Au-k"},
                                    {"SILVER-eta", "Ag-eta"},
                                    {"aluminium-k", "Al-k"}}) {
    for (int nm = 300; nm < 900; nm += 50) EXPECT_EQ(spectrum(alias)(nm), spectrum(name)(nm)) << alias;
  }
}

TEST(NamedSpectra, CameraSeesRedAboveGreenAboveBlue) {
  std::array<int, 3> peak{};
  for (std::size_t c = 0; c < 3; ++c) {
    const Spectrum s = spectrum(std::string("canon-eos-5d-mkii-") + "rgb"[c]);
    for (int nm = 380; nm <= 720; ++nm) peak[c] = s(nm) > s(peak[c]) ? nm : peak[c];
    EXPECT_GT(s.max_value(), 0.4);
    EXPECT_LE(s.max_value(), 1);
  }
  EXPECT_EQ(peak, (std::array{590, 520, 470}));
}

TEST(NamedSpectra, ObserversAreTheTables) {
  EXPECT_EQ(spectrum("cie1931-y")(555), 1);
  EXPECT_EQ(spectrum("cie1964-y")(557), 1);
  EXPECT_NEAR(spectrum("cie1931-y").integral(), 106.8569, 1e-3);
  EXPECT_EQ(spectrum("cie1931-x")(359.9), 0);
}

struct Patch {
  const char* name;
  std::array<int, 3> rgb;
};

// sRGB as BabelColor and X-Rite publish it: from L*a*b* under D50, adapted to D65.
const Patch kPatches[] = {
    {"dark-skin", {115, 82, 68}},   {"light-skin", {194, 150, 130}},  {"blue-sky", {98, 122, 157}},
    {"foliage", {87, 108, 67}},     {"blue-flower", {133, 128, 177}}, {"bluish-green", {103, 189, 170}},
    {"orange", {214, 126, 44}},     {"purplish-blue", {80, 91, 166}}, {"moderate-red", {193, 90, 99}},
    {"purple", {94, 60, 108}},      {"yellow-green", {157, 188, 64}}, {"orange-yellow", {224, 163, 46}},
    {"blue", {56, 61, 150}},        {"green", {70, 148, 73}},         {"red", {175, 54, 60}},
    {"yellow", {231, 199, 31}},     {"magenta", {187, 86, 149}},      {"cyan", {8, 133, 161}},
    {"white-9.5", {243, 243, 242}}, {"neutral-8", {200, 200, 200}},   {"neutral-6.5", {160, 160, 160}},
    {"neutral-5", {122, 122, 121}}, {"neutral-3.5", {85, 85, 85}},    {"black-2", {52, 52, 52}}};

TEST(NamedSpectra, ColorCheckerLooksAsPublished) {
  ASSERT_EQ(names_of("reflectance").size(), std::size(kPatches));
  const Spectrum light = spectrum("D65");
  for (std::size_t i = 0; i < std::size(kPatches); ++i) {
    const std::string name = std::string("colorchecker-") + kPatches[i].name;
    EXPECT_EQ(names_of("reflectance")[i], name);
    const Spectrum patch = spectrum(name);
    std::array<double, 3> xyz{};
    double white = 0;
    for (int nm = 380; nm <= 730; nm += 5) {
      for (std::size_t c = 0; c < 3; ++c) xyz[c] += patch(nm) * light(nm) * observer()[c](nm);
      white += light(nm) * observer()[1](nm);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      double v = 0;
      for (std::size_t k = 0; k < 3; ++k) v += xyz_to_srgb_matrix()[3 * c + k] * xyz[k] / white;
      v = std::max(v, 0.0);
      const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
      // Light that is D65 is not D50 adapted; the largest difference found is 14, of a blue's red.
      EXPECT_NEAR(255 * encoded, kPatches[i].rgb[c], 15) << name << " channel " << c;
    }
  }
}

TEST(NamedSpectra, EveryNameIsFoundOnceWhateverItsCase) {
  std::set<std::string> seen;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    EXPECT_TRUE(seen.insert(info.name).second) << info.name;
    EXPECT_TRUE(info.alias.empty() || seen.insert(info.alias).second) << info.alias;
    EXPECT_FALSE(info.about.empty() || info.source.empty() || info.kind.empty()) << info.name;
    std::string upper = info.name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(spectrum(upper)(550), spectrum(info.name)(550));
    EXPECT_GT(spectrum(info.name).max_value(), 0) << info.name;
    EXPECT_TRUE(std::isfinite(spectrum(info.name).integral())) << info.name;
  }
  EXPECT_EQ(named_spectra().size(), 24U + 10U + 3U + 6U + 24U);
}

TEST(NamedSpectra, KindsAreGrouped) {
  std::set<std::string> kinds;
  std::string last;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    EXPECT_TRUE(info.kind == last || kinds.insert(info.kind).second) << info.kind;
    last = info.kind;
  }
  EXPECT_EQ(kinds.size(), 6U);
}

TEST(NamedSpectra, FormulasTakeNumbers) {
  EXPECT_EQ(spectrum("constant:0.5")(1), 0.5);
  EXPECT_EQ(spectrum("Constant:-2e3")(1), -2000);
  EXPECT_NEAR(spectrum("blackbody:5000").max_value(), 1, 1e-9);
  // Wien's displacement law: 2.897771955e6 nm K.
  EXPECT_NEAR(spectrum("blackbody:5000")(2.897771955e6 / 5000), 1, 1e-9);
  EXPECT_EQ(error_of("constant:"), "constant: \"\" is not a finite number");
  EXPECT_EQ(error_of("constant:nan"), "constant: \"nan\" is not a finite number");
  EXPECT_EQ(error_of("blackbody:3200K"), "blackbody: \"3200K\" is not a finite number of kelvin");
  EXPECT_EQ(error_of("daylight:1e999"), "daylight: \"1e999\" is not a finite number of kelvin");
  EXPECT_EQ(error_of("daylight:3000"),
            "daylight of 3000 K is not defined; its colour temperature is 4000 to 25000 K");
  for (const char* text : {"blackbody:0", "blackbody:-5", "constant:x", "daylight:30000"}) {
    const auto s = named_spectrum(text);
    ASSERT_FALSE(s) << text;
    EXPECT_EQ(s.error().code, ErrorCode::kBadArgument) << text;
  }
}

TEST(NamedSpectra, UnknownNamesAreToldWhatIsNear) {
  EXPECT_EQ(error_of("D66"), "spectrum \"D66\" is unknown; near it: D60, D65");
  EXPECT_EQ(error_of("gold-etta"), "spectrum \"gold-etta\" is unknown; near it: gold-eta");
  EXPECT_EQ(error_of("cie1931"), "spectrum \"cie1931\" is unknown; near it: cie1931-x, cie1931-y, cie1931-z");
  EXPECT_EQ(error_of("blackbod"), "spectrum \"blackbod\" is unknown; near it: blackbody:3200");
  EXPECT_THAT(error_of("colorchecker-"), HasSubstr(", and 19 more"));
}

TEST(NamedSpectra, UnknownNamesAreToldTheKindsWhereNothingIsNear) {
  for (const std::string& text : {std::string(), std::string("sunshine"), std::string(100000, 'D')}) {
    const std::string message = error_of(text);
    EXPECT_THAT(message, HasSubstr("illuminant (A), refractive index (Ag-eta)"));
    EXPECT_LT(message.size(), 450U);
  }
}

}  // namespace
}  // namespace spectile
