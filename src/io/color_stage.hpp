// ColorStage: from an image's samples to the RGB of a method, with every check on the way.
#pragma once

#include <array>
#include <optional>
#include <spectile/image.hpp>
#include <string>

#include "kernels/abi.hpp"
#include "src/io/conversion.hpp"
#include "src/io/lines.hpp"
#include "src/io/rgb_source.hpp"

namespace spectile::io {

/// The way of a line of colour: samples as floats; what is not finite; components below 0 in the input's own
/// space; the matrix to the method's RGB; colours that the method cannot make.
class ColorStage {
 public:
  ColorStage(const RgbSource& source, const Upsampler& upsampler, const MethodOptions& options,
             const kernels::KernelTable& kernels);

  /// Makes a line. Returns the largest magnitude of a component.
  float line(const Strip& strip, int line, const ColorLine& color, LineStats& stats) const;

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

}  // namespace spectile::io
