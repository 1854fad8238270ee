// RGB spaces: their names, their matrices as published, chromatic adaptation, and the space in which methods
// work.
#include <gmock/gmock.h>

#include <spectile/color/colorimetry.hpp>
#include <spectile/color/rgb_space.hpp>

#include "src/color/working_space.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using Triple = std::array<double, 3>;

Chromaticities chromaticities(const char* name) {
  return rgb_space(name)->chromaticities;
}

void expect_near(const Matrix3& got, const Matrix3& want, double bound) {
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(got[i], want[i], bound) << "row " << i / 3 << " column " << i % 3;
}
void expect_near(const Triple& got, const Triple& want, double bound) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], bound) << i;
}

constexpr Matrix3 kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1};

TEST(RgbSpace, NamesAreKnownWhateverTheirCase) {
  const auto names = rgb_space_names();
  EXPECT_THAT(names, testing::IsSupersetOf({"lin_rec709", "display-p3", "rec2020", "adobe-rgb", "acescg",
                                            "aces2065-1", "xyz"}));
  for (const std::string& name : names) {
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto space = rgb_space(upper);
    ASSERT_TRUE(space) << upper;
    EXPECT_EQ(space->name, name);
    EXPECT_FALSE(space->description.empty());
  }
  EXPECT_TRUE(chromaticities("srgb") == kRec709);
  EXPECT_TRUE(chromaticities("rec709") == kRec709);
  EXPECT_TRUE(RgbSpace().chromaticities == kRec709);
}

TEST(RgbSpace, LinearOnesHaveTheNamesOfTheColorInteropForumToo) {
  for (const auto& [alias, name] : {std::pair{"lin_srgb", "lin_rec709"},
                                    {"rec709", "lin_rec709"},
                                    {"lin_p3d65", "display-p3"},
                                    {"lin_rec2020", "rec2020"},
                                    {"lin_adobergb", "adobe-rgb"},
                                    {"lin_ap1", "acescg"},
                                    {"lin_ap0", "aces2065-1"},
                                    {"lin_ciexyzd65", "xyz"}}) {
    const auto space = rgb_space(alias);
    ASSERT_TRUE(space) << alias;
    EXPECT_EQ(space->name, name);
  }
  // Its name stays, as it may mean the encoded space too.
  EXPECT_EQ(rgb_space("sRGB")->name, "srgb");
  EXPECT_EQ(rgb_space("srgb")->description, "linear Rec.709");
}

TEST(RgbSpace, EncodedOnesAreRefused) {
  for (const char* name : {"srgb_texture", "srgb_rec709", "g22_rec709", "g18_rec709"}) {
    const auto space = rgb_space(name);
    ASSERT_EQ(code_of(space), code(ErrorCode::kBadArgument)) << name;
    EXPECT_THAT(space.error().message, testing::HasSubstr("is not linear"));
  }
}

TEST(RgbSpace, UnknownNamesAreErrorsThatListTheKnownOnes) {
  for (const char* name : {"", "sRGB ", "p3", "aces", "rec.709"}) {
    const auto space = rgb_space(name);
    ASSERT_EQ(code_of(space), code(ErrorCode::kUnknownName)) << name;
    for (const std::string& known : rgb_space_names()) {
      EXPECT_THAT(space.error().message, testing::HasSubstr(known));
    }
  }
}

TEST(RgbSpace, PrimariesAndWhitesAreThePublishedOnes) {
  const Chromaticities p3 = {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}};
  const Chromaticities rec2020 = {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}};
  const Chromaticities ap0 = {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};
  const Chromaticities ap1 = {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
  EXPECT_TRUE(chromaticities("display-p3") == p3);
  EXPECT_TRUE(chromaticities("rec2020") == rec2020);
  EXPECT_TRUE(chromaticities("aces2065-1") == ap0);
  EXPECT_TRUE(chromaticities("acescg") == ap1);
}

TEST(RgbSpace, MatricesAreThePublishedOnes) {
  // IEC 61966-2-1 and BT.709, P3 and BT.2020 as in CSS Color 4; their luminances are those of the standards.
  expect_near(rgb_to_xyz(chromaticities("srgb")),
              {0.4123907993, 0.3575843394, 0.1804807884, 0.2126390059, 0.7151686788, 0.0721923154,
               0.0193308187, 0.1191947798, 0.9505321522},
              1e-10);
  expect_near(rgb_to_xyz(chromaticities("display-p3")),
              {0.4865709486, 0.2656676932, 0.1982172852, 0.2289745641, 0.6917385218, 0.0792869141, 0,
               0.0451133819, 1.0439443689},
              1e-10);
  expect_near(rgb_to_xyz(chromaticities("rec2020")),
              {0.6369580483, 0.1446169036, 0.1688809752, 0.2627002120, 0.6779980715, 0.0593017165, 0,
               0.0280726930, 1.0609850577},
              1e-10);
  // Adobe RGB (1998), version 2005-05, 4.3.5.3.
  expect_near(rgb_to_xyz(chromaticities("adobe-rgb")),
              {0.57667, 0.18556, 0.18823, 0.29734, 0.62736, 0.07529, 0.02703, 0.07069, 0.99134}, 5.1e-6);
  // SMPTE ST 2065-1 and ACES S-2014-004.
  expect_near(rgb_to_xyz(chromaticities("aces2065-1")),
              {0.9525523959, 0, 0.0000936786, 0.3439664498, 0.7281660966, -0.0721325464, 0, 0, 1.0088251844},
              1e-10);
  expect_near(rgb_to_xyz(chromaticities("acescg")),
              {0.6624541811, 0.1340042065, 0.1561876870, 0.2722287168, 0.6740817658, 0.0536895174,
               -0.0055746495, 0.0040607335, 1.0103391003},
              1e-10);
  expect_near(rgb_to_xyz(chromaticities("xyz")), kIdentity, 1e-15);
}

TEST(RgbSpace, OneOneOneIsTheWhiteAndPrimariesKeepTheirChromaticity) {
  for (const std::string& name : rgb_space_names()) {
    SCOPED_TRACE(name);
    const Chromaticities space = chromaticities(name.c_str());
    const Triple other_white = {1.0985, 1, 0.3558};
    for (const Triple& white : {chromaticity_to_xyz(space.white), other_white}) {
      const Matrix3 m = rgb_to_xyz(space, white);
      expect_near(times(m, {1, 1, 1}), white, 1e-14);
      const std::array<double, 2> primaries[3] = {space.red, space.green, space.blue};
      for (std::size_t k = 0; k < 3; ++k) {
        const double sum = m[k] + m[3 + k] + m[6 + k];
        EXPECT_NEAR(m[k], primaries[k][0] * sum, 1e-14);
        EXPECT_NEAR(m[3 + k], primaries[k][1] * sum, 1e-14);
      }
    }
    EXPECT_TRUE(rgb_to_xyz(space) == rgb_to_xyz(space, chromaticity_to_xyz(space.white)));
  }
  EXPECT_TRUE(rgb_to_xyz(kRec709) == srgb_to_xyz_matrix());
}

TEST(RgbSpace, XyzOfAChromaticityHasLuminanceOne) {
  expect_near(chromaticity_to_xyz({0.3127, 0.3290}), {0.9504559271, 1, 1.0890577508}, 1e-10);
  expect_near(chromaticity_to_xyz({1.0 / 3, 1.0 / 3}), {1, 1, 1}, 1e-15);
}

TEST(RgbSpace, MatrixArithmeticHolds) {
  const Matrix3 m = {2, -1, 0.5, 0.25, 3, 1, -2, 0.125, 1.5};
  const Matrix3 n = {1, 2, 3, 0, 1, 4, 5, 6, 0};
  EXPECT_DOUBLE_EQ(determinant(n), 1);
  expect_near(inverse(n), {-24, 18, 5, 20, -15, -4, -5, 4, 1}, 1e-13);
  expect_near(product(inverse(m), m), kIdentity, 1e-15);
  expect_near(times(product(m, n), {0.3, -0.2, 0.7}), times(m, times(n, {0.3, -0.2, 0.7})), 1e-14);
  expect_near(product(n, {0, 1, 0, 0, 0, 1, 1, 0, 0}), {3, 1, 2, 4, 0, 1, 0, 5, 6}, 0);  // columns turned
  EXPECT_EQ(determinant({1, 2, 3, 2, 4, 6, 0, 1, 1}), 0);
}

TEST(Adaptation, BradfordFromD65ToD50IsThePrintedMatrix) {
  // Lindbloom's table, with the whites of ASTM E308.
  expect_near(
      adaptation_matrix(Adaptation::kBradford, {0.95047, 1, 1.08883}, {0.96422, 1, 0.82521}),
      {1.0478112, 0.0228866, -0.0501270, 0.0295424, 0.9904844, -0.0170491, -0.0092345, 0.0150436, 0.7521316},
      1e-7);
  // As profiles of sRGB print it, from the white of IEC 61966-2-1 to the connection space's (ICC.1:2010,
  // annex E).
  expect_near(
      adaptation_matrix(Adaptation::kBradford, chromaticity_to_xyz({0.3127, 0.3290}), {0.9642, 1, 0.8249}),
      {1.047886, 0.022919, -0.050216, 0.029582, 0.990484, -0.017079, -0.009252, 0.015073, 0.751678}, 1e-6);
}

TEST(Adaptation, AcescgToSrgbIsThePublishedMatrix) {
  const Matrix3 adapt = adaptation_matrix(Adaptation::kBradford, chromaticity_to_xyz({0.32168, 0.33767}),
                                          chromaticity_to_xyz({0.3127, 0.3290}));
  expect_near(product(inverse(rgb_to_xyz(kRec709)), product(adapt, rgb_to_xyz(chromaticities("acescg")))),
              {1.70505, -0.62179, -0.08326, -0.13026, 1.14080, -0.01055, -0.02400, -0.12897, 1.15297}, 6e-6);
}

TEST(Adaptation, ScalesTheConesOfItsMethod) {
  // The matrix of CAT16: rows are the cones, and each response is multiplied by the ratio of the whites'.
  const Matrix3 cat16 = {0.401288, 0.650173,  -0.051461, -0.250268, 1.204414,
                         0.045854, -0.002079, 0.048952,  0.953127};
  const Matrix3 bradford = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
  const Triple from = {1.0985, 1, 0.3558};
  const Triple to = {0.9642, 1, 0.8251};
  for (const auto& [method, cones] :
       {std::pair{Adaptation::kCat16, cat16}, std::pair{Adaptation::kBradford, bradford}}) {
    const Matrix3 adapt = adaptation_matrix(method, from, to);
    const Triple of_from = times(cones, from);
    const Triple of_to = times(cones, to);
    for (const Triple& xyz : {Triple{0.3, 0.2, 0.1}, Triple{0.1, 0.5, 0.9}, Triple{0, 0, 1}}) {
      const Triple before = times(cones, xyz);
      const Triple after = times(cones, times(adapt, xyz));
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(after[k], before[k] * of_to[k] / of_from[k], 1e-14) << k;
    }
  }
}

TEST(Adaptation, WhiteBecomesWhiteAndEqualWhitesChangeNothing) {
  const Triple whites[] = {chromaticity_to_xyz({0.3127, 0.3290}),
                           chromaticity_to_xyz({0.3457, 0.3585}),
                           chromaticity_to_xyz({0.44758, 0.40745}),
                           {1, 1, 1}};
  for (const Adaptation method : {Adaptation::kBradford, Adaptation::kCat16}) {
    for (const Triple& from : whites) {
      for (const Triple& to : whites) {
        expect_near(times(adaptation_matrix(method, from, to), from), to, 1e-14);
        expect_near(product(adaptation_matrix(method, to, from), adaptation_matrix(method, from, to)),
                    kIdentity, 1e-13);
      }
      expect_near(adaptation_matrix(method, from, from), kIdentity, 1e-15);
    }
  }
  EXPECT_TRUE(adaptation_matrix(Adaptation::kNone, whites[0], whites[2]) == kIdentity);
}

TEST(WorkingSpace, WhiteIsOneOneOneForEverySetting) {
  for (const char* bands_text : {"400:700:5", "380:780:5", "450,550,610", "360:830:10"}) {
    const Bands bands = *Bands::parse(bands_text);
    for (const char* light : {"D65", "A", "FL11", "E"}) {
      for (const Observer observer : {Observer::kCie1931, Observer::kCie1964}) {
        for (const bool emission : {false, true}) {
          for (const char* primaries : {"srgb", "acescg", "xyz"}) {
            SCOPED_TRACE(std::string(bands_text) + " " + light + " " + primaries);
            const auto space =
                working_space(bands, emission, chromaticities(primaries), *illuminant(light), observer);
            ASSERT_TRUE(space);
            Triple white{};
            for (std::size_t b = 0; b < bands.count(); ++b) {
              for (std::size_t k = 0; k < 3; ++k) white[k] += space->weights[b][k] * space->white[b];
              EXPECT_TRUE(emission || space->white[b] == 1.0);
            }
            expect_near(white, {1, 1, 1}, 1e-13);
            expect_near(times(space->rgb_to_xyz, {1, 1, 1}), space->white_xyz, 1e-13);
            EXPECT_NEAR(space->white_xyz[1], 1, 1e-13);
          }
        }
      }
    }
  }
}

TEST(WorkingSpace, WhiteIsThatOfTheBandsAndTheLight) {
  const auto space = *working_space(Bands(), false, kRec709, *illuminant("A"), Observer::kCie1964);
  expect_near(space.white_xyz, Projector::reflective(Bands(), *illuminant("A"), Observer::kCie1964)->white(),
              1e-15);
}

TEST(WorkingSpace, WhatSpansNoSpaceIsAnError) {
  const Chromaticities line = {{0.2, 0.2}, {0.3, 0.3}, {0.4, 0.4}, {0.3127, 0.3290}};
  EXPECT_EQ(code_of(working_space(Bands(), false, line, *illuminant("D65"), Observer::kCie1931)),
            code(ErrorCode::kBadArgument));
  const MeasuredSpectrum dark = illuminant("D65")->scaled(0);
  for (const bool emission : {false, true}) {
    EXPECT_EQ(code_of(working_space(Bands(), emission, kRec709, dark, Observer::kCie1931)),
              code(ErrorCode::kBadArgument));
  }
}

}  // namespace
}  // namespace spectile::test
