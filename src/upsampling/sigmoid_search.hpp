// Sigmoid coefficients of one colour in double, with derivatives: how the tables of the fast search are made.
#pragma once

#include <array>
#include <vector>

#include "src/color/working_space.hpp"
#include "src/spectra/sigmoid_functions.hpp"

namespace spectile {

using Triple = std::array<double, 3>;

/// Sums over bands of weight times sigmoid, as a function of three coefficients.
class SigmoidSums {
 public:
  SigmoidSums(const Bands& bands, const WorkingSpace& space, const SigmoidFunctions& functions);

  /// Sets numbers that are added to the argument of the sigmoid in each band. Shapes: [bands].
  void set_offsets(std::vector<double> offsets) { offsets_ = std::move(offsets); }

  /// Sums, and their derivatives [rgb][coefficient].
  Triple at(const Triple& c, Matrix3& jacobian) const;
  /// Second derivatives [rgb][coefficient, coefficient].
  std::array<Matrix3, 3> second(const Triple& c) const;

  /// Moves `c` to where the sums are `rgb`, by the method of Levenberg and Marquardt, in so many trials at
  /// most; true if it got there.
  bool solve(const Triple& rgb, Triple& c, int trials = 200) const;
  /// Continuation from the grey axis: the part of the line from (grey, grey, grey), above 0 and below 1, to
  /// `rgb` that sigmoids have; c becomes the coefficients at its end.
  double continue_from_grey(const Triple& rgb, double grey, Triple& c) const;
  /// Coefficients of a colour from a start near by, or of the last one on the line to it from its grey that
  /// has some; true if it has. `luminance`: weights of R, G and B.
  bool find(const Triple& rgb, const Triple& luminance, Triple& c) const;
  /// Samples [bands] of coefficients.
  void samples(const Triple& c, double* out) const;
  /// The same without a start: along the line from grey.
  bool solve_from_grey(const Triple& rgb, Triple& c) const;

 private:
  double argument(const Triple& c, std::size_t band) const {
    const auto& [p, q] = at_[band];
    // In this order, so that its rounding stays that of the start table.
    const double own = quadratic_ ? (c[0] * q + c[1]) * q + c[2] : c[0] * p + c[1] * q + c[2];
    return offsets_.empty() ? own : own + offsets_[band];
  }
  bool quadratic_;
  std::vector<std::array<double, 2>> at_;  // p and q of each band
  std::vector<Triple> weights_;
  std::vector<double> offsets_;  // of each band, or none
};

}  // namespace spectile
