// The textbook's way, compiled with -O3 -march=native: the baseline of the benchmarks.
#include "bench/micro/textbook.hpp"

#include <limits>

namespace textbook {
namespace {

// --- The textbook's class: every operator a loop over the samples, results by value
// ------------------------------

struct Spectrum : SampledSpectrum {
  explicit Spectrum(float v = 0) {
    for (float& sample : c) sample = v;
  }
  explicit Spectrum(const SampledSpectrum& s) : SampledSpectrum(s) {}
  Spectrum& operator+=(const Spectrum& s) {
    for (int i = 0; i < kSamples; ++i) c[i] += s.c[i];
    return *this;
  }
  Spectrum operator*(float a) const {
    Spectrum r = *this;
    for (float& sample : r.c) sample *= a;
    return r;
  }
  Spectrum& operator*=(float a) {
    for (float& sample : c) sample *= a;
    return *this;
  }
  Spectrum clamped(float low = 0, float high = std::numeric_limits<float>::infinity()) const {
    Spectrum r;
    for (int i = 0; i < kSamples; ++i) r.c[i] = c[i] < low ? low : (c[i] > high ? high : c[i]);
    return r;
  }
};

Spectrum operator*(float a, const SampledSpectrum& s) {
  return Spectrum(s) * a;
}

SampledSpectrum operator*(const SampledSpectrum& a, const SampledSpectrum& b) {
  SampledSpectrum r;
  for (int i = 0; i < kSamples; ++i) r.c[i] = a.c[i] * b.c[i];
  return r;
}

__attribute__((noinline)) Spectrum from_rgb(const Tables& t, const float* rgb) {
  Spectrum r;
  if (rgb[0] <= rgb[1] && rgb[0] <= rgb[2]) {
    r += rgb[0] * t.white;
    if (rgb[1] <= rgb[2]) {
      r += (rgb[1] - rgb[0]) * t.cyan;
      r += (rgb[2] - rgb[1]) * t.blue;
    } else {
      r += (rgb[2] - rgb[0]) * t.cyan;
      r += (rgb[1] - rgb[2]) * t.green;
    }
  } else if (rgb[1] <= rgb[0] && rgb[1] <= rgb[2]) {
    r += rgb[1] * t.white;
    if (rgb[0] <= rgb[2]) {
      r += (rgb[0] - rgb[1]) * t.magenta;
      r += (rgb[2] - rgb[0]) * t.blue;
    } else {
      r += (rgb[2] - rgb[1]) * t.magenta;
      r += (rgb[0] - rgb[2]) * t.red;
    }
  } else {
    r += rgb[2] * t.white;
    if (rgb[0] <= rgb[1]) {
      r += (rgb[0] - rgb[2]) * t.yellow;
      r += (rgb[1] - rgb[0]) * t.green;
    } else {
      r += (rgb[1] - rgb[2]) * t.yellow;
      r += (rgb[0] - rgb[1]) * t.red;
    }
  }
  r *= t.scale;
  return r.clamped();
}

// --- The same layout with the loops fused by hand
// ------------------------------------------------------------------

void fused(const Tables& t, const float* rgb, SampledSpectrum& out) {
  const SampledSpectrum* second = nullptr;
  const SampledSpectrum* first = nullptr;
  float low = 0;
  float middle = 0;
  float high = 0;
  const float r = rgb[0];
  const float g = rgb[1];
  const float b = rgb[2];
  if (r <= g && r <= b) {
    second = &t.cyan;
    first = g <= b ? &t.blue : &t.green;
    low = r;
    middle = g <= b ? g : b;
    high = g <= b ? b : g;
  } else if (g <= r && g <= b) {
    second = &t.magenta;
    first = r <= b ? &t.blue : &t.red;
    low = g;
    middle = r <= b ? r : b;
    high = r <= b ? b : r;
  } else {
    second = &t.yellow;
    first = r <= g ? &t.green : &t.red;
    low = b;
    middle = r <= g ? r : g;
    high = r <= g ? g : r;
  }
  const float w0 = low * t.scale;
  const float w1 = (middle - low) * t.scale;
  const float w2 = (high - middle) * t.scale;
  for (int i = 0; i < kSamples; ++i) {
    const float v = w0 * t.white.c[i] + w1 * second->c[i] + w2 * first->c[i];
    out.c[i] = v < 0 ? 0 : v;
  }
}

}  // namespace

void upsample_fused(const Tables& tables, const float* rgb, SampledSpectrum* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) fused(tables, rgb + 3 * i, out[i]);
}

void upsample(const Tables& tables, const float* rgb, SampledSpectrum* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = from_rgb(tables, rgb + 3 * i);
}

void project(const Tables& tables, const SampledSpectrum* in, float* xyz, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float x = 0;
    float y = 0;
    float z = 0;
    for (int k = 0; k < kSamples; ++k) {
      x += tables.x.c[k] * in[i].c[k];
      y += tables.y.c[k] * in[i].c[k];
      z += tables.z.c[k] * in[i].c[k];
    }
    xyz[3 * i] = x;
    xyz[3 * i + 1] = y;
    xyz[3 * i + 2] = z;
  }
}

void luminance(const Tables& tables, const SampledSpectrum* in, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float sum = 0;
    for (int k = 0; k < kSamples; ++k) sum += tables.y.c[k] * in[i].c[k];
    y[i] = sum;
  }
}

void relight(const Tables& tables, const SampledSpectrum& light, const float* matrix, const float* rgb,
             float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const SampledSpectrum lit = from_rgb(tables, rgb + 3 * i) * light;
    float xyz[3];
    project(tables, &lit, xyz, 1);
    for (int k = 0; k < 3; ++k) {
      out[3 * i + static_cast<std::size_t>(k)] =
          matrix[3 * k] * xyz[0] + matrix[3 * k + 1] * xyz[1] + matrix[3 * k + 2] * xyz[2];
    }
  }
}

void multiply(const SampledSpectrum* a, const SampledSpectrum* b, SampledSpectrum* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] * b[i];
}

}  // namespace textbook
