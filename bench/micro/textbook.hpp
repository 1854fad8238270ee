// The textbook's way: one SampledSpectrum of 60 floats a pixel, array of structures, scalar code for the
// compiler.
#pragma once

#include <cstddef>

namespace textbook {

inline constexpr int kSamples = 60;

/// A sampled spectrum with the usual operators.
struct SampledSpectrum {
  float c[kSamples];
};

/// Tables that the functions below need; filled in by the caller.
struct Tables {
  SampledSpectrum white, cyan, magenta, yellow, red, green, blue;
  SampledSpectrum x, y, z;  // projection weights
  float scale;              // of the basis spectra
};

/// Linear RGB of n pixels, [n][3], to n spectra.
void upsample(const Tables& tables, const float* rgb, SampledSpectrum* out, std::size_t n);
/// The same, with the textbook's loops fused into one by hand: what is left is the layout.
void upsample_fused(const Tables& tables, const float* rgb, SampledSpectrum* out, std::size_t n);
/// n spectra to [n][3] XYZ.
void project(const Tables& tables, const SampledSpectrum* in, float* xyz, std::size_t n);
/// n spectra to n luminances.
void luminance(const Tables& tables, const SampledSpectrum* in, float* y, std::size_t n);
/// Linear RGB of n pixels to linear RGB under a light: each upsampled, multiplied by the light, projected
/// with the matching functions x, y, z, and taken through a 3 x 3 matrix.
void relight(const Tables& tables, const SampledSpectrum& light, const float* matrix, const float* rgb,
             float* out, std::size_t n);
/// out = a * b, spectrum by spectrum.
void multiply(const SampledSpectrum* a, const SampledSpectrum* b, SampledSpectrum* out, std::size_t n);

}  // namespace textbook
