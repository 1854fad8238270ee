// A benchmark's report as JSON text.
#include <nlohmann/json.hpp>
#include <spectile/bench/benchmark.hpp>

namespace spectile {
namespace {

// Keeps the order of what it holds. Numbers that are not finite are written as null.
using Json = nlohmann::ordered_json;

const char* level_name(MemoryLevel level) {
  return level == MemoryLevel::kCache ? "cache" : "memory";
}

Json units() {
  return {
      {"bytes", "machine.*_cache, machine.*_bytes, ways.bytes (a pixel, in memory or in a file)"},
      {"bytes a second", "limits.load, store, stream and copy; operations.bytes_per_second"},
      {"float operations a second",
       "limits.multiply_add (multiply and add each count), limits.fused_multiply_add, limits.divide "
       "(each counts once)"},
      {"items a second", "operations.items_per_second, of operations.item"},
      {"nanoseconds an item, one thread",
       "baseline.nanoseconds (engine), baseline_nanoseconds (scalar array of structures), fused_nanoseconds "
       "(the same tuned by hand, 0: none)"},
      {"baseline.error_unit", "baseline.error, baseline.baseline_error"},
      {"CIEDE2000", "error objects of ways and representations"},
      {"nanoseconds a pixel or sample, one thread", "ways.nanoseconds"},
      {"nanoseconds a path, one thread", "representations.nanoseconds"},
      {"operations.error_unit", "operations.error, operations.bound"},
      {"stress.unit", "stress.bound (0: exactly the documented result), stress.worst"},
      {"1",
       "spread (half the range of the middle half of the runs, over the median), fraction, speed_up, "
       "scaling.limit, baseline.ratio, baseline.fused_ratio"},
      {"seconds", "seconds"},
      {"levels", "cache: second-level cache; memory: DRAM"}};
}

Json to_json(const BenchmarkMachine& m) {
  return {{"processor", m.processor},
          {"system", m.system},
          {"compiler", m.compiler},
          {"version", m.version},
          {"date", m.date},
          {"cores", m.cores},
          {"second_level_cache", m.second_level_cache},
          {"last_level_cache", m.last_level_cache},
          {"cache_bytes", m.cache_bytes},
          {"memory_bytes", m.memory_bytes},
          {"isas", m.isas}};
}

Json to_json(const MachineLimit& l) {
  return {{"isa", l.isa},
          {"threads", l.threads},
          {"level", level_name(l.level)},
          {"load", l.load},
          {"store", l.store},
          {"stream", l.stream},
          {"copy", l.copy},
          {"multiply_add", l.multiply_add},
          {"fused_multiply_add", l.fused_multiply_add},
          {"divide", l.divide},
          {"spread", l.spread}};
}

Json to_json(const OperationSpeed& o) {
  return {{"group", o.group},
          {"name", o.name},
          {"isa", o.isa},
          {"threads", o.threads},
          {"level", level_name(o.level)},
          {"item", o.item},
          {"items_per_second", o.items_per_second},
          {"bytes_per_second", o.bytes_per_second},
          {"spread", o.spread},
          {"limit", o.limit},
          {"fraction", o.fraction},
          {"error", o.error},
          {"bound", o.bound},
          {"error_unit", o.error_unit},
          {"note", o.note}};
}

Json to_json(const ThreadScaling& s) {
  return {{"name", s.name},
          {"level", level_name(s.level)},
          {"threads", s.threads},
          {"speed_up", s.speed_up},
          {"limit", s.limit}};
}

Json to_json(const BaselineSpeed& b) {
  return {{"group", b.group},
          {"name", b.name},
          {"item", b.item},
          {"nanoseconds", b.nanoseconds},
          {"baseline_nanoseconds", b.baseline_nanoseconds},
          {"fused_nanoseconds", b.fused_nanoseconds},
          {"ratio", b.ratio},
          {"fused_ratio", b.fused_ratio},
          {"spread", b.spread},
          {"limit", b.limit},
          {"fraction", b.fraction},
          {"error", b.error},
          {"baseline_error", b.baseline_error},
          {"error_unit", b.error_unit}};
}

Json to_json(const ColorError& e) {
  return {{"mean", e.mean}, {"percentile95", e.percentile95}, {"maximum", e.maximum}};
}

Json to_json(const MethodSpeed& w) {
  return {
      {"job", w.job},     {"light", w.light},          {"spiky", w.line_spectrum},     {"family", w.family},
      {"name", w.name},   {"bands", w.bands},          {"nanoseconds", w.nanoseconds}, {"spread", w.spread},
      {"bytes", w.bytes}, {"error", to_json(w.error)}, {"frontier", w.frontier}};
}

Json to_json(const RepresentationSpeed& r) {
  return {{"light", r.light},     {"spiky", r.line_spectrum},
          {"name", r.name},       {"coefficients", r.coefficients},
          {"bounces", r.bounces}, {"nanoseconds", r.nanoseconds},
          {"spread", r.spread},   {"error", to_json(r.error)}};
}

Json to_json(const StressResult& s) {
  return {{"operation", s.operation}, {"inputs", s.inputs},        {"unit", s.unit},
          {"bound", s.bound},         {"worst", s.worst},          {"cases", s.cases},
          {"beyond", s.beyond},       {"worst_case", s.worst_case}};
}

Json to_json(const BenchmarkAdvice& a) {
  return {{"job", a.job}, {"light", a.light}, {"sentence", a.sentence}};
}

template <class T>
Json json_list(const std::vector<T>& items) {
  Json out = Json::array();
  for (const T& item : items) out.push_back(to_json(item));
  return out;
}

}  // namespace

std::string benchmark_to_json(const BenchmarkReport& report) {
  const Json json = {{"units", units()},
                     {"machine", to_json(report.machine)},
                     {"seconds", report.seconds},
                     {"disturbed", report.disturbed},
                     {"limits", json_list(report.limits)},
                     {"operations", json_list(report.operations)},
                     {"scaling", json_list(report.scaling)},
                     {"baseline", json_list(report.baseline)},
                     {"ways", json_list(report.methods)},
                     {"representations", json_list(report.representations)},
                     {"stress", json_list(report.stress)},
                     {"advice", json_list(report.advice)}};
  // Text that is no UTF-8 is mended rather than refused: names are for people.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace spectile
