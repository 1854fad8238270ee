// StraightColor: premultiplied colours taken apart into straight ones and a scale, where a method needs it.
#pragma once

#include <cstddef>
#include <optional>
#include <spectile/image/image.hpp>
#include <string>
#include <vector>

#include "src/io/convert/frame/conversion.hpp"
#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// The spectrum of half a colour is half the colour's for every method but the sigmoid's reflectances, which
/// are of another shape. There the straight colour is made into a spectrum, which is then scaled:
///
///   spectrum(rgb) = s * sigmoid(rgb / s),  s = max(a, min(1, largest magnitude of a component))
///
/// for alpha a in (0, 1), and s = 1 elsewhere, so that opaque colours, and those of alpha 0, stay what they
/// are. s is a for every premultiplied reflectance; a colour above its alpha is no reflectance, of which
/// division by alpha alone would leave nothing but white.
class StraightColor {
 public:
  /// All must outlive it.
  StraightColor(const RgbSource& source, const Upsampler& upsampler, const MethodOptions& options,
                const kernels::KernelTable& kernels);

  /// True where colours have to be taken apart. If not, there are no scales.
  bool needed() const noexcept { return plane_.has_value(); }

  /// Divides the colours of a line, of the method's RGB, by their scales, which it makes. Shapes: rgb three
  /// times [padded], scale [padded]; scales are 1 after the last pixel. Counts the colours above their alpha.
  void divide(const Strip& strip, int line, float* const rgb[3], float* scale, LineStats& stats) const;

 private:
  std::optional<std::size_t> plane_;
  SampleType type_ = SampleType::kHalf;
  const kernels::KernelTable& kernels_;
};

/// Appends notes on what was made of alpha: that it was `assumed` to be premultiplied, where that mattered,
/// and on colours above their alpha.
void note_alpha(const LineStats& stats, bool assumed, std::vector<std::string>& notes);

}  // namespace spectile::io
