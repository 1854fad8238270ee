// Look-ups as the field's textbooks write them, with all that the compiler can do for this machine.
#include "bench/micro/textbook_spectra.hpp"

#include <algorithm>
#include <cmath>

namespace textbook {

float Dense::operator()(float lambda_nm) const {
  const float at = lambda_nm - static_cast<float>(first_nm);
  if (!(at >= 0) || at > static_cast<float>(values.size() - 1)) return 0;
  const std::size_t i = std::min(static_cast<std::size_t>(at), values.size() - 2);
  const float t = at - static_cast<float>(i);
  return (1 - t) * values[i] + t * values[i + 1];
}

float PiecewiseLinear::operator()(float lambda_nm) const {
  if (lambda_nm < wavelengths_nm.front() || lambda_nm > wavelengths_nm.back()) return 0;
  const auto above = std::upper_bound(wavelengths_nm.begin(), wavelengths_nm.end(), lambda_nm);
  const auto i =
      std::min(static_cast<std::size_t>(above - wavelengths_nm.begin()), wavelengths_nm.size() - 1);
  const float t = (lambda_nm - wavelengths_nm[i - 1]) / (wavelengths_nm[i] - wavelengths_nm[i - 1]);
  return (1 - t) * values[i - 1] + t * values[i];
}

float Blackbody::operator()(float lambda_nm) const {
  if (lambda_nm <= 0) return 0;
  const float c = 299792458.0F;
  const float h = 6.62606957e-34F;
  const float kb = 1.3806488e-23F;
  const float l = lambda_nm * 1e-9F;
  const float lambda5 = (l * l) * (l * l) * l;
  return (2 * h * c * c) / (lambda5 * (std::exp((h * c) / (l * kb * temperature_k)) - 1)) * 1e-9F;
}

float Sigmoid::operator()(float lambda_nm) const {
  const float l = (lambda_nm - 550.0F) / 150.0F;
  const float x = (c[0] * l + c[1]) * l + c[2];
  return 0.5F + x / (2 * std::sqrt(1 + x * x));
}

namespace {
template <class Spectrum>
void loop(const Spectrum& spectrum, const float* lambda_nm, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = spectrum(lambda_nm[i]);
}
}  // namespace

void sample(const Dense& spectrum, const float* lambda_nm, float* out, std::size_t n) {
  loop(spectrum, lambda_nm, out, n);
}
void sample(const PiecewiseLinear& spectrum, const float* lambda_nm, float* out, std::size_t n) {
  loop(spectrum, lambda_nm, out, n);
}
void sample(const Blackbody& spectrum, const float* lambda_nm, float* out, std::size_t n) {
  loop(spectrum, lambda_nm, out, n);
}
void sample(const Sigmoid& spectrum, const float* lambda_nm, float* out, std::size_t n) {
  loop(spectrum, lambda_nm, out, n);
}

}  // namespace textbook
