// Plan files: what is written comes back to the bit, and what is no plan is refused with a sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <spectile/spectile.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

constexpr const char* kText = R"({
 "wavelengths_nm": [450, 550.5, 640],
 "sensor": {"x": [0.1, 0.2, 0.3], "y": [0.2, 0.6, 0.2], "z": [1, 0, 0]},
 "illuminants": [
  {"name": "D65", "emission": [1, 1, 1]},
  {"name": "lamp", "emission": [0.5, 1, 2.5], "spectrum": {"wavelengths_nm": [400, 700], "values": [1, 3]}}],
 "observer": "1964",
 "made by": {"whom": [null, true, "nobody"]}
})";

std::string replaced(const std::string& what, const std::string& by) {
  std::string text = kText;
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

void expect_refused(const std::string& text, const std::string& because) {
  const auto plan = parse_plan(text, "some.json");
  ASSERT_FALSE(plan) << because;
  EXPECT_EQ(plan.error().code, ErrorCode::kBadFile);
  EXPECT_THAT(plan.error().message, HasSubstr("some.json: "));
  EXPECT_THAT(plan.error().message, HasSubstr(because));
  EXPECT_EQ(plan.error().message.find('\n'), std::string::npos);
  EXPECT_LT(plan.error().message.size(), 400U);
}

void expect_same(const Plan& a, const Plan& b) {
  EXPECT_EQ(a.weights.observer, b.weights.observer);
  EXPECT_EQ(a.wavelengths_nm, b.wavelengths_nm);
  EXPECT_EQ(a.weights.sensor, b.weights.sensor);
  ASSERT_EQ(a.weights.lights.size(), b.weights.lights.size());
  for (std::size_t l = 0; l < a.weights.lights.size(); ++l) {
    EXPECT_EQ(a.weights.lights[l].name, b.weights.lights[l].name);
    EXPECT_EQ(a.weights.lights[l].emission, b.weights.lights[l].emission);
    EXPECT_TRUE(std::ranges::equal(a.weights.lights[l].spectrum.wavelengths_nm(),
                                   b.weights.lights[l].spectrum.wavelengths_nm()));
    EXPECT_TRUE(
        std::ranges::equal(a.weights.lights[l].spectrum.values(), b.weights.lights[l].spectrum.values()));
  }
  const auto same = [](const auto& p, const auto& q) {
    EXPECT_EQ(p.light, q.light);
    EXPECT_EQ(p.bounces, q.bounces);
    EXPECT_EQ(p.error.mean, q.error.mean);
    EXPECT_EQ(p.error.percentile95, q.error.percentile95);
    EXPECT_EQ(p.error.maximum, q.error.maximum);
  };
  ASSERT_EQ(a.report.errors.size(), b.report.errors.size());
  for (std::size_t i = 0; i < a.report.errors.size(); ++i) same(a.report.errors[i], b.report.errors[i]);
  ASSERT_EQ(a.report.even_bands.size(), b.report.even_bands.size());
  for (std::size_t i = 0; i < a.report.even_bands.size(); ++i) {
    EXPECT_EQ(a.report.even_bands[i].sums, b.report.even_bands[i].sums);
    EXPECT_EQ(a.report.even_bands[i].bands, b.report.even_bands[i].bands);
    same(a.report.even_bands[i], b.report.even_bands[i]);
  }
}

Plan odd_plan() {
  Plan plan;
  plan.weights.observer = Observer::kCie1964;
  plan.wavelengths_nm = {100, 400 + 1e-13, 1e3 / 3, 10000};
  std::sort(plan.wavelengths_nm.begin(), plan.wavelengths_nm.end());
  plan.weights.sensor = {
      {0.1, -0.0, 5e-324}, {1e308, -1e-308, 1.0 / 3}, {0, 0, 0}, {std::nextafter(1.0, 2.0), 2, 3}};
  const auto lamp = *MeasuredSpectrum::from_samples(std::vector<double>{400, 500, 500, 700},
                                                    std::vector<double>{1, 0.1, 1.0 / 7, 1e-17});
  plan.weights.lights = {{{"D65", *illuminant("D65")}, {1, 2, 3, 4}},
                         {{"A", lamp}, {0.1, 0.2, 0.3, 1e300}},  // not the published one of that name
                         {{"a \"lamp\", \xC3\xA9t\xC3\xA9\n", lamp}, {0, -1, 2, 3}}};
  plan.report.errors = {{"D65", 1, {0.1, 0.2, 1.0 / 3}}, {"D65", 2, {1, 2, 3}}, {"A", 1, {0, 0, 0}}};
  constexpr auto kMultiplied = EvenBandsSums::kAveragesMultiplied;
  plan.report.even_bands = {{EvenBandsSums::kAsProjected, "400:700:5", "A", 1, {0.2, 0.3, 0.4}},
                            {kMultiplied, "400:700:5", "D65", 1, {0.3, 0.4, 0.5}},
                            {kMultiplied, "400:700:5", "A", 2, {0.6, 0.7, 0.8}},
                            {kMultiplied, "380:780:10", "D65", 1, {1e-9, 1, 2}}};
  return plan;
}

TEST(PlanFile, ComesBackToTheBit) {
  const Plan plan = odd_plan();
  const std::string text = plan_to_json(plan);
  const auto back = parse_plan(text, "text");
  ASSERT_TRUE(back) << back.error().message;
  expect_same(plan, *back);
  EXPECT_TRUE(std::signbit(back->weights.sensor[0][1]));
  EXPECT_EQ(plan_to_json(*back), text);
}

TEST(PlanFile, APublishedLightIsKeptByName) {
  const std::string text = plan_to_json(odd_plan());
  EXPECT_LT(text.find("\"D65\""), text.find("\"spectrum\""));
  EXPECT_GT(text.find("\"spectrum\""), text.find("\"name\": \"A\""));
}

TEST(PlanFile, ALightThatOnlyHasAPublishedNameKeepsItsSpectrum) {
  Plan plan = odd_plan();
  const auto published = *illuminant("A");
  std::vector<double> values(published.values().begin(), published.values().end());
  values.at(50) = std::nextafter(values.at(50), 0.0);
  plan.weights.lights[1].spectrum = *MeasuredSpectrum::from_samples(published.wavelengths_nm(), values);
  const auto back = parse_plan(plan_to_json(plan), "text");
  ASSERT_TRUE(back) << back.error().message;
  expect_same(plan, *back);
}

TEST(PlanFile, WhatThePlannerMakesComesBack) {
  PlannerOptions options;
  options.lights = {*find_light("FL11"), *named_light("candle", *named_spectrum("blackbody:1900"))};
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") options.reflectances.push_back(*named_spectrum(info.name));
  }
  options.bands = 8;
  options.folds = 2;
  const auto plan = make_plan(options);
  ASSERT_TRUE(plan) << plan.error().message;
  test::TempFolder folder;
  ASSERT_TRUE(save_plan(*plan, folder / "plan.json"));
  const auto back = load_plan(folder / "plan.json");
  ASSERT_TRUE(back) << back.error().message;
  expect_same(*plan, *back);
  EXPECT_EQ(back->report.errors.size(), 2U);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"plan.json"}));
  const std::string text = test::file_bytes(folder / "plan.json");
  EXPECT_LT(text.find("FL11"), text.find("\"spectrum\""));
}

TEST(PlanFile, ReadsWhatAPersonWrites) {
  const auto plan = parse_plan(kText, "text");
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->count(), 3U);
  EXPECT_EQ(plan->weights.observer, Observer::kCie1964);
  EXPECT_EQ(plan->weights.sensor[1][1], 0.6);
  EXPECT_EQ(plan->weights.lights[1].spectrum.at(550), 2);
  EXPECT_TRUE(plan->report.errors.empty());
}

TEST(PlanFile, RefusesWhatIsNoPlan) {
  expect_refused("", "is no plan");
  expect_refused("[1, 2", "is no plan");
  expect_refused("3", "is no object");
  expect_refused("[]", "is no object");
  expect_refused("{}", "has no \"wavelengths_nm\"");
  expect_refused("\xFF\xFE", "is no plan");
  expect_refused(std::string("{\0}", 3), "is no plan");
}

TEST(PlanFile, RefusesNumbersThatCannotBe) {
  expect_refused(replaced("450", "NaN"), "is no plan");
  expect_refused(replaced("450", "1e999"), "is no plan");
  expect_refused(replaced("450", "\"450\""), "no number");
  expect_refused(replaced("450", "null"), "no number");
  expect_refused(replaced("450", "[450]"), "no number");
  expect_refused(replaced("450", "600"), "do not ascend: 550.5 nm comes after 600 nm");
  expect_refused(replaced("450", "550.5"), "do not ascend");
  expect_refused(replaced("450", "99.9"), "a wavelength of 99.9 nm is not from 100 to 10000 nm");
  expect_refused(replaced("640", "10001"), "10001 nm");
  expect_refused(replaced("640", std::string(400, '9')), "is no plan");
  expect_refused(replaced("640", "99999999999999999999999"), "nm is not from");
}

TEST(PlanFile, RefusesListsThatDoNotFit) {
  expect_refused(replaced("[450, 550.5, 640]", "[]"), "sensor has 3 weights for x, but there are 0");
  expect_refused(replaced("[450, 550.5, 640]", "450"), "\"wavelengths_nm\" of the plan is no list");
  expect_refused(replaced("[1, 0, 0]", "[1, 0]"), "the sensor has 2 weights for z, but there are 3");
  expect_refused(replaced("\"y\"", "\"Y\""), "the sensor has no \"y\"");
  expect_refused(replaced("[1, 1, 1]", "[1, 1, 1, 1]"), "\"D65\" has 4 emission values for 3 wavelengths");
  expect_refused(
      R"({"wavelengths_nm":[],"sensor":{"x":[],"y":[],"z":[]},"illuminants":[],"observer":"1931"})",
      "0 wavelengths");
}

TEST(PlanFile, RefusesLightsThatCannotBe) {
  expect_refused(replaced("\"lamp\"", "\"D65\""), "two lights are called \"D65\"");
  expect_refused(replaced("\"D65\"", "\"moon\""), "\"moon\" has no spectrum");
  expect_refused(replaced("\"D65\"", "65"), "name of a light is no text");
  expect_refused(replaced("[400, 700]", "[400]"), "spectrum of the light \"lamp\"");
  expect_refused(replaced("[400, 700]", "[]"), "spectrum of the light \"lamp\"");
  expect_refused(replaced("{\"wavelengths_nm\": [400, 700], \"values\": [1, 3]}", "7"), "is no object");
  expect_refused(replaced("\"1964\"", "1964"), "\"observer\" is neither");
  expect_refused(replaced("\"observer\"", "\"eye\""), "has no \"observer\"");
  std::string none = kText;
  const std::size_t from = none.find('[', none.find("illuminants"));
  none.replace(from, none.find("]}}]") + 4 - from, "[]");
  expect_refused(none, "0 lights");
  none.replace(none.find("[]"), 2, "{}");
  expect_refused(none, "\"illuminants\" is no list");
}

TEST(PlanFile, RefusesPromisesThatCannotBe) {
  const auto with = [](const std::string& promise) {
    return replaced("\"observer\"", "\"promise\": " + promise + ", \"observer\"");
  };
  EXPECT_TRUE(parse_plan(with("{}"), "text"));
  EXPECT_TRUE(
      parse_plan(with(R"({"illuminants": {"D65": {"1": {"mean":1,"percentile95":2,"maximum":3}}}})"), "t"));
  expect_refused(with("3"), "\"promise\" is no object");
  expect_refused(with(R"({"illuminants": []})"), "is no object");
  expect_refused(with(R"({"illuminants": {"D65": 1}})"), "is no object");
  expect_refused(with(R"({"illuminants": {"D65": {"one": {}}}})"), "\"one\" bounces");
  expect_refused(with(R"({"illuminants": {"D65": {"0": {}}}})"), "\"0\" bounces");
  expect_refused(with(R"({"illuminants": {"D65": {"1e300": {}}}})"), "\"1e300\" bounces");
  expect_refused(with(R"({"illuminants": {"D65": {"1": {"mean": 1}}}})"), "has no \"percentile95\"");
  const std::string error = R"({"mean":1,"percentile95":2,"maximum":3})";
  expect_refused(with(R"({"illuminants": {"D65": {"2": )" + error + R"(, "2.0": )" + error + "}}}"),
                 "\"D65\" is given twice for 2 bounces");
  expect_refused(with(R"({"even_bands": {"400:700:5": []}})"), "is no object");
  expect_refused(with(R"({"even_bands_projected": []})"), "\"even_bands_projected\" is no object");
}

TEST(PlanFile, RefusesTextBuiltToUseUpMemoryOrTime) {
  const auto repeated = [](const char* what, std::size_t times) {
    std::string out;
    out.reserve(std::strlen(what) * times);
    for (std::size_t i = 0; i < times; ++i) out += what;
    return out;
  };
  expect_refused(repeated("[", 30'000'000), "nested more than");
  expect_refused(repeated("{\"a\":", 10'000'000), "nested more than");
  expect_refused("{\"wavelengths_nm\": [" + repeated("1,", 30'000'000) + "1]}",
                 "holds more than 4000000 values");
  expect_refused(replaced("450", repeated("1,", 5000) + "450"), "has 5003 entries, more than 4096");
  std::string keys = "{";
  for (int i = 0; i < 5000; ++i) keys += "\"" + std::to_string(i) + "\":0,";
  expect_refused(keys + "\"end\":0}", "object of more than 1024 keys");
  expect_refused(replaced("{", "{\"wavelengths_nm\": [1], "),
                 "has the key \"wavelengths_nm\" twice in one object");
  expect_refused(std::string((std::size_t{64} << 20U) + 1, ' '), "larger than 64 MiB");
  expect_refused(replaced("D65", std::string(1000, 'x')), "...\" has no spectrum");
}

TEST(PlanFile, EveryTextCutShortIsRefused) {
  const std::string text = plan_to_json(odd_plan());
  for (std::size_t length = 0; length + 2 < text.size(); length += 7) {
    const auto plan = parse_plan(text.substr(0, length), "cut");
    ASSERT_FALSE(plan) << length;
    EXPECT_EQ(plan.error().code, ErrorCode::kBadFile);
  }
}

TEST(PlanFile, IsNotWrittenWhereItCouldNotBeRead) {
  test::TempFolder folder;
  Plan plan = odd_plan();
  plan.weights.sensor[0][0] = std::numeric_limits<double>::quiet_NaN();
  const auto saved = save_plan(plan, folder / "plan.json");
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, ErrorCode::kBadArgument);
  plan = odd_plan();
  plan.weights.lights[1].emission[0] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(save_plan(plan, folder / "plan.json"));
  EXPECT_EQ(save_plan(odd_plan(), folder / "none/plan.json").error().code, ErrorCode::kBadFile);
  EXPECT_EQ(save_plan(odd_plan(), folder.path().string()).error().code, ErrorCode::kBadFile);
  EXPECT_TRUE(folder.names().empty());
  EXPECT_EQ(load_plan(folder / "plan.json").error().code, ErrorCode::kBadFile);
}

}  // namespace
}  // namespace spectile
