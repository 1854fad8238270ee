// The scalar array-of-structures (AoS) baseline: a struct of samples a pixel with its operators, one pixel
// after the other, in plain C++ for the compiler to do its best with. Compiled once per level of the
// processor.
#pragma once

#include <cstddef>

namespace spectile::measure {

inline constexpr std::size_t kMaxAosSamples = 60;

/// Constants of the functions below. Shapes: basis [7][samples]: white, cyan, magenta, yellow, red, green,
/// blue; light [samples]; matching [3][samples].
struct AosTables {
  float basis[7][kMaxAosSamples];
  float light[kMaxAosSamples];
  float matching[3][kMaxAosSamples];
  float first_centre_nm, per_nm;  ///< of the samples' bands, which are even
  float lambda[kMaxAosSamples];   ///< argument of a sigmoid's quadratic at each sample
  float coefficients[3];          ///< of the sigmoid that is sampled at wavelengths
  float exponent;                 ///< of pow
  float planck_nm;                ///< second radiation constant over the temperature
  float first_nm;
  const float* even;  ///< values at every nanometre from first_nm on
  int even_count;
  const float* knots_nm;  ///< ascending
  const float* knot_values;
  int knots;
  const float* texels;  ///< [texture_side][texture_side][3]: RGB, or coefficients of sigmoids
  int texture_side;
};

/// n items, each of so many floats in and out, one behind the other.
using AosFunction = void (*)(const AosTables& tables, const float* in, float* out, std::size_t n);

struct AosPixel {
  double xyz[3];
  double weight;
};

/// Jobs on one number of samples.
struct AosJob {
  std::size_t samples;
  /// RGB to XYZ: upsampled, times the light, summed with the matching functions.
  AosFunction relight;
  /// n samples of radiance [n][samples], each to the pixel of its number, with a weight.
  void (*add)(const AosTables& tables, const float* radiance, const float* weight, const std::size_t* pixel,
              AosPixel* film, std::size_t n);
};

/// A sample of four wavelengths. Units: nm, 1/nm.
struct AosFilmSample {
  float radiance[4];
  float lambda_nm[4];
  float density[4];
  float weight;
};

struct AosBucket {
  double sum;
  double weight;
};

/// Pixels row by row, no locks; with buckets of even width where there are any.
struct AosFilm {
  int width, height;
  const float* curves[3];  ///< at every nanometre from 360 to 830; radiance 1 throughout has Y = 1
  float max_component;
  AosPixel* pixels;
  AosBucket* buckets;  ///< [pixel][bucket_count]
  int bucket_count;
  float first_nm, last_nm;  ///< of the buckets
};

/// u: a number a sample in [0, 1), where wavelengths are drawn.
using AosFilmFunction = void (*)(const AosFilm& film, const float* x, const float* y, const float* u,
                                 const AosFilmSample* samples, std::size_t n);

inline constexpr std::size_t kAosJobs = 3;  // 16, 30 and 60 samples

struct AosBaseline {
  const char* compiled_for;
  AosJob jobs[kAosJobs];
  // Spectra of 60 samples.
  AosFunction upsample, upsample_fused, project, luminance, sigmoid;
  /// Sample by sample; multiply() and transmittance() take n of their first operand, then n of their second.
  AosFunction multiply, exp, transmittance, pow;
  // Wavelength by wavelength.
  AosFunction interpolate_even, interpolate_knots, planck, sigmoid_at;
  /// Three numbers and 4 wavelengths to 4 samples: of a mixture of the basis, by a branch and by an index,
  /// and of a sigmoid.
  AosFunction mixture_at, mixture_at_fused, sigmoids_at;
  /// Coordinates and 4 wavelengths to 4 samples of a bilinear texture: the mean of four mixtures; the mixture
  /// of filtered weights; the mean of four sigmoids.
  AosFunction texture_of_colors, texture_of_colors_fused, texture_of_sigmoids;
  AosFunction update_throughput;  ///< four samples, four, a density and a random number
  /// 4 wavelengths and their densities, drawn as the eye sees from one number.
  AosFunction draw_visible;
  /// The nearest nanometre of each curve by lround; by a conversion (tuned by hand); with wavelengths drawn
  /// first; into buckets too.
  AosFilmFunction film_add, film_add_tuned, film_add_drawing, film_add_buckets;
};

/// The one compiled for the widest level that the processor has.
const AosBaseline& aos_baseline();

}  // namespace spectile::measure
