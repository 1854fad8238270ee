// The textbook's way. One translation unit, compiled once per level of the processor; see textbook.hpp.
//
// No algorithms or containers here: what the linker would share between levels must not be compiled for one.
#include "bench/methods/aos_baseline.hpp"

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

/// Sum of what is least of white, then what is left of a secondary, then of a primary.
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
void relight(const TextbookScene& scene, const float* rgb, float* xyz, std::size_t n) {
  SampledSpectrum<kSamples> basis[7];
  SampledSpectrum<kSamples> matching[3];
  for (int k = 0; k < 7; ++k) basis[k] = load<kSamples>(scene.basis[k]);
  for (int k = 0; k < 3; ++k) matching[k] = load<kSamples>(scene.matching[k]);
  const auto light = load<kSamples>(scene.light);
  for (std::size_t i = 0; i < n; ++i) {
    const auto lit = from_rgb<kSamples>(basis, rgb + 3 * i) * light;
    to_xyz<kSamples>(matching, lit, xyz + 3 * i);
  }
}

template <int kSamples>
void add(const TextbookScene& scene, const float* radiance, const float* weight, const std::size_t* pixel,
         TextbookPixel* film, std::size_t n) {
  SampledSpectrum<kSamples> matching[3];
  for (int k = 0; k < 3; ++k) matching[k] = load<kSamples>(scene.matching[k]);
  for (std::size_t i = 0; i < n; ++i) {
    const auto sample = load<kSamples>(radiance + i * kSamples);
    float xyz[3];
    to_xyz<kSamples>(matching, sample, xyz);
    TextbookPixel& to = film[pixel[i]];
    for (int k = 0; k < 3; ++k) to.xyz[k] += static_cast<double>(weight[i] * xyz[k]);
    to.weight += static_cast<double>(weight[i]);
  }
}

template <int kSamples>
constexpr TextbookWay way() {
  return {kSamples, relight<kSamples>, add<kSamples>};
}

}  // namespace

extern const Textbook SPECTILE_TEXTBOOK;
constexpr Textbook SPECTILE_TEXTBOOK = {SPECTILE_TEXTBOOK_TEXT, {way<16>(), way<30>(), way<60>()}};

}  // namespace spectile::measure
