// Plans as files, and the checks of what they hold.
#include <cmath>
#include <filesystem>
#include <set>
#include <spectile/image/plan_file.hpp>
#include <spectile/output_file.hpp>

#include "src/base/errors.hpp"
#include "src/io/text/json/plan_flaw.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {
namespace io {
namespace {

constexpr double kFirstNm = 100;
constexpr double kLastNm = 10000;

}  // namespace

std::string plan_flaw(const Plan& plan) {
  const std::size_t count = plan.wavelengths_nm.size();
  if (count == 0 || count > kMaxPlanWavelengths) {
    return fmt::format("{} wavelengths are not from 1 to {}", count, kMaxPlanWavelengths);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double nm = plan.wavelengths_nm[k];
    if (!(nm >= kFirstNm && nm <= kLastNm)) {
      return fmt::format("a wavelength of {} nm is not from {} to {} nm", nm, kFirstNm, kLastNm);
    }
    if (k > 0 && !(nm > plan.wavelengths_nm[k - 1])) {
      return fmt::format("the wavelengths do not ascend: {} nm comes after {} nm", nm,
                         plan.wavelengths_nm[k - 1]);
    }
  }
  if (!plan.bands.empty()) {
    if (plan.bands.size() != count) {
      return fmt::format("there are {} bands for {} wavelengths", plan.bands.size(), count);
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (plan.bands[k].centre_nm != plan.wavelengths_nm[k]) {
        return fmt::format("a band around {} nm belongs to the wavelength {} nm", plan.bands[k].centre_nm,
                           plan.wavelengths_nm[k]);
      }
    }
    if (const auto bands = Bands::from_overlapping(plan.bands); !bands) return bands.error().message;
  }
  if (plan.weights.sensor.size() != count) {
    return fmt::format("the sensor has {} weights for {} wavelengths", plan.weights.sensor.size(), count);
  }
  for (const auto& weights : plan.weights.sensor) {
    for (const double weight : weights) {
      if (!std::isfinite(weight)) return fmt::format("a sensor weight is {}", weight);
    }
  }
  if (plan.weights.lights.empty() || plan.weights.lights.size() > kMaxPlanLights) {
    return fmt::format("{} lights are not from 1 to {}", plan.weights.lights.size(), kMaxPlanLights);
  }
  std::set<std::string> names;
  for (const BandLight& light : plan.weights.lights) {
    if (!names.insert(light.name).second)
      return fmt::format("two lights are called {}", io::quoted(light.name));
    if (light.emission.size() != count) {
      return fmt::format("the light {} has {} emission values for {} wavelengths", io::quoted(light.name),
                         light.emission.size(), count);
    }
    for (const double value : light.emission) {
      if (!std::isfinite(value))
        return fmt::format("an emission value of {} is {}", io::quoted(light.name), value);
    }
  }
  return {};
}

}  // namespace io

Result<Plan> load_plan(const std::string& path) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  return parse_plan(*file.text, path);
}

Result<Bands> find_bands(const std::string& text) {
  auto bands = Bands::parse(text);
  if (bands) return bands;
  const bool like_a_path = text.find('/') != std::string::npos || text.ends_with(".json");
  std::error_code error;
  if (!like_a_path && !std::filesystem::exists(text, error)) return bands;
  SPECTILE_ASSIGN(const auto plan, load_plan(text));
  return planned_bands(plan);
}

Result<void> save_plan(const Plan& plan, const std::string& path) {
  if (const std::string what = io::plan_flaw(plan); !what.empty()) {
    return make_error(ErrorCode::kBadArgument, "{}: not written: {}", path, what);
  }
  return write_text_file(path, plan_to_json(plan));
}

}  // namespace spectile
