// make_plan, and the errors of plans and of even bands.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <spectile/plan/plan.hpp>

#include "src/base/errors.hpp"
#include "src/planner/problem.hpp"

namespace spectile {
namespace {

using plan::judged_samples;
using plan::kJudgedProducts;
using plan::Matrix;
using plan::Numbers;
using plan::SampleSet;

constexpr std::size_t kMinBands = 3;
constexpr std::size_t kMaxBands = 64;
constexpr int kMaxBounces = 4;
constexpr std::size_t kMinReflectances = 10;
/// Counts that are tried for an error asked for.
constexpr std::size_t kCounts[] = {4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20, 24, 28, 32};

Result<void> check(const PlannerOptions& o) {
  if (o.lights.empty()) return make_error(ErrorCode::kBadArgument, "a plan takes one light at least");
  std::set<std::string_view> names;
  for (const PlannedLight& light : o.lights) {
    if (names.insert(light.name).second) continue;
    return make_error(ErrorCode::kBadArgument, "two lights are called {}", light.name);
  }
  if (o.reflectances.size() < kMinReflectances) {
    return make_error(ErrorCode::kBadArgument, "a plan takes {} reflectances at least, not {}",
                      kMinReflectances, o.reflectances.size());
  }
  if (o.bounces < 1 || o.bounces > kMaxBounces) {
    return make_error(ErrorCode::kBadArgument, "{} bounces are not from 1 to {}", o.bounces, kMaxBounces);
  }
  if (o.bands.has_value() == o.max_error.has_value()) {
    return make_error(ErrorCode::kBadArgument, "a plan takes either a number of bands or a largest error");
  }
  if (o.bands && (*o.bands < kMinBands || *o.bands > kMaxBands)) {
    return make_error(ErrorCode::kBadArgument, "{} bands are not from {} to {}", *o.bands, kMinBands,
                      kMaxBands);
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

/// Starts of an exchange: the greedy one, and others spread evenly.
constexpr int kExchanges = 2;
/// With one light fits are quick: so many more starts beside each, every wavelength up to so far from there.
constexpr int kNearStarts = 3;
constexpr double kNearNm = 10;
/// Plans whose worst products are taken before: where the second differs from the first, it errs elsewhere.
constexpr int kFirstPlans = 2;

/// The nearest whole picometre.
double picometres(double nm) {
  return std::round(nm * 1000) / 1000;
}

/// Where a fit begins: from exchanges over points, or over bands of several widths, with the dyes at several
/// weights. Which start ends best only the fit can tell; these lead to different places most often. Where
/// there are products, those that the first plans err most at join the problem before, so that starts mind
/// them too.
std::vector<plan::Start> starts_of(plan::Problem& problem, const PlannerOptions& o, std::size_t count) {
  // Shares of the visible range that a band begins with.
  const double share = 300 / static_cast<double>(count);
  const bool bands = o.sampling == PlanSampling::kBands;
  const auto halves =
      bands ? std::vector<double>{0.25 * share, 0.4 * share, 0.1 * share} : std::vector<double>{0};
  for (int i = 0; problem.pool.count() > 0 && i < kFirstPlans; ++i) {
    plan::take_worst(problem,
                     {plan::choose_wavelengths(problem, count, halves[0], 1, kExchanges), halves[0]});
  }
  std::vector<plan::Start> out;
  // The same starts every time.
  std::mt19937_64 random(5);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  for (const double half : halves) {
    for (const double dyes : {1.0, 4.0}) {
      const plan::Start start = {plan::choose_wavelengths(problem, count, half, dyes, kExchanges), half};
      out.push_back(start);
      for (int i = 0; o.lights.size() == 1 && i < kNearStarts; ++i) {
        plan::Start near = start;
        for (double& nm : near.wavelengths_nm) {
          nm += kNearNm * (static_cast<double>(random() >> 11U) * 0x1p-52 - 1);
        }
        std::sort(near.wavelengths_nm.begin(), near.wavelengths_nm.end());
        out.push_back(std::move(near));
      }
    }
  }
  return out;
}

Numbers fitted(const Matrix& reflectances, const PlannerOptions& o, const std::vector<Matrix>& integrals,
               std::size_t count) {
  plan::Problem problem = plan::make_problem(reflectances, o.bounces, integrals);
  Numbers n = plan::fit(problem, starts_of(problem, o, count));
  // Whole picometres, which names of channels hold; bands that touch still do not overlap.
  for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
    n.lambda[k] = picometres(n.lambda[k]);
    n.half[k] = std::max(0.0, std::floor(n.half[k] * 1000 - 1) / 1000);
  }
  return n;
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
    const Numbers numbers = fitted(columns(table, fit), o, integrals, count);
    for (int b = 1; b <= o.bounces; ++b) {
      const auto most = std::max<std::size_t>(1, kJudgedProducts / static_cast<std::size_t>(o.folds));
      const SampleSet samples = judged_samples(columns(table, judge), b, most);
      for (std::size_t l = 0; l < integrals.size(); ++l) {
        const auto d = plan::differences(plan::truth_of(samples, integrals[l]),
                                         plan::predict(samples, numbers, static_cast<Eigen::Index>(l)),
                                         plan::white_of(integrals[l]));
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

/// What even bands do on the same reflectances: about as many as the plan has, and the usual ones.
Result<void> compare_even(Plan& plan, const PlannerOptions& o) {
  if (o.folds == 0) return {};
  const auto same = fmt::format("400:700:{}", 300.0 / static_cast<double>(plan.count()));
  for (const std::string& text :
       {same, std::string("400:700:10"), std::string("400:700:5"), std::string("380:780:5")}) {
    SPECTILE_ASSIGN(const auto bands, Bands::parse(text));
    for (const PlannedLight& light : o.lights) {
      for (int b = 1; b <= o.bounces; ++b) {
        const auto error = even_bands_error(bands, light, o.reflectances, b, o.observer);
        // A light that is all beyond these bands; there is nothing to compare with.
        if (!error) continue;
        plan.even.push_back({text, {light.name, b, *error}});
      }
    }
  }
  return {};
}

Plan plan_of(const Numbers& n, const PlannerOptions& o, const Judged& judged) {
  Plan out;
  out.observer = o.observer;
  for (const PlannedLight& light : o.lights) out.lights.push_back({light.name, {}, measured(light.spectrum)});
  for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
    const double nm = n.lambda[k];
    out.wavelengths_nm.push_back(nm);
    if (o.sampling == PlanSampling::kBands) {
      out.bands.push_back({picometres(nm - n.half[k]), nm, picometres(nm + n.half[k])});
    }
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
  SPECTILE_ASSIGN(const auto tabulated, plan::tabulate(o.reflectances));
  const Matrix& table = tabulated;
  std::vector<Matrix> integrals;
  for (const PlannedLight& light : o.lights) {
    SPECTILE_ASSIGN(auto one, plan::integrals(light, o.observer));
    integrals.push_back(std::move(one));
  }
  const auto finished = [&](std::size_t count, const Judged& judged) -> Result<Plan> {
    Plan plan = plan_of(fitted(table, o, integrals, count), o, judged);
    SPECTILE_TRY(compare_even(plan, o));
    return plan;
  };
  if (o.bands) return finished(*o.bands, cross_validate(table, o, integrals, *o.bands));
  PlannerOptions judging = o;
  if (judging.folds == 0) judging.folds = PlannerOptions().folds;
  // Errors fall as counts grow, nearly always: the fewest are between one that fails and one that does not.
  double best = std::numeric_limits<double>::infinity();
  std::size_t best_count = 0;
  std::optional<std::pair<std::size_t, Judged>> met;
  std::size_t low = 0;
  std::size_t high = std::size(kCounts);
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    Judged judged = cross_validate(table, judging, integrals, kCounts[middle]);
    const double most = largest(judged);
    if (most < best) {
      best = most;
      best_count = kCounts[middle];
    }
    if (most <= *o.max_error) {
      met.emplace(kCounts[middle], std::move(judged));
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  if (met) return finished(met->first, met->second);
  return make_error(
      ErrorCode::kUnavailable,
      "no plan keeps every difference below {}; the best there is, with {} bands, has a maximum of "
      "{:.3g}",
      *o.max_error, best_count, best);
}

}  // namespace

Result<Plan> make_plan(const PlannerOptions& options) {
  try {
    return make(options);
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kOutOfMemory, "no memory to plan for {} reflectances",
                      options.reflectances.size());
  }
}

}  // namespace spectile
