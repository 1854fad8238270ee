// Representation by polynomials on intervals.
#include "bench/representations/lane_loops.hpp"
#include "bench/representations/linear_system.hpp"
#include "bench/representations/path_lanes.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// 380 to 780 nm in four intervals.
constexpr std::size_t kFirst = 20;
constexpr std::size_t kWidth = 100;
constexpr std::size_t kIntervals = 4;

/// Chebyshev's polynomials at a sample of an interval, its ends at -1 and 1.
std::array<double, kTerms> terms_at(std::size_t sample) {
  const double x = (2 * static_cast<double>(sample) + 1) / static_cast<double>(kWidth) - 1;
  return {1, x, 2 * x * x - 1, (4 * x * x - 3) * x};
}

struct PolynomialLanes {
  FloatBuffer bounces[kMaxBounces];
  FloatBuffer product[2];
  ColorOutput output;

  void follow(const kernels::KernelTable& table, std::size_t of) {
    const float* in = bounces[0].data();
    for (std::size_t bounce = 1; bounce < of; ++bounce) {
      float* const to = product[bounce % 2].data();
      lane_loops(table.name)
          .multiply_chebyshev(to, in, bounces[bounce].data(), blocks_for(kPaths) * kIntervals);
      in = to;
    }
    output.project(table, in);
  }
};

}  // namespace

std::vector<double> chebyshev_fit(const std::vector<double>& spectrum) {
  std::vector<double> out;
  for (std::size_t i = 0; i < kIntervals; ++i) {
    std::vector<double> matrix(kTerms * kTerms);
    std::vector<double> right(kTerms);
    for (std::size_t s = 0; s < kWidth; ++s) {
      const auto terms = terms_at(s);
      for (std::size_t j = 0; j < kTerms; ++j) {
        for (std::size_t k = 0; k < kTerms; ++k) matrix[j * kTerms + k] += terms[j] * terms[k];
        right[j] += terms[j] * spectrum[kFirst + i * kWidth + s];
      }
    }
    solve_linear(matrix, right);
    out.insert(out.end(), right.begin(), right.end());
  }
  return out;
}

Result<Representation> polynomials(const PathScene& scene) {
  auto lanes = std::make_shared<PolynomialLanes>();
  std::vector<std::vector<double>> fits;
  for (const ReferenceReflectance& r : scene.reflectances()) fits.push_back(chebyshev_fit(r.values));
  for (std::size_t bounce = 0; bounce < kMaxBounces; ++bounce) {
    SPECTILE_ASSIGN(lanes->bounces[bounce], bounce_lanes(scene, fits, bounce));
  }
  for (FloatBuffer& product : lanes->product) {
    SPECTILE_ASSIGN(product, FloatBuffer::create(kPaths * kIntervals * kTerms));
  }
  // The light is not approximated: its weights are sums over the nanometres.
  std::vector<std::array<double, 3>> weights(kIntervals * kTerms);
  for (std::size_t i = 0; i < kIntervals; ++i) {
    for (std::size_t s = 0; s < kWidth; ++s) {
      const auto terms = terms_at(s);
      for (std::size_t j = 0; j < kTerms; ++j) {
        for (std::size_t k = 0; k < 3; ++k) {
          weights[i * kTerms + j][k] += terms[j] * scene.light().weights[k][kFirst + i * kWidth + s];
        }
      }
    }
  }
  SPECTILE_ASSIGN(lanes->output, ColorOutput::create(weights));
  Representation out = follow_lanes(scene, lanes, kIntervals * kTerms);
  out.name = "4 cubic polynomials";
  out.source = "Raso and Fournier 1991";
  return out;
}

}  // namespace spectile::measure
