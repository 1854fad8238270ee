// A report as large as a real one, of made-up numbers, for the tests of its renderers.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <random>
#include <spectile/bench/benchmark.hpp>
#include <string>
#include <vector>

namespace spectile::test {

struct MadeUpLight {
  const char* name;
  bool line_spectrum;
};
inline constexpr MadeUpLight kMadeUpLights[] = {
    {"D65", false}, {"A", false}, {"FL11", true}, {"HP1", true}, {"LED-RGB1", true}};
inline constexpr const char* kMadeUpJobs[] = {
    "RGB texture, under a light, to a colour; the reference: the sigmoid spectrum of each texel, integrated "
    "every "
    "nanometre in double",
    "measured reflectances, under a light, to a colour; the reference: the 24 of the ColorChecker integrated "
    "every "
    "nanometre in double"};

class MadeUpReport {
 public:
  BenchmarkReport make() {
    machine();
    limits();
    operations();
    baseline();
    for (const char* job : kMadeUpJobs) {
      for (const MadeUpLight& light : kMadeUpLights) methods(job, light);
    }
    for (const MadeUpLight& light : kMadeUpLights) representations(light);
    stress();
    return report_;
  }

 private:
  double vary(double value, double by = 0.15) {
    return value * (1 + by * std::uniform_real_distribution<double>(-1, 1)(random_));
  }

  void machine() {
    report_.machine = {"Intel(R) Xeon(R) Platinum 8581C CPU @ 2.10GHz",
                       "Linux 6.1.0",
                       "GCC 12.2.0",
                       "0.1.0",
                       "2026-11-22T15:00:00Z",
                       2,
                       2U << 20U,
                       260U << 20U,
                       512U << 10U,
                       1U << 30U,
                       {"scalar", "sse4.2", "avx2", "avx512"}};
    report_.seconds = 312.4;
    report_.disturbed = {"operations in memory, avx2: another process had 31 % of a core",
                         "methods under HP1: 12 % slower at the end than at the start"};
  }

  void limits() {
    double width = 1;
    for (const std::string& isa : report_.machine.isas) {
      for (const int threads : {1, 2}) {
        for (const MemoryLevel level : {MemoryLevel::kCache, MemoryLevel::kMemory}) {
          const double top = threads * (level == MemoryLevel::kCache ? 1.2e10 * width : 1.1e10);
          report_.limits.push_back({isa, threads, level, vary(top), vary(0.6 * top), vary(0.8 * top),
                                    vary(0.9 * top), vary(1.0e10 * width * threads),
                                    vary(0.5e10 * width * threads), 0.021});
        }
      }
      width *= 2;
    }
    for (const char* name : {"Smits upsampling", "multiply", "CIE XYZ"}) {
      for (const int threads : {1, 2}) {
        report_.scaling.push_back({name, MemoryLevel::kCache, threads, vary(threads, 0.05), 1.0 * threads});
        report_.scaling.push_back(
            {name, MemoryLevel::kMemory, threads, vary(0.6 + 0.4 * threads, 0.05), 1.4});
      }
    }
  }

  void operations() {
    constexpr const char* kGroups[] = {"arithmetic", "colorimetry", "upsampling",
                                       "spectra",    "film",        "conversion"};
    constexpr const char* kLimits[] = {"copy", "multiply-add", "load", "stream", "divisions of vectors"};
    for (int i = 0; i < 60; ++i) {
      double width = 1;
      for (const std::string& isa : report_.machine.isas) {
        for (const MemoryLevel level : {MemoryLevel::kCache, MemoryLevel::kMemory}) {
          OperationSpeed o;
          o.group = kGroups[i / 10];
          o.name = fmt::format("{} number {}",
                               i % 7 == 0 ? "multiply-add with a scalar each lane" : "operation", i);
          o.isa = isa;
          o.threads = 1;
          o.level = level;
          o.item = i % 3 == 0 ? "sample" : i % 3 == 1 ? "lane" : "colour";
          o.items_per_second = vary(2e7 * (i + 1) * width);
          o.bytes_per_second = vary(4e9 * width);
          o.spread = 0.013;
          o.limit = kLimits[i % 5];
          o.fraction = vary(0.8, 0.5);
          o.error = i == 17 ? 3.2 : vary(0.5);
          o.bound = i % 9 == 0 ? 0 : 1;
          if (o.bound == 0) o.error = 0;
          o.error_unit = "u";
          if (o.fraction < 0.5) o.note = "bound by table look-ups: two permutes an item";
          report_.operations.push_back(o);
        }
        width *= 2;
      }
    }
  }

  void baseline() {
    for (int i = 0; i < 12; ++i) {
      BaselineSpeed b;
      b.group = i < 6 ? "upsampling" : "film";
      b.name = fmt::format("operation {} of the engine", i);
      b.item = "colour";
      b.nanoseconds = vary(8);
      b.baseline_nanoseconds = vary(80);
      b.fused_nanoseconds = i % 2 == 0 ? 0 : vary(40);
      b.ratio = b.baseline_nanoseconds / b.nanoseconds;
      b.fused_ratio = b.fused_nanoseconds / b.nanoseconds;
      b.spread = 0.02;
      b.limit = "multiply-add";
      b.fraction = vary(0.8);
      b.error = vary(2);
      b.baseline_error = vary(5);
      b.error_unit = "u";
      report_.baseline.push_back(b);
    }
  }

  void method(const char* job, const MadeUpLight& light, const char* family, const std::string& name,
              int bands, double ns, double mean) {
    MethodSpeed w;
    w.job = job;
    w.light = light.name;
    w.line_spectrum = light.line_spectrum;
    w.family = family;
    w.name = name;
    w.bands = bands;
    w.nanoseconds = vary(ns);
    w.spread = 0.02;
    w.bytes = static_cast<std::uint64_t>(bands) * 2;
    w.error = {vary(mean, 0.3), 2.4 * mean, 6 * mean};
    report_.methods.push_back(w);
  }

  void methods(const char* job, const MadeUpLight& light) {
    const double hard = light.line_spectrum ? 2 : 1;
    const std::size_t first = report_.methods.size();
    method(job, light, "AoS baseline", "AoS baseline, 60 bands", 60, 120, 0.14 * hard);
    method(job, light, "AoS baseline", "AoS baseline, 81 wavelengths", 81, 165, 0.05 * hard);
    method(job, light, "AoS baseline", "AoS baseline, RGB times RGB", 0, 0.4, 2.6 * hard);
    for (const int n : {16, 24, 30, 60, 80, 100}) {
      method(job, light, "even bands", fmt::format("even bands, {}", n), n, 0.12 * n, 60 * hard / (n * n));
    }
    for (const int n : {4, 6, 8, 10, 12, 16}) {
      method(job, light, "planned bands", fmt::format("planned bands, {}, for this light", n), n, 0.12 * n,
             5.0 / (n * n));
      method(job, light, "planned wavelengths", fmt::format("planned wavelengths, {}", n), n, 0.13 * n,
             9.0 / (n * n));
    }
    method(job, light, "smits-exact", "smits-exact, folded", 0, 0.54, 1.1 * hard);
    method(job, light, "mallett", "mallett, folded", 0, 0.37, 1.7 * hard);
    method(job, light, "sigmoid", "sigmoid, 60 bands", 60, 68, 0.15 * hard);
    method(job, light, "sigmoid", "sigmoid <search & \"solve\">", 0, 74, 0);
    for (std::size_t i = first; i < report_.methods.size(); ++i) {
      MethodSpeed& w = report_.methods[i];
      w.frontier = true;
      for (std::size_t k = first; k < report_.methods.size(); ++k) {
        const MethodSpeed& other = report_.methods[k];
        if (other.nanoseconds < w.nanoseconds && other.error.mean <= w.error.mean) w.frontier = false;
      }
    }
    report_.advice.push_back(
        {job, light.name,
         "For a mean error of 0.1 take planned bands, 8, for this light: 0.96 ns a pixel, 125 "
         "times as fast as the AoS baseline; for 0.02 take 16."});
  }

  void representations(const MadeUpLight& light) {
    constexpr const char* kNames[] = {"RGB", "even bands, 60", "planned bands, 12", "planned wavelengths, 16",
                                      "Fourier moments, 8"};
    constexpr int kCoefficients[] = {3, 60, 12, 16, 8};
    constexpr double kErrors[] = {1.4, 0.12, 0.02, 0.03, 0.4};
    for (int i = 0; i < 5; ++i) {
      for (int bounces = 1; bounces <= 5; ++bounces) {
        const double mean = vary(kErrors[i] * std::pow(bounces, 0.8) * (light.line_spectrum ? 1.7 : 1), 0.1);
        report_.representations.push_back({light.name,
                                           light.line_spectrum,
                                           kNames[i],
                                           kCoefficients[i],
                                           bounces,
                                           vary(0.03 * kCoefficients[i] * (bounces + 2), 0.05),
                                           0.02,
                                           {mean, 2.5 * mean, 7 * mean}});
      }
    }
  }

  void stress() {
    for (int i = 0; i < 80; ++i) {
      StressResult s;
      s.operation = fmt::format("stressed operation {}", i);
      s.inputs = i % 2 == 0 ? "NaN, infinities, denormals, signed zeros, in every lane position"
                            : "random bit patterns of every exponent";
      s.unit = i % 2 == 0 ? "ULP" : "u";
      s.bound = i % 3 == 0 ? 0 : 2;
      s.worst = i % 3 == 0 ? 0 : vary(1.2);
      s.cases = 1'000'000U + 12'345U * static_cast<unsigned>(i);
      if (i == 11 || i == 42) {
        s.beyond = 17;
        s.worst = 3.7;
        s.worst_case = "x = 1.17549435e-38, y = -0x1.fffffep+127: 0x7f800000 in place of 0x7f7fffff";
      }
      report_.stress.push_back(s);
    }
  }

  BenchmarkReport report_;
  std::mt19937_64 random_{7};
};

/// 60 operations by four instruction sets and two levels, 5 lights by 2 jobs by 25 methods, 5 by 5 by 5
/// representations, 80 stress rows of which two are beyond their bounds.
inline BenchmarkReport made_up_report() {
  return MadeUpReport().make();
}

/// A report of one entry of everything, each with this number where there is one and this text.
inline BenchmarkReport filled_with(double x, const std::string& text) {
  BenchmarkReport r;
  r.machine.processor = text;
  r.machine.isas = {text};
  r.seconds = x;
  r.disturbed = {text};
  r.limits = {{text, 1, MemoryLevel::kCache, x, x, x, x, x, x, x}};
  r.operations = {{text, text, text, 1, MemoryLevel::kMemory, text, x, x, x, text, x, x, x, text, text}};
  r.scaling = {{text, MemoryLevel::kCache, 2, x, x}};
  r.baseline = {{text, text, text, x, x, x, x, x, x, text, x, x, x, text}};
  r.methods = {{text, text, true, text, text, 3, x, x, 12, {x, x, x}, true},
               {text, text, true, "AoS baseline", text, 3, 5.0, x, 12, {0.5, x, x}, false}};
  r.representations = {{text, false, text, 3, 1, x, x, {x, x, x}},
                       {text, false, text, 3, 2, 5.0, x, {0.5, x, x}}};
  r.stress = {{text, text, text, x, x, 10, 0, text}};
  r.advice = {{text, text, text}, {text, "", text}};
  return r;
}

inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The same one at every call.
inline const BenchmarkReport& full() {
  static const BenchmarkReport report = made_up_report();
  return report;
}

}  // namespace spectile::test
