// Look-ups as the field's textbooks write them: one wavelength after the other, single precision.
#pragma once

#include <cstddef>
#include <vector>

namespace textbook {

/// Every nanometre from first_nm on, linear in between, 0 outside.
struct Dense {
  int first_nm;
  std::vector<float> values;
  float operator()(float lambda_nm) const;
};
/// Linear between samples, found by bisection, 0 outside.
struct PiecewiseLinear {
  std::vector<float> wavelengths_nm, values;
  float operator()(float lambda_nm) const;
};
/// Planck's law. Units: W/(m^2 sr nm).
struct Blackbody {
  float temperature_k;
  float operator()(float lambda_nm) const;
};
/// The sigmoid of a quadratic.
struct Sigmoid {
  float c[3];
  float operator()(float lambda_nm) const;
};

/// out[i] = spectrum(lambda_nm[i]).
void sample(const Dense& spectrum, const float* lambda_nm, float* out, std::size_t n);
void sample(const PiecewiseLinear& spectrum, const float* lambda_nm, float* out, std::size_t n);
void sample(const Blackbody& spectrum, const float* lambda_nm, float* out, std::size_t n);
void sample(const Sigmoid& spectrum, const float* lambda_nm, float* out, std::size_t n);

}  // namespace textbook
