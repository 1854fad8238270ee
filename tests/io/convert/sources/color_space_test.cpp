// The RGB space that a file declares decides what its numbers mean.
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using Triple = std::array<double, 3>;

const Imf::Chromaticities kAces({0.7347F, 0.2653F}, {0, 1}, {0.0001F, -0.077F}, {0.32168F, 0.33767F});
const Imf::Chromaticities kXyz({1, 0}, {0, 1}, {0, 0}, {1.0F / 3, 1.0F / 3});
const Imf::Chromaticities kRec709({0.64F, 0.33F}, {0.3F, 0.6F}, {0.15F, 0.06F}, {0.3127F, 0.329F});

/// A 3 x 2 image of one float colour.
test::Picture flat(const Triple& color) {
  test::Picture picture = test::blank(3, 2);
  std::size_t c = 0;
  for (const char* name : {"R", "G", "B"}) {
    picture.add(name, Imf::FLOAT, [v = color[c]](int, int) { return v; });
    ++c;
  }
  return picture;
}

class ColorSpaces : public testing::Test {
 protected:
  Result<ImageReport> convert(test::Picture picture, Quantity quantity,
                              NegativeInput negative = NegativeInput::kGamut,
                              std::optional<GamutPolicy> gamut = std::nullopt) {
    test::write_scanlines(folder_ / "in.exr", picture);
    UpsampleImageOptions options;
    options.pixel = SampleType::kFloat;
    options.quantity = quantity;
    options.negative = negative;
    options.out_of_gamut = gamut;
    // Wide enough that what the bands cut off does not matter.
    options.bands = *Bands::uniform(380, 780, 5);
    return upsample_image(folder_ / "in.exr", folder_ / "out.exr", options);
  }

  /// The spectrum of the first pixel.
  std::vector<double> spectrum() {
    std::vector<double> out;
    for (const auto& [name, plane] : test::read_picture(folder_ / "out.exr").planes) {
      if (name.starts_with("T.") || name.starts_with("S0.")) out.push_back(plane.at(0));
    }
    EXPECT_EQ(out.size(), 80U);
    return out;
  }

  static test::Picture with(test::Picture picture, const Imf::Chromaticities& space) {
    Imf::addChromaticities(picture.header, space);
    return picture;
  }
  static test::Picture with(test::Picture picture, const std::string& id) {
    picture.header.insert("colorInteropID", Imf::StringAttribute(id));
    return picture;
  }

  static void expect_near(const std::vector<double>& a, const std::vector<double>& b, double bound) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], bound) << "band " << i;
  }

  test::TempFolder folder_;
};

TEST_F(ColorSpaces, PrimariesXyzAreXyzThatIsNotAdapted) {
  // One reflectance as sRGB and as the XYZ of that; white E of the latter is no white to adapt from.
  const Triple rgb = {0.2, 0.4, 0.6};
  ASSERT_TRUE(convert(with(flat(rgb), kRec709), Quantity::kReflectance));
  const auto wanted = spectrum();
  ASSERT_TRUE(convert(with(flat(times(srgb_to_xyz_matrix(), rgb)), kXyz), Quantity::kReflectance));
  expect_near(spectrum(), wanted, 2e-6);
}

TEST_F(ColorSpaces, WhiteReflectanceStaysWhiteInEverySpace) {
  ASSERT_TRUE(convert(flat({1, 1, 1}), Quantity::kReflectance));
  const auto white = spectrum();
  // The declared whites have five decimals in float; the matrices are made in double.
  ASSERT_TRUE(convert(with(flat({1, 1, 1}), kAces), Quantity::kReflectance));
  expect_near(spectrum(), white, 1e-5);
  for (const char* id : {"lin_rec709_scene", "lin_srgb_scene", "lin_p3d65_scene", "lin_rec2020_scene",
                         "lin_adobergb_scene", "lin_ap0_scene", "lin_ap1_scene"}) {
    const auto report = convert(with(flat({1, 1, 1}), id), Quantity::kReflectance);
    ASSERT_TRUE(report) << report.error().message;
    expect_near(spectrum(), white, 1e-5);
  }
}

TEST_F(ColorSpaces, LightInAcesKeepsItsXyz) {
  const Triple aces = {0.35, 0.5, 0.3};
  // SMPTE ST 2065-1:2012, table of the matrix from ACES to CIE XYZ.
  const double to_xyz[9] = {0.9525523959, 0, 0.0000936786, 0.3439664498, 0.7281660966, -0.0721325464, 0, 0,
                            1.0088251844};
  Triple xyz{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) xyz[i] += to_xyz[3 * i + k] * aces[k];
  }
  // The same light given as sRGB must have the same spectrum.
  const Matrix3& m = xyz_to_srgb_matrix();
  Triple srgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) srgb[i] += m[3 * i + k] * xyz[k];
  }
  ASSERT_GT(*std::min_element(srgb.begin(), srgb.end()), 0) << "the colour must lie inside sRGB";
  ASSERT_TRUE(convert(flat(srgb), Quantity::kIlluminant));
  const auto expected = spectrum();
  ASSERT_TRUE(convert(with(flat(aces), kAces), Quantity::kIlluminant));
  // The matrix is printed with ten decimals, the chromaticities are floats.
  expect_near(spectrum(), expected, 2e-6);
  ASSERT_TRUE(convert(with(flat(aces), "lin_ap0_scene"), Quantity::kIlluminant));
  expect_near(spectrum(), expected, 2e-6);
  // As a reflectance the white is adapted, so the spectrum is another.
  ASSERT_TRUE(convert(with(flat(aces), kAces), Quantity::kReflectance));
  double largest = 0;
  const auto reflectance = spectrum();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    largest = std::max(largest, std::abs(reflectance[i] - expected[i]));
  }
  EXPECT_GT(largest, 1e-3);
}

TEST_F(ColorSpaces, LightInXyzKeepsItsXyz) {
  const Triple srgb = {0.6, 0.4, 0.5};
  const Matrix3& m = srgb_to_xyz_matrix();
  Triple xyz{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) xyz[i] += m[3 * i + k] * srgb[k];
  }
  ASSERT_TRUE(convert(flat(srgb), Quantity::kIlluminant));
  const auto expected = spectrum();
  ASSERT_TRUE(convert(with(flat(xyz), kXyz), Quantity::kIlluminant));
  expect_near(spectrum(), expected, 2e-6);
  for (const auto quantity : {Quantity::kIlluminant, Quantity::kReflectance}) {
    ASSERT_TRUE(convert(flat(srgb), quantity));
    const auto same = spectrum();
    ASSERT_TRUE(convert(with(flat(xyz), "lin_ciexyzd65_scene"), quantity));
    expect_near(spectrum(), same, 2e-6);
  }
}

TEST_F(ColorSpaces, DeclaredRec709ChangesNoBit) {
  ASSERT_TRUE(convert(flat({0.7, 0.1, 0.3}), Quantity::kReflectance));
  const auto expected = spectrum();
  ASSERT_TRUE(convert(with(flat({0.7, 0.1, 0.3}), kRec709), Quantity::kReflectance));
  EXPECT_EQ(spectrum(), expected);
  ASSERT_TRUE(convert(with(flat({0.7, 0.1, 0.3}), "lin_rec709_scene"), Quantity::kReflectance));
  EXPECT_EQ(spectrum(), expected);
}

TEST_F(ColorSpaces, InteropIdWinsOverChromaticities) {
  ASSERT_TRUE(convert(flat({0.7, 0.1, 0.3}), Quantity::kReflectance));
  const auto expected = spectrum();
  const auto report =
      convert(with(with(flat({0.7, 0.1, 0.3}), kAces), "lin_rec709_scene"), Quantity::kReflectance);
  ASSERT_TRUE(report);
  EXPECT_EQ(spectrum(), expected);
  // "unknown" says nothing, so the chromaticities count.
  ASSERT_TRUE(convert(with(flat({0.5, 0.4, 0.3}), kAces), Quantity::kReflectance));
  const auto aces = spectrum();
  ASSERT_TRUE(convert(with(with(flat({0.5, 0.4, 0.3}), kAces), "unknown"), Quantity::kReflectance));
  EXPECT_EQ(spectrum(), aces);
}

TEST_F(ColorSpaces, ColorsOutsideSrgbAreCounted) {
  const auto report = convert(with(flat({0, 1, 0}), "lin_rec2020_scene"), Quantity::kReflectance);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->negative_pixels, 0U);
  EXPECT_EQ(report->out_of_gamut_pixels, 6U);
  const auto stopped = convert(with(flat({0, 1, 0}), "lin_rec2020_scene"), Quantity::kReflectance,
                               NegativeInput::kGamut, GamutPolicy::kError);
  EXPECT_FALSE(stopped);
}

TEST_F(ColorSpaces, UnusableOnesAreClearErrors) {
  for (const char* id :
       {"srgb_rec709_scene", "g22_rec709_scene", "g18_rec709_scene", "data", "lin_unheard_of"}) {
    const auto report = convert(with(flat({1, 1, 1}), id), Quantity::kReflectance);
    ASSERT_FALSE(report) << id;
    EXPECT_EQ(report.error().code, ErrorCode::kBadFile);
    EXPECT_THAT(report.error().message, testing::HasSubstr(id));
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"in.exr"});
  }
  const Imf::Chromaticities line({0.6F, 0.3F}, {0.4F, 0.3F}, {0.2F, 0.3F}, {0.3127F, 0.329F});
  const auto report = convert(with(flat({1, 1, 1}), line), Quantity::kReflectance);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, testing::HasSubstr("chromaticities"));
}

/// OpenImageIO's own attribute says it where no other does.
TEST_F(ColorSpaces, NamesOfOpenImageIoAreRead) {
  const auto named = [&](const char* name) {
    test::Picture picture = flat({0.25, 0.5, 0.125});
    picture.header.insert("oiio:ColorSpace", Imf::StringAttribute(name));
    return picture;
  };
  const std::pair<const char*, const char*> same[] = {{"Linear", "lin_rec709_scene"},
                                                      {"lin_rec709_scene", "lin_rec709_scene"},
                                                      {"ACEScg", "lin_ap1_scene"},
                                                      {"lin_rec2020", "lin_rec2020_scene"},
                                                      {"lin_ciexyzd65_scene", "lin_ciexyzd65_scene"}};
  for (const auto& [name, id] : same) {
    ASSERT_TRUE(convert(with(flat({0.25, 0.5, 0.125}), id), Quantity::kReflectance)) << id;
    const auto expected = spectrum();
    const auto report = convert(named(name), Quantity::kReflectance);
    ASSERT_TRUE(report) << name << report.error().message;
    EXPECT_THAT(report->notes, testing::Not(testing::Contains(testing::HasSubstr("assumed")))) << name;
    expect_near(spectrum(), expected, 0);
  }
  ASSERT_TRUE(convert(with(named("sRGB"), "lin_ap1_scene"), Quantity::kReflectance)) << "the other one wins";
  for (const char* name : {"sRGB", "srgb_texture", "g22_rec709", "Rec709", "unheard of"}) {
    const auto report = convert(named(name), Quantity::kReflectance);
    if (std::string(name) == "Rec709") {
      EXPECT_TRUE(report) << "the linear one, as elsewhere";
      continue;
    }
    ASSERT_FALSE(report) << name;
    EXPECT_THAT(report.error().message, testing::HasSubstr("--input-space")) << name;
  }
}

TEST_F(ColorSpaces, HugeFiniteColorsNeverBecomeNonFiniteSpectra) {
  // Within float in the file, beyond it after conversion to sRGB, or times the largest basis value.
  for (const test::Picture& picture :
       {with(flat({3e38, 1e38, 1e38}), kAces), flat({3.4e38, 3.4e38, 3.4e38})}) {
    const auto report = convert(picture, Quantity::kReflectance);
    if (!report) {
      EXPECT_EQ(report.error().code, ErrorCode::kNonFinite) << report.error().message;
      continue;
    }
    for (const double v : spectrum()) ASSERT_TRUE(std::isfinite(v)) << v;
  }
}

}  // namespace
}  // namespace spectile
