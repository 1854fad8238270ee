// SigmoidFunctions: the two functions of the wavelength that sigmoids combine.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <spectile/spectra/observer.hpp>
#include <vector>

namespace spectile {

/// p and q of a sigmoid 1/2 + x / (2 sqrt(1 + x^2)) with x = c0 p + c1 q + c2.
///
/// Of a quadratic: p = l^2, q = l, l = (wavelength - 550 nm) / 150 nm. Source: Jakob, Hanika, A
/// Low-Dimensional Function Space for Efficient Spectral Upsampling, Computer Graphics Forum 38(2), 2019.
///
/// Of an observer: double integrals over the wavelength of differences of its matching functions, each
/// divided by its own sum: of z - y in p, of x - y in q. Their slopes are 0 at both ends of the visible
/// range, beyond which they are constant. Combined with 1 so that (p, q) is (1, -1), (0, 0), (1, 1) at 450,
/// 550, 650 nm, where the quadratic's are nearly so. They are the first order of the spectra with the least
/// slope that have a colour. Source of those: Burns, Numerical methods for smoothest reflectance
/// reconstruction, Color Research and Application 45(1), 2020; the functions are our own.
class SigmoidFunctions {
 public:
  static constexpr double kFirstNm = 360;  ///< of the tables, which go by 1 nm
  static constexpr double kLastNm = 830;

  /// The observer's, or the quadratic's. Made once.
  static const SigmoidFunctions& of(std::optional<Observer> observer);

  bool are_quadratic() const noexcept { return table_.empty(); }
  /// p and q. An observer's are linear between whole nanometres. Units: nm.
  std::array<double, 2> at(double wavelength_nm) const noexcept;
  /// The same in float, as kernels compute them from pairs().
  std::array<float, 2> at_float(double wavelength_nm) const noexcept;
  /// Of an observer: p (k = 0) or q (k = 1) at every nanometre from kFirstNm to kLastNm, each but the last
  /// with its difference to the next. Shapes: [470][2].
  const std::vector<float>& pairs(std::size_t k) const noexcept { return pairs_[k]; }

 private:
  SigmoidFunctions() = default;
  explicit SigmoidFunctions(Observer observer);
  std::vector<std::array<double, 2>> table_;  // by 1 nm
  std::array<std::vector<float>, 2> pairs_;
};

/// (wavelength - 550 nm) / 150 nm.
constexpr double sigmoid_lambda(double wavelength_nm) {
  return (wavelength_nm - 550.0) / 150.0;
}

}  // namespace spectile
