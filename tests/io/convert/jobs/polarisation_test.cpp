// Degree and angle of linear polarisation, from Stokes components whose polarisation is known.
#include <numbers>
#include <spectile/image/polarisation.hpp>

#include "tests/io/channels/spectral_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

class PolarisedImages : public SpectralFiles {
 protected:
  /// `value(nm, x)` of a component in 31 bands of 10 nm; one line of pixels.
  template <class F>
  static void add(Picture& picture, int component, F value) {
    for (int nm = 400; nm <= 700; nm += 10) {
      picture.add(fmt::format("S{}.{},000000nm", component, nm), Imf::FLOAT,
                  [=](int x, int /*y*/) { return value(nm, x); });
    }
  }
  ImageReport polarisation(Polarisation what, const std::string& channel, std::vector<double>& values,
                           SampleType type = SampleType::kFloat) {
    PolarisationImageOptions options;
    options.pixel = type;
    options.polarisation = what;
    const auto report = polarisation_image(in_, out_, options);
    EXPECT_TRUE(report) << report.error().message;
    values.clear();
    if (!report) return {};
    const Picture out = read_picture(out_);
    EXPECT_EQ(out.planes.size(), 1U);
    for (std::size_t i = 0; i < out.pixels(); ++i) values.push_back(out.planes.at(channel).at(i));
    return *report;
  }
};

TEST_F(PolarisedImages, HaveTheDegreeAndAngleTheyWereMadeWith) {
  // Pixel x: degree x / 64, angle 2.5 x degrees, brightness of its own.
  constexpr int kPixels = 65;
  Picture picture = blank(kPixels, 1);
  const auto angle = [](int x) { return 2.5 * x * std::numbers::pi / 180; };
  const auto light = [](int nm, int x) { return (1 + x % 3) * (nm - 380) / 100.0; };
  add(picture, 0, light);
  add(picture, 1, [=](int nm, int x) { return light(nm, x) * x / 64 * std::cos(2 * angle(x)); });
  add(picture, 2, [=](int nm, int x) { return light(nm, x) * x / 64 * std::sin(2 * angle(x)); });
  add(picture, 3, [](int, int) { return 0.5; });
  write_scanlines(in_, picture);
  std::vector<double> degree;
  std::vector<double> angles;
  const ImageReport report = polarisation(Polarisation::kDegree, "DOLP", degree);
  EXPECT_THAT(report.notes, Contains(HasSubstr("left out: 31 channels of polarised light")));
  EXPECT_EQ(report.bands, 31U);
  polarisation(Polarisation::kAngle, "AOLP", angles);
  for (int x = 0; x < kPixels; ++x) {
    EXPECT_NEAR(degree[static_cast<std::size_t>(x)], x / 64.0, 1e-6) << x;
    if (x == 0) continue;  // no angle
    EXPECT_NEAR(angles[static_cast<std::size_t>(x)], 2.5 * x, 2e-4) << x;
  }
}

TEST_F(PolarisedImages, BrightWavelengthsCountMost) {
  // Polarised at 0 degrees below 550 nm and at 90 degrees above: by luminance, not by the number of bands.
  Picture picture = blank(1, 1);
  add(picture, 0, [](int, int) { return 1.0; });
  add(picture, 1, [](int nm, int) { return nm < 550 ? 1.0 : -1.0; });
  add(picture, 2, [](int, int) { return 0.0; });
  write_scanlines(in_, picture);
  const auto y = [](double from, double to) {
    return integral(from, to, [](double nm) { return matching(1, nm); });
  };
  const double below = y(395, 545);
  const double above = y(545, 705);
  std::vector<double> values;
  polarisation(Polarisation::kDegree, "DOLP", values);
  EXPECT_NEAR(values[0], (above - below) / (above + below), 1e-5);
  polarisation(Polarisation::kAngle, "AOLP", values);
  EXPECT_NEAR(values[0], 90, 1e-4);
}

TEST_F(PolarisedImages, DarkNegativeAndImpossibleLightIsSaid) {
  // Black, unpolarised, negative, more polarised than there is light.
  const double s[4][2] = {{0, 0}, {2, 0}, {-1, 0.5}, {1, 1.5}};
  Picture picture = blank(4, 1);
  add(picture, 0, [&](int, int x) { return s[x][0]; });
  add(picture, 1, [&](int, int x) { return s[x][1]; });
  add(picture, 2, [](int, int) { return 0.0; });
  write_scanlines(in_, picture);
  std::vector<double> values;
  const ImageReport report = polarisation(Polarisation::kDegree, "DOLP", values);
  EXPECT_EQ(values[0], 0);
  EXPECT_EQ(values[1], 0);
  EXPECT_EQ(values[2], 0);
  EXPECT_NEAR(values[3], 1.5, 1e-6);
  EXPECT_THAT(report.notes, Contains(HasSubstr("1 pixels are polarised by more than 1")));
  EXPECT_THAT(report.notes, Contains(HasSubstr("1 pixels have negative light")));
  EXPECT_THAT(polarisation(Polarisation::kAngle, "AOLP", values).notes, Contains(HasSubstr("has no angle")));
  EXPECT_EQ(values[0], 0);
}

TEST_F(PolarisedImages, NonFiniteLightStopsOrBecomesBlack) {
  Picture picture = blank(2, 1);
  add(picture, 0, [](int, int) { return 1.0; });
  add(picture, 1, [](int, int x) { return x == 1 ? std::nan("") : 0.25; });
  add(picture, 2, [](int, int) { return 0.0; });
  write_scanlines(in_, picture);
  PolarisationImageOptions options;
  const auto stopped = polarisation_image(in_, out_, options);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kNonFinite);
  options.nonfinite = NonFinite::kZero;
  const auto zeroed = polarisation_image(in_, out_, options);
  ASSERT_TRUE(zeroed);
  EXPECT_EQ(zeroed->nonfinite_pixels, 1U);
  EXPECT_EQ(read_picture(out_).at("DOLP", 1, 0), 0);
  EXPECT_NEAR(read_picture(out_).at("DOLP", 0, 0), 0.25, 1e-3);
}

TEST_F(PolarisedImages, NeedAllComponentsAtTheSameWavelengths) {
  PolarisationImageOptions options;
  Picture plain = blank(1, 1);
  add(plain, 0, [](int, int) { return 1.0; });
  write_scanlines(in_, plain);
  EXPECT_THAT(polarisation_image(in_, out_, options).error().message, HasSubstr("no channels S1"));
  Picture uneven = blank(1, 1);
  add(uneven, 0, [](int, int) { return 1.0; });
  add(uneven, 1, [](int, int) { return 0.0; });
  uneven.add("S2.400,000000nm", Imf::FLOAT, [](int, int) { return 0.0; });
  write_scanlines(in_, uneven);
  EXPECT_THAT(polarisation_image(in_, out_, options).error().message, HasSubstr("other wavelengths than S0"));
  options.mipmap = true;
  EXPECT_THAT(polarisation_image(in_, out_, options).error().message, HasSubstr("no mip levels"));
}

TEST_F(PolarisedImages, AreNeverMistakenForRadiance) {
  Picture picture = blank(1, 1);
  add(picture, 0, [](int, int) { return 1.0; });
  add(picture, 1, [](int, int) { return 7.0; });
  const ImageReport report = project(picture);
  EXPECT_NEAR(luminance_at_origin(out_), 1, 1e-6);
  EXPECT_EQ(report.bands, 31U);
  EXPECT_THAT(report.notes, Contains(HasSubstr("left out: 31 channels of polarised light")));
  EXPECT_EQ(read_picture(out_).planes.size(), 3U);
}

}  // namespace
}  // namespace spectile::test
