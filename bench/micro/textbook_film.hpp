// A film as the field's textbooks write it: one sample after the other, sums in double.
#pragma once

#include <cstddef>
#include <vector>

namespace textbook {

/// Every nanometre from first_nm on, scaled so that radiance 1 throughout has Y = 1.
struct Curve {
  int first_nm = 0;
  std::vector<float> values;
};

/// A sample of four wavelengths. Units: nm, 1/nm.
struct FilmSample {
  float radiance[4];
  float lambda_nm[4];
  float density[4];
  float weight;
};

struct FilmPixel {
  double rgb[3] = {0, 0, 0};
  double weight = 0;
};

/// Pixels row by row, no locks.
struct Film {
  int width = 0;
  int height = 0;
  Curve curves[3];
  float maximum_component = 0;
  std::vector<FilmPixel> pixels;

  /// The nearest nanometre of each curve by std::lround, as in Pharr, Jakob, Humphreys, Physically Based
  /// Rendering, 4th edition.
  void add(const float* x, const float* y, const FilmSample* samples, std::size_t n);
  /// The same with int(lambda + 0.5) in place of the library's call.
  void add_tuned(const float* x, const float* y, const FilmSample* samples, std::size_t n);
  /// The same as add(), but wavelengths and densities are drawn first, from one number u a sample.
  void add_drawing(const float* x, const float* y, const float* u, const FilmSample* samples, std::size_t n);
};

/// Buckets of even width: a pixel is `buckets` pairs of sums, of weighted values and of weights.
struct BucketFilm {
  struct Bucket {
    double sum = 0;
    double weight = 0;
  };
  Film color;
  int buckets = 0;
  float first_nm = 0;
  float last_nm = 0;
  std::vector<Bucket> sums;  ///< [pixel][bucket]

  void add(const float* x, const float* y, const FilmSample* samples, std::size_t n);
};

/// The visible density's wavelength for u in [0, 1), and its density.
float draw_visible(float u);
float visible_density(float lambda_nm);

}  // namespace textbook
