// Spectra in memory of the caller's, from and to batches, block by block.
#include <spectile/lanes/sample_arrays.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/arrays/strided_array.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

/// The array with its strides in bytes, checked against the batch.
template <class Byte, class Void>
Result<arrays::StridedArray<Byte>> matched_samples(const BasicSampleArray<Void>& array,
                                                   const SampledSpectraView& spectra) {
  if (array.type != ElementType::kFloat && array.type != ElementType::kHalf) {
    return make_error(ErrorCode::kBadArgument, "samples are floats or halves, not integers of {} bytes",
                      arrays::element_bytes(array.type));
  }
  if (array.samples != spectra.axis.count()) {
    return make_error(ErrorCode::kBandsMismatch, "the array has {} samples a lane, the batch has {}",
                      array.samples, spectra.axis.description());
  }
  if (array.lanes != spectra.lanes) {
    return make_error(ErrorCode::kSizeMismatch, "the array has {} lanes, the batch {}", array.lanes,
                      spectra.lanes);
  }
  SPECTILE_TRY(shape::aligned(spectra.data));
  const auto bytes = static_cast<std::ptrdiff_t>(arrays::element_bytes(array.type));
  arrays::StridedArray<Byte> out{static_cast<Byte*>(array.data), array.type, array.lanes, array.samples};
  if (__builtin_mul_overflow(array.lane_stride, bytes, &out.lane_stride) ||
      __builtin_mul_overflow(array.sample_stride, bytes, &out.sample_stride)) {
    return make_error(ErrorCode::kBadArgument, "strides of {} and {} elements exceed the memory",
                      array.lane_stride, array.sample_stride);
  }
  SPECTILE_TRY(arrays::check_strides(out, "lane", "sample"));
  return out;
}

/// A packed array; `by_lane` says which index is the outer one.
template <class Array, class Values>
Result<Array> packed_samples(Values values, ElementType type, std::size_t samples, bool by_lane) {
  if (samples == 0) return make_error(ErrorCode::kBadArgument, "spectra of 0 samples");
  if (values.size() % samples != 0) {
    return make_error(ErrorCode::kSizeMismatch, "{} values are no multiple of {} samples", values.size(),
                      samples);
  }
  const std::size_t lanes = values.size() / samples;
  const auto outer = static_cast<std::ptrdiff_t>(by_lane ? samples : lanes);
  return Array{values.data(), type, lanes, samples, by_lane ? outer : 1, by_lane ? 1 : outer};
}

}  // namespace

template <class Void>
Result<BasicSampleArray<Void>> BasicSampleArray<Void>::lane_rows(std::span<Element<float>> values,
                                                                 std::size_t samples) {
  return packed_samples<BasicSampleArray>(values, ElementType::kFloat, samples, true);
}

template <class Void>
Result<BasicSampleArray<Void>> BasicSampleArray<Void>::lane_rows_of_halves(
    std::span<Element<std::uint16_t>> patterns, std::size_t samples) {
  return packed_samples<BasicSampleArray>(patterns, ElementType::kHalf, samples, true);
}

template <class Void>
Result<BasicSampleArray<Void>> BasicSampleArray<Void>::sample_rows(std::span<Element<float>> values,
                                                                   std::size_t samples) {
  return packed_samples<BasicSampleArray>(values, ElementType::kFloat, samples, false);
}

template <class Void>
Result<BasicSampleArray<Void>> BasicSampleArray<Void>::sample_rows_of_halves(
    std::span<Element<std::uint16_t>> patterns, std::size_t samples) {
  return packed_samples<BasicSampleArray>(patterns, ElementType::kHalf, samples, false);
}

template struct BasicSampleArray<const void>;
template struct BasicSampleArray<void>;

Result<void> read_samples(SampleArray array, SampledSpectraSpan spectra, const Execution& execution) {
  SPECTILE_ASSIGN(const auto from, matched_samples<const std::byte>(array, spectra));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  tiles::for_blocks(spectra.blocks(), execution, [&](std::size_t first, std::size_t count) {
    for (std::size_t block = first; block < first + count; ++block)
      arrays::load_block(*table, from, block * kLanesPerBlock, spectra.row(block, 0));
  });
  return {};
}

Result<void> write_samples(SampledSpectraView spectra, MutableSampleArray array, const Execution& execution) {
  SPECTILE_ASSIGN(const auto to, matched_samples<std::byte>(array, spectra));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  tiles::for_blocks(spectra.blocks(), execution, [&](std::size_t first, std::size_t count) {
    for (std::size_t block = first; block < first + count; ++block)
      arrays::store_block(*table, spectra.row(block, 0), to, block * kLanesPerBlock);
  });
  return {};
}

}  // namespace spectile
