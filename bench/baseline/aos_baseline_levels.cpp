// The AoS baseline. One translation unit, compiled once per level of the processor; see aos_baseline.hpp.
//
// No algorithms or containers here, and only C's mathematics: what the linker would share between levels must
// not be compiled for one.
#include <math.h>

#include "bench/baseline/aos_baseline.hpp"

namespace spectile::measure {
namespace {

/// A sampled spectrum with the usual operators.
template <int kSamples>
struct SampledSpectrum {
  float c[kSamples];

  SampledSpectrum& operator+=(const SampledSpectrum& other) {
    for (int i = 0; i < kSamples; ++i) c[i] += other.c[i];
    return *this;
  }
  SampledSpectrum operator*(float a) const {
    SampledSpectrum out = *this;
    for (int i = 0; i < kSamples; ++i) out.c[i] *= a;
    return out;
  }
  SampledSpectrum operator*(const SampledSpectrum& other) const {
    SampledSpectrum out = *this;
    for (int i = 0; i < kSamples; ++i) out.c[i] *= other.c[i];
    return out;
  }
  SampledSpectrum clamped() const {
    SampledSpectrum out = *this;
    for (int i = 0; i < kSamples; ++i) out.c[i] = out.c[i] < 0 ? 0 : out.c[i];
    return out;
  }
};

template <int kSamples>
SampledSpectrum<kSamples> load(const float* samples) {
  SampledSpectrum<kSamples> out;
  for (int i = 0; i < kSamples; ++i) out.c[i] = samples[i];
  return out;
}

/// Sum of the least component of white, then what is left of a secondary, then of a primary.
/// Source: Smits, An RGB-to-Spectrum Conversion for Reflectances, J. Graphics Tools 4(4), 1999.
template <int kSamples>
SampledSpectrum<kSamples> from_rgb(const SampledSpectrum<kSamples>* basis, const float* rgb) {
  const float r = rgb[0];
  const float g = rgb[1];
  const float b = rgb[2];
  enum { kWhite, kCyan, kMagenta, kYellow, kRed, kGreen, kBlue };
  SampledSpectrum<kSamples> out{};
  if (r <= g && r <= b) {
    out += basis[kWhite] * r;
    if (g <= b) {
      out += basis[kCyan] * (g - r);
      out += basis[kBlue] * (b - g);
    } else {
      out += basis[kCyan] * (b - r);
      out += basis[kGreen] * (g - b);
    }
  } else if (g <= r && g <= b) {
    out += basis[kWhite] * g;
    if (r <= b) {
      out += basis[kMagenta] * (r - g);
      out += basis[kBlue] * (b - r);
    } else {
      out += basis[kMagenta] * (b - g);
      out += basis[kRed] * (r - b);
    }
  } else {
    out += basis[kWhite] * b;
    if (r <= g) {
      out += basis[kYellow] * (r - b);
      out += basis[kGreen] * (g - r);
    } else {
      out += basis[kYellow] * (g - b);
      out += basis[kRed] * (r - g);
    }
  }
  return out.clamped();
}

template <int kSamples>
void to_xyz(const SampledSpectrum<kSamples>* matching, const SampledSpectrum<kSamples>& s, float xyz[3]) {
  for (int k = 0; k < 3; ++k) {
    float sum = 0;
    for (int i = 0; i < kSamples; ++i) sum += matching[k].c[i] * s.c[i];
    xyz[k] = sum;
  }
}

template <int kSamples>
void relight(const AosTables& t, const float* rgb, float* xyz, std::size_t n) {
  SampledSpectrum<kSamples> basis[7];
  SampledSpectrum<kSamples> matching[3];
  for (int k = 0; k < 7; ++k) basis[k] = load<kSamples>(t.basis[k]);
  for (int k = 0; k < 3; ++k) matching[k] = load<kSamples>(t.matching[k]);
  const auto light = load<kSamples>(t.light);
  for (std::size_t i = 0; i < n; ++i) {
    const auto lit = from_rgb<kSamples>(basis, rgb + 3 * i) * light;
    to_xyz<kSamples>(matching, lit, xyz + 3 * i);
  }
}

template <int kSamples>
void add(const AosTables& t, const float* radiance, const float* weight, const std::size_t* pixel,
         AosPixel* film, std::size_t n) {
  SampledSpectrum<kSamples> matching[3];
  for (int k = 0; k < 3; ++k) matching[k] = load<kSamples>(t.matching[k]);
  for (std::size_t i = 0; i < n; ++i) {
    const auto sample = load<kSamples>(radiance + i * kSamples);
    float xyz[3];
    to_xyz<kSamples>(matching, sample, xyz);
    AosPixel& to = film[pixel[i]];
    for (int k = 0; k < 3; ++k) to.xyz[k] += static_cast<double>(weight[i] * xyz[k]);
    to.weight += static_cast<double>(weight[i]);
  }
}

template <int kSamples>
constexpr AosJob job() {
  return {kSamples, relight<kSamples>, add<kSamples>};
}

constexpr int kSamples = 60;
using Spectrum = SampledSpectrum<kSamples>;

Spectrum* spectra(float* values) {
  return reinterpret_cast<Spectrum*>(values);
}
const Spectrum* spectra(const float* values) {
  return reinterpret_cast<const Spectrum*>(values);
}

void upsample(const AosTables& t, const float* rgb, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    spectra(out)[i] = from_rgb<kSamples>(spectra(&t.basis[0][0]), rgb + 3 * i);
  }
}

/// The same layout with the loops fused by hand.
void upsample_fused(const AosTables& t, const float* rgb, float* __restrict out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, rgb += 3, out += kSamples) {
    int least = 0;
    int most = 0;
    for (int k = 1; k < 3; ++k) {
      if (rgb[k] < rgb[least]) least = k;
      if (rgb[k] > rgb[most]) most = k;
    }
    const float low = rgb[least];
    const float middle = least == most ? low : rgb[3 - least - most];
    const float* const second = t.basis[1 + least];
    const float* const first = t.basis[4 + most];
    for (int k = 0; k < kSamples; ++k) {
      const float v = low * t.basis[0][k] + (middle - low) * second[k] + (rgb[most] - middle) * first[k];
      out[k] = v < 0 ? 0 : v;
    }
  }
}

void project(const AosTables& t, const float* in, float* xyz, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    to_xyz<kSamples>(spectra(&t.matching[0][0]), spectra(in)[i], xyz + 3 * i);
}

void luminance(const AosTables& t, const float* in, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float sum = 0;
    for (int k = 0; k < kSamples; ++k)
      sum += t.matching[1][k] * in[i * kSamples + static_cast<std::size_t>(k)];
    y[i] = sum;
  }
}

float sigmoid(const float* c, float lambda) {
  const float x = (c[0] * lambda + c[1]) * lambda + c[2];
  return 0.5F + x / (2 * sqrtf(1 + x * x));
}

void sigmoid_spectrum(const AosTables& t, const float* c, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, c += 3, out += kSamples) {
    for (int k = 0; k < kSamples; ++k) out[k] = sigmoid(c, t.lambda[k]);
  }
}

void multiply(const AosTables& /*tables*/, const float* in, float* out, std::size_t n) {
  const std::size_t whole = n / kSamples;
  for (std::size_t i = 0; i < whole; ++i) {
    Spectrum b;
    for (int k = 0; k < kSamples; ++k) b.c[k] = in[n + i * kSamples + static_cast<std::size_t>(k)];
    spectra(out)[i] = spectra(in)[i] * b;
  }
  for (std::size_t i = whole * kSamples; i < n; ++i) out[i] = in[i] * in[n + i];
}

void exponential(const AosTables& /*tables*/, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = expf(in[i]);
}

void transmittance(const AosTables& /*tables*/, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = expf(-(in[i] * in[n + i]));
}

void power(const AosTables& t, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = powf(in[i], t.exponent);
}

void interpolate_even(const AosTables& t, const float* lambda_nm, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float at = lambda_nm[i] - t.first_nm;
    out[i] = 0;
    if (!(at >= 0) || at > static_cast<float>(t.even_count - 1)) continue;
    const int k = at < static_cast<float>(t.even_count - 2) ? static_cast<int>(at) : t.even_count - 2;
    const float part = at - static_cast<float>(k);
    out[i] = (1 - part) * t.even[k] + part * t.even[k + 1];
  }
}

/// Linear between knots, found by bisection, 0 outside.
void interpolate_knots(const AosTables& t, const float* lambda_nm, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float nm = lambda_nm[i];
    out[i] = 0;
    if (!(nm >= t.knots_nm[0] && nm <= t.knots_nm[t.knots - 1])) continue;
    int low = 0;
    int high = t.knots - 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (nm < t.knots_nm[middle] ? high : low) = middle;
    }
    const float part = (nm - t.knots_nm[low]) / (t.knots_nm[high] - t.knots_nm[low]);
    out[i] = (1 - part) * t.knot_values[low] + part * t.knot_values[high];
  }
}

/// Planck's law with wavelengths in units of 1024 nm.
void planck(const AosTables& t, const float* lambda_nm, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float l = lambda_nm[i] / 1024;
    out[i] = 1 / ((l * l) * (l * l) * l * (expf(t.planck_nm / lambda_nm[i]) - 1));
  }
}

void sigmoid_at(const AosTables& t, const float* lambda_nm, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float nm = lambda_nm[i] < 400 ? 400 : lambda_nm[i] > 700 ? 700 : lambda_nm[i];
    out[i] = sigmoid(t.coefficients, (nm - 550) / 150);
  }
}

#include "bench/baseline/aos_own_wavelengths.inl"

/// Four wavelengths as the eye sees, and their densities. Constants: Pharr, Jakob, Humphreys, Physically
/// Based Rendering, 4th edition, section 4.5.4.
void draw(float u, float* lambda_nm, float* density) {
  for (int k = 0; k < 4; ++k) {
    float up = u + static_cast<float>(k) / 4;
    if (up >= 1) up -= 1;
    lambda_nm[k] = 538 - 138.888889F * atanhf(0.85691062F - 1.82750197F * up);
    const float c = coshf(0.0072F * (lambda_nm[k] - 538));
    density[k] = lambda_nm[k] < 360 || lambda_nm[k] > 830 ? 0 : 0.0039398042F / (c * c);
  }
}

void draw_visible(const AosTables& /*tables*/, const float* u, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) draw(u[i], out + 8 * i, out + 8 * i + 4);
}

#include "bench/baseline/aos_film.inl"

}  // namespace

extern const AosBaseline SPECTILE_AOS_BASELINE;
constexpr AosBaseline SPECTILE_AOS_BASELINE = {SPECTILE_LEVEL_TEXT,
                                               {job<16>(), job<30>(), job<60>()},
                                               upsample,
                                               upsample_fused,
                                               project,
                                               luminance,
                                               sigmoid_spectrum,
                                               multiply,
                                               exponential,
                                               transmittance,
                                               power,
                                               interpolate_even,
                                               interpolate_knots,
                                               planck,
                                               sigmoid_at,
                                               mixture_at,
                                               mixture_at_fused,
                                               sigmoids_at,
                                               texture_of_colors,
                                               texture_of_colors_fused,
                                               texture_of_sigmoids,
                                               update_throughput,
                                               draw_visible,
                                               film_add<Rounding::kLround>,
                                               film_add<Rounding::kConversion>,
                                               film_add_drawing,
                                               film_add_buckets};

}  // namespace spectile::measure
