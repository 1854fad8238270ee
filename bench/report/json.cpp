// A benchmark's report as JSON text.
#include <nlohmann/json.hpp>
#include <spectile/bench/benchmark.hpp>

namespace spectile {
namespace {

// Keeps the order of what it holds. Numbers that are not finite are written as null.
using Json = nlohmann::ordered_json;

Json units() {
  return {{"bytes", "machine.*_cache, machine.*_bytes, ways.bytes (a pixel, in memory or in a file)"},
          {"bytes a second", "limits.load, store, stream and copy; operations.bytes_per_second"},
          {"float operations a second",
           "limits.multiply_add (multiply and add each count), limits.fused_multiply_add, limits.divide "
           "(each counts once)"},
          {"items a second", "operations.items_per_second, of operations.item"},
          {"nanoseconds an item, one thread",
           "baseline.nanoseconds (engine), baseline_nanoseconds (scalar array of structures), "
           "fused_nanoseconds (the same tuned by hand, 0: none)"},
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

}  // namespace

// Found by the library's own conversions of the types that hold these.
static void to_json(Json& json, MemoryLevel level) {
  json = level == MemoryLevel::kCache ? "cache" : "memory";
}

/// A structure's members under their own names.
#define SPECTILE_JSON(Type, ...)                                             \
  static void to_json(Json& nlohmann_json_j, const Type& nlohmann_json_t) {  \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__)) \
  }
SPECTILE_JSON(BenchmarkMachine, processor, system, compiler, version, date, cores, second_level_cache,
              last_level_cache, cache_bytes, memory_bytes, isas)
SPECTILE_JSON(MachineLimit, isa, threads, level, load, store, stream, copy, multiply_add, fused_multiply_add,
              divide, spread)
SPECTILE_JSON(OperationSpeed, group, name, isa, threads, level, item, items_per_second, bytes_per_second,
              spread, limit, fraction, error, bound, error_unit, note)
SPECTILE_JSON(ThreadScaling, name, level, threads, speed_up, limit)
SPECTILE_JSON(BaselineSpeed, group, name, item, nanoseconds, baseline_nanoseconds, fused_nanoseconds, ratio,
              fused_ratio, spread, limit, fraction, error, baseline_error, error_unit)
SPECTILE_JSON(ColorError, mean, percentile95, maximum)
SPECTILE_JSON(StressResult, operation, inputs, unit, bound, worst, cases, beyond, worst_case)
SPECTILE_JSON(BenchmarkAdvice, job, light, sentence)
#undef SPECTILE_JSON

static void to_json(Json& json, const MethodSpeed& w) {
  json = {{"job", w.job},     {"light", w.light}, {"spiky", w.line_spectrum},     {"family", w.family},
          {"name", w.name},   {"bands", w.bands}, {"nanoseconds", w.nanoseconds}, {"spread", w.spread},
          {"bytes", w.bytes}, {"error", w.error}, {"frontier", w.frontier}};
  if (!w.differences.empty()) json["differences"] = w.differences;
}

static void to_json(Json& json, const RepresentationSpeed& r) {
  json = {{"light", r.light},   {"spiky", r.line_spectrum},     {"name", r.name},
          {"source", r.source}, {"bounces", r.bounces},         {"coefficients", r.coefficients},
          {"spread", r.spread}, {"nanoseconds", r.nanoseconds}, {"error", r.error}};
}

std::string benchmark_to_json(const BenchmarkReport& report) {
  const Json json = {{"units", units()},          {"machine", report.machine},
                     {"seconds", report.seconds}, {"disturbed", report.disturbed},
                     {"limits", report.limits},   {"operations", report.operations},
                     {"scaling", report.scaling}, {"baseline", report.baseline},
                     {"ways", report.methods},    {"representations", report.representations},
                     {"stress", report.stress},   {"advice", report.advice}};
  // Text that is no UTF-8 is mended rather than refused: names are for people.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace spectile
