// Gamut clipping and the folded Smits mixture: every instruction set gives the reference's bits, also in
// place.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::KernelTable;
using kernels::kLanes;
using kernels::kSmitsRow;

/// Luminance of linear sRGB.
constexpr float kLuminance[3] = {0.2126F, 0.7152F, 0.0722F};

/// Three planes of n: every triple of telling values in an order that mixes them, then colours in and about
/// the cube.
Floats gamut_colors(std::size_t n, std::uint32_t seed) {
  const float values[] = {0.0F,   -0.0F, 0.5F,  1.0F, 1.0F + 0x1p-23F, -kTiny, kTiny, -1.0F, 2.0F, 1e-4F,
                          -1e-4F, kInf,  -kInf, kNan, kMost,           -kMost, 0.3F};
  constexpr std::size_t kCount = std::size(values);
  const Floats plain = plain_floats(3 * n, seed, -0.3F, 1.4F);
  std::mt19937 random(seed);
  Floats rgb(3 * n);
  for (std::size_t i = 0; i < 3 * n; ++i) rgb[i] = i % 2 == 0 ? values[random() % kCount] : plain[i];
  return rgb;
}

class GamutKernels : public KernelTest {
 protected:
  struct Clipped {
    Floats rgb;
    std::vector<std::uint64_t> moved;
  };
  static Clipped clipped(const KernelTable& t, const Floats& rgb, const float weights[3], float low,
                         float high) {
    const std::size_t n = rgb.size() / 3;
    Clipped out{Floats(std::span(rgb.data(), rgb.size())),
                std::vector<std::uint64_t>(n / kLanes, 0x5A5A5A5A5A5A5A5AU)};
    float* const planes[3] = {out.rgb.data(), out.rgb.data() + n, out.rgb.data() + 2 * n};
    t.gamut_clip(planes, weights, low, high, out.moved.data(), n);
    return out;
  }
};

TEST_P(GamutKernels, ClipsAreTheReferencesForEveryKindOfColor) {
  const float limits[][2] = {{0, 1}, {0, kInf}, {-kInf, kInf}, {0.25F, 0.25F}, {-0.5F, 2.0F}, {kTiny, kMost}};
  const Floats arbitrary = arbitrary_floats(3, 1);
  for (const std::size_t lanes : kSizes) {
    const Floats rgb = gamut_colors(blocks_for(lanes) * kLanes, static_cast<std::uint32_t>(lanes));
    for (const auto& [low, high] : limits) {
      for (const float* weights : {kLuminance, arbitrary.data()}) {
        const Clipped got = clipped(k(), rgb, weights, low, high);
        const Clipped want = clipped(ref(), rgb, weights, low, high);
        ASSERT_TRUE(same_bits(got.rgb, want.rgb)) << lanes << " lanes, " << low << " to " << high;
        ASSERT_EQ(got.moved, want.moved) << lanes << " lanes, " << low << " to " << high;
      }
    }
  }
}

TEST_P(GamutKernels, ColorsInsideKeepTheirBitsAndOthersHaveTheirBit) {
  const std::size_t n = 4160;
  const Floats rgb = plain_floats(3 * n, 2, -0.02F, 1.02F);
  const Clipped got = clipped(k(), rgb, kLuminance, 0, 1);
  for (std::size_t i = 0; i < n; ++i) {
    bool outside = false;
    for (std::size_t c = 0; c < 3; ++c) outside = outside || rgb[c * n + i] < 0 || rgb[c * n + i] > 1;
    ASSERT_EQ(got.moved[i / kLanes] >> (i % kLanes) & 1U, outside ? 1U : 0U) << i;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_TRUE(outside || same_bits(got.rgb[c * n + i], rgb[c * n + i])) << i;
      ASSERT_GE(got.rgb[c * n + i], 0) << i;
      ASSERT_LE(got.rgb[c * n + i], 1) << i;
    }
  }
}

TEST_P(GamutKernels, FoldsAreTheReferencesAlsoInPlace) {
  for (const bool arbitrary : {false, true}) {
    const Floats table =
        arbitrary ? arbitrary_floats(3 * kSmitsRow, 3) : plain_floats(3 * kSmitsRow, 4, -0.5F, 1.5F);
    for (const std::size_t lanes : kSizes) {
      const std::size_t n = blocks_for(lanes) * kLanes;
      const Floats rgb = gamut_colors(n, 5);
      const float* const in[3] = {rgb.data(), rgb.data() + n, rgb.data() + 2 * n};
      const auto fold = [&](const KernelTable& t, Floats& dst, bool in_place) {
        float* const out[3] = {dst.data(), dst.data() + n, dst.data() + 2 * n};
        const float* const same[3] = {out[0], out[1], out[2]};
        t.smits_fold(out, in_place ? same : in, table.data(), n);
      };
      Floats want(3 * n);
      Floats got(3 * n);
      Floats replaced(std::span(rgb.data(), rgb.size()));
      fold(ref(), want, false);
      fold(k(), got, false);
      fold(k(), replaced, true);
      ASSERT_TRUE(same_bits(got, want)) << lanes << " lanes";
      ASSERT_TRUE(same_bits(replaced, want)) << lanes << " lanes, in place";
    }
  }
}

TEST_P(GamutKernels, AFoldIsTheProjectionOfTheSpectra) {
  // Three rows of the table are three bands: the fold is smits_blocks with nothing clamped.
  const Floats table = plain_floats(3 * kSmitsRow, 6);
  const std::size_t n = 1024;
  const Floats rgb = plain_floats(3 * n, 7);
  const float* const in[3] = {rgb.data(), rgb.data() + n, rgb.data() + 2 * n};
  Floats folded(3 * n);
  Floats blocks(3 * n);
  float* const out[3] = {folded.data(), folded.data() + n, folded.data() + 2 * n};
  k().smits_fold(out, in, table.data(), n);
  k().smits_blocks(blocks.data(), in, {table.data(), 3, -kInf}, n / kLanes, false);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t b = 0; b < 3; ++b) {
      ASSERT_TRUE(same_bits(folded[b * n + i], blocks[(i / kLanes * 3 + b) * kLanes + i % kLanes])) << i;
    }
  }
}

SPECTILE_FOR_EVERY_ISA(GamutKernels);

}  // namespace
}  // namespace spectile::test
