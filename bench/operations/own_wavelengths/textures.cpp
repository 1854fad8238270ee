// Lookups in textures, of tiles that the cache has: a small texture of noise, bilinear, at lanes' own
// wavelengths.
#include "bench/operations/own_wavelengths/textures.hpp"

#include <algorithm>
#include <cmath>

#include "bench/operations/operation.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/texture/texture_lookup.hpp"

namespace spectile::measure {
namespace {

constexpr std::size_t kSide = kTextureSide;

/// Tiles made of texels in memory.
class MemoryTiles : public io::TileSource {
 public:
  MemoryTiles(io::TexelFormat format, const KernelTable& kernels, std::vector<float> texels)
      : kernels_(kernels), texels_(std::move(texels)) {
    format_ = std::move(format);
    add_level({static_cast<int>(kSide), static_cast<int>(kSide)});
  }
  Result<void> read(std::int32_t tile, std::size_t /*max_tiles*/, const Take& take) override {
    constexpr std::size_t kTile = kernels::kTextureTile;
    SPECTILE_ASSIGN(auto texels, FloatBuffer::create(kTile * kTile * format_.floats));
    const std::size_t left = static_cast<std::size_t>(tile) % (kSide / kTile) * kTile;
    const std::size_t top = static_cast<std::size_t>(tile) / (kSide / kTile) * kTile;
    alignas(64) float samples[3 * kTile];
    for (std::size_t y = 0; y < kTile; ++y) {
      for (std::size_t x = 0; x < kTile; ++x) {
        const float* const texel = texels_.data() + 3 * ((top + y) * kSide + left + x);
        for (std::size_t k = 0; k < 3; ++k) samples[k * kTile + x] = texel[k];
      }
      format_.pack(kernels_, samples, kTile, texels.data() + y * kTile * format_.floats);
    }
    return take(tile, std::move(texels));
  }

 private:
  const KernelTable& kernels_;
  std::vector<float> texels_;
};

/// A texture, all of whose tiles are cached.
struct Texture {
  std::shared_ptr<const Upsampler> upsampler;
  std::unique_ptr<io::TextureTiles> tiles;
};

Result<std::shared_ptr<Texture>> make_texture(const std::shared_ptr<const Upsampler>& upsampler,
                                              const std::vector<float>& noise) {
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  SPECTILE_ASSIGN(const auto rows, rows::SampledRows::over(*upsampler, upsampler->bands()));
  auto format = io::TexelFormat::of_coefficients(*upsampler, rows, std::vector<io::PlaneSpec>(3));
  auto out = std::make_shared<Texture>();
  out->upsampler = upsampler;
  out->tiles =
      std::make_unique<io::TextureTiles>(std::make_unique<MemoryTiles>(std::move(format), *kernels, noise),
                                         std::make_shared<io::TileCache>(std::size_t{16} << 20));
  return out;
}

/// Coordinates on a grid of 32 steps a texel, so that they and the weights are exact.
float on_grid(float coordinate) {
  constexpr float kSteps = 32.0F * kSide;
  if (!(std::abs(coordinate) <= 1)) return 0.5F;
  return std::min(std::floor(std::abs(coordinate) * kSteps), kSteps - 1) / kSteps;
}

}  // namespace

std::vector<float> texture_noise(float low, float high) {
  Random random(11);
  std::vector<float> out(3 * kSide * kSide);
  for (float& v : out) v = uniform(random, low, high);
  return out;
}

Result<void> add_texture(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler,
                         const TextureCost& cost) {
  const auto noise = std::make_shared<const std::vector<float>>(texture_noise(cost.low, cost.high));
  SPECTILE_ASSIGN(const auto texture, make_texture(upsampler, *noise));
  constexpr std::size_t kRows = 2 + kWavelengths;
  Operation& op = add_operation(to, "wavelengths",
                                "texture at 4 wavelengths, " + std::string(to_string(upsampler->method())),
                                "lookup", {1, kRows}, {1, kWavelengths});
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < 2; ++k) v[k] = on_grid(uniform(random, 0.0F, 1.0F));
    for (std::size_t k = 2; k < kRows; ++k) v[k] = uniform(random, 360.0F, 830.0F);
  };
  op.admit = [](float* v) {
    for (std::size_t k = 0; k < 2; ++k) v[k] = on_grid(v[k]);
  };
  op.operations = cost.operations;
  op.divisions = cost.divisions;
  op.bottleneck = cost.bottleneck;
  op.unit = cost.unit;
  op.bound = cost.bound;
  op.run = [texture](const KernelTable& k, const Arrays& a) {
    const io::TextureContent content = {*texture->tiles, texture->upsampler.get(), {}};
    const kernels::TextureShape shape = {.levels = texture->tiles->levels().data()};
    for (std::size_t block = 0; block < a.blocks; ++block) {
      const float* const rows = a.in() + block * kRows * kernels::kLanes;
      // Of tiles in memory nothing can fail.
      (void)io::sample_block(k, content, shape,
                             {.at = {rows, rows + kernels::kLanes},
                              .lambda_nm = rows + 2 * kernels::kLanes,
                              .count = kWavelengths},
                             a.out() + block * kWavelengths * kernels::kLanes);
    }
  };
  op.error = [noise, sample = cost.sample](const double* v, const double* out, double tiny) {
    double worst = 0;
    const double x = v[0] * static_cast<double>(kSide) - 0.5;
    const double y = v[1] * static_cast<double>(kSide) - 0.5;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double lambda = v[2 + k];
      if (std::isnan(lambda)) {
        if (!std::isnan(out[k])) return kBeyond;
        continue;
      }
      double want = 0;
      double scale = 0;
      for (int tap = 0; tap < 4; ++tap) {
        const double column = std::floor(x) + tap % 2;
        const double line = std::floor(y) + tap / 2;
        const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - line));
        const auto wrapped = [](double i) { return static_cast<std::size_t>(i + kSide) % kSide; };
        const SampleAndScale texel =
            sample(noise->data() + 3 * (wrapped(line) * kSide + wrapped(column)), lambda);
        want += weight * texel.sample;
        scale = std::max(scale, texel.scale);
      }
      worst = std::max(worst, (std::abs(out[k] - want) - tiny) / (0x1p-24 * scale));
    }
    return worst;
  };
  return {};
}

}  // namespace spectile::measure
