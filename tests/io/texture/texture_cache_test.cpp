// The cache of textures: bounded, shared by threads and textures, and the same samples whatever its size.
#include <thread>

#include "tests/io/texture/texture_lookups.hpp"

namespace spectile::test {
namespace {

constexpr std::size_t kTileBytes = 64 * 64 * 4 * sizeof(float);  // of coefficients

class TextureCaches : public testing::Test {
 protected:
  TextureCaches() {
    UpsampleImageOptions options = options_of({Method::kSigmoid, Quantity::kReflectance});
    Picture picture = blank(400, 300);
    add_rgb_noise(picture, Imf::FLOAT);
    write_scanlines(folder_ / "in.exr", picture);
    upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "lines.exr", options);
    options.tile = {{32, 32}};
    upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "tiles.exr", options);
  }
  SampledSpectra want(std::size_t lanes, std::uint32_t seed) const {
    return sampled(opened(folder_ / "lines.exr"), points_about(lanes, seed).at(),
                   wavelengths_of(lanes, {450, 550}), {});
  }
  const TempFolder folder_;
};

TEST_F(TextureCaches, TilesAreReadOnceWhileThereIsRoom) {
  for (const char* name : {"lines.exr", "tiles.exr"}) {
    const auto cache = *TextureCache::create();
    const SpectralTexture texture = opened(folder_ / name, cache);
    const Points points = centres_of_texels(400, 300);
    const SampledSpectra lambda = wavelengths_of(400 * 300, {500});
    const TextureLookup nearest = {.filter = TextureFilter::kNearest};
    sampled(texture, points.at(), lambda, nearest, {1});
    const TextureCacheStats first = cache.stats();
    EXPECT_EQ(first.tiles, 7U * 5) << name;
    EXPECT_EQ(first.tiles_read, 7U * 5) << name;
    EXPECT_EQ(first.bytes, 7 * 5 * kTileBytes);
    EXPECT_EQ(first.evicted, 0U);
    EXPECT_EQ(first.hits + first.misses, 400U * 300);
    // Lines are decoded as whole rows of tiles.
    EXPECT_EQ(first.misses, std::string(name) == "lines.exr" ? 5U : 35U);
    sampled(texture, points.at(), lambda, nearest, {1});
    EXPECT_EQ(cache.stats().misses, first.misses);
    EXPECT_EQ(cache.stats().hits, first.hits + 400 * 300);
    EXPECT_EQ(texture.cache_stats().hits, cache.stats().hits);
  }
}

TEST_F(TextureCaches, ABoundIsNeverExceededAndChangesNoSample) {
  const std::size_t lanes = 150;
  const SampledSpectra expected = want(lanes, 11);
  for (const char* name : {"lines.exr", "tiles.exr"}) {
    for (const std::size_t bytes : {std::size_t{0}, kTileBytes, 3 * kTileBytes, 20 * kTileBytes}) {
      const auto cache = *TextureCache::create(bytes);
      const SpectralTexture texture = opened(folder_ / name, cache);
      const SampledSpectra got =
          sampled(texture, points_about(lanes, 11).at(), wavelengths_of(lanes, {450, 550}), {}, {1});
      EXPECT_TRUE(same_lanes(got, expected)) << name << " in " << bytes;
      const TextureCacheStats stats = cache.stats();
      EXPECT_LE(stats.bytes, std::max(bytes, kTileBytes));
      EXPECT_EQ(stats.max_bytes, bytes);
      EXPECT_EQ(stats.tiles_read, stats.tiles + stats.evicted);
      EXPECT_GT(stats.evicted, 0U);
      EXPECT_EQ(stats.hits + stats.misses, lanes * 4);
    }
  }
}

TEST_F(TextureCaches, ThreadsThatShareASmallCacheGetTheirSamples) {
  const std::size_t lanes = 100;
  const auto cache = *TextureCache::create(4 * kTileBytes);
  const SpectralTexture lines = opened(folder_ / "lines.exr", cache);
  const SpectralTexture tiles = opened(folder_ / "tiles.exr", cache);
  std::vector<SampledSpectra> expected;
  for (std::uint32_t seed = 0; seed < 3; ++seed) expected.push_back(want(lanes, seed));
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (std::uint32_t t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t seed = (t + i) % 3;
        SampledSpectra out = own_batch(lanes, 2);
        const auto done =
            (t % 2 == 0 ? lines : tiles)
                .sample(points_about(lanes, seed).at(), wavelengths_of(lanes, {450, 550}), out, {}, {1});
        if (!done || !same_lanes(out, expected[seed])) ++wrong;
        if (cache.stats().bytes > 4 * kTileBytes) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(cache.stats().hits + cache.stats().misses, 6U * 4 * lanes * 4);
}

TEST_F(TextureCaches, ATextureTakesItsTilesAlong) {
  const auto cache = *TextureCache::create();
  const auto fill = [&](const SpectralTexture& texture) {
    sampled(texture, points_about(500, 1).at(), wavelengths_of(500, {500}), {}, {1});
    return cache.stats().tiles;
  };
  const SpectralTexture stays = opened(folder_ / "lines.exr", cache);
  const std::size_t before = fill(stays);
  {
    const SpectralTexture goes = opened(folder_ / "tiles.exr", cache);
    EXPECT_GT(fill(goes), before);
  }
  EXPECT_EQ(cache.stats().tiles, before);
  EXPECT_EQ(cache.stats().bytes, before * kTileBytes);
  EXPECT_EQ(fill(stays), before);
}

}  // namespace
}  // namespace spectile::test
