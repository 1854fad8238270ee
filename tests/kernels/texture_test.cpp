// Kernels for places in textures, and batches from and to rows: every instruction set gives the reference's
// bits; the reference agrees with places found in double.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::kLanes;
using kernels::TextureCoordinates;
using kernels::TextureShape;
using kernels::TextureTaps;
using kernels::TextureWrap;

constexpr std::size_t kTextureLanes = 8 * kLanes;
constexpr TextureWrap kWraps[] = {TextureWrap::kRepeat, TextureWrap::kMirror, TextureWrap::kClamp,
                                  TextureWrap::kBlack};
constexpr TextureTaps kTaps[] = {TextureTaps::kNearest, TextureTaps::kBilinear, TextureTaps::kTrilinear};

/// Levels of a texture of 300 x 70, rounded down, in tiles of 64 x 64.
std::vector<std::int32_t> levels_of_300_by_70() {
  std::vector<std::int32_t> out;
  std::int32_t first = 0;
  for (std::int32_t width = 300, height = 70;;
       width = std::max(1, width / 2), height = std::max(1, height / 2)) {
    const std::int32_t tiles_x = (width + 63) / 64;
    out.insert(out.end(), {width, height, tiles_x, first});
    first += tiles_x * ((height + 63) / 64);
    if (width == 1 && height == 1) return out;
  }
}

/// Coordinates in and around the texture, some at texels' centres and edges, some no numbers.
Floats coordinates(std::uint32_t seed, float texels) {
  Floats out = plain_floats(kTextureLanes, seed, -2.5F, 3.5F);
  const Floats strange = arbitrary_floats(kTextureLanes, seed + 1);
  for (std::size_t i = 0; i < kTextureLanes; ++i) {
    if (i % 7 == 0) out[i] = strange[i];
    if (i % 5 == 1) out[i] = (static_cast<float>(i % 80) - 20 + 0.5F * static_cast<float>(i % 2)) / texels;
    if (i % 97 == 0) out[i] = -1e-10F;
  }
  return out;
}

struct Texels {
  Texels() : tile(8 * kTextureLanes), texel(8 * kTextureLanes), weight(8 * kTextureLanes) {}
  kernels::TextureTexels rows() {
    return {reinterpret_cast<std::int32_t*>(tile.data()), reinterpret_cast<std::int32_t*>(texel.data()),
            weight.data()};
  }
  Floats tile, texel, weight;  // as many bytes as integers
};

class TextureKernels : public KernelTest {};

TEST_P(TextureKernels, PlacesAreTheReferences) {
  const auto levels = levels_of_300_by_70();
  const Floats u = coordinates(1, 300);
  const Floats v = coordinates(3, 70);
  Floats level = plain_floats(kTextureLanes, 5, -1.0F, 10.0F);
  const Floats strange = arbitrary_floats(kTextureLanes, 6);
  for (std::size_t i = 0; i < kTextureLanes; ++i) {
    if (i % 6 == 0) level[i] = strange[i];
    if (i % 6 == 1) level[i] = i % 12 == 1 ? -0.0F : static_cast<float>(i % 9);
  }
  for (const TextureTaps taps : kTaps) {
    for (std::size_t wrap = 0; wrap < 4; ++wrap) {
      const TextureShape shape = {levels.data(), static_cast<std::int32_t>(levels.size() / 4), kWraps[wrap],
                                  kWraps[(wrap + 1) % 4], taps};
      for (const TextureCoordinates& at :
           {TextureCoordinates{u.data(), v.data()}, TextureCoordinates{u.data(), v.data(), level.data()},
            TextureCoordinates{u.data(), v.data(), level.data(), 300}}) {
        Texels got;
        Texels want;
        k().texture_places(got.rows(), at, shape, kTextureLanes);
        ref().texture_places(want.rows(), at, shape, kTextureLanes);
        EXPECT_TRUE(same_bits(got.tile, want.tile)) << wrap;
        EXPECT_TRUE(same_bits(got.texel, want.texel)) << wrap;
        EXPECT_TRUE(same_bits(got.weight, want.weight)) << wrap;
        EXPECT_TRUE(got.tile.guard_holds() && got.texel.guard_holds() && got.weight.guard_holds());
      }
    }
  }
}

TEST_P(TextureKernels, PlacesBetweenCentresAreTheReferences) {
  Floats lambda = plain_floats(kTextureLanes, 11, 300, 900);
  const Floats strange = arbitrary_floats(kTextureLanes, 12);
  for (std::size_t i = 0; i < kTextureLanes; i += 5) lambda[i] = strange[i];
  const kernels::CentreTable even = {.first_nm = 402.5F, .last_nm = 697.5F, .intervals = 59, .per_nm = 0.2F};
  Texels got;
  Texels want;
  k().centre_places(got.rows().tile, got.weight.data(), lambda.data(), even, kTextureLanes);
  ref().centre_places(want.rows().tile, want.weight.data(), lambda.data(), even, kTextureLanes);
  EXPECT_TRUE(same_bits(got.tile, want.tile));
  EXPECT_TRUE(same_bits(got.weight, want.weight));
}

TEST_P(TextureKernels, RowsBecomeBlocksAndBlocksRows) {
  for (const std::size_t count : {1, 3, 4, 7, 31, 60}) {
    for (const std::size_t n : {1, 15, 16, 63, 64, 65, 200}) {
      const std::size_t stride = count + n % 3;
      const std::size_t padded = (n + kLanes - 1) / kLanes * kLanes;
      // One float on: rows have any alignment.
      const Floats source = arbitrary_floats(blocks_for(n * stride + 1) * kLanes, 7);
      Floats got(padded * count);
      Floats want(padded * count);
      k().rows_to_blocks(got.data(), source.data() + 1, stride, count, n);
      ref().rows_to_blocks(want.data(), source.data() + 1, stride, count, n);
      ASSERT_TRUE(same_bits(got, want)) << count << " of " << n;
      Floats back(n * stride + 1);
      for (std::size_t i = 0; i <= n * stride; ++i) back[i] = 0.25F;
      k().blocks_to_rows(back.data() + 1, stride, want.data(), count, n);
      for (std::size_t lane = 0; lane < n; ++lane) {
        for (std::size_t i = 0; i < stride; ++i) {
          const float expected = i < count ? source[1 + lane * stride + i] : 0.25F;
          ASSERT_TRUE(same_bits(back[1 + lane * stride + i], expected)) << lane << ' ' << i;
        }
      }
      ASSERT_TRUE(got.guard_holds() && back.guard_holds());
    }
  }
}

SPECTILE_FOR_EVERY_ISA(TextureKernels);

TEST(TexturePlaces, AreThoseOfDouble) {
  const auto levels = levels_of_300_by_70();
  const Floats u = plain_floats(kTextureLanes, 21, -2.0F, 3.0F);
  const Floats v = plain_floats(kTextureLanes, 22, -2.0F, 3.0F);
  const TextureShape shape = {levels.data(), 1, TextureWrap::kRepeat, TextureWrap::kMirror,
                              TextureTaps::kBilinear};
  Texels out;
  reference::kKernelTable.texture_places(out.rows(), {u.data(), v.data()}, shape, kTextureLanes);
  const kernels::TextureTexels rows = out.rows();
  for (std::size_t i = 0; i < kTextureLanes; ++i) {
    // Of a picture that is x + 1000 y, but for the columns at the seam of the repetition.
    double want_x = std::fmod(static_cast<double>(u[i]) + 4, 1) * 300 - 0.5;
    double want_y = std::fmod(static_cast<double>(v[i]) + 4, 2);
    want_y = std::clamp((want_y > 1 ? 2 - want_y : want_y) * 70 - 0.5, 0.0, 69.0);
    if (want_x < 0 || want_x > 299) continue;
    double got_x = 0;
    double got_y = 0;
    for (std::size_t tap = 0; tap < 4; ++tap) {
      const std::size_t at = tap * kTextureLanes + i;
      const std::int32_t tile = rows.tile[at];
      got_x += static_cast<double>(rows.weight[at]) * (tile % 5 * 64 + rows.texel[at] % 64);
      got_y += static_cast<double>(rows.weight[at]) * (tile / 5 * 64 + rows.texel[at] / 64);
    }
    // Coordinates up to 3 are wrapped within 2^-23, and the weights' products are rounded.
    EXPECT_NEAR(got_x, want_x, 300 * 4e-7) << i;
    EXPECT_NEAR(got_y, want_y, 70 * 8e-7) << i;
  }
}

}  // namespace
}  // namespace spectile::test
