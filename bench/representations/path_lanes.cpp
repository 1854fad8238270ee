// Lanes of paths: how coefficients of materials come into blocks, and colours out of them.
#include "bench/representations/path_lanes.hpp"

#include "src/base/errors.hpp"

namespace spectile::measure {

Result<FloatBuffer> bounce_lanes(const PathScene& scene, const std::vector<std::vector<double>>& rows,
                                 std::size_t bounce) {
  const std::size_t count = rows.front().size();
  SPECTILE_ASSIGN(auto out, FloatBuffer::create(kPaths * count));
  for (std::size_t lane = 0; lane < kPaths; ++lane) {
    const std::vector<double>& of = rows[scene.paths[lane][bounce]];
    float* const to = out.data() + lane / kLanesPerBlock * count * kLanesPerBlock + lane % kLanesPerBlock;
    for (std::size_t c = 0; c < count; ++c) to[c * kLanesPerBlock] = static_cast<float>(of[c]);
  }
  return out;
}

const float* multiply_bounces(const kernels::KernelTable& table, const FloatBuffer* bounces, std::size_t of,
                              FloatBuffer& product, std::size_t floats) {
  const float* in = bounces[0].data();
  for (std::size_t bounce = 1; bounce < of; ++bounce) {
    table.multiply(product.data(), in, bounces[bounce].data(), floats);
    in = product.data();
  }
  return in;
}

Result<ColorOutput> ColorOutput::create(const std::vector<std::array<double, 3>>& weights) {
  ColorOutput out;
  out.count = weights.size();
  SPECTILE_ASSIGN(out.xyz, FloatBuffer::create(3 * kPaths));
  SPECTILE_ASSIGN(out.weights, FloatBuffer::create(4 * out.count));
  for (std::size_t c = 0; c < out.count; ++c) {
    for (std::size_t k = 0; k < 4; ++k) {
      out.weights.data()[4 * c + k] = k < 3 ? static_cast<float>(weights[c][k]) : 0.0F;
    }
  }
  return out;
}

void ColorOutput::project(const kernels::KernelTable& table, const float* coefficients) {
  float* const x = xyz.data();
  float* const planes[3] = {x, x + kPaths, x + 2 * kPaths};
  table.project(planes, coefficients, weights.data(), count, blocks_for(kPaths));
}

std::vector<Xyz> ColorOutput::colors() const {
  std::vector<Xyz> out(kPaths);
  for (std::size_t path = 0; path < kPaths; ++path) {
    for (std::size_t k = 0; k < 3; ++k) {
      out[path][k] = static_cast<double>(xyz.data()[k * kPaths + path]);
    }
  }
  return out;
}

}  // namespace spectile::measure
