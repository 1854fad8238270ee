// Half conversion and the RGB scan: every instruction set against the reference, the reference against
// Imath's half.
#include <Imath/half.h>

#include "src/reference/half.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::kLanes;
using kernels::RgbScan;

bool is_nan(std::uint16_t half) {
  return (half & 0x7FFFU) > 0x7C00U;
}

/// Every half boundary: the halves, the middles between neighbours and the floats beside both; then a stride
/// over all.
const std::vector<float>& telling_floats() {
  static const std::vector<float> floats = [] {
    std::vector<float> out;
    for (std::uint32_t h = 0; h < 0x7C00U; ++h) {
      const float low = reference::float_from_half(static_cast<std::uint16_t>(h));
      const float high =
          h == 0x7BFFU ? 65536.0F : reference::float_from_half(static_cast<std::uint16_t>(h + 1));
      const float middle = 0.5F * (low + high);  // exact: twelve bits
      for (const float centre : {low, middle}) {
        for (const float f : {std::nextafter(centre, -kInf), centre, std::nextafter(centre, kInf)}) {
          out.push_back(f);
          out.push_back(-f);
        }
      }
    }
    for (std::uint64_t bits = 0; bits <= 0xFFFFFFFFU; bits += 4093) {
      out.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    }
    out.insert(out.end(), special_values().begin(), special_values().end());
    out.resize(blocks_for(out.size()) * kLanes, 0.0F);
    return out;
  }();
  return floats;
}

TEST(Half, ReferenceAgreesWithImathOnEveryHalf) {
  for (std::uint32_t h = 0; h <= 0xFFFFU; ++h) {
    const float ours = reference::float_from_half(static_cast<std::uint16_t>(h));
    const float theirs = imath_half_to_float(static_cast<imath_half_bits_t>(h));
    ASSERT_TRUE(same_bits(ours, theirs)) << h << ": " << ours << " and " << theirs;
    ASSERT_EQ(std::isnan(ours), is_nan(static_cast<std::uint16_t>(h))) << h;
  }
}

TEST(Half, ReferenceAgreesWithImathOnEveryBoundary) {
  for (const float f : telling_floats()) {
    const std::uint16_t ours = reference::half_from_float(f);
    const std::uint16_t theirs = imath_float_to_half(f);
    ASSERT_TRUE(ours == theirs || (is_nan(ours) && is_nan(theirs))) << f << ": " << ours << " and " << theirs;
    ASSERT_EQ(is_nan(ours), std::isnan(f)) << f;
  }
}

TEST(Half, MiddlesGoToTheEvenNeighbour) {
  for (std::uint32_t h = 0; h < 0x7BFFU; ++h) {
    const float middle = 0.5F * (reference::float_from_half(static_cast<std::uint16_t>(h)) +
                                 reference::float_from_half(static_cast<std::uint16_t>(h + 1)));
    ASSERT_EQ(reference::half_from_float(middle), h + (h & 1U));
    ASSERT_EQ(reference::half_from_float(std::nextafter(middle, 0.0F)), h);
    ASSERT_EQ(reference::half_from_float(std::nextafter(middle, kInf)), h + 1);
  }
}

TEST(Half, RangeEndsHalfwayBeyondTheLargest) {
  EXPECT_EQ(reference::half_from_float(65504.0F), 0x7BFFU);
  EXPECT_EQ(reference::half_from_float(std::nextafter(65520.0F, 0.0F)), 0x7BFFU);
  EXPECT_EQ(reference::half_from_float(65520.0F), 0x7C00U);
  EXPECT_EQ(reference::half_from_float(-65520.0F), 0xFC00U);
  EXPECT_EQ(reference::half_from_float(0x1p-25F), 0U);
  EXPECT_EQ(reference::half_from_float(std::nextafter(0x1p-25F, 1.0F)), 1U);
  EXPECT_EQ(reference::half_from_float(-0.0F), 0x8000U);
}

TEST(Half, NanBecomesQuietAndKeepsItsSign) {
  EXPECT_EQ(reference::half_from_float(std::bit_cast<float>(0xFF800001U)), 0xFE00U);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(reference::float_from_half(0x7C01U)), 0x7FC02000U);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(reference::float_from_half(0xFC01U)), 0xFFC02000U);
}

class ConvertKernels : public KernelTest {};

TEST_P(ConvertKernels, EveryHalfGivesTheReferencesFloat) {
  std::vector<std::uint16_t> halves(0x10000U);
  for (std::uint32_t h = 0; h <= 0xFFFFU; ++h) halves[h] = static_cast<std::uint16_t>(h);
  Floats got(halves.size());
  Floats want(halves.size());
  k().half_to_float(got.data(), halves.data(), halves.size());
  ref().half_to_float(want.data(), halves.data(), halves.size());
  EXPECT_TRUE(same_bits(got, want));
}

TEST_P(ConvertKernels, EveryBoundaryGivesTheReferencesHalf) {
  const std::vector<float>& in = telling_floats();
  std::vector<std::uint16_t> got(in.size());
  std::vector<std::uint16_t> want(in.size());
  k().float_to_half(got.data(), in.data(), in.size());
  ref().float_to_half(want.data(), in.data(), in.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    ASSERT_TRUE(got[i] == want[i] || (is_nan(got[i]) && is_nan(want[i])))
        << in[i] << " gives " << got[i] << ", not " << want[i];
  }
}

TEST_P(ConvertKernels, ConversionTakesAnyAlignmentAndStaysInItsArrays) {
  for (const std::size_t lanes : kSizes) {
    const std::size_t n = blocks_for(lanes) * kLanes;
    for (const std::size_t shift : {std::size_t{1}, std::size_t{3}, std::size_t{7}}) {
      const Floats in = arbitrary_floats(n + shift, 61);
      std::vector<std::uint16_t> got(n + shift + 16, 0xABCDU);
      std::vector<std::uint16_t> want = got;
      k().float_to_half(got.data() + shift, in.data() + shift, n);
      ref().float_to_half(want.data() + shift, in.data() + shift, n);
      for (std::size_t i = 0; i < got.size(); ++i) {
        ASSERT_TRUE(got[i] == want[i] || (is_nan(got[i]) && is_nan(want[i]))) << i;
        const bool outside = i < shift || i >= n + shift;
        ASSERT_TRUE(!outside || got[i] == 0xABCDU) << i;
      }
      Floats back(n + shift);
      Floats expected(n + shift);
      k().half_to_float(back.data() + shift, want.data() + shift, n);
      ref().half_to_float(expected.data() + shift, want.data() + shift, n);
      EXPECT_TRUE(same_bits(back, expected));
    }
  }
}

TEST_P(ConvertKernels, ScanCountsLikeTheReference) {
  for (const std::size_t lanes : kSizes) {
    const std::size_t n = blocks_for(lanes) * kLanes;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
      const Floats a = seed < 4 ? arbitrary_floats(3 * n, seed) : plain_floats(3 * n, seed, -0.5F, 1.5F);
      const float* const rgb[3] = {a.data(), a.data() + n, a.data() + 2 * n};
      const RgbScan start = {5, 7, 11, seed % 2 == 0 ? 0.0F : 0.75F};
      RgbScan got = start;
      RgbScan want = start;
      k().scan_rgb(&got, rgb, n);
      ref().scan_rgb(&want, rgb, n);
      EXPECT_EQ(got.nonfinite, want.nonfinite);
      EXPECT_EQ(got.negative, want.negative);
      EXPECT_EQ(got.over_one, want.over_one);
      EXPECT_EQ(std::bit_cast<std::uint32_t>(got.maximum), std::bit_cast<std::uint32_t>(want.maximum));
    }
  }
}

TEST(ReferenceScan, CountsPixelsAndNotComponents) {
  Floats rgb[3] = {Floats(kLanes), Floats(kLanes), Floats(kLanes)};
  const float* const planes[3] = {rgb[0].data(), rgb[1].data(), rgb[2].data()};
  for (Floats& plane : rgb) plane[0] = kNan;
  rgb[1][1] = -kInf;
  rgb[0][2] = rgb[2][2] = -1.0F;
  rgb[0][3] = 1.0F + 0x1p-23F;
  rgb[2][4] = 1.0F;
  rgb[0][5] = -0.0F;
  RgbScan scan;
  reference::kKernelTable.scan_rgb(&scan, planes, kLanes);
  EXPECT_EQ(scan.nonfinite, 2U);
  EXPECT_EQ(scan.negative, 2U);
  EXPECT_EQ(scan.over_one, 1U);
  EXPECT_EQ(scan.maximum, 1.0F + 0x1p-23F);
}

SPECTILE_FOR_EVERY_ISA(ConvertKernels);

}  // namespace
}  // namespace spectile::test
