// A benchmark's report as JSON: every entry, bit for bit; and numbers as people read them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "bench/report/text.hpp"
#include "tests/bench/report_support.hpp"

namespace spectile::test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

TEST(BenchmarkJson, HoldsEveryEntry) {
  const Json json = Json::parse(benchmark_to_json(full()));
  EXPECT_EQ(json["limits"].size(), full().limits.size());
  EXPECT_EQ(json["operations"].size(), full().operations.size());
  EXPECT_EQ(json["scaling"].size(), full().scaling.size());
  EXPECT_EQ(json["baseline"].size(), full().baseline.size());
  EXPECT_EQ(json["baseline"][0]["ratio"], full().baseline[0].ratio);
  EXPECT_EQ(json["ways"].size(), full().methods.size());
  EXPECT_EQ(json["representations"].size(), full().representations.size());
  EXPECT_EQ(json["stress"].size(), full().stress.size());
  EXPECT_EQ(json["advice"].size(), full().advice.size());
  EXPECT_EQ(json["disturbed"], Json(full().disturbed));
  EXPECT_EQ(json["machine"]["isas"], Json(full().machine.isas));
  EXPECT_EQ(json["machine"]["second_level_cache"], full().machine.second_level_cache);
}

TEST(BenchmarkJson, NamesThePublicationOfARepresentation) {
  BenchmarkReport report;
  report.representations.resize(1);
  report.representations[0].source = "Peercy 1993";
  EXPECT_EQ(Json::parse(benchmark_to_json(report))["representations"][0]["source"], "Peercy 1993");
  EXPECT_THAT(benchmark_to_html(report), HasSubstr("<td class=\"words\">Peercy 1993</td>"));
}

TEST(BenchmarkJson, ComesBackBitForBit) {
  const Json json = Json::parse(benchmark_to_json(full()));
  for (std::size_t i = 0; i < full().methods.size(); ++i) {
    const MethodSpeed& w = full().methods[i];
    const Json& j = json["ways"][i];
    EXPECT_EQ(j["job"], w.job);
    EXPECT_EQ(j["name"], w.name);
    EXPECT_EQ(j["nanoseconds"].get<double>(), w.nanoseconds);
    EXPECT_EQ(j["error"]["mean"].get<double>(), w.error.mean);
    EXPECT_EQ(j["error"]["percentile95"].get<double>(), w.error.percentile95);
    EXPECT_EQ(j["error"]["maximum"].get<double>(), w.error.maximum);
    EXPECT_EQ(j["frontier"].get<bool>(), w.frontier);
  }
  for (std::size_t i = 0; i < full().operations.size(); ++i) {
    const OperationSpeed& o = full().operations[i];
    const Json& j = json["operations"][i];
    EXPECT_EQ(j["level"], o.level == MemoryLevel::kCache ? "cache" : "memory");
    EXPECT_EQ(j["items_per_second"].get<double>(), o.items_per_second);
    EXPECT_EQ(j["fraction"].get<double>(), o.fraction);
    EXPECT_EQ(j["bound"].get<double>(), o.bound);
  }
}

TEST(BenchmarkJson, WritesNullForWhatIsNoNumber) {
  for (const double x : {kNotANumber, kInfinity, -kInfinity}) {
    const Json json = Json::parse(benchmark_to_json(filled_with(x, "text")));
    EXPECT_TRUE(json["ways"][0]["nanoseconds"].is_null());
    EXPECT_TRUE(json["stress"][0]["worst"].is_null());
    EXPECT_TRUE(json["seconds"].is_null());
  }
}

TEST(BenchmarkJson, SurvivesTextThatIsNoUtf8) {
  const Json json = Json::parse(benchmark_to_json(filled_with(1, "a\xFF\xC3 b")));
  EXPECT_THAT(json["machine"]["processor"].get<std::string>(), HasSubstr(" b"));
}

TEST(BenchmarkNumbers, HaveThreeDigits) {
  EXPECT_EQ(report::number(0), "0");
  EXPECT_EQ(report::number(0.54321), "0.543");
  EXPECT_EQ(report::number(12.96), "13.0");
  EXPECT_EQ(report::number(12.96, report::Zeros::kDrop), "13");
  EXPECT_EQ(report::number(999.6), "1\u202F000");
  EXPECT_EQ(report::number(2804), "2\u202F800");
  EXPECT_EQ(report::number(1.234e-7), "1.23×10⁻⁷");
  EXPECT_EQ(report::number(-0.5), "−0.500");
  EXPECT_EQ(report::number(std::numeric_limits<double>::max()), "1.80×10³⁰⁸");
  EXPECT_EQ(report::number(std::numeric_limits<double>::denorm_min(), report::Zeros::kDrop), "4.94×10⁻³²⁴");
}

TEST(BenchmarkNumbers, HavePrefixesAndUnits) {
  EXPECT_EQ(report::with_prefix(12.34e9, "op/s"), "12.3\u00A0Gop/s");
  EXPECT_EQ(report::with_prefix(999.7e6, "B/s"), "1.00\u00A0GB/s");
  EXPECT_EQ(report::with_prefix(512, "B/s"), "512\u00A0B/s");
  EXPECT_EQ(report::percent(0.826), "83\u00A0%");
  EXPECT_EQ(report::percent(0.0042), "0.42\u00A0%");
  EXPECT_EQ(report::percent(1.184), "118\u00A0%");
  EXPECT_EQ(report::bytes_text(2U << 20U), "2\u00A0MiB");
  EXPECT_EQ(report::count_text(1234567), "1\u202F234\u202F567");
}

}  // namespace
}  // namespace spectile::test
