// Plans as JSON text.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <spectile/image/plan_file.hpp>
#include <stdexcept>

#include "src/base/errors.hpp"
#include "src/io/text/json/checked_json.hpp"
#include "src/io/text/json/plan_flaw.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {
namespace {

using io::Json;
using io::member;
using io::numbers;
using io::Refused;

constexpr const char* kMeasure = "CIEDE2000 against 1 nm integration, cross-validated";
constexpr std::array<const char*, 3> kSensorNames = {"x", "y", "z"};

// --- to JSON ----------------------------------------------------------------------------------------------

Json to_json(const ColorError& error) {
  return {{"mean", error.mean}, {"percentile95", error.percentile95}, {"maximum", error.maximum}};
}

Json to_json(const BandLight& light) {
  Json out = {{"name", light.name}, {"emission", light.emission}};
  io::add_spectrum(out, light);
  return out;
}

const char* key_of(EvenBandsSums sums) {
  return sums == EvenBandsSums::kAsProjected ? "even_bands_projected" : "even_bands";
}

Json to_json(const PlanReport& report) {
  Json out = {{"measure", kMeasure}, {"illuminants", Json::object()}};
  for (const CrossValidatedError& e : report.errors) {
    out["illuminants"][e.light][std::to_string(e.bounces)] = to_json(e.error);
  }
  for (const EvenBandsError& e : report.even_bands) {
    out[key_of(e.sums)][e.bands][e.light][std::to_string(e.bounces)] = to_json(e.error);
  }
  return out;
}

// --- from JSON --------------------------------------------------------------------------------------------

ColorError error_from(const Json& json, const std::string& where) {
  const auto one = [&](const char* key) {
    const Json& value = member(json, key, where);
    if (!value.is_number()) throw Refused(fmt::format("\"{}\" of {} is no number", key, where));
    return value.get<double>();
  };
  return {one("mean"), one("percentile95"), one("maximum")};
}

std::vector<CrossValidatedError> errors_from(const Json& illuminants, const std::string& where) {
  std::vector<CrossValidatedError> out;
  if (!illuminants.is_object()) throw Refused(where + " is no object");
  for (const auto& [light, bounces] : illuminants.items()) {
    if (!bounces.is_object())
      throw Refused(fmt::format("{} under {} is no object", where, io::quoted(light)));
    std::set<int> known;  // "1" and "1.0" are one
    for (const auto& [text, error] : bounces.items()) {
      const auto number = io::number_in(text);
      if (!number || !(*number >= 1 && *number <= 1000) || std::trunc(*number) != *number) {
        throw Refused(fmt::format("{} bounces of {} are no integer from 1", io::quoted(text), where));
      }
      if (!known.insert(static_cast<int>(*number)).second) {
        throw Refused(fmt::format("{} under {} is given twice for {} bounces", where, io::quoted(light),
                                  static_cast<int>(*number)));
      }
      out.push_back({light, static_cast<int>(*number), error_from(error, where)});
    }
  }
  return out;
}

BandLight light_from(const Json& json) {
  NamedLight light = io::light_from(json);
  std::vector<double> emission =
      numbers(json, "emission", "the light " + io::quoted(light.name), io::kMaxPlanWavelengths);
  return {std::move(light), std::move(emission)};
}

/// [[lower, upper], ...], one for each wavelength.
std::vector<Band> bands_from(const Json& json, const std::vector<double>& wavelengths_nm) {
  if (!json.is_array() || json.size() != wavelengths_nm.size()) {
    throw Refused(fmt::format("\"bands_nm\" is no list of {} bands", wavelengths_nm.size()));
  }
  std::vector<Band> out;
  for (std::size_t k = 0; k < wavelengths_nm.size(); ++k) {
    const Json& ends = json[k];
    if (!ends.is_array() || ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number()) {
      throw Refused("\"bands_nm\" holds what is no pair of wavelengths");
    }
    out.push_back({ends[0].get<double>(), wavelengths_nm[k], ends[1].get<double>()});
  }
  return out;
}

Plan plan_from(const Json& json) {
  const std::string where = "the plan";
  Plan plan;
  plan.wavelengths_nm = numbers(json, "wavelengths_nm", where, io::kMaxPlanWavelengths);
  plan.weights.sensor.resize(plan.wavelengths_nm.size());
  const Json& sensor = member(json, "sensor", where);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto weights = numbers(sensor, kSensorNames[c], "the sensor", io::kMaxPlanWavelengths);
    if (weights.size() != plan.wavelengths_nm.size()) {
      throw Refused(fmt::format("the sensor has {} weights for {}, but there are {} wavelengths",
                                weights.size(), kSensorNames[c], plan.wavelengths_nm.size()));
    }
    for (std::size_t k = 0; k < weights.size(); ++k) plan.weights.sensor[k][c] = weights[k];
  }
  if (json.contains("bands_nm")) plan.bands = bands_from(json["bands_nm"], plan.wavelengths_nm);
  const Json& lights = member(json, "illuminants", where);
  if (!lights.is_array()) throw Refused("\"illuminants\" is no list");
  if (lights.size() > io::kMaxPlanLights) {
    throw Refused(fmt::format("{} lights are not from 1 to {}", lights.size(), io::kMaxPlanLights));
  }
  for (const Json& light : lights) plan.weights.lights.push_back(light_from(light));
  const Json& observer = member(json, "observer", where);
  if (observer != "1931" && observer != "1964")
    throw Refused("\"observer\" is neither \"1931\" nor \"1964\"");
  if (observer == "1964") plan.weights.observer = Observer::kCie1964;
  const auto promise = json.find("promise");
  if (promise == json.end()) return plan;
  if (!promise->is_object()) throw Refused("\"promise\" is no object");
  if (promise->contains("illuminants")) {
    plan.report.errors = errors_from((*promise)["illuminants"], "the promise");
  }
  for (const EvenBandsSums sums : {EvenBandsSums::kAsProjected, EvenBandsSums::kAveragesMultiplied}) {
    const auto even = promise->find(key_of(sums));
    if (even == promise->end()) continue;
    if (!even->is_object()) throw Refused(fmt::format("\"{}\" is no object", key_of(sums)));
    for (const auto& [bands, errors] : even->items()) {
      for (auto& e : errors_from(errors, "the promise of even bands")) {
        plan.report.even_bands.push_back({sums, bands, std::move(e.light), e.bounces, e.error});
      }
    }
  }
  return plan;
}

}  // namespace

std::string plan_to_json(const Plan& plan, bool one_line) {
  Json out = {{"wavelengths_nm", plan.wavelengths_nm}};
  for (const Band& band : plan.bands) out["bands_nm"].push_back({band.lower_nm, band.upper_nm});
  out["sensor"] = Json::object();
  for (std::size_t c = 0; c < 3; ++c) {
    Json& weights = out["sensor"][kSensorNames[c]] = Json::array();
    for (const auto& of : plan.weights.sensor) weights.push_back(of[c]);
  }
  out["illuminants"] = Json::array();
  for (const BandLight& light : plan.weights.lights) out["illuminants"].push_back(to_json(light));
  out["observer"] = to_string(plan.weights.observer);
  if (!plan.report.errors.empty() || !plan.report.even_bands.empty()) out["promise"] = to_json(plan.report);
  return io::json_text(out, one_line);
}

Result<Plan> parse_plan(std::string_view json, const std::string& source) {
  return io::read_json(json, source, "plan", [](const Json& tree) {
    Plan plan = plan_from(tree);
    if (const std::string what = io::plan_flaw(plan); !what.empty()) throw Refused(what);
    return plan;
  });
}

}  // namespace spectile
