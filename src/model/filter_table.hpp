// Drawing from the magnitude of an even function by a table of its integral.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/model/quadrature.hpp"

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
      const double cells = std::max(kLeastCells, std::ceil(kCells * share));
      const double step = (pieces[i] - pieces[i - 1]) / cells;
      for (double c = 0; c < cells; ++c) {
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
    const double part = std::clamp((wanted - cell.before) / cell.mass, 0.0, 1.0);
    // The root of first t + (second - first) t^2 / 2 = part (first + second) / 2 that does not cancel.
    const double first = cell.first;
    const double second = cell.second;
    const double root = std::sqrt(first * first + (second * second - first * first) * part);
    const double t = first + root > 0 ? part * (first + second) / (first + root) : part;
    const double d = cell.from + std::min(t, 1.0) * cell.width;
    return {both < 0 ? -d : d, cell.negative};
  }

 private:
  static constexpr double kCells = 1024;
  static constexpr double kLeastCells = 8;
  struct Cell {
    double from, width, before, mass;  ///< before: integral from 0 to it
    double first, second;              ///< magnitude at both ends
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
    if (!(mass > 0)) return;  // nothing is drawn there
    cells_.push_back({from, to - from, total_, mass, std::abs(f(from)), std::abs(f(to)), signed_mass < 0});
    total_ += mass;
  }

  void make_guide() {
    guide_.resize(cells_.size());
    std::size_t i = 0;
    for (std::size_t g = 0; g < guide_.size(); ++g) {
      const double at = static_cast<double>(g) / static_cast<double>(guide_.size()) * total_;
      while (i + 1 < cells_.size() && cells_[i + 1].before <= at) ++i;
      // One less: the quotient that finds a guide may have been rounded up.
      guide_[g] = static_cast<std::uint32_t>(i > 0 ? i - 1 : 0);
    }
  }

  std::vector<Cell> cells_;
  std::vector<std::uint32_t> guide_;  ///< a cell at or before the one of each even share of the integral
  double total_ = 0;
};

}  // namespace spectile
