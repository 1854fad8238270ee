// Errors of plans and of even bands, and what a plan makes of samples.
#include "src/base/errors.hpp"

#include <cmath>
#include <spectile/plan/plan.hpp>

#include "src/planner/problem.hpp"

namespace spectile {
namespace plan {

SampleSet judged_samples(Matrix table, int bounces, std::size_t most) {
  const Eigen::Index count = table.cols();
  SampleSet out = sample_set(std::move(table));
  if (bounces <= 1) return out;
  out.factors.clear();
  add_products(out, count, bounces, most);
  return out;
}

}  // namespace plan

using plan::judged_samples;
using plan::kGrid;
using plan::kJudgedProducts;
using plan::Matrix;
using plan::Numbers;
using plan::SampleSet;

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

Result<PlanError> plan_error(const Plan& plan, const PlannedLight& light,
                             const std::vector<Spectrum>& reflectances, int bounces) {
  std::size_t index = 0;
  while (index < plan.lights.size() && plan.lights[index].name != light.name) ++index;
  if (index == plan.lights.size()) {
    return make_error(ErrorCode::kBadArgument, "the plan has no light {}", light.name);
  }
  SPECTILE_ASSIGN(const auto integrals, plan::integrals(light, plan.observer));
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
  numbers.half = plan::Vector::Zero(count);
  for (std::size_t k = 0; k < plan.bands.size(); ++k) {
    numbers.half[static_cast<Eigen::Index>(k)] = plan.bands[k].width_nm() / 2;
  }
  SPECTILE_ASSIGN(auto table, plan::tabulate(reflectances));
  const SampleSet samples = judged_samples(std::move(table), bounces, kJudgedProducts);
  return plan::summary(plan::differences(plan::truth_of(samples, integrals),
                                         plan::predict(samples, numbers, 0), plan::white_of(integrals)));
}

Result<PlanError> even_bands_error(const Bands& bands, const PlannedLight& light,
                                   const std::vector<Spectrum>& reflectances, int bounces,
                                   Observer observer) {
  SPECTILE_ASSIGN(const auto integrals, plan::integrals(light, observer));
  PlannedLight equal = light;
  equal.spectrum = ConstantSpectrum(1);
  SPECTILE_ASSIGN(const auto curves, plan::integrals(equal, observer));
  // Averages over each band of reflectances, light and curves apart, as sampled spectra are multiplied.
  const auto count = static_cast<Eigen::Index>(bands.count());
  plan::Vector centres(count);
  plan::Vector halves(count);
  for (Eigen::Index b = 0; b < count; ++b) {
    const Band& band = bands[static_cast<std::size_t>(b)];
    centres[b] = (band.lower_nm + band.upper_nm) / 2;
    halves[b] = band.width_nm() / 2;
  }
  Matrix emitted(kGrid, 1);
  for (Eigen::Index g = 0; g < kGrid; ++g) {
    emitted(g, 0) = light.spectrum(plan::kFirstNm + static_cast<double>(g));
  }
  Numbers numbers;
  numbers.lambda = centres;
  numbers.half = halves;
  numbers.sensor = plan::values_of(plan::sample_set(curves), centres, halves).transpose();
  numbers.emission = plan::values_of(plan::sample_set(std::move(emitted)), centres, halves).transpose();
  numbers.emission.col(0) = numbers.emission.col(0).cwiseProduct(2 * halves);
  const double sum = numbers.emission.col(0).dot(numbers.sensor.col(1));
  if (!(sum > 0)) {
    return make_error(ErrorCode::kBadArgument, "the light {} has no luminance in these bands", light.name);
  }
  numbers.sensor /= sum;
  SPECTILE_ASSIGN(auto table, plan::tabulate(reflectances));
  const SampleSet samples = judged_samples(std::move(table), bounces, kJudgedProducts);
  return plan::summary(plan::differences(plan::truth_of(samples, integrals),
                                         plan::predict(samples, numbers, 0), plan::white_of(integrals)));
}

}  // namespace spectile
