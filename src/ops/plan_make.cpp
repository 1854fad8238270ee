// make_plan, and the errors of plans and of even bands.
#include <algorithm>
#include <cmath>
#include <spectile/plan.hpp>

#include "src/base/errors.hpp"
#include "src/ops/plan_problem.hpp"

namespace spectile {
namespace {

using plan::kGrid;
using plan::Matrix;
using plan::Numbers;

constexpr std::size_t kFewestBands = 3;
constexpr std::size_t kMostBands = 64;
constexpr int kMostBounces = 4;
constexpr std::size_t kFewestReflectances = 10;
/// Products that an error is taken over.
constexpr std::size_t kJudgedProducts = 2000;
/// Counts that are tried for an error asked for.
constexpr std::size_t kCounts[] = {4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20, 24, 28, 32};

Result<void> check(const PlannerOptions& o) {
  if (o.lights.empty()) return make_error(ErrorCode::kBadArgument, "a plan takes one light at least");
  if (o.reflectances.size() < kFewestReflectances) {
    return make_error(ErrorCode::kBadArgument, "a plan takes {} reflectances at least, not {}",
                      kFewestReflectances, o.reflectances.size());
  }
  if (o.bounces < 1 || o.bounces > kMostBounces) {
    return make_error(ErrorCode::kBadArgument, "{} bounces are not from 1 to {}", o.bounces, kMostBounces);
  }
  if (o.bands.has_value() == o.max_error.has_value()) {
    return make_error(ErrorCode::kBadArgument, "a plan takes either a number of bands or a largest error");
  }
  if (o.bands && (*o.bands < kFewestBands || *o.bands > kMostBands)) {
    return make_error(ErrorCode::kBadArgument, "{} bands are not from {} to {}", *o.bands, kFewestBands,
                      kMostBands);
  }
  if (o.max_error && !(*o.max_error > 0)) {
    return make_error(ErrorCode::kBadArgument, "a largest error of {} is not above 0", *o.max_error);
  }
  if (o.folds != 0 && (o.folds < 2 || static_cast<std::size_t>(o.folds) * 2 > o.reflectances.size())) {
    return make_error(ErrorCode::kBadArgument, "{} folds of {} reflectances cannot be made", o.folds,
                      o.reflectances.size());
  }
  return {};
}

Matrix columns(const Matrix& table, const std::vector<Eigen::Index>& which) {
  Matrix out(table.rows(), static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = table.col(which[i]);
  return out;
}

Numbers fitted(const Matrix& reflectances, int bounces, const std::vector<Matrix>& integrals,
               std::size_t count) {
  const plan::Problem problem = plan::make_problem(reflectances, bounces, integrals);
  // One light is quick enough for some more starts.
  const int starts = integrals.size() == 1 ? 4 : 1;
  return plan::fit(problem, plan::choose_wavelengths(problem, count, problem.share, starts));
}

Eigen::Vector3d white_of(const Matrix& integrals) {
  return integrals.colwise().sum().transpose();
}

/// Differences of reflectances (or products of them) that took no part, light by light, bounce by bounce.
using Judged = std::vector<std::vector<std::vector<double>>>;

Judged cross_validate(const Matrix& table, const PlannerOptions& o, const std::vector<Matrix>& integrals,
                      std::size_t count) {
  Judged out(integrals.size(), std::vector<std::vector<double>>(static_cast<std::size_t>(o.bounces)));
  for (int fold = 0; fold < o.folds; ++fold) {
    std::vector<Eigen::Index> fit;
    std::vector<Eigen::Index> judge;
    // Neighbours in a file are often alike: they go to different folds.
    for (Eigen::Index i = 0; i < table.cols(); ++i) (i % o.folds == fold ? judge : fit).push_back(i);
    const Numbers numbers = fitted(columns(table, fit), o.bounces, integrals, count);
    const Matrix judged = columns(table, judge);
    for (int b = 1; b <= o.bounces; ++b) {
      const auto most = kJudgedProducts / static_cast<std::size_t>(o.folds);
      const Matrix samples = plan::products(judged, b, most);
      for (std::size_t l = 0; l < integrals.size(); ++l) {
        const auto d = plan::differences(integrals[l].transpose() * samples,
                                         plan::predict(samples, numbers, static_cast<Eigen::Index>(l)),
                                         white_of(integrals[l]));
        auto& all = out[l][static_cast<std::size_t>(b - 1)];
        all.insert(all.end(), d.begin(), d.end());
      }
    }
  }
  return out;
}

double largest(const Judged& judged) {
  double out = 0;
  for (const auto& light : judged) {
    for (const auto& bounce : light) out = std::max(out, *std::max_element(bounce.begin(), bounce.end()));
  }
  return out;
}

/// The light as a plan keeps it: its own samples, or a table every nanometre.
MeasuredSpectrum measured(const Spectrum& light) {
  if (const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&light.kind())) {
    return linear->measured();
  }
  std::vector<double> wavelengths;
  for (int nm = plan::kFirstNm; nm <= plan::kLastNm; ++nm) wavelengths.push_back(nm);
  return *MeasuredSpectrum::from_samples(wavelengths, light.sample(wavelengths));
}

Plan plan_of(const Numbers& n, const PlannerOptions& o, const Judged& judged) {
  Plan out;
  out.observer = o.observer;
  for (const PlannedLight& light : o.lights) out.lights.push_back({light.name, {}, measured(light.spectrum)});
  for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
    out.wavelengths_nm.push_back(n.lambda[k]);
    // Only products count: emission values are made 1 on average.
    const double mean = n.emission.row(k).mean();
    const double by = std::abs(mean) > 1e-6 ? mean : 1.0;
    out.sensor.push_back({n.sensor(k, 0) * by, n.sensor(k, 1) * by, n.sensor(k, 2) * by});
    for (std::size_t l = 0; l < o.lights.size(); ++l) {
      out.lights[l].emission.push_back(n.emission(k, static_cast<Eigen::Index>(l)) / by);
    }
  }
  for (std::size_t l = 0; l < judged.size(); ++l) {
    for (std::size_t b = 0; b < judged[l].size(); ++b) {
      if (judged[l][b].empty()) continue;
      out.promises.push_back({o.lights[l].name, static_cast<int>(b) + 1, plan::summary(judged[l][b])});
    }
  }
  return out;
}

Result<Plan> make(const PlannerOptions& o) {
  SPECTILE_TRY(check(o));
  const Matrix table = plan::tabulate(o.reflectances);
  std::vector<Matrix> integrals;
  for (const PlannedLight& light : o.lights) {
    auto one = plan::integrals(light, o.observer);
    if (!one) return one.error();
    integrals.push_back(*std::move(one));
  }
  if (o.bands) {
    return plan_of(fitted(table, o.bounces, integrals, *o.bands), o,
                   cross_validate(table, o, integrals, *o.bands));
  }
  PlannerOptions judging = o;
  if (judging.folds == 0) judging.folds = PlannerOptions().folds;
  double best = -1;
  std::size_t best_count = 0;
  for (const std::size_t count : kCounts) {
    const Judged judged = cross_validate(table, judging, integrals, count);
    const double most = largest(judged);
    if (most <= *o.max_error) return plan_of(fitted(table, o.bounces, integrals, count), o, judged);
    if (best < 0 || most < best) {
      best = most;
      best_count = count;
    }
  }
  return make_error(
      ErrorCode::kUnavailable,
      "no plan keeps every difference below {}; the best there is, with {} bands, has a maximum of "
      "{:.3g}",
      *o.max_error, best_count, best);
}

}  // namespace

std::array<double, 3> Plan::xyz(std::size_t light, std::span<const double> samples) const {
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) out[c] += sensor[k][c] * lights[light].emission[k] * samples[k];
  }
  return out;
}

double Plan::absolute_sum(std::size_t light) const {
  double out = 0;
  for (std::size_t k = 0; k < count(); ++k) out += std::abs(sensor[k][1] * lights[light].emission[k]);
  return out;
}

Result<Plan> make_plan(const PlannerOptions& options) {
  try {
    return make(options);
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kOutOfMemory, "no memory to plan for {} reflectances",
                      options.reflectances.size());
  }
}

Result<PlanError> plan_error(const Plan& plan, const PlannedLight& light,
                             const std::vector<Spectrum>& reflectances, int bounces) {
  std::size_t index = 0;
  while (index < plan.lights.size() && plan.lights[index].name != light.name) ++index;
  if (index == plan.lights.size()) {
    return make_error(ErrorCode::kBadArgument, "the plan has no light {}", light.name);
  }
  const auto integrals = plan::integrals(light, plan.observer);
  if (!integrals) return integrals.error();
  Numbers numbers;
  const auto count = static_cast<Eigen::Index>(plan.count());
  numbers.lambda = Eigen::Map<const plan::Vector>(plan.wavelengths_nm.data(), count);
  numbers.sensor.resize(count, 3);
  numbers.emission.resize(count, 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    for (Eigen::Index c = 0; c < 3; ++c) numbers.sensor(k, c) = plan.sensor[at][static_cast<std::size_t>(c)];
    numbers.emission(k, 0) = plan.lights[index].emission[at];
  }
  const Matrix samples = plan::products(plan::tabulate(reflectances), bounces, kJudgedProducts);
  return plan::summary(plan::differences(integrals->transpose() * samples, plan::predict(samples, numbers, 0),
                                         white_of(*integrals)));
}

Result<PlanError> even_bands_error(const Bands& bands, const PlannedLight& light,
                                   const std::vector<Spectrum>& reflectances, int bounces,
                                   Observer observer) {
  const auto integrals = plan::integrals(light, observer);
  if (!integrals) return integrals.error();
  PlannedLight equal = light;
  equal.spectrum = ConstantSpectrum(1);
  const auto curves = plan::integrals(equal, observer);
  if (!curves) return curves.error();
  // Averages over each band of reflectances, light and curves apart, as sampled spectra are multiplied.
  const Matrix table = plan::tabulate(reflectances);
  Matrix averages = Matrix::Zero(static_cast<Eigen::Index>(bands.count()), table.cols());
  Matrix weights = Matrix::Zero(averages.rows(), 3);
  for (Eigen::Index b = 0; b < averages.rows(); ++b) {
    const Band& band = bands[static_cast<std::size_t>(b)];
    constexpr int kSteps = 20;
    double emitted = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double nm = band.lower_nm + (i + 0.5) / kSteps * band.width_nm();
      averages.row(b) += plan::samples_at(table, nm).transpose() / kSteps;
      weights.row(b) += plan::samples_at(*curves, nm).transpose() / kSteps;
      emitted += light.spectrum(nm) / kSteps;
    }
    weights.row(b) *= emitted * band.width_nm();
  }
  const double sum = weights.col(1).sum();
  if (!(sum > 0)) {
    return make_error(ErrorCode::kBadArgument, "the light {} has no luminance in these bands", light.name);
  }
  weights /= sum;
  // Each bounce multiplies the bands' averages: the products of both must be of the same reflectances.
  const Matrix both =
      plan::products((Matrix(kGrid + averages.rows(), table.cols()) << table, averages).finished(), bounces,
                     kJudgedProducts);
  return plan::summary(plan::differences(integrals->transpose() * both.topRows(kGrid),
                                         weights.transpose() * both.bottomRows(averages.rows()),
                                         white_of(*integrals)));
}

}  // namespace spectile
