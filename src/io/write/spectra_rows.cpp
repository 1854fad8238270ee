// SpectraRows: rows of an image's spectra in a caller's memory, whatever their arrangement.
#include "src/io/write/spectra_rows.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

void load_lanes(const SampledSpectraView& from, std::size_t lane, std::size_t count, float* const* to) {
  const std::size_t bands = from.axis.count();
  for (std::size_t done = 0; done < count;) {
    const std::size_t block = (lane + done) / kLanesPerBlock;
    const std::size_t at = (lane + done) % kLanesPerBlock;
    const std::size_t n = std::min(kLanesPerBlock - at, count - done);
    for (std::size_t k = 0; k < bands; ++k) {
      std::memcpy(to[k] + done, from.row(block, k) + at, n * sizeof(float));
    }
    done += n;
  }
}

void load_strided(const StridedSpectraView& from, const float* pixel, std::size_t count, float* const* to) {
  // A line of the cache on both sides.
  constexpr std::size_t kSide = 16;
  const std::size_t step = from.pixel_stride_floats;
  for (std::size_t x0 = 0; x0 < count; x0 += kSide) {
    const std::size_t x1 = std::min(x0 + kSide, count);
    for (std::size_t k0 = 0; k0 < from.bands; k0 += kSide) {
      const std::size_t k1 = std::min(k0 + kSide, from.bands);
      for (std::size_t k = k0; k < k1; ++k) {
        const float* const samples = pixel + k * from.band_stride_floats;
        for (std::size_t x = x0; x < x1; ++x) to[k][x] = samples[x * step];
      }
    }
  }
}

/// Floats up to the last sample of so many rows; nothing where the strides alone exceed the data.
std::optional<std::size_t> floats_needed(const StridedSpectraView& view, std::size_t rows,
                                         std::size_t width) {
  std::size_t last = 0;
  const std::pair<std::size_t, std::size_t> steps[] = {{rows - 1, view.row_stride_floats},
                                                       {width - 1, view.pixel_stride_floats},
                                                       {view.bands - 1, view.band_stride_floats}};
  for (const auto& [count, stride] : steps) {
    // Products of larger ones could wrap.
    if (count > 0 && stride > view.data.size()) return {};
    last += count * stride;
  }
  return last + 1;
}

Result<void> check_alpha(const RowsOf& image, std::size_t pixels, std::span<const float> alpha) {
  const std::size_t wanted = image.alpha ? pixels : 0;
  if (alpha.size() == wanted) return {};
  return make_error(ErrorCode::kSizeMismatch, "{}: {} samples of alpha, the image expects {} for {} pixels{}",
                    image.path, alpha.size(), wanted, pixels,
                    image.alpha ? "" : ", as its options ask for no alpha");
}

}  // namespace

Result<SpectraRows> SpectraRows::of(const RowsOf& image, const RowRange& range,
                                    const SampledSpectraView& spectra, std::span<const float> alpha) {
  const Bands* const bands = spectra.axis.bands();
  if (bands == nullptr || *bands != image.bands) {
    return make_error(ErrorCode::kBandsMismatch, "{}: spectra on {}, the image expects {}", image.path,
                      spectra.axis.description(), SpectralAxis(image.bands).description());
  }
  const std::size_t pixels = static_cast<std::size_t>(range.count) * static_cast<std::size_t>(image.width);
  if (spectra.lanes != pixels) {
    return make_error(ErrorCode::kSizeMismatch, "{}: {} lanes are not {} row{} of {} pixels", image.path,
                      spectra.lanes, range.count, range.count == 1 ? "" : "s", image.width);
  }
  if (spectra.data == nullptr) {
    return make_error(ErrorCode::kBadArgument, "{}: no data for {} lanes", image.path, spectra.lanes);
  }
  SPECTILE_TRY(check_alpha(image, pixels, alpha));
  SpectraRows out;
  out.range_ = range;
  out.width_ = static_cast<std::size_t>(image.width);
  out.spectra_ = spectra;
  out.alpha_ = alpha;
  return out;
}

Result<SpectraRows> SpectraRows::of(const RowsOf& image, const RowRange& range,
                                    const StridedSpectraView& spectra, std::span<const float> alpha) {
  if (spectra.bands != image.bands.count()) {
    return make_error(ErrorCode::kBandsMismatch, "{}: spectra of {} bands, the image expects {}", image.path,
                      spectra.bands, image.bands.count());
  }
  const auto rows = static_cast<std::size_t>(range.count);
  const auto width = static_cast<std::size_t>(image.width);
  const auto needed = floats_needed(spectra, rows, width);
  if (!needed || *needed > spectra.data.size()) {
    return make_error(ErrorCode::kSizeMismatch,
                      "{}: {} floats are too few for {} rows of {} pixels in {} bands, at strides of {}, {} "
                      "and {}",
                      image.path, spectra.data.size(), rows, width, spectra.bands, spectra.row_stride_floats,
                      spectra.pixel_stride_floats, spectra.band_stride_floats);
  }
  SPECTILE_TRY(check_alpha(image, rows * width, alpha));
  SpectraRows out;
  out.range_ = range;
  out.width_ = width;
  out.spectra_ = spectra;
  out.alpha_ = alpha;
  return out;
}

void SpectraRows::load(int row, std::size_t x, std::size_t count, float* const* to) const {
  const auto y = static_cast<std::size_t>(row - range_.first);
  const std::size_t lane = y * width_ + x;
  std::size_t bands = 0;
  if (const auto* const batch = std::get_if<SampledSpectraView>(&spectra_)) {
    bands = batch->axis.count();
    load_lanes(*batch, lane, count, to);
  } else {
    const auto& strided = std::get<StridedSpectraView>(spectra_);
    bands = strided.bands;
    const std::size_t at = y * strided.row_stride_floats + x * strided.pixel_stride_floats;
    load_strided(strided, strided.data.data() + at, count, to);
  }
  if (!alpha_.empty()) std::memcpy(to[bands], alpha_.data() + lane, count * sizeof(float));
}

}  // namespace spectile::io
