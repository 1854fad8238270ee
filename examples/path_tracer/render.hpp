// Rendering of a scene to a film by several workers.
#pragma once

#include "wavefront.hpp"

namespace tracer {

/// A film, and the time that it took: the processor's, which other programs do not lengthen much.
struct Rendered {
  Film film;           ///< XYZ of the CIE 1931 observer
  Times times;         ///< of all workers together
  double seconds = 0;  ///< of the processor, likewise
  TextureCacheStats cache;
};
Result<Rendered> render(const Scene& scene, const SpectralScene& spectra, const RenderSettings& settings);

/// XYZ of a lamp at Y = 1.
Result<std::array<double, 3>> white_of(const Lamp& lamp);

/// XYZ of a film's pixels. Shapes: lane y * size + x.
Result<ColorLanes> xyz_of(const Film& film);

}  // namespace tracer
