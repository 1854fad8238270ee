// BandFilter: what of a method's spectra is averaged for mip levels, so that averages are those of spectra.
#pragma once

#include <atomic>
#include <cstddef>
#include <spectile/image/image.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "kernels/abi.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/exr/strips.hpp"
#include "src/upsampling/sampled_rows.hpp"

namespace spectile::io {

/// True if the spectrum of averaged coefficients is the average of the spectra, where no sample is clamped.
bool linear_in_coefficients(const Upsampler& upsampler);

/// Three coefficients in the planes of a strip, from plane `first` on.
LineCoefficients coefficients_in(const Strip& strip, int line, std::size_t first);

/// The least that has the averages of spectra: the RGB of methods that are linear in it; else the weights of
/// the seven bases, where samples are linear in them; else the samples of all bands. Averages of float
/// samples all, before they are clamped to halves.
class BandFilter {
 public:
  /// Work space of one slot.
  struct Work {
    FloatBuffer row;
    FloatBuffer halves;
  };

  /// All must outlive it. `stored`: the coefficients are written, and so averaged.
  BandFilter(const kernels::KernelTable& kernels, const Upsampler& upsampler, const rows::SampledRows& rows,
             const BandPacker& packer, const ImageOptions& options, bool stored);

  /// Errors: kOutOfMemory.
  Result<Work> work(int width) const;

  /// Must have seen every line before rows() is asked: a component below 0 can make samples that are clamped.
  /// Any number of threads may call it.
  void scan(const LineCoefficients& of, std::size_t width);

  /// Rows that are averaged.
  std::size_t rows() const noexcept;
  /// The rows of a line.
  void filter(const LineCoefficients& of, std::size_t width, float* const* out) const;
  /// Where averaged rows are.
  struct Averages {
    const Strip& strip;
    int line;
    std::size_t first;  // plane
  };
  /// Packs the bands of a level's line, the first being the writer's channel `first`.
  void pack(Work& work, BandPacker::Work& bands, const Averages& from, const ExrWriter& writer,
            std::size_t first, std::byte* packed) const;

 private:
  enum class Kind { kCoefficients, kWeights, kSamples };
  Kind kind() const noexcept;
  void store(Work& work, const float* row, std::size_t width, std::byte* out) const;

  const kernels::KernelTable& kernels_;
  const rows::SampledRows& rows_;
  const BandPacker& packer_;
  const ImageOptions& options_;
  bool stored_ = false;
  bool coefficients_ = false;  // linear in them
  bool linear_ = false;        // whatever the components
  bool linear_above_ = false;  // as long as none is below 0
  std::atomic<bool> below_ = false;
};

}  // namespace spectile::io
