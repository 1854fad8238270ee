// The bands of a spectral output: their channels, the attributes that go with them, and their samples,
// packed.
#pragma once

#include <array>
#include <cstdint>
#include <spectile/image/image.hpp>
#include <string>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/exr/exr_writer.hpp"
#include "src/upsampling/sampled_rows.hpp"

namespace spectile::io {

/// Appends a channel for each band to a spec.
void add_band_channels(std::vector<ChannelSpec>& channels, const Bands& bands, Quantity quantity,
                       SampleType type);

/// Names of the layout's own attributes.
std::vector<std::string> layout_attribute_names();
/// Those and the names of method_attributes(): all that say how spectra were made.
std::vector<std::string> spectral_attribute_names();
/// Appends the layout's own attributes, and the plan of the bands where they have one: name and text.
void add_layout_attributes(TextAttributes& texts, Quantity quantity, const Bands& bands);

/// Coefficients of a line, at multiples of 64 bytes and readable up to whole blocks.
struct LineCoefficients {
  const float* c[3] = {nullptr, nullptr, nullptr};
  const float* scale = nullptr;  ///< null where there is none
};

/// Largest magnitude in a row; NaN where it holds one.
float largest_magnitude(const float* row, std::size_t n);

/// Packs the samples of a line's bands into an output line.
class BandPacker {
 public:
  /// Work space of one slot.
  struct Work {
    std::vector<void*> rows;  // where each band of the present segment goes
    FloatBuffer block;        // spectra of 64 pixels, to count those that a half cannot hold
    // Samples of the colour that filled a run last, as they are packed, and that colour's coefficients.
    std::vector<std::uint32_t> filler;
    std::array<std::uint32_t, 4> filler_of{};
    bool has_filler = false;
  };

  /// The kernels and the rows must outlive it.
  BandPacker(const kernels::KernelTable& kernels, const rows::SampledRows& rows, const ImageOptions& options);

  /// Errors: kOutOfMemory.
  Result<Work> work() const;

  /// Packs `width` pixels at `packed`, the first band being the writer's channel `first`. Returns how many
  /// have a sample that was clamped to the largest half.
  std::uint64_t line(Work& work, const LineCoefficients& of, std::size_t width, const ExrWriter& writer,
                     std::size_t first, std::byte* packed) const;

  /// `pixels` pixels from pixel `at`, a multiple of 64, on, of a line of `width`.
  struct Part {
    std::size_t at = 0;
    std::size_t pixels = 0;
    std::size_t width = 0;
  };
  /// The same for a part of a line; none is counted.
  void run(Work& work, const LineCoefficients& of, const Part& part, const ExrWriter& writer,
           std::size_t first, std::byte* packed) const;
  /// The same bytes for pixels that all have the coefficients of the first.
  void fill(Work& work, const LineCoefficients& of, const Part& part, const ExrWriter& writer,
            std::size_t first, std::byte* packed) const;
  /// How many pixels of a line have a sample that was clamped.
  std::uint64_t clamped(Work& work, const LineCoefficients& of, std::size_t width) const;

 private:
  bool may_exceed_half(const LineCoefficients& of, std::size_t width) const;
  std::uint64_t count_clamped(Work& work, const LineCoefficients& of, std::size_t width) const;

  const kernels::KernelTable& kernels_;
  const rows::SampledRows& rows_;
  bool half_ = false;
  std::size_t segment_ = 0;
};

}  // namespace spectile::io
