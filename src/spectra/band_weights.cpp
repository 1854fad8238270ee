// Bands with weights of their own, and samples in them.
#include "src/spectra/band_weights.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/digest.hpp"
#include "src/base/errors.hpp"

namespace spectile {
namespace {

/// A light's name and a digest of its spectrum over the visible range, relative to its largest value.
std::string light_id(const NamedLight& light) {
  // Rounded, as relative values on two scales differ in their last bits.
  constexpr double kSteps = 1 << 20;
  Digest digest;
  for (const double v : relative_values(light.spectrum)) digest.add(std::round(v * kSteps) + 0.0);  // no -0
  return light.name + '#' + digest.text();
}

}  // namespace

struct Bands::Weighting {
  BandWeights weights;
  BandSampling sampling;
  std::vector<std::string> light_ids;
  std::shared_ptr<const PlanReport> report;
};

Result<Bands> Bands::with_weights(BandWeights weights, BandSampling sampling,
                                  std::shared_ptr<const PlanReport> report) const {
  bool fits = weights.sensor.size() == count() && !weights.lights.empty();
  std::vector<std::string> ids;
  for (const BandLight& light : weights.lights) {
    fits = fits && light.emission.size() == count();
    ids.push_back(light_id(light));
  }
  if (!fits) {
    return make_error(ErrorCode::kBadArgument,
                      "{} sensor weights and {} lights for {} bands are not whole: each band takes a sensor "
                      "weight, and an emission value of every light",
                      weights.sensor.size(), weights.lights.size(), count());
  }
  Bands out = *this;
  out.weighting_ = std::make_shared<const Weighting>(
      Weighting{std::move(weights), sampling, std::move(ids), std::move(report)});
  return out;
}

const BandWeights* Bands::weights() const noexcept {
  return weighting_ == nullptr ? nullptr : &weighting_->weights;
}

const PlanReport* Bands::report() const noexcept {
  return weighting_ == nullptr ? nullptr : weighting_->report.get();
}

bool Bands::are_points() const noexcept {
  return weighting_ != nullptr && weighting_->sampling == BandSampling::kPoints;
}

bool Bands::same_weighting(const Bands& a, const Bands& b) noexcept {
  if (a.weighting_ == nullptr || b.weighting_ == nullptr) return false;
  const Weighting& p = *a.weighting_;
  const Weighting& q = *b.weighting_;
  return p.sampling == q.sampling && p.weights.observer == q.weights.observer &&
         p.weights.sensor == q.weights.sensor && p.light_ids == q.light_ids &&
         std::ranges::equal(p.weights.lights, q.weights.lights, {}, &BandLight::emission,
                            &BandLight::emission);
}

double sample_in(const MeasuredSpectrum& spectrum, const Bands& bands, std::size_t band) {
  const Band& b = bands[band];
  return bands.are_points() ? spectrum.at(b.centre_nm)
                            : spectrum.integral(b.lower_nm, b.upper_nm) / b.width_nm();
}

Result<std::size_t> find_band_light(const BandWeights& weights, const MeasuredSpectrum& light) {
  std::string known;
  for (std::size_t l = 0; l < weights.lights.size(); ++l) {
    if (same_light(weights.lights[l].spectrum, light)) return l;
    known += (l == 0 ? "" : ", ") + weights.lights[l].name;
  }
  return make_error(ErrorCode::kBadArgument,
                    "the plan of these bands holds no emission values for this light, only for {}", known);
}

Result<std::vector<double>> light_samples(const MeasuredSpectrum& light, const Bands& bands) {
  if (bands.weights() != nullptr) {
    SPECTILE_ASSIGN(const auto index, find_band_light(*bands.weights(), light));
    return bands.weights()->lights[index].emission;
  }
  std::vector<double> out;
  for (std::size_t b = 0; b < bands.count(); ++b) out.push_back(sample_in(light, bands, b));
  return out;
}

Result<void> check_observer(const BandWeights& weights, Observer observer) {
  if (weights.observer == observer) return {};
  return make_error(ErrorCode::kBadArgument, "the plan of these bands is for the {} observer, not the {}",
                    to_string(weights.observer), to_string(observer));
}

}  // namespace spectile
