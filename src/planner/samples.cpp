// Samples of spectra and of their products, at wavelengths or over bands.
#include <algorithm>
#include <random>

#include "src/planner/problem.hpp"

namespace spectile::plan {
namespace {

/// A place between two rows of a table.
struct Row {
  Eigen::Index first;
  double t;
};

Row row_at(double lambda_nm) {
  const double at = std::clamp(lambda_nm - kFirstNm, 0.0, static_cast<double>(kGrid - 1));
  const auto g = std::min<Eigen::Index>(static_cast<Eigen::Index>(at), kGrid - 2);
  return {g, at - static_cast<double>(g)};
}

Vector value_at(const SampleSet& set, double lambda_nm) {
  const Row r = row_at(lambda_nm);
  return (1 - r.t) * set.table.row(r.first).transpose() + r.t * set.table.row(r.first + 1).transpose();
}

/// Integral from kFirstNm, of spectra that are linear in between.
Vector integral_to(const SampleSet& set, double lambda_nm) {
  const Row r = row_at(lambda_nm);
  return set.cumulative.row(r.first).transpose() +
         (r.t - 0.5 * r.t * r.t) * set.table.row(r.first).transpose() +
         0.5 * r.t * r.t * set.table.row(r.first + 1).transpose();
}

/// Narrower bands are points.
constexpr double kPointNm = 1e-3;

Vector average(const SampleSet& set, double lambda_nm, double half_nm) {
  if (half_nm < kPointNm) return value_at(set, lambda_nm);
  return (integral_to(set, lambda_nm + half_nm) - integral_to(set, lambda_nm - half_nm)) / (2 * half_nm);
}

/// Slopes over 5 nm, the step of most measurements: one that jumps every nanometre leads nowhere.
constexpr double kSlopeNm = 2.5;

}  // namespace

SampleSet sample_set(Matrix table) {
  SampleSet out;
  out.table = std::move(table);
  out.cumulative = Matrix::Zero(out.table.rows(), out.table.cols());
  for (Eigen::Index g = 1; g < out.table.rows(); ++g) {
    out.cumulative.row(g) = out.cumulative.row(g - 1) + 0.5 * (out.table.row(g - 1) + out.table.row(g));
  }
  out.factors.reserve(static_cast<std::size_t>(out.table.cols()));
  for (Eigen::Index i = 0; i < out.table.cols(); ++i) out.factors.push_back({i});
  return out;
}

void add_products(SampleSet& set, Eigen::Index among, int bounces, std::size_t most) {
  // Deterministic.
  std::mt19937_64 random(20);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  for (std::size_t i = 0; i < most; ++i) {
    std::vector<Eigen::Index> factors;
    factors.reserve(static_cast<std::size_t>(bounces));
    for (int b = 0; b < bounces; ++b) {
      factors.push_back(static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(among)));
    }
    set.factors.push_back(std::move(factors));
  }
}

Matrix sample_values(const SampleSet& set, const Vector& lambda, const Vector& half) {
  Matrix out(set.count(), lambda.size());
  for (Eigen::Index k = 0; k < lambda.size(); ++k) {
    const Vector own = average(set, lambda[k], half[k]);
    for (Eigen::Index i = 0; i < set.count(); ++i) {
      double product = 1;
      for (const Eigen::Index f : set.factors[static_cast<std::size_t>(i)]) product *= own[f];
      out(i, k) = product;
    }
  }
  return out;
}

Slopes sample_slopes(const SampleSet& set, const Vector& lambda, const Vector& half) {
  Slopes out;
  out.values.resize(set.count(), lambda.size());
  out.by_lambda = out.by_half = out.values;
  for (Eigen::Index k = 0; k < lambda.size(); ++k) {
    const Vector own = average(set, lambda[k], half[k]);
    const double step = std::max(half[k], kSlopeNm);
    const Vector left = value_at(set, lambda[k] - step);
    const Vector right = value_at(set, lambda[k] + step);
    const Vector by_lambda = (right - left) / (2 * step);
    const Vector by_half = ((left + right) / 2 - own) / step;
    for (Eigen::Index i = 0; i < set.count(); ++i) {
      const auto& factors = set.factors[static_cast<std::size_t>(i)];
      double product = 1;
      double lambda_slope = 0;
      double half_slope = 0;
      for (const Eigen::Index f : factors) {
        lambda_slope = lambda_slope * own[f] + product * by_lambda[f];
        half_slope = half_slope * own[f] + product * by_half[f];
        product *= own[f];
      }
      out.values(i, k) = product;
      out.by_lambda(i, k) = lambda_slope;
      out.by_half(i, k) = half_slope;
    }
  }
  return out;
}

Matrix reference_xyz(const SampleSet& set, const Matrix& integrals) {
  Matrix out(3, set.count());
  for (Eigen::Index i = 0; i < set.count(); ++i) {
    const auto& factors = set.factors[static_cast<std::size_t>(i)];
    Vector product = set.table.col(factors[0]);
    for (std::size_t f = 1; f < factors.size(); ++f)
      product = product.cwiseProduct(set.table.col(factors[f]));
    out.col(i) = integrals.transpose() * product;
  }
  return out;
}

Matrix predict(const SampleSet& set, const Parameters& parameters, Eigen::Index light) {
  const Matrix weights = parameters.emission.col(light).asDiagonal() * parameters.sensor;
  return (sample_values(set, parameters.lambda, parameters.half) * weights).transpose();
}

}  // namespace spectile::plan
