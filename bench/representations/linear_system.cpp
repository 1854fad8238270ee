// Small systems of linear equations.
#include "bench/representations/linear_system.hpp"

#include <cmath>
#include <utility>

namespace spectile::measure {

bool solve_linear(std::vector<double>& matrix, std::vector<double>& right) {
  const std::size_t n = right.size();
  const auto at = [&](std::size_t row, std::size_t column) -> double& { return matrix[row * n + column]; };
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t row = c + 1; row < n; ++row) {
      if (std::abs(at(row, c)) > std::abs(at(pivot, c))) pivot = row;
    }
    if (!(std::abs(at(pivot, c)) > 0)) return false;
    for (std::size_t k = 0; k < n && pivot != c; ++k) std::swap(at(pivot, k), at(c, k));
    std::swap(right[pivot], right[c]);
    for (std::size_t row = c + 1; row < n; ++row) {
      const double factor = at(row, c) / at(c, c);
      for (std::size_t k = c; k < n; ++k) at(row, k) -= factor * at(c, k);
      right[row] -= factor * right[c];
    }
  }
  for (std::size_t row = n; row-- > 0;) {
    for (std::size_t k = row + 1; k < n; ++k) right[row] -= at(row, k) * right[k];
    right[row] /= at(row, row);
    if (!std::isfinite(right[row])) return false;
  }
  return true;
}

}  // namespace spectile::measure
