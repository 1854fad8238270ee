// Drawing from the magnitude of an even function by a table of its integral.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "src/spectra/quadrature.hpp"

namespace spectile {

/// The magnitude of an even function in cells, none of which it changes its sign in: their integrals are
/// exact, and within one the magnitude is taken to be linear.
class MagnitudeTable {
 public:
  struct Drawn {
    double d = 0;
    bool negative = false;
  };

  /// `pieces` ascend from 0 to where the function ends and it is smooth between them.
  template <class Function>
  MagnitudeTable(const Function& f, const std::vector<double>& pieces) {
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      // At least these many a piece, so that it is near to linear in a cell; the error is their square's.
      const double share = (pieces[i] - pieces[i - 1]) / pieces.back();
      const int cells = std::max(kMinCells, static_cast<int>(std::ceil(kCells * share)));
      const double step = (pieces[i] - pieces[i - 1]) / cells;
      for (int c = 0; c < cells; ++c) {
        const double from = pieces[i - 1] + c * step;
        add(f, from, c + 1 < cells ? from + step : pieces[i]);
      }
    }
    make_guide();
  }

  /// Integral of the magnitude from 0 on.
  double total() const noexcept { return total_; }

  /// u in [0, 1) to a distance of either sign.
  Drawn sample(double u) const noexcept {
    const double both = 2 * u - 1;
    const double share = std::abs(both);
    const auto guide = static_cast<std::size_t>(share * static_cast<double>(guide_.size()));
    std::size_t i = guide_[std::min(guide, guide_.size() - 1)];
    const double wanted = share * total_;
    while (i + 1 < cells_.size() && cells_[i + 1].before <= wanted) ++i;
    const Cell& cell = cells_[i];
    const double part = std::min((wanted - cell.before) * cell.per_mass, 1.0);
    // The root of 2 first t + (1 - 2 first) t^2 = part, written so that it does not cancel.
    const double first = cell.first;
    const double t = part / (first + std::sqrt(first * first + (1 - 2 * first) * part) + kTiny);
    const double d = cell.from + std::min(t, 1.0) * cell.width;
    return {both < 0 ? -d : d, cell.negative};
  }

 private:
  static constexpr int kCells = 256;  // the table stays in the innermost cache
  static constexpr int kMinCells = 16;
  static constexpr double kTiny = std::numeric_limits<double>::min();  // for 0 / 0
  struct Cell {
    double from, width, before, per_mass;  ///< before: integral from 0 to it
    double first;                          ///< magnitude at its beginning, over the sum of those at both ends
    bool negative;
  };

  template <class Function>
  void add(const Function& f, double from, double to) {
    const double a = f(from);
    const double b = f(to);
    if (!(a * b < 0)) return add_of_one_sign(f, from, to);
    double low = from;
    double high = to;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      ((f(middle) < 0) == (a < 0) ? low : high) = middle;
    }
    add_of_one_sign(f, from, low);
    add_of_one_sign(f, high, to);
  }

  template <class Function>
  void add_of_one_sign(const Function& f, double from, double to) {
    const double signed_mass = quadrature::ten_points(f, from, to);
    const double mass = std::abs(signed_mass);
    if (!std::isnormal(mass)) return;  // nothing is drawn there
    const double first = std::abs(f(from));
    const double both = first + std::abs(f(to));
    const double beginning = both > 0 ? first / both : 0.5;
    cells_.push_back({from, to - from, total_, 1 / mass, beginning, signed_mass < 0});
    total_ += mass;
  }

  void make_guide() {
    // A power of two, so that shares and guides come from one another without rounding.
    guide_.resize(std::bit_ceil(2 * cells_.size()));
    std::size_t i = 0;
    for (std::size_t g = 0; g < guide_.size(); ++g) {
      const double at = static_cast<double>(g) / static_cast<double>(guide_.size()) * total_;
      while (i + 1 < cells_.size() && cells_[i + 1].before <= at) ++i;
      guide_[g] = static_cast<std::uint32_t>(i);
    }
  }

  std::vector<Cell> cells_;
  std::vector<std::uint32_t> guide_;  ///< the cell of each even share of the integral
  double total_ = 0;
};

}  // namespace spectile
