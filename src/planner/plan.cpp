// Colours by a plan's weights, and plans as bands.
#include <cmath>
#include <spectile/plan/plan.hpp>

#include "src/base/errors.hpp"

namespace spectile {

std::array<double, 3> Plan::xyz(std::size_t light, std::span<const double> samples) const {
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      out[c] += weights.sensor[k][c] * weights.lights[light].emission[k] * samples[k];
    }
  }
  return out;
}

double Plan::absolute_sum(std::size_t light) const {
  double out = 0;
  for (std::size_t k = 0; k < count(); ++k) {
    out += std::abs(weights.sensor[k][1] * weights.lights[light].emission[k]);
  }
  return out;
}

Result<Bands> planned_bands(const Plan& plan) {
  const bool points = plan.bands.empty();
  if (plan.count() == 0 || (!points && plan.bands.size() != plan.count())) {
    return make_error(ErrorCode::kBadArgument, "a plan of {} wavelengths and {} bands is not whole",
                      plan.count(), plan.bands.size());
  }
  SPECTILE_ASSIGN(const auto bands,
                  points ? Bands::from_centres(plan.wavelengths_nm) : Bands::from_overlapping(plan.bands));
  return bands.with_weights(plan.weights, points ? BandSampling::kPoints : BandSampling::kAverages,
                            std::make_shared<const PlanReport>(plan.report));
}

Plan plan_of_bands(const Bands& bands) {
  Plan out;
  for (const Band& band : bands.list()) out.wavelengths_nm.push_back(band.centre_nm);
  if (!bands.are_points()) out.bands.assign(bands.list().begin(), bands.list().end());
  if (bands.weights() != nullptr) out.weights = *bands.weights();
  if (bands.report() != nullptr) out.report = *bands.report();
  return out;
}

}  // namespace spectile
