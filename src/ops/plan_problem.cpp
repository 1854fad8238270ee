// What a plan is fitted to.
#include "src/ops/plan_problem.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <spectile/color_difference.hpp>
#include <spectile/sensor.hpp>

#include "src/base/errors.hpp"

namespace spectile::plan {
namespace {

/// Spectra that no measurement has shown must not come out wild: smooth ones of this correlation length and
/// size join the measured ones with a small share.
constexpr double kPriorLengthNm = 25;
constexpr double kPriorSize = 0.15;
constexpr double kPriorShare = 2e-2;
constexpr Eigen::Index kPriorSpectra = 24;

/// Products that a fit takes beside the reflectances themselves.
constexpr std::size_t kProducts = 300;

/// The leading eigenvectors of a squared-exponential covariance, scaled by their roots.
Matrix prior_spectra() {
  Matrix covariance(kGrid, kGrid);
  for (Eigen::Index a = 0; a < kGrid; ++a) {
    for (Eigen::Index b = 0; b < kGrid; ++b) {
      const double d = static_cast<double>(a - b) / kPriorLengthNm;
      covariance(a, b) = kPriorSize * kPriorSize * std::exp(-0.5 * d * d);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
  Matrix out(kGrid, kPriorSpectra);
  for (Eigen::Index k = 0; k < kPriorSpectra; ++k) {
    const Eigen::Index at = kGrid - 1 - k;
    out.col(k) = solver.eigenvectors().col(at) * std::sqrt(std::max(0.0, solver.eigenvalues()[at]));
  }
  return out;
}

std::array<double, 3> triple(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Matrix tabulate(const std::vector<Spectrum>& reflectances) {
  Matrix out(kGrid, static_cast<Eigen::Index>(reflectances.size()));
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    const Spectrum& r = reflectances[static_cast<std::size_t>(i)];
    double first = kFirstNm;
    double last = kLastNm;
    if (const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&r.kind())) {
      first = linear->wavelengths_nm().front();
      last = linear->wavelengths_nm().back();
    } else if (const auto* const dense = std::get_if<DenselySampledSpectrum>(&r.kind())) {
      first = dense->first_nm();
      last = dense->last_nm();
    }
    for (Eigen::Index g = 0; g < kGrid; ++g) {
      const double nm = std::clamp(kFirstNm + static_cast<double>(g), first, last);
      out(g, i) = std::clamp(r(nm), 0.0, 1.0);
    }
  }
  return out;
}

Matrix products(const Matrix& reflectances, int bounces, std::size_t most) {
  if (bounces <= 1) return reflectances;
  // The same products every time.
  std::mt19937_64 random(20);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  const auto count = static_cast<std::uint64_t>(reflectances.cols());
  Matrix out(reflectances.rows(), static_cast<Eigen::Index>(most));
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    out.col(i).setOnes();
    for (int b = 0; b < bounces; ++b) {
      out.col(i) = out.col(i).cwiseProduct(reflectances.col(static_cast<Eigen::Index>(random() % count)));
    }
  }
  return out;
}

Result<Matrix> integrals(const PlannedLight& light, Observer observer) {
  const auto sensor = Sensor::named(observer == Observer::kCie1931 ? "cie1931" : "cie1964");
  if (!sensor) return sensor.error();
  Matrix out(kGrid, 3);
  for (Eigen::Index g = 0; g < kGrid; ++g) {
    const double nm = kFirstNm + static_cast<double>(g);
    const double emitted = light.spectrum(nm);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      out(g, c) = sensor->factors()[k] * sensor->curves()[k](nm) * emitted;
    }
  }
  const double sum = out.col(1).sum();
  if (!(sum > 0) || !std::isfinite(sum)) {
    return make_error(ErrorCode::kBadArgument, "the light {} has no luminance", light.name);
  }
  return Matrix(out / sum);
}

std::vector<Eigen::Matrix3d> metrics(const Matrix& xyz, const Eigen::Vector3d& white) {
  // Small against a just visible difference, large against roundings.
  constexpr double kStep = 1e-5;
  std::vector<Eigen::Matrix3d> out;
  for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
    const Eigen::Vector3d at = xyz.col(i).cwiseMax(1e-4 * white);
    const Lab here = xyz_to_lab(triple(at), triple(white));
    const auto square = [&](const Eigen::Vector3d& step) {
      const double d = ciede2000(here, xyz_to_lab(triple(at + kStep * step), triple(white)));
      return d * d / (kStep * kStep);
    };
    Eigen::Matrix3d metric;
    for (int a = 0; a < 3; ++a) {
      metric(a, a) = square(Eigen::Vector3d::Unit(a));
      for (int b = 0; b < a; ++b) {
        const Eigen::Vector3d both = Eigen::Vector3d::Unit(a) + Eigen::Vector3d::Unit(b);
        metric(a, b) = metric(b, a) = 0.5 * (square(both) - metric(a, a) - metric(b, b));
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(metric);
    const Eigen::Vector3d roots = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    out.emplace_back(roots.asDiagonal() * solver.eigenvectors().transpose());
  }
  return out;
}

std::vector<double> differences(const Matrix& truth, const Matrix& got, const Eigen::Vector3d& white) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < truth.cols(); ++i) {
    out.push_back(ciede2000(xyz_to_lab(triple(truth.col(i)), triple(white)),
                            xyz_to_lab(triple(got.col(i)), triple(white))));
  }
  return out;
}

PlanError summary(std::vector<double> d) {
  if (d.empty()) return {};
  std::sort(d.begin(), d.end());
  PlanError out;
  for (const double v : d) out.mean += v / static_cast<double>(d.size());
  out.percentile95 = d[std::min(d.size() - 1, d.size() * 95 / 100)];
  out.maximum = d.back();
  return out;
}

Vector samples_at(const Matrix& table, double lambda_nm) {
  const double at = std::clamp(lambda_nm - kFirstNm, 0.0, static_cast<double>(kGrid - 1));
  const auto g = std::min<Eigen::Index>(static_cast<Eigen::Index>(at), kGrid - 2);
  const double t = at - static_cast<double>(g);
  return (1 - t) * table.row(g).transpose() + t * table.row(g + 1).transpose();
}

Vector slopes_at(const Matrix& table, double lambda_nm) {
  // Over 5 nm, the step of most measurements: a slope that jumps every nanometre leads nowhere.
  constexpr double kHalf = 2.5;
  return (samples_at(table, lambda_nm + kHalf) - samples_at(table, lambda_nm - kHalf)) / (2 * kHalf);
}

Problem make_problem(const Matrix& reflectances, int bounces, const std::vector<Matrix>& lights) {
  Problem out;
  out.weights = lights;
  const Matrix prior = prior_spectra();
  std::vector<Matrix> parts;
  for (int b = 1; b <= bounces; ++b) parts.push_back(products(reflectances, b, kProducts));
  for (const Matrix& part : parts) out.measured += part.cols();
  out.samples.resize(kGrid, out.measured + prior.cols());
  Eigen::Index at = 0;
  for (const Matrix& part : parts) {
    out.samples.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  out.samples.rightCols(prior.cols()) = prior;
  out.share = Vector::Ones(out.samples.cols());
  const double prior_share =
      kPriorShare * static_cast<double>(out.measured) / static_cast<double>(prior.cols());
  out.share.tail(prior.cols()).setConstant(prior_share);
  for (const Matrix& light : lights) {
    out.white.emplace_back(light.colwise().sum().transpose());
    out.truth.emplace_back(light.transpose() * out.samples);
    // The prior's spectra are deviations: they are judged at a middle grey.
    Matrix colors = out.truth.back();
    constexpr double kGrey = 0.2;
    colors.rightCols(prior.cols()) = (kGrey * out.white.back()).replicate(1, prior.cols());
    out.metric.push_back(metrics(colors, out.white.back()));
  }
  return out;
}

Matrix predict(const Matrix& samples, const Numbers& numbers, Eigen::Index light) {
  Matrix out = Matrix::Zero(3, samples.cols());
  for (Eigen::Index k = 0; k < numbers.lambda.size(); ++k) {
    const Vector values = samples_at(samples, numbers.lambda[k]);
    out += numbers.sensor.row(k).transpose() * (numbers.emission(k, light) * values.transpose());
  }
  return out;
}

}  // namespace spectile::plan
