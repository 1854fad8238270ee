// Spectral images in the dialects that programs write: which channels are read, as what, and what is said.
#include <OpenEXR/ImfDoubleAttribute.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/spectra/named_spectra.hpp>

#include "src/io/channels/spectral_layout.hpp"
#include "tests/io/channels/spectral_files.hpp"

namespace spectile::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using SpectralDialects = SpectralFiles;

TEST_F(SpectralDialects, RangesAreBandsWithTheirEdges) {
  // As Mitsuba 0.6 writes them, plain and under a name.
  for (const char* prefix : {"", "radiance."}) {
    Picture picture = blank(3, 2);
    std::vector<std::pair<double, double>> bands;
    std::vector<double> values;
    for (int i = 0; i < 30; ++i) {
      const double lower = std::round((360 + 470.0 / 30 * i) * 100) / 100;
      const double upper = std::round((360 + 470.0 / 30 * (i + 1)) * 100) / 100;
      const double value = 0.25F + 0.03125F * static_cast<float>(i % 7);
      bands.emplace_back(lower, upper);
      values.push_back(value);
      picture.add(fmt::format("{}{:.2f}-{:.2f}nm", prefix, lower, upper), Imf::FLOAT,
                  [=](int, int) { return value; });
    }
    const ImageReport report = project(picture);
    EXPECT_EQ(report.bands, 30U);
    EXPECT_EQ(report.quantity, Quantity::kIlluminant);
    EXPECT_THAT(report.notes, testing::Contains(HasSubstr("Mitsuba 0.6's channels are taken for light")));
    expect_pixel(light_of(bands, values));
  }
}

TEST_F(SpectralDialects, RangesCanBeReflectances) {
  Picture picture = blank(2, 2);
  for (int i = 0; i < 16; ++i) {
    picture.add(fmt::format("{}-{}nm", 390 + 20 * i, 410 + 20 * i), Imf::FLOAT, [](int, int) { return 0.5; });
  }
  ProjectImageOptions options = xyz();
  options.target = ColorTarget::kLuminance;
  options.quantity = Quantity::kReflectance;
  const ImageReport report = project(picture, options);
  EXPECT_EQ(report.quantity, Quantity::kReflectance);
  EXPECT_THAT(report.notes, IsEmpty());
  EXPECT_NEAR(read_picture(out_).at("Y", 0, 0), 0.5, 1e-6);
}

TEST_F(SpectralDialects, LowerEdgesReachToTheNextOne) {
  // As Indigo writes them.
  const double lower[] = {400, 430.25, 460.5, 490.75, 521, 551.25, 581.5, 611.75, 642, 672.25, 702.5};
  Picture picture = blank(2, 2);
  std::vector<std::pair<double, double>> bands;
  std::vector<double> values;
  for (std::size_t i = 0; i < std::size(lower); ++i) {
    const double value = 0.5 + 0.125 * static_cast<double>(i % 3);
    bands.emplace_back(lower[i], lower[i] + 30.25);
    values.push_back(value);
    std::string number = fmt::format("{}", lower[i]);
    std::replace(number.begin(), number.end(), '.', '_');
    picture.add("wavelength" + number, Imf::FLOAT, [=](int, int) { return value; });
  }
  const ImageReport report = project(picture);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("Indigo's channels are taken for light")));
  expect_pixel(light_of(bands, values));
}

TEST_F(SpectralDialects, WavelengthsMayBeAttributes) {
  // As Ocean writes them: numbered channels in the order of their names, metres beside.
  Picture picture = blank(2, 2);
  std::vector<std::pair<double, double>> bands;
  std::vector<double> values;
  for (int i = 0; i < 31; ++i) {
    const double value = 0.25 + 0.0625 * (i % 5);
    bands.emplace_back(395 + 10 * i, 405 + 10 * i);
    values.push_back(value);
    const std::string name = fmt::format("wl{}", i);
    picture.add(name, Imf::FLOAT, [=](int, int) { return value; });
    picture.header.insert(name + ".wavelength", Imf::DoubleAttribute((400 + 10 * i) * 1e-9));
  }
  project(picture);
  expect_pixel(light_of(bands, values));
  // Without them the names mean nothing.
  Picture bare = blank(2, 2);
  bare.add("wl0", Imf::FLOAT, [](int, int) { return 1; });
  write_scanlines(in_, bare);
  EXPECT_THAT(error_of(), HasSubstr("no spectral channels"));
}

TEST_F(SpectralDialects, WhatIsNotShownIsSaid) {
  Picture picture = blank(2, 2);
  add_even(picture, "", 0.5, "T");
  add_even(picture, "", 0.25, "S0");
  add_even(picture, "", 0.125, "S1");
  const ImageReport report = project(picture);
  EXPECT_EQ(report.quantity, Quantity::kReflectance);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("left out: 31 bands of emission"),
                                        HasSubstr("left out: 31 channels of polarised light")));
}

TEST_F(SpectralDialects, ReradiationIsProjectedUnderTheLight) {
  Picture picture = blank(70, 2);
  std::vector<double> centres;
  for (int nm = 400; nm <= 700; nm += 20) centres.push_back(nm);
  const auto shares = [](double from, double to) {
    return to > from ? 0.03125 * static_cast<int>((to - from) / 20) / 16 : 0.0;
  };
  for (const double nm : centres) {
    picture.add(fmt::format("T.{:.0f},0nm", nm), Imf::FLOAT, [](int, int) { return 0.5; });
    for (const double to : centres) {
      if (to <= nm) continue;
      picture.add(fmt::format("T.{:.0f},0nm.{:.0f},0nm", nm, to), Imf::FLOAT,
                  [=](int, int) { return shares(nm, to); });
    }
  }
  for (const char* light : {"D65", "FL11"}) {
    const MeasuredSpectrum spectrum = *illuminant(light);
    const auto at = [&](double nm) { return spectrum.at(nm); };
    double unit = 0;
    Xyz want{};
    for (const double nm : centres) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double w = integral(nm - 10, nm + 10, [&](double x) { return at(x) * matching(k, x); });
        want[k] += 0.5 * w;
        if (k == 1) unit += w;
      }
      const double absorbed = integral(nm - 10, nm + 10, at) / 20;
      for (const double to : centres) {
        for (std::size_t k = 0; k < 3; ++k) {
          want[k] += shares(nm, to) * absorbed *
                     integral(to - 10, to + 10, [&](double x) { return matching(k, x); });
        }
      }
    }
    for (double& v : want) v /= unit;
    ProjectImageOptions options = xyz();
    options.light = spectrum;
    const ImageReport report = project(picture, options);
    EXPECT_EQ(report.bands, centres.size());
    expect_pixel(want, 2e-5);
    // No spectral channel is left.
    EXPECT_EQ(read_picture(out_).planes.size(), 3U);
  }
  const auto verified = verify_image(in_);
  ASSERT_TRUE(verified) << verified.error().message;
  EXPECT_TRUE(verified->ok()) << verified->max_oracle_difference;
}

TEST_F(SpectralDialects, ReradiationNeedsItsBands) {
  Picture picture = blank(2, 2);
  add_even(picture, "", 0.5, "T");
  picture.add("T.300,0nm.500,0nm", Imf::FLOAT, [](int, int) { return 0.5; });
  write_scanlines(in_, picture);
  EXPECT_THAT(error_of(), HasSubstr("re-radiates from a wavelength without a band"));
}

TEST_F(SpectralDialects, AreListedWithExamplesThatTheyRead) {
  for (const io::Dialect& dialect : io::dialects()) {
    const std::string_view first = dialect.example.substr(0, dialect.example.find_first_of(", ", 10));
    EXPECT_FALSE(dialect.name.empty());
    EXPECT_TRUE(dialect.name == "Ocean" || io::parse_spectral_channel(first, {})) << first;
  }
}

TEST_F(SpectralDialects, TwoInOneFileAreTwoSets) {
  Picture picture = blank(2, 2);
  add_even(picture, "", 0.5);
  for (int nm = 400; nm <= 700; nm += 100) {
    picture.add(fmt::format("wavelength{}", nm), Imf::FLOAT, [](int, int) { return 7.0; });
  }
  const ImageReport report = project(picture);
  EXPECT_EQ(report.bands, 31U);
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("left out: 4 bands of emission")));
}

TEST_F(SpectralDialects, ReradiationAloneIsSaid) {
  Picture picture = blank(2, 2);
  picture.add("T.400,000000nm.500,000000nm", Imf::FLOAT, [](int, int) { return 0.5; });
  write_scanlines(in_, picture);
  EXPECT_THAT(error_of(), HasSubstr("no channels of one wavelength"));
}

TEST_F(SpectralDialects, WavelengthAttributesMayBeOfAnyChannel) {
  Picture picture = blank(2, 2);
  const std::pair<const char*, double> channels[] = {{"blue", 450e-9}, {"green", 550e-9}, {"red", 650e-9}};
  for (const auto& [name, metres] : channels) {
    picture.add(name, Imf::FLOAT, [](int, int) { return 0.5; });
    picture.header.insert(std::string(name) + ".wavelength", Imf::DoubleAttribute(metres));
  }
  EXPECT_EQ(project(picture).bands, 3U);
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);
}

}  // namespace
}  // namespace spectile::test
