// What a plan is fitted to.
#include "src/planner/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <spectile/color/color_difference.hpp>
#include <spectile/color/sensor.hpp>

#include "src/base/errors.hpp"

namespace spectile::plan {
namespace {

/// What the dyes, and the smooth deviations, count beside the reflectances: enough that no spectrum comes out
/// wild that no measurement has shown, little enough to leave the measured ones their precision. By
/// cross-validation over several deals of the folds.
constexpr Eigen::Index kDyes = 400;
constexpr double kFirstDyeNm = 380;
constexpr double kLastDyeNm = 780;
constexpr double kDyeShare = 0.2;
constexpr double kSmoothShare = 1e-2;

/// Products that a fit takes beside the reflectances themselves, for each number of bounces.
constexpr std::size_t kProducts = 300;
/// Products, for each number of bounces, among which the worst are looked for; and how many are taken at a
/// time under each light: random ones alone miss the few dark saturated ones that err most.
constexpr std::size_t kPool = 5000;
constexpr std::size_t kWorst = 20;
/// Where smooth deviations are judged.
constexpr double kGrey = 0.2;

std::array<double, 3> triple(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Result<Matrix> tabulate(const std::vector<Spectrum>& reflectances) {
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
      const double value = r(nm);
      if (std::isnan(value)) {
        return make_error(ErrorCode::kBadArgument, "reflectance {} of {} is no number at {} nm", i + 1,
                          out.cols(), nm);
      }
      out(g, i) = std::clamp(value, 0.0, 1.0);
    }
  }
  return out;
}

Result<Matrix> integrals(const PlannedLight& light, Observer observer) {
  SPECTILE_ASSIGN(const auto sensor, Sensor::named(observer == Observer::kCie1931 ? "cie1931" : "cie1964"));
  Matrix out(kGrid, 3);
  for (Eigen::Index g = 0; g < kGrid; ++g) {
    const double nm = kFirstNm + static_cast<double>(g);
    const double emitted = light.spectrum(nm);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      out(g, c) = sensor.factors()[k] * sensor.curves()[k](nm) * emitted;
    }
  }
  const Eigen::Vector3d white = white_of(out);
  const double sum = white[1];
  if (!(sum > 0) || !std::isfinite(sum)) {
    return make_error(ErrorCode::kBadArgument, "the light {} has no luminance", light.name);
  }
  // CIELAB divides by all three. Red light beyond 650 nm has no Z.
  if (!(white.minCoeff() > 0) || !white.allFinite()) {
    return make_error(
        ErrorCode::kBadArgument,
        "the light {} has a white of X {:.3g}, Y 1, Z {:.3g}: colour differences are defined only "
        "where all are above 0",
        light.name, white[0] / sum, white[2] / sum);
  }
  return Matrix(out / sum);
}

Eigen::Vector3d white_of(const Matrix& integrals) {
  return integrals.colwise().sum().transpose();
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
    const double d = ciede2000(xyz_to_lab(triple(truth.col(i)), triple(white)),
                               xyz_to_lab(triple(got.col(i)), triple(white)));
    // What is no number must not pass for a small difference.
    out.push_back(std::isnan(d) ? std::numeric_limits<double>::infinity() : d);
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

namespace {

/// True colours, and the squared metric there, of the samples.
void judge(Problem& p) {
  p.truth.clear();
  p.squared_metric.clear();
  const Eigen::Index smooth = p.samples.count() - p.measured;
  for (std::size_t l = 0; l < p.integrals.size(); ++l) {
    p.truth.push_back(truth_of(p.samples, p.integrals[l]));
    // Smooth spectra are deviations: they are judged at a middle grey.
    Matrix colors = p.truth.back();
    colors.rightCols(smooth) = (kGrey * p.white[l]).replicate(1, smooth);
    const auto roots = metrics(colors, p.white[l]);
    Matrix squared(p.samples.count(), kPairs);
    for (Eigen::Index i = 0; i < squared.rows(); ++i) {
      const Eigen::Matrix3d& root = roots[static_cast<std::size_t>(i)];
      const Eigen::Matrix3d square = root.transpose() * root;
      for (Eigen::Index s = 0; s < kPairs; ++s) squared(i, s) = square(kFirstOf[s], kSecondOf[s]);
    }
    p.squared_metric.push_back(std::move(squared));
  }
}

}  // namespace

Problem make_problem(const Matrix& reflectances, int bounces, const std::vector<Matrix>& lights) {
  Problem out;
  out.integrals = lights;
  for (const Matrix& light : lights) out.white.push_back(white_of(light));
  const Matrix dyes = dye_spectra(kDyes, kFirstDyeNm, kLastDyeNm);
  const Matrix smooth = smooth_spectra();
  const Eigen::Index given = reflectances.cols();
  Matrix table(kGrid, given + dyes.cols() + smooth.cols());
  table << reflectances, dyes, smooth;
  out.samples = sample_set(std::move(table));
  auto& factors = out.samples.factors;
  factors.resize(static_cast<std::size_t>(given));
  // Products are reflectances too, dark and saturated ones: the bands of several lights, which are no light's
  // own, err less with them in the fit even where light is reflected once.
  if (lights.size() > 1) bounces = std::max(bounces, 2);
  if (bounces > 1) {
    out.pool = sample_set(reflectances);
    out.pool.factors.clear();
    for (int b = 2; b <= bounces; ++b) {
      add_products(out.samples, given, b, kProducts);
      add_products(out.pool, given, b, kPool);
    }
    for (const Matrix& light : lights) out.pool_truth.push_back(truth_of(out.pool, light));
  }
  out.scene = out.samples.count();
  for (Eigen::Index i = given; i < out.samples.table.cols(); ++i) factors.push_back({i});
  out.measured = out.scene + dyes.cols();
  out.share = Vector::Ones(out.samples.count());
  const auto whole = static_cast<double>(out.scene);
  out.share.segment(out.scene, dyes.cols()).setConstant(kDyeShare * whole / static_cast<double>(dyes.cols()));
  out.share.tail(smooth.cols()).setConstant(kSmoothShare * whole / static_cast<double>(smooth.cols()));
  judge(out);
  return out;
}

void take_worst(Problem& p, const Numbers& numbers) {
  const auto count = static_cast<std::size_t>(p.pool.count());
  if (count == 0) return;
  std::set<std::size_t> taken;
  for (std::size_t l = 0; l < p.integrals.size(); ++l) {
    const auto wrong =
        differences(p.pool_truth[l], predict(p.pool, numbers, static_cast<Eigen::Index>(l)), p.white[l]);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(kWorst, count));
    // Of equal ones the first, everywhere.
    std::partial_sort(order.begin(), end, order.end(), [&](std::size_t a, std::size_t b) {
      return wrong[a] != wrong[b] ? wrong[a] > wrong[b] : a < b;
    });
    taken.insert(order.begin(), end);
  }
  auto& factors = p.samples.factors;
  const std::set<std::vector<Eigen::Index>> known(factors.begin(), factors.end());
  std::set<std::vector<Eigen::Index>> more;
  for (const std::size_t i : taken) {
    if (known.count(p.pool.factors[i]) == 0) more.insert(p.pool.factors[i]);
  }
  if (more.empty()) return;
  const auto added = static_cast<Eigen::Index>(more.size());
  factors.insert(factors.begin() + p.scene, more.begin(), more.end());
  Vector share(p.share.size() + added);
  share << p.share.head(p.scene), Vector::Ones(added), p.share.tail(p.share.size() - p.scene);
  p.share = std::move(share);
  p.scene += added;
  p.measured += added;
  judge(p);
}

}  // namespace spectile::plan
