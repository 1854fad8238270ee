// The matrices between XYZ and linear sRGB against the standard's printed values, the oracle and each other.
#include <spectile/color/colorimetry.hpp>

#include "src/reference/oracle/oracle.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

TEST(ColorMatrix, IsThatOfTheStandard) {
  // IEC 61966-2-1:1999, four decimals.
  const Matrix3 printed = {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(srgb_to_xyz_matrix()[i], printed[i], 5.1e-5) << i;
}

TEST(ColorMatrix, InverseIsThatOfTheStandard) {
  // Printed to four decimals as the inverse of the rounded matrix, which the inverse of the exact one misses
  // by up to 3.5e-4.
  const Matrix3 printed = {3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(xyz_to_srgb_matrix()[i], printed[i], 4e-4) << i;
}

TEST(ColorMatrix, ProductWithTheInverseIsTheIdentity) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += xyz_to_srgb_matrix()[3 * i + k] * srgb_to_xyz_matrix()[3 * k + j];
      EXPECT_NEAR(sum, i == j ? 1 : 0, 2e-15);
    }
  }
}

TEST(ColorMatrix, WhiteIsD65) {
  auto rgb = *ColorLanes::create(1);
  for (std::size_t k = 0; k < 3; ++k) rgb.at(0, k) = 1;
  auto xyz = *ColorLanes::create(1);
  ASSERT_TRUE(srgb_to_xyz(rgb.view(), xyz.span()));
  EXPECT_NEAR(xyz.at(0, 0), 0.3127 / 0.3290, 4 * 0x1p-24);
  EXPECT_NEAR(xyz.at(0, 1), 1.0, 4 * 0x1p-24);
  EXPECT_NEAR(xyz.at(0, 2), (1 - 0.3127 - 0.3290) / 0.3290, 4 * 0x1p-23);
  EXPECT_NEAR(xyz.at(0, 0), 0.9505, 5e-5);
  EXPECT_NEAR(xyz.at(0, 2), 1.0891, 5e-5);
}

TEST(ColorMatrix, PrimariesHaveTheStandardsChromaticities) {
  const double primaries[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  const Matrix3& m = srgb_to_xyz_matrix();
  for (std::size_t k = 0; k < 3; ++k) {
    const double sum = m[k] + m[3 + k] + m[6 + k];
    EXPECT_NEAR(m[k] / sum, primaries[k][0], 1e-15);
    EXPECT_NEAR(m[3 + k] / sum, primaries[k][1], 1e-15);
  }
}

TEST(ColorMatrix, BatchesAgreeWithTheOracle) {
  // Three products and two sums, each rounded, and the matrix rounded: 4 units of 2^-24 of the sum of
  // magnitudes, to which the next row adds what the first power leaves out.
  for (const std::size_t lanes : kSizes) {
    const Floats values = plain_floats(3 * lanes, 1, -1.0F, 2.0F);
    auto in = *ColorLanes::create(lanes);
    for (std::size_t i = 0; i < lanes; ++i) {
      for (std::size_t k = 0; k < 3; ++k) in.at(i, k) = values[3 * i + k];
    }
    auto rgb = *ColorLanes::create(lanes);
    auto xyz = *ColorLanes::create(lanes);
    ASSERT_TRUE(xyz_to_srgb(in.view(), rgb.span()));
    ASSERT_TRUE(srgb_to_xyz(in.view(), xyz.span()));
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::array<double, 3> v = {in.at(i, 0), in.at(i, 1), in.at(i, 2)};
      const auto exact_rgb = oracle::xyz_to_srgb(v);
      const auto exact_xyz = oracle::srgb_to_xyz(v);
      for (std::size_t k = 0; k < 3; ++k) {
        double size_rgb = 0;
        double size_xyz = 0;
        for (std::size_t j = 0; j < 3; ++j) {
          size_rgb += std::abs(xyz_to_srgb_matrix()[3 * k + j] * v[j]);
          size_xyz += std::abs(srgb_to_xyz_matrix()[3 * k + j] * v[j]);
        }
        ASSERT_NEAR(rgb.at(i, k), exact_rgb[k], 4.001 * 0x1p-24 * size_rgb + 1e-14);
        ASSERT_NEAR(xyz.at(i, k), exact_xyz[k], 4.001 * 0x1p-24 * size_xyz + 1e-14);
      }
    }
  }
}

TEST(ColorMatrix, RoundTripReturnsTheColour) {
  const Floats values = plain_floats(3 * 4099, 2, -0.5F, 4.0F);
  auto rgb = *ColorLanes::create(4099);
  for (std::size_t i = 0; i < 4099; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = values[3 * i + k];
  }
  auto out = *ColorLanes::create(4099);
  ASSERT_TRUE(srgb_to_xyz(rgb.view(), out.span()));
  ASSERT_TRUE(xyz_to_srgb(out.view(), out.span()));  // in place
  for (std::size_t i = 0; i < 4099; ++i) {
    const float largest =
        std::max({std::abs(rgb.at(i, 0)), std::abs(rgb.at(i, 1)), std::abs(rgb.at(i, 2)), 0.1F});
    // 8 roundings on the way, raised by at most the magnitudes of the inverse's rows times those of the
    // matrix (5.1).
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(out.at(i, k), rgb.at(i, k), 8 * 5.1 * 0x1p-24 * largest);
  }
}

TEST(ColorMatrix, TransformMayBeInPlaceAndRunsInAnyTiling) {
  constexpr std::size_t kLanes = 70001;
  const Matrix3 swap = {0, 1, 0, 0, 0, 1, 1, 0, 0};
  auto in = *ColorLanes::create(kLanes);
  const Floats values = plain_floats(3 * kLanes, 3);
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) in.at(i, k) = values[3 * i + k];
  }
  for (const Execution& execution :
       {Execution{1, 64}, Execution{2, 64}, Execution{3, 100}, Execution{2, 65536}, Execution{}}) {
    auto out = *ColorLanes::create(kLanes);
    ASSERT_TRUE(transform(swap, in.view(), out.span(), execution));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(same_bits(out.view().c[k], in.view().c[(k + 1) % 3], kLanes));
    ASSERT_TRUE(transform(swap, out.view(), out.span(), execution));
    ASSERT_TRUE(transform(swap, out.view(), out.span(), execution));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(same_bits(out.view().c[k], in.view().c[k], kLanes));
  }
}

TEST(ColorMatrix, ColoursOutsideTheGamutStayAsTheyAre) {
  auto xyz = *ColorLanes::create(1);
  xyz.at(0, 1) = 1;  // no real colour: green beyond everything
  auto rgb = *ColorLanes::create(1);
  ASSERT_TRUE(xyz_to_srgb(xyz.view(), rgb.span()));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(rgb.at(0, k), static_cast<float>(xyz_to_srgb_matrix()[3 * k + 1]));
  EXPECT_LT(rgb.at(0, 0), 0);
  EXPECT_GT(rgb.at(0, 1), 1);
}

TEST(ColorMatrix, OtherLanesAreAnError) {
  const auto in = *ColorLanes::create(17);
  auto out = *ColorLanes::create(16);
  EXPECT_EQ(code_of(transform(srgb_to_xyz_matrix(), in.view(), out.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(xyz_to_srgb(in.view(), out.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(srgb_to_xyz(in.view(), out.span())), code(ErrorCode::kSizeMismatch));
}

}  // namespace
}  // namespace spectile::test
