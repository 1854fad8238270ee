// Benchmark: what this machine can do, how near each operation comes to it, what each method
// costs in time and in error, and how far the numbers hold.
#pragma once

#include <cstdint>
#include <functional>
#include <spectile/color/color_difference.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Machine and build of a run. Units: bytes.
struct BenchmarkMachine {
  std::string processor;                 ///< as the operating system names it, or its architecture
  std::string system;                    ///< operating system and its release
  std::string compiler;                  ///< of the library
  std::string version;                   ///< of spectile
  std::string date;                      ///< of the run, UTC, ISO 8601
  int cores = 1;                         ///< that the process may use
  std::uint64_t second_level_cache = 0;  ///< 0 where the system does not say
  std::uint64_t last_level_cache = 0;
  std::uint64_t cache_bytes = 0;   ///< worked on for what is said of the second-level cache, each thread
  std::uint64_t memory_bytes = 0;  ///< and of memory, all threads together
  std::vector<std::string> isas;   ///< that run here, the slowest first
};

/// Place of an operation's operands.
enum class MemoryLevel {
  kCache,   ///< second-level cache
  kMemory,  ///< DRAM
};

/// Peak rates of the machine with vectors of one instruction set.
/// Units: bytes and operations a second; medians.
struct MachineLimit {
  std::string isa;
  int threads = 1;
  MemoryLevel level = MemoryLevel::kCache;
  double load = 0;                ///< bytes read
  double store = 0;               ///< bytes written by ordinary stores
  double stream = 0;              ///< bytes written by non-temporal stores
  double copy = 0;                ///< bytes read and written, together
  double multiply_add = 0;        ///< multiply, then add, each rounded; each counts as one
  double fused_multiply_add = 0;  ///< fused ones; each counts once. Kernels' strict formulas have few
  double divide = 0;              ///< divisions
  double spread = 0;  ///< largest of these: half the range of the middle half of the runs, over the median
};

/// One operation's speed.
struct OperationSpeed {
  std::string group;  ///< "arithmetic", "colorimetry", ...
  std::string name;
  std::string isa;
  int threads = 1;
  MemoryLevel level = MemoryLevel::kCache;
  std::string item = "lane";  ///< that is counted: "sample", "lane", "colour"
  double items_per_second = 0;
  double bytes_per_second = 0;  ///< that it must read and write
  double spread = 0;
  std::string limit;    ///< limiting resource: "load", "store", "stream", "copy", "multiply-add", or in words
  double fraction = 0;  ///< of that limit
  double error = 0;     ///< against double, in units of `error_unit`
  double bound = 0;     ///< stated for it, in the same units
  std::string error_unit;  ///< "u": 2^-24 of the sum of magnitudes, ...
  std::string note;        ///< bottleneck where the limit is not reached
};

/// An operation of the engine beside the scalar array-of-structures (AoS) baseline, on one thread: spectra
/// and colours in the second-level cache, films in memory. Units: nanoseconds an item.
struct BaselineSpeed {
  std::string group;
  std::string name;
  std::string item = "lane";
  double nanoseconds = 0;           ///< of the engine
  double baseline_nanoseconds = 0;  ///< of the baseline
  double fused_nanoseconds = 0;  ///< of the baseline tuned by hand (its loops fused); 0 where there is none
  double ratio = 0;              ///< of the baseline's time to the engine's, median of the rounds' ratios
  double fused_ratio = 0;
  double spread = 0;
  std::string limit;    ///< the engine's limiting resource, and
  double fraction = 0;  ///< the share of its limit that the engine reaches
  double error = 0;     ///< of the engine, in units of `error_unit`
  double baseline_error = 0;
  std::string error_unit;
};

/// One method of doing a job under a light.
struct MethodSpeed {
  std::string job;  ///< "RGB texture, under a light, to a colour", ...
  std::string light;
  bool line_spectrum = false;  ///< the light has lines
  std::string
      family;  ///< of methods that are drawn alike: "AoS baseline", "smits-exact", "planned bands", ...
  std::string name;
  int bands = 0;           ///< 0 where there are none
  double nanoseconds = 0;  ///< a pixel or sample, one thread
  double spread = 0;
  std::uint64_t bytes = 0;  ///< that the pixel takes in memory or in a file, 0 where nothing is stored
  ColorError error;
  bool frontier = false;                 ///< no other method is as fast and as accurate, by mean error
  std::vector<double> differences = {};  ///< of each reflectance, where they were asked for
};

/// One representation of light and materials in a scene of some bounces.
struct RepresentationSpeed {
  std::string light;
  bool line_spectrum = false;
  std::string name;
  int coefficients = 0;  ///< of a material
  int bounces = 1;
  double nanoseconds = 0;  ///< a path: its products and its colour, of all samples of drawn wavelengths
  double spread = 0;
  ColorError error;
  std::string source = {};  ///< publication, in short; empty for usual practice and spectile's own
};

/// Result of an operation's stress test.
struct StressResult {
  std::string operation;
  std::string inputs;  ///< description of the inputs
  std::string unit;    ///< of bound and worst: "u", "ULP", "CIEDE2000", "relative"
  double bound = 0;    ///< 0: exactly the documented result
  double worst = 0;    ///< found
  std::uint64_t cases = 0;
  std::uint64_t beyond = 0;  ///< cases beyond the bound
  std::string worst_case;    ///< the input with the largest error, in words
};

/// The speed-up of several threads over one.
struct ThreadScaling {
  std::string name;
  MemoryLevel level = MemoryLevel::kCache;
  int threads = 1;
  double speed_up = 1;
  double limit = 1;  ///< that of the machine's own limit
};

/// Recommended method for a given error.
struct BenchmarkAdvice {
  std::string job;
  std::string light;
  std::string sentence;
};

struct BenchmarkReport {
  BenchmarkMachine machine;
  double seconds = 0;  ///< it took
  /// Parts of the run in which other work took the processor, in words; empty where it was left alone.
  std::vector<std::string> disturbed;
  std::vector<MachineLimit> limits;
  std::vector<OperationSpeed> operations;
  std::vector<ThreadScaling> scaling;
  std::vector<BaselineSpeed> baseline;  ///< of the fastest instruction set
  std::vector<MethodSpeed> methods;
  std::vector<RepresentationSpeed> representations;
  std::vector<StressResult> stress;
  std::vector<BenchmarkAdvice> advice;
};

struct BenchmarkOptions {
  bool quick = false;                       ///< one or two minutes rather than six
  bool memory = true;                       ///< also of what lies in memory, not in the caches
  bool speed = true;                        ///< limits, operations, methods, representations
  bool stress = false;                      ///< also the long form of the numbers' stress test
  std::vector<int> threads = {};            ///< 1, 2, 4 ... up to the cores where empty
  std::vector<std::string> isas = {};       ///< every one that runs here where empty
  std::vector<std::string> lights = {};     ///< by name; four smooth and line spectra where empty
  std::vector<std::string> only = {};       ///< operations whose name contains one of these; all where empty
  bool differences = false;                 ///< also of each reflectance by each method
  std::vector<Spectrum> reflectances = {};  ///< errors are over these; the 24 of the ColorChecker where empty
  std::uint64_t seed = 1;                   ///< of the inputs
  /// Called before each part; false ends the run with kCancelled.
  std::function<bool(const std::string& part, double done)> progress = {};
};

/// Runs the benchmark. One thing at a time, medians of interleaved runs. Errors: kBadArgument for lights,
/// ISAs or threads that there are not; kOutOfMemory; kCancelled.
Result<BenchmarkReport> run_benchmark(const BenchmarkOptions& options = {});

/// The report for machines. Numbers that are not finite do not occur.
std::string benchmark_to_json(const BenchmarkReport& report);
/// The report as one page of HTML that needs nothing else: no network, no script.
std::string benchmark_to_html(const BenchmarkReport& report);
/// Error against time of one job under one light, as SVG: every method, the frontier as a line. Empty where
/// the report has none of them.
std::string benchmark_plot(const BenchmarkReport& report, const std::string& job, const std::string& light);

}  // namespace spectile
