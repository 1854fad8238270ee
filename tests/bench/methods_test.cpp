// The benchmark's measures: medians, Pareto frontiers, references, evaluations; and its refusals.
#include "bench/methods/methods.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <spectile/bench/benchmark.hpp>
#include <spectile/color/color_difference.hpp>

#include "bench/limits/clock.hpp"
#include "bench/methods/reference_colors.hpp"
#include "bench/operations/operation.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using measure::error_against;
using measure::kOutOfDomain;
using measure::Timed;

TEST(Clock, TimesAreMediansOfRoundsInTurn) {
  std::string order;
  Timed first;
  Timed second;
  const auto busy = [&](char who, int microseconds) {
    order += who;
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(microseconds);
    while (std::chrono::steady_clock::now() < end) {
    }
  };
  first.run = [&] { busy('a', 100); };
  second.run = [&] { busy('b', 300); };
  const std::array<Timed*, 2> work = {&first, &second};
  measure::time_in_turn(work, {5, 1e-6, {}});
  ASSERT_EQ(first.rounds.size(), 5U);
  ASSERT_EQ(second.rounds.size(), 5U);
  EXPECT_GE(first.seconds, 100e-6);
  EXPECT_GE(second.seconds, 300e-6);
  EXPECT_EQ(order.substr(order.size() - 10), "ababababab");
}

TEST(Clock, RatiosAreTakenWithinRounds) {
  // A machine that becomes ten times slower: the ratio of what ran in the same round stays.
  Timed a;
  Timed b;
  a.rounds = {1, 10, 1, 10, 10};
  b.rounds = {2, 20, 2, 20, 20};
  EXPECT_DOUBLE_EQ(measure::median_ratio(a, b), 0.5);
}

TEST(Frontier, HoldsWhatNothingBeats) {
  const auto method = [](const char* light, const char* name, double ns, double mean) {
    MethodSpeed w;
    w.job = "job";
    w.light = light;
    w.name = name;
    w.nanoseconds = ns;
    w.error.mean = mean;
    return w;
  };
  std::vector<MethodSpeed> methods = {method("A", "fast", 1, 2),      method("A", "exact", 10, 0.1),
                                      method("A", "beaten", 11, 0.2), method("A", "as slow", 10, 0.11),
                                      method("A", "same", 1, 2),      method("D65", "alone", 100, 5)};
  measure::mark_frontier(methods);
  const bool expected[] = {true, true, false, false, true, true};
  for (std::size_t i = 0; i < methods.size(); ++i)
    EXPECT_EQ(methods[i].frontier, expected[i]) << methods[i].name;
  const auto advice = measure::advice_on(methods);
  ASSERT_FALSE(advice.empty());
  for (const BenchmarkAdvice& a : advice) {
    EXPECT_EQ(a.sentence.find("beaten"), std::string::npos) << a.sentence;
  }
  EXPECT_NE(advice.front().sentence.find("below 2: fast"), std::string::npos) << advice.front().sentence;
}

TEST(ReferenceColors, WhiteIsTheLightsAndLampsHaveLines) {
  for (const auto& [name, line_spectrum] :
       {std::pair{"D65", false}, {"A", false}, {"E", false}, {"FL2", true}, {"FL11", true}, {"HP1", true}}) {
    const auto light = *measure::reference_light(name);
    EXPECT_EQ(light.line_spectrum, line_spectrum) << name;
    EXPECT_NEAR(light.white[1], 1, 1e-12) << name;
    const auto chart = *measure::chart_reflectances();
    EXPECT_EQ(chart.size(), 24U);
    const auto reflectances = *measure::reference_reflectances(chart);
    for (const auto& r : reflectances) {
      const auto xyz = measure::reference_xyz(light, {&r});
      EXPECT_GT(xyz[1], 0.01);
      EXPECT_LT(xyz[1], 0.95);
    }
  }
  // D65's published white. Source: CIE 015:2018.
  const auto d65 = *measure::reference_light("D65");
  EXPECT_NEAR(d65.white[0], 0.95047, 2e-5);
  EXPECT_NEAR(d65.white[2], 1.08883, 5e-5);
}

TEST(ReferenceColors, ErrorsAreSummedUpByMeanMaximumAndNinetyFiveOfAHundredDoNotExceed) {
  const measure::Xyz white = {1, 1, 1};
  measure::ErrorList list(white);
  std::vector<double> all;
  for (int i = 1; i <= 100; ++i) {
    const measure::Xyz reference = {0.5, 0.5, 0.5};
    const measure::Xyz found = {0.5, 0.5 + 0.001 * i, 0.5};
    list.add(reference, found);
    all.push_back(ciede2000(xyz_to_lab(reference, white), xyz_to_lab(found, white)));
  }
  const ColorError e = list.summary();
  EXPECT_DOUBLE_EQ(e.maximum, all[99]);
  EXPECT_DOUBLE_EQ(e.percentile95, all[94]);
  EXPECT_EQ(list.differences(), all);
}

TEST(Benchmark, JsonHoldsDifferencesWhereThereAreSome) {
  BenchmarkReport report;
  report.methods.resize(2);
  report.methods[1].differences = {0.5, 2};
  const auto json = nlohmann::json::parse(benchmark_to_json(report));
  EXPECT_FALSE(json["ways"][0].contains("differences"));
  EXPECT_EQ(json["ways"][1]["differences"], (std::vector<double>{0.5, 2}));
}

TEST(Evaluation, AllowsTheBoundAndNotMore) {
  const auto evaluate_errors = error_against(
      1, 1, false, 2,
      [](const double* in, double* reference, double* scale) { reference[0] = scale[0] = in[0]; });
  const double in = 1;
  const auto error = [&](double out) { return evaluate_errors(&in, &out, 0); };
  EXPECT_EQ(error(1), 0);
  EXPECT_NEAR(error(1 + 0x1p-24), 1, 1e-12);
  EXPECT_NEAR(error(1 - 0x1p-22), 4, 1e-12);
  EXPECT_TRUE(std::isinf(error(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isinf(error(std::numeric_limits<double>::infinity())));
}

TEST(Evaluation, KnowsOverflowAndWhatIsNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  const auto value = [](const double* in, double* reference, double* scale) {
    reference[0] = in[0];
    scale[0] = std::abs(in[0]);
  };
  const auto once = error_against(1, 1, true, 1, value);
  const auto sum = error_against(1, 1, false, 1, value);
  const auto at = [](const auto& evaluate_errors, double in, double out) {
    return evaluate_errors(&in, &out, 0);
  };
  EXPECT_EQ(at(once, 1e39, kInfinity), 0);
  EXPECT_EQ(at(once, -1e39, kInfinity), kInfinity);
  EXPECT_EQ(at(once, 1e39, 3e38), kInfinity);
  EXPECT_EQ(at(sum, 1e39, kInfinity), kOutOfDomain);
  EXPECT_EQ(at(once, kNotANumber, kNotANumber), 0);
  EXPECT_EQ(at(once, kNotANumber, 0), kInfinity);
  EXPECT_EQ(at(once, kInfinity, kInfinity), 0);
  EXPECT_EQ(at(once, kInfinity, -kInfinity), kInfinity);
  EXPECT_EQ(at(sum, kInfinity, kNotANumber), 0);
  EXPECT_EQ(at(sum, kInfinity, 1), kInfinity);
}

TEST(Benchmark, RefusesWhatThereIsNot) {
  const auto code_of = [](const BenchmarkOptions& options) {
    const auto report = run_benchmark(options);
    return report ? std::optional<ErrorCode>() : std::optional<ErrorCode>(report.error().code);
  };
  BenchmarkOptions o;
  o.quick = true;
  o.threads = {0};
  EXPECT_EQ(code_of(o), ErrorCode::kBadArgument);
  o.threads = {1};
  o.isas = {"avx3"};
  EXPECT_EQ(code_of(o), ErrorCode::kUnknownName);
  o.isas = {};
  o.lights = {"moonlight"};
  EXPECT_EQ(code_of(o), ErrorCode::kUnknownName);
  o.lights = {};
  o.only = {"no such operation"};
  EXPECT_EQ(code_of(o), ErrorCode::kBadArgument);
  o.only = {};
  o.progress = [](const std::string&, double) { return false; };
  EXPECT_EQ(code_of(o), ErrorCode::kCancelled);
}

TEST(Benchmark, MeasuresOneOperationWithItsLimitAndItsError) {
  BenchmarkOptions o;
  o.quick = true;
  o.threads = {1};
  o.only = {"multiply_add"};
  o.memory = false;
  const auto report = run_benchmark(o);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->operations.size(), report->machine.isas.size());
  ASSERT_EQ(report->limits.size(), report->machine.isas.size());
  for (const OperationSpeed& s : report->operations) {
    EXPECT_EQ(s.name, "multiply_add");
    EXPECT_GT(s.items_per_second, 1e6);
    EXPECT_DOUBLE_EQ(s.bytes_per_second, 16 * s.items_per_second);  // three floats read, one written
    EXPECT_GT(s.fraction, 0.05);
    EXPECT_GT(s.error, 0);
    EXPECT_LE(s.error, s.bound);
  }
  for (const MachineLimit& l : report->limits) {
    for (const double rate :
         {l.load, l.store, l.stream, l.copy, l.multiply_add, l.fused_multiply_add, l.divide}) {
      EXPECT_GT(rate, 1e6) << l.isa;
    }
  }
  EXPECT_TRUE(report->methods.empty());
}

}  // namespace
}  // namespace spectile::test
