// Construction of batches of spectra, scalars and colours.
#include <algorithm>
#include <spectile/lanes/sampled_spectra.hpp>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

Result<FloatBuffer> zeroed(std::size_t count) {
  auto buffer = FloatBuffer::create(count);
  if (buffer) std::fill_n(buffer->data(), count, 0.0F);
  return buffer;
}

bool too_many(std::size_t lanes, std::size_t per_lane) {
  return lanes > (std::size_t{1} << 60) / std::max<std::size_t>(per_lane, 1);
}

}  // namespace

Result<SampledSpectra> SampledSpectra::create(const SpectralAxis& axis, std::size_t lanes) {
  return constant(axis, lanes, 0.0F);
}

Result<SampledSpectra> SampledSpectra::constant(const SpectralAxis& axis, std::size_t lanes, float value) {
  const std::vector<float> values(axis.count(), value);
  return broadcast(axis, lanes, values);
}

Result<SampledSpectra> SampledSpectra::broadcast(const SpectralAxis& axis, std::size_t lanes,
                                                 std::span<const float> values) {
  if (values.size() != axis.count()) {
    return make_error(ErrorCode::kBandsMismatch, "the spectrum has {} values, the batch has {}",
                      values.size(), axis.description());
  }
  if (too_many(lanes, axis.count())) {
    return make_error(ErrorCode::kOutOfMemory, "{} lanes of {} samples do not fit in memory", lanes,
                      axis.count());
  }
  const std::size_t blocks = blocks_for(lanes);
  SampledSpectra spectra;
  SPECTILE_ASSIGN(spectra.buffer_, FloatBuffer::create(blocks * axis.count() * kLanesPerBlock));
  float* out = spectra.buffer_.data();
  for (std::size_t block = 0; block < blocks; ++block) {
    for (const float value : values) out = std::fill_n(out, kLanesPerBlock, value);
  }
  spectra.lanes_ = lanes;
  spectra.axis_ = axis;
  return spectra;
}

Result<SampledSpectra> SampledSpectra::clone() const {
  SampledSpectra out;
  SPECTILE_ASSIGN(out.buffer_, FloatBuffer::create(buffer_.size()));
  std::copy_n(buffer_.data(), buffer_.size(), out.buffer_.data());
  out.lanes_ = lanes_;
  out.axis_ = axis_;
  return out;
}

Result<ScalarLanes> ScalarLanes::create(std::size_t lanes) {
  if (too_many(lanes, 1)) return make_error(ErrorCode::kOutOfMemory, "{} lanes do not fit in memory", lanes);
  ScalarLanes out;
  SPECTILE_ASSIGN(out.buffer_, zeroed(blocks_for(lanes) * kLanesPerBlock));
  out.lanes_ = lanes;
  return out;
}

Result<ColorLanes> ColorLanes::create(std::size_t lanes) {
  if (too_many(lanes, 3)) return make_error(ErrorCode::kOutOfMemory, "{} lanes do not fit in memory", lanes);
  const std::size_t stride = blocks_for(lanes) * kLanesPerBlock;
  ColorLanes out;
  SPECTILE_ASSIGN(out.buffer_, zeroed(3 * stride));
  out.lanes_ = lanes;
  out.stride_ = stride;
  return out;
}

ColorSpan ColorLanes::span() noexcept {
  float* p = buffer_.data();
  return {{p, p + stride_, p + 2 * stride_}, lanes_};
}

ColorView ColorLanes::view() const noexcept {
  const float* p = buffer_.data();
  return {{p, p + stride_, p + 2 * stride_}, lanes_};
}

}  // namespace spectile
