// SampledSpectra: a batch of sampled spectra as structure-of-arrays lanes in blocks of 64, and its views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/float_buffer.hpp>
#include <spectile/lanes/spectral_axis.hpp>
#include <spectile/result.hpp>
#include <type_traits>
#include <vector>

namespace spectile {

/// Lanes in one block; a block is [sample][kLanesPerBlock] floats.
inline constexpr std::size_t kLanesPerBlock = 64;

/// Blocks needed for `lanes` lanes.
constexpr std::size_t blocks_for(std::size_t lanes) noexcept {
  return (lanes + kLanesPerBlock - 1) / kLanesPerBlock;
}

/// View of a batch: n lanes of K samples, on bands or at each lane's own wavelengths. Shapes: data
/// [block][sample][64], 64-byte aligned, the last block padded. No access is checked against the bounds.
template <class Float>
struct BatchView {
  Float* data = nullptr;
  std::size_t lanes = 0;
  SpectralAxis axis = {};

  std::size_t blocks() const noexcept { return blocks_for(lanes); }
  std::size_t floats() const noexcept { return blocks() * axis.count() * kLanesPerBlock; }
  /// Sample k of 64 lanes. Shapes: [64].
  Float* row(std::size_t block, std::size_t k) const noexcept {
    return data + (block * axis.count() + k) * kLanesPerBlock;
  }
  Float& at(std::size_t lane, std::size_t k) const noexcept {
    return row(lane / kLanesPerBlock, k)[lane % kLanesPerBlock];
  }
  /// A range of the lanes without a copy: whole blocks, or up to the last lane.
  BatchView range(std::size_t first, std::size_t count) const {
    return {data + first * axis.count(), count, axis};
  }
  operator BatchView<const Float>() const requires(!std::is_const_v<Float>) { return {data, lanes, axis}; }
};
using SampledSpectraView = BatchView<const float>;  ///< to read
using SampledSpectraSpan = BatchView<float>;        ///< to write

/// Owner of a batch of `lanes` sampled spectra on one axis. Converts to its views; one of a temporary is for
/// the call only.
class SampledSpectra {
 public:
  /// A batch with every sample zero, padding included. Errors: kOutOfMemory.
  static Result<SampledSpectra> create(const SpectralAxis& axis, std::size_t lanes);
  /// A batch with every sample equal to `value`. Errors: kOutOfMemory.
  static Result<SampledSpectra> constant(const SpectralAxis& axis, std::size_t lanes, float value);
  /// A batch with every lane the same samples. Shapes: values [samples].
  /// Errors: kBandsMismatch when the count of values differs from that of the axis; kOutOfMemory.
  static Result<SampledSpectra> broadcast(const SpectralAxis& axis, std::size_t lanes,
                                          std::span<const float> values);

  /// A copy of the batch. Errors: kOutOfMemory.
  Result<SampledSpectra> clone() const;

  std::size_t lanes() const noexcept { return lanes_; }
  std::size_t blocks() const noexcept { return blocks_for(lanes_); }
  const SpectralAxis& axis() const noexcept { return axis_; }
  SampledSpectraSpan span() { return {buffer_.data(), lanes_, axis_}; }
  SampledSpectraView view() const { return {buffer_.data(), lanes_, axis_}; }
  operator SampledSpectraSpan() & { return span(); }
  operator SampledSpectraView() const { return view(); }

  /// One sample; no bounds check.
  float& at(std::size_t lane, std::size_t k) noexcept { return buffer_.data()[index(lane, k)]; }
  float at(std::size_t lane, std::size_t k) const noexcept { return buffer_.data()[index(lane, k)]; }

 private:
  std::size_t index(std::size_t lane, std::size_t k) const noexcept {
    return ((lane / kLanesPerBlock) * axis_.count() + k) * kLanesPerBlock + lane % kLanesPerBlock;
  }
  FloatBuffer buffer_;
  std::size_t lanes_ = 0;
  SpectralAxis axis_;
};

/// Read-only view of one float a lane, padded to whole blocks. Shapes: data [lanes rounded up to 64], 64-byte
/// aligned.
struct LanesView {
  const float* data = nullptr;
  std::size_t lanes = 0;
  std::span<const float> values() const noexcept { return {data, lanes}; }
  /// As BatchView::range().
  LanesView range(std::size_t first, std::size_t count) const { return {data + first, count}; }
};

/// Writable view of one float a lane; shapes as in LanesView.
struct LanesSpan {
  float* data = nullptr;
  std::size_t lanes = 0;
  LanesSpan range(std::size_t first, std::size_t count) const { return {data + first, count}; }
  operator LanesView() const { return {data, lanes}; }
};

/// Read-only view of three colour components a lane. Shapes: each [lanes rounded up to 64], 64-byte aligned.
struct ColorView {
  const float* c[3] = {nullptr, nullptr, nullptr};
  std::size_t lanes = 0;
  ColorView range(std::size_t first, std::size_t count) const {
    return {{c[0] + first, c[1] + first, c[2] + first}, count};
  }
};

/// Writable view of three colour components a lane; shapes as in ColorView.
struct ColorSpan {
  float* c[3] = {nullptr, nullptr, nullptr};
  std::size_t lanes = 0;
  ColorSpan range(std::size_t first, std::size_t count) const {
    return {{c[0] + first, c[1] + first, c[2] + first}, count};
  }
  operator ColorView() const { return {{c[0], c[1], c[2]}, lanes}; }
};

/// Owner of one float a lane (a luminance, a minimum), zero at first.
class ScalarLanes {
 public:
  /// Errors: kOutOfMemory.
  static Result<ScalarLanes> create(std::size_t lanes);
  LanesSpan span() noexcept { return {buffer_.data(), lanes_}; }
  LanesView view() const noexcept { return {buffer_.data(), lanes_}; }
  operator LanesSpan() & noexcept { return span(); }
  operator LanesView() const noexcept { return view(); }
  float& operator[](std::size_t i) noexcept { return buffer_.data()[i]; }
  float operator[](std::size_t i) const noexcept { return buffer_.data()[i]; }
  std::size_t lanes() const noexcept { return lanes_; }

 private:
  FloatBuffer buffer_;
  std::size_t lanes_ = 0;
};

/// Owner of three colour components a lane (RGB or XYZ), zero at first.
class ColorLanes {
 public:
  /// Errors: kOutOfMemory.
  static Result<ColorLanes> create(std::size_t lanes);
  ColorSpan span() noexcept;
  ColorView view() const noexcept;
  operator ColorSpan() & noexcept { return span(); }
  operator ColorView() const noexcept { return view(); }
  float& at(std::size_t lane, std::size_t component) noexcept {
    return buffer_.data()[component * stride_ + lane];
  }
  float at(std::size_t lane, std::size_t component) const noexcept {
    return buffer_.data()[component * stride_ + lane];
  }
  std::size_t lanes() const noexcept { return lanes_; }

 private:
  FloatBuffer buffer_;
  std::size_t lanes_ = 0;
  std::size_t stride_ = 0;
};

/// One bit a lane: bit i % 64 of word i / 64; the last word's bits beyond the lanes are 0.
using LaneMask = std::vector<std::uint64_t>;

/// How a batch operation is run. The result never depends on it.
struct Execution {
  int threads = 0;                 ///< 0: every core that the process may use.
  std::size_t tile_lanes = 16384;  ///< Lanes a task, rounded up to whole blocks; 1 to 2^31.
};

}  // namespace spectile
