// make_plan, and the errors of plans and of even bands.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <spectile/plan/plan.hpp>

#include "src/base/out_of_memory.hpp"
#include "src/planner/problem.hpp"

namespace spectile {
namespace {

using plan::evaluation_samples;
using plan::kEvaluationProducts;
using plan::Matrix;
using plan::Parameters;
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
  for (const NamedLight& light : o.lights) {
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

/// Initial guesses of an exchange: the greedy one, and others spread evenly.
constexpr int kExchanges = 2;
/// With one light fits are quick: so many more initial guesses near each, every wavelength within this
/// distance.
constexpr int kNearGuesses = 3;
constexpr double kNearNm = 10;
/// Preliminary plans whose worst products are added: the second errs elsewhere than the first.
constexpr int kFirstPlans = 2;

/// Several lights have lines at several places, where narrow bands end best: fits of bands that may overlap
/// came out no better for them, and their largest errors worse.
bool keeps_apart(const PlannerOptions& o) {
  return o.apart || o.lights.size() > 1;
}

/// The nearest whole picometre.
double picometres(double nm) {
  return std::round(nm * 1000) / 1000;
}

/// Initial guesses of a fit: from exchanges over points, or over bands of several widths, with the synthetic
/// reflectances at several weights. Only the fit can tell which ends best; these lead to different minima
/// most often. Where there are products, those with the largest errors of preliminary plans join the problem
/// first.
std::vector<plan::InitialGuess> initial_guesses(plan::Problem& problem, const PlannerOptions& o,
                                                std::size_t count) {
  // Widths that bands begin with, relative to an even division of 300 nm.
  const double even_nm = 300 / static_cast<double>(count);
  const bool bands = o.sampling == BandSampling::kAverages;
  std::vector<double> halves = {0};
  if (bands) halves = {0.25 * even_nm, 0.4 * even_nm, (keeps_apart(o) ? 0.1 : 0.8) * even_nm};
  for (int i = 0; problem.pool.count() > 0 && i < kFirstPlans; ++i) {
    plan::add_worst_products(problem,
                             {plan::choose_wavelengths(problem, count, halves[0], 1, kExchanges), halves[0]});
  }
  std::vector<plan::InitialGuess> out;
  // Deterministic.
  std::mt19937_64 random(5);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  for (const double half : halves) {
    for (const double synthetic_weight : {1.0, 4.0}) {
      const plan::InitialGuess guess = {
          plan::choose_wavelengths(problem, count, half, synthetic_weight, kExchanges), half};
      out.push_back(guess);
      for (int i = 0; o.lights.size() == 1 && i < kNearGuesses; ++i) {
        plan::InitialGuess near = guess;
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

Parameters fitted(const Matrix& reflectances, const PlannerOptions& o, const std::vector<Matrix>& integrals,
                  std::size_t count) {
  plan::Problem problem = plan::make_problem(reflectances, o.bounces, integrals);
  problem.apart = keeps_apart(o);
  problem.check = [&o] {
    if (o.go_on && !o.go_on()) throw plan::Stopped{};
  };
  Parameters n = plan::fit(problem, initial_guesses(problem, o, count));
  // Whole picometres, which names of channels hold; bands that touch still do not overlap.
  for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
    n.lambda[k] = picometres(n.lambda[k]);
    n.half[k] = std::max(0.0, std::floor(n.half[k] * 1000 - 1) / 1000);
  }
  return n;
}

/// Colour differences of held-out reflectances or products of them. Shapes: [lights][bounces][..].
using HeldOutErrors = std::vector<std::vector<std::vector<double>>>;

HeldOutErrors cross_validate(const Matrix& table, const PlannerOptions& o,
                             const std::vector<Matrix>& integrals, std::size_t count) {
  HeldOutErrors out(integrals.size(), std::vector<std::vector<double>>(static_cast<std::size_t>(o.bounces)));
  for (int fold = 0; fold < o.folds; ++fold) {
    std::vector<Eigen::Index> fit;
    std::vector<Eigen::Index> evaluate;
    // Neighbours in a file are often alike: they go to different folds.
    for (Eigen::Index i = 0; i < table.cols(); ++i) (i % o.folds == fold ? evaluate : fit).push_back(i);
    const Parameters parameters = fitted(table(Eigen::all, fit), o, integrals, count);
    for (int b = 1; b <= o.bounces; ++b) {
      const auto most = std::max<std::size_t>(1, kEvaluationProducts / static_cast<std::size_t>(o.folds));
      const SampleSet samples = evaluation_samples(table(Eigen::all, evaluate), b, most);
      for (std::size_t l = 0; l < integrals.size(); ++l) {
        const auto d = plan::differences(plan::reference_xyz(samples, integrals[l]),
                                         plan::predict(samples, parameters, static_cast<Eigen::Index>(l)),
                                         plan::white_xyz(integrals[l]));
        auto& all = out[l][static_cast<std::size_t>(b - 1)];
        all.insert(all.end(), d.begin(), d.end());
      }
    }
  }
  return out;
}

double largest(const HeldOutErrors& held_out) {
  double out = 0;
  for (const auto& light : held_out) {
    for (const auto& bounce : light) out = std::max(out, *std::max_element(bounce.begin(), bounce.end()));
  }
  return out;
}

/// Adds the errors of even bands on the same reflectances: about as many as the plan has, and the usual ones.
Result<void> compare_even(Plan& plan, const PlannerOptions& o) {
  if (o.folds == 0) return {};
  const auto same = fmt::format("400:700:{}", 300.0 / static_cast<double>(plan.count()));
  for (const EvenBandsSums sums : {EvenBandsSums::kAsProjected, EvenBandsSums::kAveragesMultiplied}) {
    for (const std::string& text :
         {same, std::string("400:700:10"), std::string("400:700:5"), std::string("380:780:5")}) {
      SPECTILE_ASSIGN(const auto bands, Bands::parse(text));
      for (const NamedLight& light : o.lights) {
        for (int b = 1; b <= o.bounces; ++b) {
          const auto error = even_bands_error(bands, light, o.reflectances, b, sums, o.observer);
          // A light that is all beyond these bands; there is nothing to compare with.
          if (!error) continue;
          plan.report.even_bands.push_back({sums, text, light.name, b, *error});
        }
      }
    }
  }
  return {};
}

Plan assemble_plan(const Parameters& n, const PlannerOptions& o, const HeldOutErrors& held_out) {
  Plan out;
  out.weights.observer = o.observer;
  for (const NamedLight& light : o.lights) out.weights.lights.push_back({light, {}});
  for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
    const double nm = n.lambda[k];
    out.wavelengths_nm.push_back(nm);
    if (o.sampling == BandSampling::kAverages) {
      out.bands.push_back({picometres(nm - n.half[k]), nm, picometres(nm + n.half[k])});
    }
    // Only products count: emission values are made 1 on average.
    const double mean = n.emission.row(k).mean();
    const double by = std::abs(mean) > 1e-6 ? mean : 1.0;
    out.weights.sensor.push_back({n.sensor(k, 0) * by, n.sensor(k, 1) * by, n.sensor(k, 2) * by});
    for (std::size_t l = 0; l < o.lights.size(); ++l) {
      out.weights.lights[l].emission.push_back(n.emission(k, static_cast<Eigen::Index>(l)) / by);
    }
  }
  for (std::size_t l = 0; l < held_out.size(); ++l) {
    for (std::size_t b = 0; b < held_out[l].size(); ++b) {
      if (held_out[l][b].empty()) continue;
      out.report.errors.push_back({o.lights[l].name, static_cast<int>(b) + 1, summarize(held_out[l][b])});
    }
  }
  return out;
}

Result<Plan> make(const PlannerOptions& o) {
  SPECTILE_TRY(check(o));
  SPECTILE_ASSIGN(const auto tabulated, plan::tabulate(o.reflectances));
  const Matrix& table = tabulated;
  std::vector<Matrix> integrals;
  for (const NamedLight& light : o.lights) {
    SPECTILE_ASSIGN(auto one, plan::integrals(light, o.observer));
    integrals.push_back(std::move(one));
  }
  const auto finished = [&](std::size_t count, const HeldOutErrors& held_out) -> Result<Plan> {
    Plan plan = assemble_plan(fitted(table, o, integrals, count), o, held_out);
    SPECTILE_TRY(compare_even(plan, o));
    return plan;
  };
  if (o.bands) return finished(*o.bands, cross_validate(table, o, integrals, *o.bands));
  PlannerOptions evaluated = o;
  if (evaluated.folds == 0) evaluated.folds = PlannerOptions().folds;
  // Errors fall as counts grow, nearly always: the fewest are between one that fails and one that does not.
  double best = std::numeric_limits<double>::infinity();
  std::size_t best_count = 0;
  std::optional<std::pair<std::size_t, HeldOutErrors>> met;
  std::size_t low = 0;
  std::size_t high = std::size(kCounts);
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    HeldOutErrors held_out = cross_validate(table, evaluated, integrals, kCounts[middle]);
    const double most = largest(held_out);
    if (most < best) {
      best = most;
      best_count = kCounts[middle];
    }
    if (most <= *o.max_error) {
      met.emplace(kCounts[middle], std::move(held_out));
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
    return guard_memory([&] { return make(options); }, "no memory to plan for {} reflectances",
                        options.reflectances.size());
  } catch (const plan::Stopped&) {
    return make_error(ErrorCode::kCancelled, "stopped on request");
  }
}

}  // namespace spectile
