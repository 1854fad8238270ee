// ColorStage: from an image's samples to the RGB of a method, with every check on the way.
#pragma once

#include <array>
#include <optional>
#include <spectile/image/image.hpp>
#include <string>

#include "kernels/abi.hpp"
#include "src/io/convert/frame/conversion.hpp"
#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/convert/stages/lines.hpp"

namespace spectile::io {

/// The way of a line of colour: samples as floats; what is not finite; components below 0 in the input's own
/// space; the matrix to the method's RGB; colours that the method cannot make.
class ColorStage {
 public:
  ColorStage(const RgbSource& source, const Upsampler& upsampler, const MethodOptions& options,
             const kernels::KernelTable& kernels);

  /// Makes a line, in the three steps below; `color` has the width of the strip's lines. Returns the largest
  /// magnitude of a component.
  float line(const Strip& strip, int line, const ColorLine& color, LineStats& stats) const;

  /// A line's samples as floats.
  void load(const Strip& strip, int line, const ColorLine& color) const;
  /// The largest magnitude of a component, and whether there may be colours that the method cannot make.
  struct Sanitized {
    float largest = 0;
    bool may_be_outside = false;
  };
  /// Treats pixels that are not finite, checks the range, and converts to the method's RGB.
  Sanitized sanitize(int line, const ColorLine& color, std::size_t width, LineStats& stats) const;
  /// Colours of the method's RGB that it cannot make, of the whole line.
  void clip_to_gamut(int line, const ColorLine& color, std::size_t width, LineStats& stats) const;

  /// The space that the input's RGB is taken for.
  const RgbSpace& space() const noexcept { return space_; }
  GamutPolicy out_of_gamut() const noexcept { return out_of_gamut_; }
  /// The error that what was found makes of the conversion, if it forbids an output.
  std::optional<Error> refusal(const std::string& path, const LineStats& stats) const;

 private:
  const RgbSource& source_;
  const Upsampler& upsampler_;
  const MethodOptions& options_;
  const kernels::KernelTable& kernels_;
  RgbSpace space_;
  GamutPolicy out_of_gamut_;
  std::array<float, 9> matrix_{};
  bool convert_ = false;
};

/// The upsampler that the options ask for.
Result<Upsampler> upsampler_for(const MethodOptions& options);

/// Notes nodes that could not have all of what was learned of them.
void note_nodes(const Upsampler& upsampler, std::vector<std::string>& notes);

}  // namespace spectile::io
