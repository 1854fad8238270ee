// Errors of plans and of even bands.
#include "src/base/errors.hpp"

#include <spectile/plan/plan.hpp>

#include "src/planner/problem.hpp"

namespace spectile {
namespace plan {

SampleSet evaluation_samples(Matrix table, int bounces, std::size_t most) {
  const Eigen::Index count = table.cols();
  SampleSet out = sample_set(std::move(table));
  if (bounces <= 1) return out;
  out.factors.clear();
  add_products(out, count, bounces, most);
  return out;
}

}  // namespace plan

using plan::evaluation_samples;
using plan::kEvaluationProducts;
using plan::kGrid;
using plan::Matrix;
using plan::Parameters;
using plan::SampleSet;

Result<ColorError> plan_error(const Plan& plan, const NamedLight& light,
                              const std::vector<Spectrum>& reflectances, int bounces) {
  std::size_t index = 0;
  while (index < plan.weights.lights.size() && plan.weights.lights[index].name != light.name) ++index;
  if (index == plan.weights.lights.size()) {
    return make_error(ErrorCode::kBadArgument, "the plan has no light {}", light.name);
  }
  SPECTILE_ASSIGN(const auto integrals, plan::integrals(light, plan.weights.observer));
  Parameters parameters;
  const auto count = static_cast<Eigen::Index>(plan.count());
  parameters.lambda = Eigen::Map<const plan::Vector>(plan.wavelengths_nm.data(), count);
  parameters.sensor.resize(count, 3);
  parameters.emission.resize(count, 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    for (Eigen::Index c = 0; c < 3; ++c)
      parameters.sensor(k, c) = plan.weights.sensor[at][static_cast<std::size_t>(c)];
    parameters.emission(k, 0) = plan.weights.lights[index].emission[at];
  }
  parameters.half = plan::Vector::Zero(count);
  for (std::size_t k = 0; k < plan.bands.size(); ++k) {
    parameters.half[static_cast<Eigen::Index>(k)] = plan.bands[k].width_nm() / 2;
  }
  SPECTILE_ASSIGN(auto table, plan::tabulate(reflectances));
  const SampleSet samples = evaluation_samples(std::move(table), bounces, kEvaluationProducts);
  return summarize(plan::differences(plan::reference_xyz(samples, integrals),
                                     plan::predict(samples, parameters, 0), plan::white_xyz(integrals)));
}

namespace {

/// Averages of light and matching functions over each band, apart. Shapes: sensor [bands][3], emission
/// [bands][1].
Result<void> add_averages(Parameters& parameters, const NamedLight& light, Observer observer) {
  SPECTILE_ASSIGN(const auto equal_energy, named_light(light.name, ConstantSpectrum(1)));
  SPECTILE_ASSIGN(const auto curves, plan::integrals(equal_energy, observer));
  Matrix emitted(kGrid, 1);
  const PiecewiseLinearSpectrum spectrum(light.spectrum);
  for (Eigen::Index g = 0; g < kGrid; ++g) {
    emitted(g, 0) = spectrum(plan::kFirstNm + static_cast<double>(g));
  }
  const auto averages = [&parameters](Matrix spectra) -> Matrix {
    return plan::sample_values(plan::sample_set(std::move(spectra)), parameters.lambda, parameters.half)
        .transpose();
  };
  parameters.sensor = averages(curves);
  parameters.emission = averages(std::move(emitted));
  return {};
}

}  // namespace

Result<ColorError> even_bands_error(const Bands& bands, const NamedLight& light,
                                    const std::vector<Spectrum>& reflectances, int bounces,
                                    EvenBandsSums sums, Observer observer) {
  SPECTILE_ASSIGN(const auto integrals, plan::integrals(light, observer));
  const auto count = static_cast<Eigen::Index>(bands.count());
  Parameters parameters;
  parameters.lambda.resize(count);
  parameters.half.resize(count);
  for (Eigen::Index b = 0; b < count; ++b) {
    const Band& band = bands[static_cast<std::size_t>(b)];
    parameters.lambda[b] = (band.lower_nm + band.upper_nm) / 2;
    parameters.half[b] = band.width_nm() / 2;
  }
  const bool projected = sums == EvenBandsSums::kAsProjected;
  if (projected) {
    parameters.sensor =
        plan::sample_values(plan::sample_set(integrals), parameters.lambda, parameters.half).transpose();
    parameters.emission = Matrix::Ones(count, 1);
  } else {
    SPECTILE_TRY(add_averages(parameters, light, observer));
  }
  parameters.emission.col(0) = parameters.emission.col(0).cwiseProduct(2 * parameters.half);
  Eigen::Vector3d white = parameters.sensor.transpose() * parameters.emission.col(0);
  if (!(white.minCoeff() > 0)) {
    return make_error(ErrorCode::kBadArgument, "the light {} has no X, Y or Z in these bands", light.name);
  }
  parameters.sensor /= white[1];
  white /= white[1];
  SPECTILE_ASSIGN(auto table, plan::tabulate(reflectances));
  const SampleSet samples = evaluation_samples(std::move(table), bounces, kEvaluationProducts);
  const Matrix reference = plan::reference_xyz(samples, integrals);
  const Matrix got = plan::predict(samples, parameters, 0);
  const Eigen::Vector3d light_white = plan::white_xyz(integrals);
  return summarize(plan::differences(reference, got, light_white, projected ? white : light_white));
}

}  // namespace spectile
