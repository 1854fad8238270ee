// The film of the AoS baseline: a part of aos_baseline_levels.cpp.

enum class Rounding { kLround, kConversion };

template <Rounding kRounding>
float nearest(const float* curve, float lambda_nm) {
  const long at =
      (kRounding == Rounding::kLround ? lroundf(lambda_nm) : static_cast<int>(lambda_nm + 0.5F)) - 360;
  return at < 0 || at > 470 ? 0 : curve[at];
}

/// The pixel's number, or a negative one outside.
std::ptrdiff_t pixel_at(const AosFilm& film, float x, float y) {
  const int px = static_cast<int>(floorf(x));
  const int py = static_cast<int>(floorf(y));
  if (px < 0 || py < 0 || px >= film.width || py >= film.height) return -1;
  return static_cast<std::ptrdiff_t>(py) * film.width + px;
}

template <Rounding kRounding>
void add_sample(const AosFilm& film, std::ptrdiff_t at, const AosFilmSample& s) {
  float ratio[4];
  for (int k = 0; k < 4; ++k) ratio[k] = s.density[k] != 0 ? s.radiance[k] / s.density[k] : 0;
  float xyz[3];
  float most = 0;
  for (int c = 0; c < 3; ++c) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) sum += nearest<kRounding>(film.curves[c], s.lambda_nm[k]) * ratio[k];
    xyz[c] = sum / 4;
    most = xyz[c] > most ? xyz[c] : most;
  }
  if (most > film.max_component) {
    for (float& v : xyz) v *= film.max_component / most;
  }
  if (at < 0) return;
  AosPixel& pixel = film.pixels[at];
  for (int c = 0; c < 3; ++c) pixel.xyz[c] += static_cast<double>(s.weight * xyz[c]);
  pixel.weight += static_cast<double>(s.weight);
}

template <Rounding kRounding>
void film_add(const AosFilm& film, const float* x, const float* y, const float* /*u*/,
              const AosFilmSample* samples, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) add_sample<kRounding>(film, pixel_at(film, x[i], y[i]), samples[i]);
}

void film_add_drawing(const AosFilm& film, const float* x, const float* y, const float* u,
                      const AosFilmSample* samples, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    AosFilmSample s = samples[i];
    draw(u[i], s.lambda_nm, s.density);
    add_sample<Rounding::kLround>(film, pixel_at(film, x[i], y[i]), s);
  }
}

void film_add_buckets(const AosFilm& film, const float* x, const float* y, const float* /*u*/,
                      const AosFilmSample* samples, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const AosFilmSample& s = samples[i];
    const std::ptrdiff_t at = pixel_at(film, x[i], y[i]);
    add_sample<Rounding::kLround>(film, at, s);
    if (at < 0) continue;
    float most = 0;
    for (const float v : s.radiance) most = v > most ? v : most;
    const float scale = most > film.max_component ? s.weight * film.max_component / most : s.weight;
    for (int k = 0; k < 4; ++k) {
      if (!(s.lambda_nm[k] >= film.first_nm) || s.lambda_nm[k] >= film.last_nm) continue;
      const float part = (s.lambda_nm[k] - film.first_nm) / (film.last_nm - film.first_nm);
      int b = static_cast<int>(part * static_cast<float>(film.bucket_count));
      b = b < film.bucket_count ? b : film.bucket_count - 1;
      AosBucket& bucket = film.buckets[at * film.bucket_count + b];
      bucket.sum += static_cast<double>(s.radiance[k] * scale);
      bucket.weight += static_cast<double>(s.weight);
    }
  }
}
