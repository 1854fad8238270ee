// Lanes of paths: how coefficients of materials come into blocks, and colours out of them.
#pragma once

#include <memory>
#include <vector>

#include "bench/representations/representation.hpp"

namespace spectile::measure {

/// The coefficients of each lane's material at a bounce. Shapes: rows [reflectance][count], result
/// [block][count][64]. Errors: kOutOfMemory.
Result<FloatBuffer> bounce_lanes(const PathScene& scene, const std::vector<std::vector<double>>& rows,
                                 std::size_t bounce);

/// Colours in blocks, and the weights of a projection to them. Shapes: xyz [3][kPaths], weights
/// [count][4].
struct ColorOutput {
  FloatBuffer xyz, weights;
  std::size_t count = 0;

  /// Errors: kOutOfMemory.
  static Result<ColorOutput> create(const std::vector<std::array<double, 3>>& weights);
  /// XYZ of coefficients [block][count][64].
  void project(const kernels::KernelTable& table, const float* coefficients);
  std::vector<Xyz> colors() const;
};

/// Product of the first `of` bounces, `floats` each: in `product`, or the only one as it lies.
const float* multiply_bounces(const kernels::KernelTable& table, const FloatBuffer* bounces, std::size_t of,
                              FloatBuffer& product, std::size_t floats);

/// Runs and colours of lanes with follow(table, bounces) and an `output`.
template <class Lanes>
Representation follow_lanes(const PathScene& scene, std::shared_ptr<Lanes> lanes, std::size_t coefficients) {
  Representation out;
  out.coefficients = coefficients;
  out.run = [lanes, table = scene.scene->table](std::size_t bounces) { lanes->follow(*table, bounces); };
  out.colors = [run = out.run, lanes](std::size_t bounces) {
    run(bounces);
    return lanes->output.colors();
  };
  return out;
}

}  // namespace spectile::measure
