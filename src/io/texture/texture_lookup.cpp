// TextureLookup: filtered samples of lanes, block by block.
#include "src/io/texture/texture_lookup.hpp"

#include <algorithm>
#include <cstring>

#include "src/upsampling/own_wavelengths/samples_at.hpp"

namespace spectile::io {
namespace {

using kernels::KernelTable;

constexpr std::size_t kLanes = kLanesPerBlock;
constexpr std::size_t kMaxTaps = 8;
/// Samples of a lane that are made at once.
constexpr std::size_t kSamples = SpectralAxis::kMaxWavelengths;

/// Where a block's lanes find their texels.
struct Places {
  alignas(64) std::int32_t tile[kMaxTaps][kLanes];
  alignas(64) std::int32_t texel[kMaxTaps][kLanes];
  alignas(64) float weight[kMaxTaps][kLanes];
};

/// Work space of samples.
struct Samples {
  alignas(64) float sum[kSamples * kLanes];
  alignas(64) float tap[kSamples * kLanes];
};

/// sum = tap * weight, added to what is there after the first tap.
void accumulate(const KernelTable& kernels, float* sum, const float* tap, const float* weight,
                std::size_t count, bool first) {
  if (first) {
    kernels.scale_lanes(sum, tap, weight, count, 1);
  } else {
    kernels.multiply_add_lanes(sum, tap, weight, sum, count, 1);
  }
}

TextureTiles::Places tiles_of(const Places& places) {
  return {places.tile[0], places.texel[0], kLanes};
}

template <std::size_t kNumber>
using Constant = std::integral_constant<std::size_t, kNumber>;

/// use(floats of a texel, taps), both constants, which make their loops straight code.
template <class Use>
Result<void> with_constants(const TextureContent& content, std::size_t taps, Use use) {
  const auto with_taps = [&](auto floats) {
    if (taps == 1) return use(floats, Constant<1>());
    return taps == 4 ? use(floats, Constant<4>()) : use(floats, Constant<8>());
  };
  return content.tiles.format().floats == 4 ? with_taps(Constant<4>())
                                            : with_taps(Constant<kernels::kSmitsRow>());
}

/// The filtered numbers of lanes, [floats][64]: the sum of each tap's times its weight, in the taps' order.
Result<void> filtered_numbers(const KernelTable& kernels, const TextureContent& content, const Places& places,
                              std::size_t taps, std::size_t lanes, float* out) {
  return with_constants(content, taps, [&](auto floats, auto count) -> Result<void> {
    constexpr std::size_t kFloats = decltype(floats)::value;
    constexpr std::size_t kTaps = decltype(count)::value;
    alignas(64) float rows[kLanes * kFloats];
    const auto filter = [&](std::size_t lane, const float* const* texels) {
      float sum[kFloats];
      for (std::size_t k = 0; k < kFloats; ++k) sum[k] = texels[0][k] * places.weight[0][lane];
      for (std::size_t tap = 1; tap < kTaps; ++tap) {
        for (std::size_t k = 0; k < kFloats; ++k) sum[k] = texels[tap][k] * places.weight[tap][lane] + sum[k];
      }
      std::memcpy(rows + lane * kFloats, sum, sizeof(sum));
    };
    SPECTILE_TRY(content.tiles.template for_each<kTaps>(tiles_of(places), lanes, filter));
    kernels.rows_to_blocks(out, rows, kFloats, kFloats, lanes);
    return {};
  });
}

/// The numbers of each tap's texels, [taps][floats][64].
Result<void> tap_numbers(const KernelTable& kernels, const TextureContent& content, const Places& places,
                         std::size_t taps, std::size_t lanes, float* out) {
  return with_constants(content, taps, [&](auto floats, auto count) -> Result<void> {
    constexpr std::size_t kFloats = decltype(floats)::value;
    constexpr std::size_t kTaps = decltype(count)::value;
    alignas(64) float rows[kTaps][kLanes * kFloats];
    const auto keep = [&](std::size_t lane, const float* const* texels) {
      for (std::size_t tap = 0; tap < kTaps; ++tap)
        std::memcpy(rows[tap] + lane * kFloats, texels[tap], kFloats * sizeof(float));
    };
    SPECTILE_TRY(content.tiles.template for_each<kTaps>(tiles_of(places), lanes, keep));
    for (std::size_t tap = 0; tap < kTaps; ++tap)
      kernels.rows_to_blocks(out + tap * kFloats * kLanes, rows[tap], kFloats, kFloats, lanes);
    return {};
  });
}

/// The scale of coefficients, or null.
const float* scale_of(const TextureContent& content, const float* numbers) {
  return content.tiles.format().planes.size() > 3 ? numbers + 3 * kLanes : nullptr;
}

SampledSpectraView view_of(const float* samples, std::size_t count) {
  return {samples, kLanes, *SpectralAxis::own_wavelengths(count)};
}
SampledSpectraSpan span_of(float* samples, std::size_t count) {
  return {samples, kLanes, *SpectralAxis::own_wavelengths(count)};
}

void samples_of(const KernelTable& kernels, const TextureContent& content, const float* numbers,
                const float* lambda_nm, std::size_t count, float* out) {
  if (content.tiles.format().kind == TexelKind::kWeights) {
    rows::samples_of_weights(kernels, *content.upsampler, numbers, view_of(lambda_nm, count),
                             span_of(out, count));
    return;
  }
  const float* const c[3] = {numbers, numbers + kLanes, numbers + 2 * kLanes};
  rows::samples_at(kernels, *content.upsampler, c, scale_of(content, numbers), view_of(lambda_nm, count),
                   span_of(out, count));
}

/// Linear numbers: filtered, then made into samples.
Result<void> filter_numbers(const KernelTable& kernels, const TextureContent& content, const Places& places,
                            std::size_t taps, const TextureBlock& block, float* out) {
  alignas(64) float sum[kernels::kSmitsRow * kLanes];
  SPECTILE_TRY(filtered_numbers(kernels, content, places, taps, block.lanes, sum));
  for (std::size_t k = 0; k < block.count; k += kSamples) {
    samples_of(kernels, content, sum, block.lambda_nm + k * kLanes, std::min(kSamples, block.count - k),
               out + k * kLanes);
  }
  return {};
}

/// Others: samples of each tap's texels, then filtered.
Result<void> filter_samples(const KernelTable& kernels, const TextureContent& content, const Places& places,
                            std::size_t taps, const TextureBlock& block, float* out) {
  alignas(64) float numbers[kMaxTaps * kernels::kSmitsRow * kLanes];
  Samples samples;
  SPECTILE_TRY(tap_numbers(kernels, content, places, taps, block.lanes, numbers));
  const std::size_t floats = content.tiles.format().floats;
  for (std::size_t k = 0; k < block.count; k += kSamples) {
    const std::size_t some = std::min(kSamples, block.count - k);
    for (std::size_t i = 0; i < taps; ++i) {
      samples_of(kernels, content, numbers + i * floats * kLanes, block.lambda_nm + k * kLanes, some,
                 samples.tap);
      accumulate(kernels, samples.sum, samples.tap, places.weight[i], some, i == 0);
    }
    std::memcpy(out + k * kLanes, samples.sum, some * kLanes * sizeof(float));
  }
  return {};
}

/// Samples on the bands that coefficients were made for, by the kernels of whole batches, which need no
/// look-up a wavelength; each tap's, then filtered. `out` is not the block's wavelengths.
Result<void> filter_on_own_bands(const KernelTable& kernels, const TextureContent& content,
                                 const Places& places, std::size_t taps, const TextureBlock& block,
                                 float* out) {
  alignas(64) float numbers[kMaxTaps * kernels::kSmitsRow * kLanes];
  const auto expand = [&](const float* of, float* samples) {
    const float* const c[3] = {of, of + kLanes, of + 2 * kLanes};
    rows::expand_blocks(kernels, *content.upsampler, c, scale_of(content, of), samples, 1, false);
  };
  if (content.tiles.format().linear) {
    SPECTILE_TRY(filtered_numbers(kernels, content, places, taps, block.lanes, numbers));
    expand(numbers, out);
    return {};
  }
  SPECTILE_TRY(tap_numbers(kernels, content, places, taps, block.lanes, numbers));
  SPECTILE_ASSIGN(auto tap, FloatBuffer::create(block.count * kLanes));
  for (std::size_t i = 0; i < taps; ++i) {
    expand(numbers + i * content.tiles.format().floats * kLanes, tap.data());
    accumulate(kernels, out, tap.data(), places.weight[i], block.count, i == 0);
  }
  return {};
}

/// Bands: of each texel those next to the wavelengths, linear between them, filtered.
Result<void> filter_bands(const KernelTable& kernels, const TextureContent& content, const Places& places,
                          std::size_t taps, const TextureBlock& block, float* out) {
  Samples samples = {};
  alignas(64) float next[kSamples * kLanes] = {};
  alignas(64) float part[kSamples * kLanes];
  alignas(64) std::int32_t interval[kSamples * kLanes];
  for (std::size_t k = 0; k < block.count; k += kSamples) {
    const std::size_t some = std::min(kSamples, block.count - k);
    const std::size_t n = some * kLanes;
    kernels.centre_places(interval, part, block.lambda_nm + k * kLanes, content.centres, n);
    for (std::size_t i = 0; i < taps; ++i) {
      const auto keep = [&](std::size_t lane, const float* const* texels) {
        for (std::size_t at = lane; at < n; at += kLanes) {
          samples.tap[at] = texels[0][interval[at]];
          next[at] = texels[0][interval[at] + 1];
        }
      };
      SPECTILE_TRY(content.tiles.for_each<1>({places.tile[i], places.texel[i], kLanes}, block.lanes, keep));
      kernels.subtract(next, next, samples.tap, n);
      kernels.multiply_add(samples.tap, part, next, samples.tap, n);
      accumulate(kernels, samples.sum, samples.tap, places.weight[i], some, i == 0);
    }
    std::memcpy(out + k * kLanes, samples.sum, n * sizeof(float));
  }
  return {};
}

}  // namespace

Result<void> sample_block(const KernelTable& kernels, const TextureContent& content,
                          const kernels::TextureShape& shape, const TextureBlock& block, float* out) {
  Places places;
  kernels.texture_places({places.tile[0], places.texel[0], places.weight[0]}, block.at, shape, kLanes);
  const auto taps = static_cast<std::size_t>(shape.taps);
  if (content.upsampler == nullptr) return filter_bands(kernels, content, places, taps, block, out);
  if (block.own_bands && content.tiles.format().kind == TexelKind::kCoefficients)
    return filter_on_own_bands(kernels, content, places, taps, block, out);
  return content.tiles.format().linear ? filter_numbers(kernels, content, places, taps, block, out)
                                       : filter_samples(kernels, content, places, taps, block, out);
}

}  // namespace spectile::io
