// The problem that a plan is fitted to.
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

/// Weights of the synthetic reflectances and of the smooth deviations relative to the scene: enough that
/// unmeasured spectra keep small errors, little enough that measured ones keep their precision. Chosen by
/// cross-validation over several assignments to folds.
constexpr Eigen::Index kSyntheticCount = 400;
constexpr double kFirstEdgeNm = 380;
constexpr double kLastEdgeNm = 780;
constexpr double kSyntheticWeight = 0.2;
constexpr double kSmoothWeight = 1e-2;

/// Products that a fit takes beside the reflectances themselves, for each number of bounces.
constexpr std::size_t kProducts = 300;
/// Products, for each number of bounces, among which the worst are searched; and the number added at a time
/// under each light: random ones alone leave out the few dark saturated ones with the largest errors.
constexpr std::size_t kPool = 5000;
constexpr std::size_t kWorst = 20;
/// Noise of an instrument lies below 0, total reflectance factors of fluorescent paper lie up to 2.
constexpr double kMinReflectance = -0.1;
constexpr double kMaxReflectance = 2;
/// Reflectance at which smooth deviations are evaluated.
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
      if (!(value >= kMinReflectance && value <= kMaxReflectance)) {
        return make_error(ErrorCode::kBadArgument,
                          "reflectance {} of {} is {:.6g} at {} nm; reflectances run from 0 to 1, with room "
                          "from {} to {} for noise and fluorescence",
                          i + 1, out.cols(), value, nm, kMinReflectance, kMaxReflectance);
      }
      out(g, i) = value;
    }
  }
  return out;
}

Result<Matrix> integrals(const NamedLight& light, Observer observer) {
  SPECTILE_ASSIGN(const auto sensor, Sensor::named(observer == Observer::kCie1931 ? "cie1931" : "cie1964"));
  const PiecewiseLinearSpectrum spectrum(light.spectrum);
  Matrix out(kGrid, 3);
  for (Eigen::Index g = 0; g < kGrid; ++g) {
    const double nm = kFirstNm + static_cast<double>(g);
    const double emitted = spectrum(nm);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      out(g, c) = sensor.factors()[k] * sensor.curves()[k](nm) * emitted;
    }
  }
  const Eigen::Vector3d white = white_xyz(out);
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

Eigen::Vector3d white_xyz(const Matrix& integrals) {
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

std::vector<double> differences(const Matrix& reference, const Matrix& got, const Eigen::Vector3d& white,
                                const Eigen::Vector3d& got_white) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < reference.cols(); ++i) {
    const double d = ciede2000(xyz_to_lab(triple(reference.col(i)), triple(white)),
                               xyz_to_lab(triple(got.col(i)), triple(got_white)));
    // NaN must not pass for a small difference.
    out.push_back(std::isnan(d) ? std::numeric_limits<double>::infinity() : d);
  }
  return out;
}

namespace {

/// Reference colours of the samples, and the squared metric at each.
void update_reference(Problem& p) {
  p.reference.clear();
  p.squared_metric.clear();
  const Eigen::Index smooth = p.samples.count() - p.measured;
  for (std::size_t l = 0; l < p.integrals.size(); ++l) {
    p.reference.push_back(reference_xyz(p.samples, p.integrals[l]));
    // Smooth spectra are deviations: their metric is that of a middle grey.
    Matrix colors = p.reference.back();
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
  for (const Matrix& light : lights) out.white.push_back(white_xyz(light));
  const Matrix synthetic = synthetic_reflectances(kSyntheticCount, kFirstEdgeNm, kLastEdgeNm);
  const Matrix smooth = smooth_spectra();
  const Eigen::Index given = reflectances.cols();
  Matrix table(kGrid, given + synthetic.cols() + smooth.cols());
  table << reflectances, synthetic, smooth;
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
    for (const Matrix& light : lights) out.pool_reference.push_back(reference_xyz(out.pool, light));
  }
  out.scene = out.samples.count();
  for (Eigen::Index i = given; i < out.samples.table.cols(); ++i) factors.push_back({i});
  out.measured = out.scene + synthetic.cols();
  out.sample_weights = Vector::Ones(out.samples.count());
  const auto whole = static_cast<double>(out.scene);
  out.sample_weights.segment(out.scene, synthetic.cols())
      .setConstant(kSyntheticWeight * whole / static_cast<double>(synthetic.cols()));
  out.sample_weights.tail(smooth.cols())
      .setConstant(kSmoothWeight * whole / static_cast<double>(smooth.cols()));
  update_reference(out);
  return out;
}

void add_worst_products(Problem& p, const Parameters& parameters) {
  const auto count = static_cast<std::size_t>(p.pool.count());
  if (count == 0) return;
  std::set<std::size_t> taken;
  for (std::size_t l = 0; l < p.integrals.size(); ++l) {
    const auto wrong = differences(p.pool_reference[l],
                                   predict(p.pool, parameters, static_cast<Eigen::Index>(l)), p.white[l]);
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
  Vector weights(p.sample_weights.size() + added);
  weights << p.sample_weights.head(p.scene), Vector::Ones(added),
      p.sample_weights.tail(p.sample_weights.size() - p.scene);
  p.sample_weights = std::move(weights);
  p.scene += added;
  p.measured += added;
  update_reference(p);
}

}  // namespace spectile::plan
