// A film as the field's textbooks write it, with all that the compiler can do for this machine.
#include "bench/micro/textbook_film.hpp"

#include <algorithm>
#include <cmath>

namespace textbook {
namespace {

struct ByLround {
  float operator()(const Curve& curve, float lambda_nm) const {
    const long at = std::lround(lambda_nm) - curve.first_nm;
    if (at < 0 || at >= static_cast<long>(curve.values.size())) return 0;
    return curve.values[static_cast<std::size_t>(at)];
  }
};

struct ByConversion {
  float operator()(const Curve& curve, float lambda_nm) const {
    const int at = static_cast<int>(lambda_nm + 0.5F) - curve.first_nm;
    if (at < 0 || at >= static_cast<int>(curve.values.size())) return 0;
    return curve.values[static_cast<std::size_t>(at)];
  }
};

/// The pixel's number, or a negative one outside.
inline std::ptrdiff_t pixel_of(const Film& film, float x, float y) {
  const int px = static_cast<int>(std::floor(x));
  const int py = static_cast<int>(std::floor(y));
  if (px < 0 || py < 0 || px >= film.width || py >= film.height) return -1;
  return static_cast<std::ptrdiff_t>(py) * film.width + px;
}

template <class LookUp>
inline void add_one(Film& film, std::ptrdiff_t at, const FilmSample& s, LookUp look_up) {
  float ratio[4];
  for (int k = 0; k < 4; ++k) ratio[k] = s.density[k] != 0 ? s.radiance[k] / s.density[k] : 0;
  float rgb[3];
  for (int c = 0; c < 3; ++c) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) sum += look_up(film.curves[c], s.lambda_nm[k]) * ratio[k];
    rgb[c] = sum / 4;
  }
  const float most = std::max(rgb[0], std::max(rgb[1], rgb[2]));
  if (most > film.maximum_component) {
    for (float& v : rgb) v *= film.maximum_component / most;
  }
  if (at < 0) return;
  FilmPixel& pixel = film.pixels[static_cast<std::size_t>(at)];
  for (int c = 0; c < 3; ++c) pixel.rgb[c] += s.weight * rgb[c];
  pixel.weight += s.weight;
}

}  // namespace

// Constants: Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, section 4.5.4.
float draw_visible(float u) {
  return 538 - 138.888889F * std::atanh(0.85691062F - 1.82750197F * u);
}
float visible_density(float lambda_nm) {
  if (lambda_nm < 360 || lambda_nm > 830) return 0;
  const float cosh = std::cosh(0.0072F * (lambda_nm - 538));
  return 0.0039398042F / (cosh * cosh);
}

void Film::add(const float* x, const float* y, const FilmSample* samples, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) add_one(*this, pixel_of(*this, x[i], y[i]), samples[i], ByLround());
}

void Film::add_tuned(const float* x, const float* y, const FilmSample* samples, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    add_one(*this, pixel_of(*this, x[i], y[i]), samples[i], ByConversion());
  }
}

void Film::add_drawing(const float* x, const float* y, const float* u, const FilmSample* samples,
                       std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    FilmSample s = samples[i];
    for (int k = 0; k < 4; ++k) {
      float up = u[i] + static_cast<float>(k) / 4;
      if (up > 1) up -= 1;
      s.lambda_nm[k] = draw_visible(up);
      s.density[k] = visible_density(s.lambda_nm[k]);
    }
    add_one(*this, pixel_of(*this, x[i], y[i]), s, ByLround());
  }
}

void BucketFilm::add(const float* x, const float* y, const FilmSample* samples, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const FilmSample& s = samples[i];
    const std::ptrdiff_t at = pixel_of(color, x[i], y[i]);
    add_one(color, at, s, ByLround());
    if (at < 0) continue;
    float scale = s.weight;
    const float most =
        std::max(std::max(s.radiance[0], s.radiance[1]), std::max(s.radiance[2], s.radiance[3]));
    if (most > color.maximum_component) scale *= color.maximum_component / most;
    Bucket* const pixel = sums.data() + at * buckets;
    for (int k = 0; k < 4; ++k) {
      if (!(s.lambda_nm[k] >= first_nm) || s.lambda_nm[k] >= last_nm) continue;
      const int b =
          static_cast<int>((s.lambda_nm[k] - first_nm) / (last_nm - first_nm) * static_cast<float>(buckets));
      Bucket& bucket = pixel[std::clamp(b, 0, buckets - 1)];
      bucket.sum += s.radiance[k] * scale;
      bucket.weight += s.weight;
    }
  }
}

}  // namespace textbook
