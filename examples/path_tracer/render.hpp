// Rendering of a scene to a film by several workers.
#pragma once

#include "wavefront.hpp"

namespace tracer {

/// The film for a representation: XYZ of the CIE 1931 observer.
FilmOptions film_options(const SpectralScene& spectra, const RenderSettings& settings);

/// Adds all samples of the settings to a film.
Result<Times> render(const Scene& scene, const SpectralScene& spectra, const RenderSettings& settings,
                     Film& film);

/// A film of its own, and the time that it took: the processor's, which other programs do not lengthen much.
struct Rendered {
  Film film;
  Times times;         ///< of all workers together
  double seconds = 0;  ///< of the processor, likewise
  TextureCacheStats cache;
};
Result<Rendered> render(const Scene& scene, const SpectralScene& spectra, const RenderSettings& settings);

/// XYZ of a film's pixels. Shapes: lane y * size + x.
Result<ColorLanes> xyz_of(const Film& film);

}  // namespace tracer
