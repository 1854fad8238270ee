// A SpectralTexture's lanes: points to samples, block by block over threads.
#include <atomic>
#include <optional>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/texture/texture_image.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using kernels::TextureTaps;

kernels::TextureWrap kernel_wrap(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::kRepeat:
      return kernels::TextureWrap::kRepeat;
    case TextureWrap::kMirror:
      return kernels::TextureWrap::kMirror;
    case TextureWrap::kClamp:
      return kernels::TextureWrap::kClamp;
    case TextureWrap::kBlack:
      break;
  }
  return kernels::TextureWrap::kBlack;
}

TextureTaps kernel_taps(TextureFilter filter, const std::vector<std::int32_t>& levels) {
  // Between levels there is nothing where there is one.
  if (filter == TextureFilter::kTrilinear && levels.size() == kernels::kTextureLevelRow)
    filter = TextureFilter::kBilinear;
  switch (filter) {
    case TextureFilter::kNearest:
      return TextureTaps::kNearest;
    case TextureFilter::kBilinear:
      return TextureTaps::kBilinear;
    case TextureFilter::kTrilinear:
      break;
  }
  return TextureTaps::kTrilinear;
}

Result<void> check(const TexturePoints& at, const SampledSpectraView* lambda_nm,
                   const SampledSpectraSpan& samples) {
  for (const LanesView* const lanes : {&at.u, &at.v, &at.level, &at.footprint}) {
    const bool optional = lanes == &at.level || lanes == &at.footprint;
    if (optional && lanes->lanes == 0) continue;
    SPECTILE_TRY(shape::same_lanes(lanes->lanes, samples.lanes));
    SPECTILE_TRY(shape::aligned(lanes->data));
  }
  if (at.level.lanes != 0 && at.footprint.lanes != 0) {
    return make_error(ErrorCode::kBadArgument, "points have mip levels or footprints, not both");
  }
  SPECTILE_TRY(shape::aligned(samples.data));
  if (lambda_nm == nullptr) {
    if (samples.axis.bands() != nullptr) return {};
    return make_error(ErrorCode::kBandsMismatch, "the batch has {}, which must be given",
                      samples.axis.description());
  }
  SPECTILE_TRY(shape::own_wavelengths(lambda_nm->axis));
  SPECTILE_TRY(shape::same(*lambda_nm, samples));
  return shape::aligned(lambda_nm->data);
}

/// The first error of several threads.
class FirstError {
 public:
  bool any() const noexcept { return any_.load(std::memory_order_relaxed); }
  void set(Error error) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = std::move(error);
    any_.store(true, std::memory_order_relaxed);
  }
  Result<void> result() && {
    if (!error_) return {};
    return *std::move(error_);
  }

 private:
  std::atomic<bool> any_ = false;
  std::mutex mutex_;
  std::optional<Error> error_;
};

}  // namespace

Result<io::TexelFormat> SpectralTexture::Image::texel_format() const {
  if (!source_) return io::TexelFormat::of_bands(channels_);
  SPECTILE_ASSIGN(const auto rows,
                  rows::SampledRows::over(source_->upsampler(), source_->upsampler().bands()));
  auto planes = source_->planes();
  planes.resize(source_->coefficients());
  return io::TexelFormat::of_coefficients(source_->upsampler(), rows, std::move(planes));
}

Result<io::TextureTiles*> SpectralTexture::Image::tiles() {
  if (io::TextureTiles* const tiles = tiles_.load(std::memory_order_acquire)) return tiles;
  const std::scoped_lock lock(opening_);
  if (own_tiles_) return own_tiles_.get();
  const PixelWindow& data = file().header(part_).data_window();
  const PixelWindow& display = file().header(part_).display_window();
  if (data != display) {
    return make_error(ErrorCode::kBadFile,
                      "{}: its data window, {} x {} at {},{}, is not its display window, {} x {} at {},{}: a "
                      "texture's 0 to 1 could be either",
                      path(), data.width(), data.height(), data.x0, data.y0, display.width(),
                      display.height(), display.x0, display.y0);
  }
  SPECTILE_TRY(file().unchanged());
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path(), threads_));
  SPECTILE_TRY(file().unchanged());
  SPECTILE_ASSIGN(auto format, texel_format());
  if (!source_) {
    SPECTILE_ASSIGN(centres_, centre_tables(bands_));
  }
  SPECTILE_ASSIGN(auto reader, io::TileReader::create(std::move(input), part_, std::move(format)));
  own_tiles_ = std::make_unique<io::TextureTiles>(std::move(reader), cache_->tiles());
  tiles_.store(own_tiles_.get(), std::memory_order_release);
  return own_tiles_.get();
}

Result<void> SpectralTexture::Image::sample(const TexturePoints& at, const SampledSpectraView* lambda_nm,
                                            SampledSpectraSpan samples, const TextureLookup& lookup,
                                            const Execution& execution) {
  SPECTILE_TRY(check(at, lambda_nm, samples));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  SPECTILE_ASSIGN(io::TextureTiles* const tiles, this->tiles());
  const std::vector<std::int32_t>& levels = tiles->levels();
  const kernels::TextureShape shape = {
      levels.data(), static_cast<std::int32_t>(levels.size() / kernels::kTextureLevelRow),
      kernel_wrap(lookup.wrap_u), kernel_wrap(lookup.wrap_v), kernel_taps(lookup.filter, levels)};
  const io::TextureContent content = {*tiles, source_ ? &source_->upsampler() : nullptr,
                                      centres_ ? centres_->centres : kernels::CentreTable{}};
  const std::size_t count = samples.axis.count();
  FloatBuffer centres;
  if (lambda_nm == nullptr) {
    SPECTILE_ASSIGN(centres, FloatBuffer::create(count * kLanesPerBlock));
    for (std::size_t k = 0; k < count; ++k) {
      const auto nm = static_cast<float>((*samples.axis.bands())[k].centre_nm);
      std::fill_n(centres.data() + k * kLanesPerBlock, kLanesPerBlock, nm);
    }
  }
  const bool own_bands =
      lambda_nm == nullptr && source_ && *samples.axis.bands() == source_->upsampler().bands();
  FirstError failed;
  tiles::for_blocks(samples.blocks(), execution, [&](std::size_t first, std::size_t blocks) {
    for (std::size_t block = first; block < first + blocks && !failed.any(); ++block) {
      const std::size_t lane = block * kLanesPerBlock;
      kernels::TextureCoordinates where = {at.u.data + lane, at.v.data + lane};
      if (at.level.lanes != 0) where.level = at.level.data + lane;
      if (at.footprint.lanes != 0) {
        where.level = at.footprint.data + lane;
        where.footprint_texels = static_cast<float>(std::max(width(), height()));
      }
      const float* const lambda = lambda_nm == nullptr ? centres.data() : lambda_nm->row(block, 0);
      Result<void> done =
          io::sample_block(*table, content, shape,
                           {where, lambda, count, std::min(kLanesPerBlock, samples.lanes - lane), own_bands},
                           samples.row(block, 0));
      if (!done) failed.set(std::move(done).error());
    }
  });
  return std::move(failed).result();
}

}  // namespace spectile
