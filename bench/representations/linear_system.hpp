// Small systems of linear equations.
#pragma once

#include <vector>

namespace spectile::measure {

/// Replaces `right` by the solution of matrix * x = right, by Gauss's elimination with the largest pivot of a
/// column; false for a singular matrix and where it is not finite. `matrix`: row by row, destroyed.
bool solve_linear(std::vector<double>& matrix, std::vector<double>& right);

}  // namespace spectile::measure
