// Representation in a basis of characteristic vectors: a material is a matrix.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bench/representations/lane_loops.hpp"
#include "bench/representations/path_lanes.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

using Vectors = std::vector<std::vector<double>>;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Gram and Schmidt's method, twice for accuracy.
void make_orthonormal(Vectors& vectors) {
  for (std::size_t j = 0; j < vectors.size(); ++j) {
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t k = 0; k < j; ++k) {
        const double along = dot(vectors[j], vectors[k]);
        for (std::size_t i = 0; i < vectors[j].size(); ++i) vectors[j][i] -= along * vectors[k][i];
      }
      const double length = std::sqrt(dot(vectors[j], vectors[j]));
      for (double& v : vectors[j]) v = length > 0 ? v / length : 0;
    }
  }
}

/// Lanes of products in the basis.
struct BasisLanes {
  std::size_t size = 0;  // of kBasisSizes
  FloatBuffer first;     // the light on the first material
  FloatBuffer matrices[kMaxBounces];
  FloatBuffer at[2];
  ColorOutput output;

  void follow(const kernels::KernelTable& table, std::size_t bounces) {
    const float* in = first.data();
    for (std::size_t bounce = 1; bounce < bounces; ++bounce) {
      float* const to = at[bounce % 2].data();
      lane_loops(table.name).apply[size](to, in, matrices[bounce].data(), blocks_for(kPaths));
      in = to;
    }
    output.project(table, in);
  }
};

}  // namespace

LinearBasis characteristic_basis(const PathScene& scene, std::size_t functions) {
  const ReferenceLight& light = scene.light();
  LinearBasis out;
  // Spectra are weighed by what is seen of them.
  std::vector<double> power(kGridSamples);
  out.scale.resize(kGridSamples);
  for (std::size_t i = 0; i < kGridSamples; ++i) {
    power[i] = light.spectrum.at(kFirstVisibleNm + static_cast<double>(i));
    out.scale[i] = power[i] > 0 ? std::sqrt(seen_at(light, i) / power[i]) : 0;
  }
  Vectors lit = spectra_of_scene(scene);
  for (auto& spectrum : lit) {
    for (std::size_t i = 0; i < kGridSamples; ++i) spectrum[i] *= power[i] * out.scale[i];
  }
  Vectors covariance(kGridSamples, std::vector<double>(kGridSamples));
  for (const auto& spectrum : lit) {
    for (std::size_t i = 0; i < kGridSamples; ++i) {
      if (spectrum[i] == 0) continue;
      for (std::size_t k = 0; k < kGridSamples; ++k) covariance[i][k] += spectrum[i] * spectrum[k];
    }
  }
  // Orthogonal iteration from cosines times the light.
  for (std::size_t j = 0; j < functions; ++j) {
    std::vector<double>& start = out.functions.emplace_back(kGridSamples);
    for (std::size_t i = 0; i < kGridSamples; ++i) {
      const double angle = std::numbers::pi * static_cast<double>(j * i) / kGridSamples;
      start[i] = power[i] * out.scale[i] * std::cos(angle);
    }
  }
  make_orthonormal(out.functions);
  constexpr int kIterations = 60;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Vectors next;
    for (const auto& f : out.functions) {
      std::vector<double>& to = next.emplace_back(kGridSamples);
      for (std::size_t i = 0; i < kGridSamples; ++i) to[i] = dot(covariance[i], f);
    }
    out.functions = std::move(next);
    make_orthonormal(out.functions);
  }
  out.light.resize(kGridSamples);
  for (std::size_t i = 0; i < kGridSamples; ++i) out.light[i] = power[i] * out.scale[i];
  for (const auto& f : out.functions) {
    Xyz sum{};
    for (std::size_t i = 0; i < kGridSamples; ++i) {
      if (out.light[i] == 0) continue;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += f[i] / out.light[i] * light.weights[k][i];
    }
    out.weights.push_back(sum);
  }
  return out;
}

Result<Representation> linear_basis(const PathScene& scene, const LinearBasis& basis, std::size_t functions) {
  auto lanes = std::make_shared<BasisLanes>();
  while (kBasisSizes[lanes->size] != functions) ++lanes->size;
  // The lit material, then its matrix.
  Vectors lit;
  Vectors matrices;
  for (const ReferenceReflectance& r : scene.reflectances()) {
    std::vector<double>& vector = lit.emplace_back();
    std::vector<double>& matrix = matrices.emplace_back();
    for (std::size_t j = 0; j < functions; ++j) {
      std::vector<double> product = basis.functions[j];
      for (std::size_t i = 0; i < kGridSamples; ++i) product[i] *= r.values[i];
      vector.push_back(dot(product, basis.light));
      for (std::size_t k = 0; k <= j; ++k) matrix.push_back(dot(product, basis.functions[k]));
    }
  }
  SPECTILE_ASSIGN(lanes->first, bounce_lanes(scene, lit, 0));
  for (std::size_t bounce = 1; bounce < kMaxBounces; ++bounce) {
    SPECTILE_ASSIGN(lanes->matrices[bounce], bounce_lanes(scene, matrices, bounce));
  }
  for (FloatBuffer& at : lanes->at) {
    SPECTILE_ASSIGN(at, FloatBuffer::create(kPaths * functions));
  }
  const auto end = basis.weights.begin() + static_cast<std::ptrdiff_t>(functions);
  SPECTILE_ASSIGN(lanes->output, ColorOutput::create({basis.weights.begin(), end}));
  Representation out = follow_lanes(scene, lanes, functions * (functions + 1) / 2);
  out.name = fmt::format("linear basis, {} functions", functions);
  out.source = "Peercy 1993";
  return out;
}

}  // namespace spectile::measure
