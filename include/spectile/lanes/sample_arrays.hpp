// Spectra in memory that the caller owns, [n][K] or [K][n], to batches and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/lanes/element_type.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <type_traits>

namespace spectile {

/// View of n lanes of K samples in memory that the caller owns. Shapes: sample k of lane i is element
/// i * lane_stride + k * sample_stride of `data`, which may start at any address; the samples of a lane lie
/// within one lane stride ([n][K]), or the lanes of a sample within one sample stride ([K][n]).
template <class Void>
struct BasicSampleArray {
  template <class T>
  using Element = std::conditional_t<std::is_const_v<Void>, const T, T>;

  Void* data = nullptr;
  ElementType type = ElementType::kFloat;  ///< kFloat or kHalf
  std::size_t lanes = 0;
  std::size_t samples = 0;
  std::ptrdiff_t lane_stride = 0;    ///< elements
  std::ptrdiff_t sample_stride = 1;  ///< elements

  /// A lane a row: [n][samples], packed. Errors: kBadArgument for no samples; kSizeMismatch for values that
  /// are not a multiple of them.
  static Result<BasicSampleArray> lane_rows(std::span<Element<float>> values, std::size_t samples);
  /// The same of the patterns of halves.
  static Result<BasicSampleArray> lane_rows_of_halves(std::span<Element<std::uint16_t>> patterns,
                                                      std::size_t samples);
  /// A sample a row: [samples][n], packed (planar). Errors: as lane_rows().
  static Result<BasicSampleArray> sample_rows(std::span<Element<float>> values, std::size_t samples);
  /// The same of the patterns of halves.
  static Result<BasicSampleArray> sample_rows_of_halves(std::span<Element<std::uint16_t>> patterns,
                                                        std::size_t samples);

  operator BasicSampleArray<const void>() const requires(!std::is_const_v<Void>) {
    return {data, type, lanes, samples, lane_stride, sample_stride};
  }
};
using SampleArray = BasicSampleArray<const void>;   ///< to read
using MutableSampleArray = BasicSampleArray<void>;  ///< to write

extern template struct BasicSampleArray<const void>;
extern template struct BasicSampleArray<void>;

/// Reads samples into a batch, on bands or at wavelengths of each lane's own: wavelengths and densities too.
/// The padding of the last block becomes 0. The array may not overlap the batch. Units: floats as they are,
/// bit by bit; halves exactly, NaN made quiet. Errors: kBandsMismatch for another K; kSizeMismatch for other
/// lanes; kBadArgument for integers, no data, strides below one element or at which elements overlap, and a
/// batch that does not start at a multiple of 64 bytes.
Result<void> read_samples(SampleArray array, SampledSpectraSpan spectra, const Execution& execution = {});

/// Writes a batch into samples. Nothing else of the array's memory is read or written. The array may not
/// overlap the batch. Units: floats as they are, bit by bit; halves as in write_pixels(). Errors: as
/// read_samples().
Result<void> write_samples(SampledSpectraView spectra, MutableSampleArray array,
                           const Execution& execution = {});

}  // namespace spectile
