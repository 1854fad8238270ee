// Plans as JSON text.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <spectile/image/plan_file.hpp>
#include <stdexcept>

#include "src/base/errors.hpp"
#include "src/io/text/plan_flaw.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {
namespace {

// Keeps the order of what it holds.
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
// Plans are well within; text beyond these is built to use up memory or time.
constexpr std::size_t kDeepest = 16;
constexpr std::size_t kMaxValues = 4'000'000;
constexpr std::size_t kMaxKeys = 1024;  // of one object, whose keys are searched one by one
constexpr const char* kMeasure = "CIEDE2000 against 1 nm integration, cross-validated";
constexpr std::array<const char*, 3> kSensorNames = {"x", "y", "z"};

std::string dumped(const Json& json, int indent) {
  // Text that is no UTF-8 is mended rather than refused: names are for people.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// --- to JSON ----------------------------------------------------------------------------------------------

Json to_json(const ColorError& error) {
  return {{"mean", error.mean}, {"percentile95", error.percentile95}, {"maximum", error.maximum}};
}

bool is_published(const BandLight& light) {
  const auto known = illuminant(light.name);
  return known && std::ranges::equal(known->wavelengths_nm(), light.spectrum.wavelengths_nm()) &&
         std::ranges::equal(known->values(), light.spectrum.values());
}

Json to_json(const BandLight& light) {
  Json out = {{"name", light.name}, {"emission", light.emission}};
  if (!is_published(light)) {
    const auto wavelengths = light.spectrum.wavelengths_nm();
    const auto values = light.spectrum.values();
    out["spectrum"] = {{"wavelengths_nm", std::vector<double>(wavelengths.begin(), wavelengths.end())},
                       {"values", std::vector<double>(values.begin(), values.end())}};
  }
  return out;
}

Json to_json(const PlanReport& report) {
  Json out = {{"measure", kMeasure}, {"illuminants", Json::object()}};
  for (const CrossValidatedError& e : report.errors) {
    out["illuminants"][e.light][std::to_string(e.bounces)] = to_json(e.error);
  }
  for (const EvenBandsError& e : report.even_bands) {
    out["even_bands"][e.bands][e.light][std::to_string(e.bounces)] = to_json(e.error);
  }
  return out;
}

// --- from JSON --------------------------------------------------------------------------------------------

/// Thrown and caught here only.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Refuses text that is built to use up memory or time, before anything is made of it. (The library's own
/// callback, while it parses, looks through a whole list at each object's end.)
class Guard : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return value(); }
  bool boolean(bool /*value*/) override { return value(); }
  bool number_integer(number_integer_t /*value*/) override { return value(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return value(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return value(); }
  bool string(string_t& /*value*/) override { return value(); }
  bool binary(binary_t& /*value*/) override { return value(); }
  bool start_object(std::size_t /*elements*/) override { return open(); }
  bool key(string_t& name) override {
    if (keys_.back().size() == kMaxKeys)
      throw Refused(fmt::format("has an object of more than {} keys", kMaxKeys));
    if (!keys_.back().insert(name).second)
      throw Refused(fmt::format("has the key \"{}\" twice in one object", name));
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*elements*/) override { return open(); }
  bool end_array() override { return close(); }
  /// The parser proper says what is wrong.
  bool parse_error(std::size_t /*at*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    return false;
  }

 private:
  bool value() {
    if (++values_ > kMaxValues) throw Refused(fmt::format("holds more than {} values", kMaxValues));
    return true;
  }
  bool open() {
    if (keys_.size() > kDeepest) throw Refused(fmt::format("is nested more than {} deep", kDeepest));
    keys_.emplace_back();
    return value();
  }
  bool close() {
    keys_.pop_back();
    return true;
  }
  std::vector<std::set<std::string>> keys_ =
      std::vector<std::set<std::string>>(1);  // of each object or list that is open
  std::size_t values_ = 0;
};

const Json& member(const Json& object, const char* key, const std::string& where) {
  if (!object.is_object()) throw Refused(where + " is no object");
  const auto found = object.find(key);
  if (found == object.end()) throw Refused(fmt::format("{} has no \"{}\"", where, key));
  return *found;
}

std::vector<double> numbers(const Json& object, const char* key, const std::string& where, std::size_t most) {
  const Json& list = member(object, key, where);
  if (!list.is_array()) throw Refused(fmt::format("\"{}\" of {} is no list", key, where));
  if (list.size() > most) {
    throw Refused(fmt::format("\"{}\" of {} has {} entries, more than {}", key, where, list.size(), most));
  }
  std::vector<double> out;
  out.reserve(list.size());
  for (const Json& entry : list) {
    if (!entry.is_number()) {
      throw Refused(fmt::format("\"{}\" of {} holds what is no number", key, where));
    }
    out.push_back(entry.get<double>());
  }
  return out;
}

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
  const std::string where = "a light";
  const Json& name = member(json, "name", where);
  if (!name.is_string()) throw Refused("the name of a light is no text");
  const auto text = name.get<std::string>();
  const std::string named = "the light " + io::quoted(text);
  std::vector<double> emission = numbers(json, "emission", named, io::kMaxPlanWavelengths);
  if (!json.contains("spectrum")) {
    auto known = illuminant(text);
    if (!known) throw Refused(named + " has no spectrum, and no illuminant is called so");
    return {{text, *std::move(known), {}}, std::move(emission)};
  }
  const Json& spectrum = json["spectrum"];
  const std::string of = "the spectrum of " + named;
  auto samples = MeasuredSpectrum::from_samples(numbers(spectrum, "wavelengths_nm", of, kMaxValues),
                                                numbers(spectrum, "values", of, kMaxValues), Ends::kZero);
  if (!samples) throw Refused(of + ": " + samples.error().message);
  return {{text, *std::move(samples), {}}, std::move(emission)};
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
  if (promise->contains("even_bands")) {
    const Json& even = (*promise)["even_bands"];
    if (!even.is_object()) throw Refused("\"even_bands\" is no object");
    for (const auto& [bands, errors] : even.items()) {
      for (auto& e : errors_from(errors, "the promise of even bands")) {
        plan.report.even_bands.push_back({bands, std::move(e.light), e.bounces, e.error});
      }
    }
  }
  return plan;
}

/// "line N: ..." and the like, of what nlohmann-json says of text that is no JSON.
std::string json_error(const std::string& what) {
  // "[json.exception.parse_error.101] parse error at line 1, column 3: syntax error while ... - last read:
  // ..."
  const std::size_t at = what.find("] ");
  std::string text = at == std::string::npos ? what : what.substr(at + 2);
  if (const std::size_t tail = text.find("; last read"); tail != std::string::npos) text.resize(tail);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  }
  constexpr std::size_t kMost = 200;
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
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
  return one_line ? dumped(out, -1) : dumped(out, 1) + "\n";
}

Result<Plan> parse_plan(std::string_view json, const std::string& source) {
  const auto refuse = [&](const std::string& what) {
    return make_error(ErrorCode::kBadFile, "{}: {}", source, what);
  };
  if (json.size() > kMaxBytes) return refuse("is larger than 64 MiB, which no plan is");
  try {
    Guard guard;
    Json::sax_parse(json, &guard);
    Plan plan = plan_from(Json::parse(json));
    if (const std::string what = io::plan_flaw(plan); !what.empty()) return refuse(what);
    return plan;
  } catch (const Refused& refused) {
    return refuse(refused.what());
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kOutOfMemory, "{}: no memory for a plan of {} bytes", source, json.size());
  } catch (const nlohmann::json::exception& error) {
    return refuse("is no plan: " + json_error(error.what()));
  }
}

}  // namespace spectile
