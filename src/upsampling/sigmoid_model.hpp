// Tables of the sigmoid kernels for given bands, light, observer and primaries.
#pragma once

#include <memory>
#include <vector>

#include "kernels/abi.hpp"
#include "src/color/working_space.hpp"
#include "src/spectra/sigmoid_functions.hpp"

namespace spectile {

/// Tables for the kernels, and the memory that they lie in.
struct SigmoidModel {
  FloatBuffer memory;
  kernels::SigmoidTable table;
  const SigmoidFunctions* functions = nullptr;
  /// Outer centres of the bands; beyond them a spectrum keeps its value there.
  double first_nm = 0;
  double last_nm = 0;
  bool covers_unit_cube = false;  ///< every colour with components from 0 to 1 has a sigmoid
};

/// Tables whose sums over the bands give RGB of the space. Errors: kOutOfMemory.
Result<std::shared_ptr<const SigmoidModel>> sigmoid_model(const Bands& bands, const WorkingSpace& space,
                                                          const SigmoidFunctions& functions);

/// The functions of a band or wavelength in a row of the kernels' table.
void set_functions(const SigmoidModel& model, double wavelength_nm, float* row);

/// Coefficients of the quadratics' start table's nodes for a space, found from grey without any start:
/// [3][steps][steps][steps][3]; see sigmoid_node_rgb() for their colours.
std::vector<double> sigmoid_start_nodes(const Bands& bands, const WorkingSpace& space, int steps);

/// Colour at a point of the table's grid. `most` is the channel with the largest component, which is
/// 1 - (1 - q0)^2; the next ones, cyclically, are q1^2 and q2^2 times that.
std::array<double, 3> sigmoid_node_rgb(std::size_t most, const std::array<double, 3>& q);

}  // namespace spectile
