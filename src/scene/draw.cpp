// Drawing batches of samples of procedural scenes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "src/base/errors.hpp"
#include "src/scene/parts.hpp"
#include "src/scene/pixel_walk.hpp"

namespace spectile {
namespace {

// Wavelengths are drawn for this many samples at a time, so that they stay in the innermost cache.
constexpr std::size_t kChunk = 512;

// Counter-based random numbers: the n-th number of the SplitMix64 generator with a given state. Source:
// Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014; its finaliser is variant
// 13 of Stafford's.
constexpr std::uint64_t kGoldenGamma = 0x9E3779B97F4A7C15;

std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

std::uint64_t random(std::uint64_t state, std::uint64_t n) {
  return mixed(state + (n + 1) * kGoldenGamma);
}

/// The samples of a chunk between the passes over them.
struct Chunk {
  std::array<float, kChunk> factor;
  std::array<std::uint32_t, kChunk> spectrum;
};

/// In [0, 1), whole multiples of 2^-32.
double unit(std::uint64_t bits32) {
  return static_cast<double>(bits32) * 0x1p-32;
}

/// A place within a pixel as a float that is within it too: rounding up must not take it into the next.
float placed(int pixel, double offset) {
  const auto at = static_cast<float>(pixel + offset);
  const auto end = static_cast<float>(pixel + 1);
  return at < end ? at : std::nextafter(end, 0.0F);
}

/// Radiance of the chunk's spectra at wavelengths. `tables`: pairs of a value and the difference to the next,
/// kIntervals of them a spectrum.
void interpolate(float* radiance, const float* lambda_nm, const Chunk& chunk, const float* tables,
                 std::size_t n) {
  constexpr auto kIntervals = static_cast<std::int32_t>(kLastVisibleNm - kFirstVisibleNm);
  for (std::size_t i = 0; i < n; ++i) {
    // A wavelength may be rounded out of the range that it is drawn from.
    const float t =
        std::clamp(lambda_nm[i] - static_cast<float>(kFirstVisibleNm), 0.0F, static_cast<float>(kIntervals));
    const std::int32_t nm = std::min(static_cast<std::int32_t>(t), kIntervals - 1);
    const float* const pair =
        tables + 2 * (std::size_t{chunk.spectrum[i]} * kIntervals + static_cast<std::size_t>(nm));
    radiance[i] = chunk.factor[i] * (pair[0] + (t - static_cast<float>(nm)) * pair[1]);
  }
}

Result<void> check(const FilmOptions& film, const SceneSampling& sampling, const PixelWindow& window,
                   std::uint64_t first, std::uint64_t count) {
  if (sampling.shard >= sampling.shards) {
    return make_error(ErrorCode::kBadArgument, "there is no shard {} of {}, counted from 0", sampling.shard,
                      sampling.shards);
  }
  if (window.x0 < 0 || window.y0 < 0 || window.x1 > film.width || window.y1 > film.height ||
      window.width() < 1 || window.height() < 1) {
    return make_error(ErrorCode::kBadArgument,
                      "pixels from ({}, {}) to ({}, {}) are no window of a film of {} x {} pixels", window.x0,
                      window.y0, window.x1, window.y1, film.width, film.height);
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(window.width()) * static_cast<std::uint64_t>(window.height());
  if (first > pixels || count > pixels - first) {
    return make_error(ErrorCode::kBadArgument, "{} pixels from number {} on are beyond the window's {}",
                      count, first, pixels);
  }
  return {};
}

}  // namespace

Result<SceneBatch> SceneBatch::create(std::size_t most_samples, std::size_t rows, bool wavelengths) {
  // Rows a power of two apart would share few sets of the caches.
  constexpr std::size_t kApart = 16;
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max() / 64;
  if (most_samples > kMost || rows > kMost / (most_samples + kLanesPerBlock + kApart)) {
    return make_error(ErrorCode::kOutOfMemory, "{} samples of {} values do not fit in memory", most_samples,
                      rows);
  }
  SceneBatch out;
  out.capacity_ = most_samples;
  out.rows_ = rows;
  out.stride_ = blocks_for(most_samples) * kLanesPerBlock + kApart;
  out.wavelengths_ = wavelengths;
  const auto take = [&](FloatBuffer& buffer, std::size_t lines) -> Result<void> {
    SPECTILE_ASSIGN(buffer, FloatBuffer::create(lines * out.stride_));
    return {};
  };
  SPECTILE_TRY(take(out.x_, 1));
  SPECTILE_TRY(take(out.y_, 1));
  SPECTILE_TRY(take(out.weight_, 1));
  SPECTILE_TRY(take(out.radiance_, rows));
  SPECTILE_TRY(take(out.lambda_, wavelengths ? rows : 0));
  SPECTILE_TRY(take(out.density_, wavelengths ? rows : 0));
  return out;
}

WavelengthSamples SceneBatch::wavelength_samples() const noexcept {
  if (!wavelengths_) return {};
  return {{x_.data(), size_},
          {y_.data(), size_},
          {weight_.data(), weighted_ ? size_ : 0},
          {radiance_.data(), rows_, stride_},
          {lambda_.data(), rows_, stride_},
          {density_.data(), rows_, stride_}};
}

BandSamples SceneBatch::band_samples() const noexcept {
  if (wavelengths_) return {};
  return {{x_.data(), size_},
          {y_.data(), size_},
          {weight_.data(), weighted_ ? size_ : 0},
          {radiance_.data(), rows_, stride_}};
}

Result<void> ProceduralScene::draw(const FilmOptions& film, const SceneSampling& sampling,
                                   std::uint64_t first, std::uint64_t count, SceneBatch& batch) const {
  const PixelWindow window = scene::filter_window(film);
  SPECTILE_TRY(check(film, sampling, window, first, count));
  const bool bands = film.input == FilmInput::kBands;
  const std::size_t rows = bands ? film.bands.count() : sampling.wavelengths;
  if (batch.wavelengths_ == bands || batch.rows_ != rows) {
    return make_error(ErrorCode::kSizeMismatch, "the batch is for {} {}, the film is fed with {} {}",
                      batch.rows_, batch.wavelengths_ ? "wavelengths" : "bands", rows,
                      bands ? "bands" : "wavelengths");
  }
  // Of the numbers from 0 to samples_per_pixel - 1 those that are `shard` modulo `shards`.
  const std::uint64_t per_pixel =
      sampling.samples_per_pixel > sampling.shard
          ? (sampling.samples_per_pixel - sampling.shard - 1) / sampling.shards + 1
          : 0;
  if (count > 0 && per_pixel > batch.capacity_ / count) {
    return make_error(ErrorCode::kSizeMismatch, "{} pixels of {} samples do not fit into a batch of {}",
                      count, per_pixel, batch.capacity_);
  }
  const std::size_t total = count * per_pixel;
  const std::size_t lanes = std::max<std::size_t>(1, std::min(kChunk, total));
  SPECTILE_ASSIGN(auto u, ScalarLanes::create(lanes));
  SPECTILE_ASSIGN(auto wavelengths, SampledWavelengths::create(lanes, bands ? 1 : rows));
  const SampledWavelengthsView drawn = wavelengths;
  const auto averages = bands ? parts_->responses.averages(film.bands, false) : nullptr;

  batch.size_ = 0;
  batch.weighted_ = film.placement == SamplePlacement::kOnePixel && film.filter.has_negative_lobes();
  scene::PixelWalk walk(window, first);
  Chunk chunk;
  const double per_width = 1.0 / film.width;
  const double per_height = 1.0 / film.height;
  const std::uint64_t run = mixed(sampling.seed + kGoldenGamma);
  std::uint64_t pixel = 0;  // the state of its random numbers
  std::uint64_t left = 0;   // of its samples
  std::uint64_t number = 0;
  for (std::size_t done = 0; done < total; done += lanes) {
    const std::size_t n = std::min(lanes, total - done);
    for (std::size_t i = 0; i < n; ++i) {
      if (left == 0) {
        walk.next();
        left = per_pixel;
        number = sampling.shard;
        const std::uint64_t place =
            static_cast<std::uint64_t>(walk.y()) * static_cast<std::uint64_t>(film.width) +
            static_cast<std::uint64_t>(walk.x());
        pixel = random(run, place);
      }
      const std::uint64_t position = random(pixel, 2 * number);
      (u)[i] = static_cast<float>(random(pixel, 2 * number + 1) >> 40) * 0x1p-24F;
      --left;
      number += sampling.shards;

      double x = unit(position >> 32);
      double y = unit(position & 0xFFFFFFFF);
      if (film.placement == SamplePlacement::kSplat) {
        batch.x_.data()[done + i] = placed(walk.x(), x);
        batch.y_.data()[done + i] = placed(walk.y(), y);
      } else {
        // The film is told the pixel only; the area of its filter is seen from the centre.
        const FilterSample sample = film.filter.sample(x, y);
        x = 0.5 + sample.dx;
        y = 0.5 + sample.dy;
        batch.x_.data()[done + i] = static_cast<float>(walk.x()) + 0.5F;
        batch.y_.data()[done + i] = static_cast<float>(walk.y()) + 0.5F;
        if (batch.weighted_) batch.weight_.data()[done + i] = static_cast<float>(sample.weight);
      }
      const double across = (walk.x() + x) * per_width;
      const double down = (walk.y() + y) * per_height;
      const scene::Rectangle& seen = parts_->layout.at(across, down);
      chunk.factor[i] = static_cast<float>(seen.factor(across, down));
      chunk.spectrum[i] = static_cast<std::uint32_t>(seen.spectrum);
    }
    if (bands) {
      for (std::size_t b = 0; b < rows; ++b) {
        float* const radiance = batch.radiance_.data() + b * batch.stride_ + done;
        for (std::size_t i = 0; i < n; ++i) {
          radiance[i] = chunk.factor[i] * averages->rounded[chunk.spectrum[i] * rows + b];
        }
      }
      continue;
    }
    SPECTILE_TRY(sample_wavelengths(sampling.density, u.view(), wavelengths, kFirstVisibleNm, kLastVisibleNm,
                                    Execution{1}));
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t at = k * batch.stride_ + done;
      float* const lambda = batch.lambda_.data() + at;
      for (std::size_t i = 0; i < n; i += kLanesPerBlock) {
        const std::size_t lanes_left = std::min(kLanesPerBlock, n - i);
        std::copy_n(drawn.lambda_nm.row(i / kLanesPerBlock, k), lanes_left, lambda + i);
        std::copy_n(drawn.density.row(i / kLanesPerBlock, k), lanes_left, batch.density_.data() + at + i);
      }
      interpolate(batch.radiance_.data() + at, lambda, chunk, parts_->tables.data(), n);
    }
  }
  batch.size_ = total;
  return {};
}

}  // namespace spectile
