// Bands of plans, and what they weigh by.
#include "src/spectra/planned_bands.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

/// Spectra that differ by no more than this of their largest value are the same.
constexpr double kSame = 1e-6;

/// Where lights are compared: the range of the observers.
constexpr int kFirstNm = 360;
constexpr int kLastNm = 830;

double largest(const MeasuredSpectrum& spectrum) {
  double out = 0;
  for (int nm = kFirstNm; nm <= kLastNm; ++nm) out = std::max(out, std::abs(spectrum.at(nm)));
  return out;
}

/// Whether two spectra are one on different scales.
bool same_light(const MeasuredSpectrum& a, const MeasuredSpectrum& b) {
  const double size_a = largest(a);
  const double size_b = largest(b);
  if (!(size_a > 0) || !(size_b > 0)) return false;
  for (int nm = kFirstNm; nm <= kLastNm; ++nm) {
    if (!(std::abs(a.at(nm) / size_a - b.at(nm) / size_b) <= kSame)) return false;
  }
  return true;
}

bool same_lights(const Plan& a, const Plan& b) {
  return std::equal(a.lights.begin(), a.lights.end(), b.lights.begin(), b.lights.end(),
                    [](const PlanLight& x, const PlanLight& y) {
                      return x.name == y.name && x.emission == y.emission &&
                             same_light(x.spectrum, y.spectrum);
                    });
}

}  // namespace

Result<Bands> Bands::of_plan(const Plan& plan) {
  const std::size_t count = plan.count();
  bool fits = count > 0 && plan.sensor.size() == count && !plan.lights.empty() &&
              (plan.bands.empty() || plan.bands.size() == count);
  for (const PlanLight& light : plan.lights) fits = fits && light.emission.size() == count;
  if (!fits) {
    return make_error(ErrorCode::kBadArgument,
                      "a plan of {} wavelengths, {} sensor weights, {} bands and {} lights is not whole",
                      count, plan.sensor.size(), plan.bands.size(), plan.lights.size());
  }
  auto out = plan.bands.empty() ? from_centres(plan.wavelengths_nm) : from_list(plan.bands);
  if (!out) return out;
  out->plan_ = std::make_shared<const Plan>(plan);
  return out;
}

bool Bands::are_points() const noexcept {
  return plan_ != nullptr && plan_->bands.empty();
}

bool Bands::same_plan(const Bands& a, const Bands& b) noexcept {
  if (a.plan_ == nullptr || b.plan_ == nullptr) return false;
  const Plan& p = *a.plan_;
  const Plan& q = *b.plan_;
  return p.observer == q.observer && p.wavelengths_nm == q.wavelengths_nm && p.bands == q.bands &&
         p.sensor == q.sensor && same_lights(p, q);
}

double sample_in(const MeasuredSpectrum& spectrum, const Bands& bands, std::size_t band) {
  const Band& b = bands[band];
  return bands.are_points() ? spectrum.at(b.centre_nm)
                            : spectrum.integral(b.lower_nm, b.upper_nm) / b.width_nm();
}

Result<std::size_t> planned_light(const Plan& plan, const MeasuredSpectrum& light) {
  std::string known;
  for (std::size_t l = 0; l < plan.lights.size(); ++l) {
    if (same_light(plan.lights[l].spectrum, light)) return l;
    known += (l == 0 ? "" : ", ") + plan.lights[l].name;
  }
  return make_error(ErrorCode::kBadArgument,
                    "the plan of these bands holds no emission values for this light, only for {}", known);
}

Result<std::vector<double>> light_samples(const MeasuredSpectrum& light, const Bands& bands) {
  if (bands.plan() != nullptr) {
    SPECTILE_ASSIGN(const auto index, planned_light(*bands.plan(), light));
    return bands.plan()->lights[index].emission;
  }
  std::vector<double> out;
  for (std::size_t b = 0; b < bands.count(); ++b) out.push_back(sample_in(light, bands, b));
  return out;
}

Result<void> check_observer(const Plan& plan, Observer observer) {
  if (plan.observer == observer) return {};
  return make_error(ErrorCode::kBadArgument, "the plan of these bands is for the {} observer, not the {}",
                    plan.observer == Observer::kCie1964 ? "1964" : "1931",
                    observer == Observer::kCie1964 ? "1964" : "1931");
}

}  // namespace spectile
