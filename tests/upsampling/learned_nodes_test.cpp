// Nodes learned from measured reflectances: exact as others, nearer where materials have a habit in common.
#include <gmock/gmock.h>

#include <filesystem>
#include <random>
#include <spectile/image/nodes_file.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/upsampling/learned_nodes.hpp>

#include "src/spectra/sigmoid_functions.hpp"
#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/grid/measured_colors.hpp"
#include "src/upsampling/method_rows.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

using testing::HasSubstr;

ReflectanceSet color_checker() {
  ReflectanceSet out = {"ColorChecker", {}};
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") out.reflectances.push_back(*named_spectrum(info.name));
  }
  return out;
}

double bump(double nm) {
  const double d = (nm - 580) / 25;
  return std::exp(-d * d);
}

/// Reflectances whose sigmoids have `habit` added to their arguments.
ReflectanceSet materials(std::size_t count, std::uint32_t seed, double habit) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-1, 1);
  ReflectanceSet out = {"drawn", {}};
  std::vector<double> nm;
  for (int i = 0; i <= 90; ++i) nm.push_back(360 + 5 * i);
  for (std::size_t n = 0; n < count; ++n) {
    const double c[3] = {0.8 * draw(random), 0.5 * draw(random), 0.8 * draw(random) - 0.3};
    std::vector<double> values;
    for (const double at : nm) {
      const auto [p, q] = SigmoidFunctions::of(Observer::kCie1931).at(at);
      const double x = c[0] * p + c[1] * q + c[2] + habit * bump(at);
      values.push_back(0.5 + x / (2 * std::sqrt(1 + x * x)));
    }
    out.reflectances.emplace_back(*PiecewiseLinearSpectrum::from_samples(nm, values, Ends::kHeld));
  }
  return out;
}

UpsamplerOptions with(LearnedNodes nodes) {
  UpsamplerOptions out;
  out.observer = nodes.observer;
  if (nodes.light.name != "D65") out.light = nodes.light.spectrum;
  out.nodes = std::make_shared<const LearnedNodes>(std::move(nodes));
  return out;
}

TEST(LearnedNodes, KeepColoursExactAndGreysFlat) {
  for (const ReflectanceSet& set : {color_checker(), materials(60, 1, 0.8)}) {
    const UpsamplerOptions options = with(*learn_nodes({&set, 1}));
    for (const char* bands : {"400:700:5", "380:780:5", "300:1000:10"}) {
      for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
        SCOPED_TRACE(std::string(bands) + " " + std::string(to_string(quantity)));
        const auto upsampler =
            *Upsampler::create(Method::kTetrahedral, quantity, *Bands::parse(bands), options);
        const RoundTrip result = round_trip(upsampler, cube_grid(9));
        EXPECT_LE(result.rgb, 2e-6);
        EXPECT_GE(result.least, 0);
        EXPECT_TRUE(quantity != Quantity::kReflectance || result.greatest <= 1) << result.greatest;
      }
    }
    const auto spectra =
        spectra_of(*Upsampler::create(Method::kTetrahedral, Quantity::kReflectance, Bands(), options),
                   lanes_of({{0.3F, 0.3F, 0.3F}, {1, 1, 1}}));
    for (std::size_t b = 0; b < 60; ++b) {
      ASSERT_NEAR(spectra.at(0, b), 0.3, 1e-7);
      ASSERT_EQ(spectra.at(1, b), 1);
    }
  }
}

TEST(LearnedNodes, FindTheHabitThatMaterialsHaveInCommon) {
  const ReflectanceSet set = materials(150, 2, 0.8);
  const LearnedNodes nodes = *learn_nodes({&set, 1});
  EXPECT_EQ(nodes.reflectances, 150U);
  // At a node among the colours, the offset rises and falls with the bump, less what coefficients can make of
  // it.
  const std::size_t node = (2 * 5 + 1) * 5 + 1;
  const auto at = [&](double nm) {
    const auto i = std::find(nodes.wavelengths_nm.begin(), nodes.wavelengths_nm.end(), nm);
    return nodes.offsets[node * nodes.wavelengths_nm.size() +
                         static_cast<std::size_t>(i - nodes.wavelengths_nm.begin())];
  };
  EXPECT_GT(at(580), 0.25F);
  EXPECT_LT(at(530), 0);
  EXPECT_LT(at(640), 0);
  const auto trials = *try_learning({&set, 1});
  ASSERT_EQ(trials.size(), 1U);
  EXPECT_EQ(trials[0].held_out, "");
  EXPECT_GT(trials[0].reflectances, 100U);
  EXPECT_LT(trials[0].learned.mean, 0.5 * trials[0].sigmoid_observer.mean);
  EXPECT_LT(trials[0].learned.mean, 0.5 * trials[0].tetrahedral.mean);
  EXPECT_TRUE(trials[0].pays());
}

TEST(LearnedNodes, WithoutAHabitLearningDoesNotPay) {
  const ReflectanceSet set = materials(50, 3, 0);
  const auto trials = *try_learning({&set, 1});
  EXPECT_FALSE(trials[0].pays());
  EXPECT_LT(trials[0].sigmoid_observer.mean, 0.01);
  EXPECT_NEAR(trials[0].learned.mean, trials[0].tetrahedral.mean, 0.05);
}

TEST(LearnedNodes, HaveErrorsOfEachSetThatTookNoPart) {
  ReflectanceSet sets[] = {materials(40, 4, 0.8), materials(40, 5, -0.8), materials(12, 6, 0.8)};
  sets[1].name = "of the other habit";
  const auto trials = *try_learning(sets);
  ASSERT_EQ(trials.size(), 4U);
  EXPECT_EQ(trials[2].held_out, "of the other habit");
  EXPECT_FALSE(trials[2].pays());
  EXPECT_GT(trials[2].learned.mean, trials[2].tetrahedral.mean);
}

TEST(LearnedNodes, ComeFromTheReflectancesAloneNotFromTheirOrder) {
  ReflectanceSet set = materials(40, 7, 0.5);
  const LearnedNodes a = *learn_nodes({&set, 1});
  std::reverse(set.reflectances.begin(), set.reflectances.end());
  const LearnedNodes b = *learn_nodes({&set, 1});
  ASSERT_EQ(a.offsets.size(), b.offsets.size());
  for (std::size_t i = 0; i < a.offsets.size(); ++i) ASSERT_NEAR(a.offsets[i], b.offsets[i], 1e-6);
}

TEST(LearnedNodes, AreForTheirOwnMethodWhiteObserverAndPrimaries) {
  const ReflectanceSet set = color_checker();
  LearningOptions under_d75;
  under_d75.light = NamedLight{"D75", *illuminant("D75")};
  under_d75.observer = Observer::kCie1964;
  const UpsamplerOptions right = with(*learn_nodes({&set, 1}, under_d75));
  const auto make = [](Method method, const UpsamplerOptions& options) {
    return Upsampler::create(method, Quantity::kReflectance, Bands(), options);
  };
  ASSERT_TRUE(make(Method::kTetrahedral, right)) << make(Method::kTetrahedral, right).error().message;
  for (int wrong = 0; wrong < 4; ++wrong) {
    UpsamplerOptions options = right;
    if (wrong == 1) options.light.reset();
    if (wrong == 2) options.observer = Observer::kCie1931;
    if (wrong == 3) options.primaries.red = {0.65, 0.33};
    const auto made = make(wrong == 0 ? Method::kSigmoid : Method::kTetrahedral, options);
    ASSERT_FALSE(made) << wrong;
    EXPECT_EQ(made.error().code, ErrorCode::kBadArgument);
    EXPECT_THAT(made.error().message, HasSubstr("learned")) << wrong;
  }
}

TEST(LearnedNodes, OffsetsThatNoColourAllowsAreWeakenedAndCounted) {
  const ReflectanceSet set = color_checker();
  LearnedNodes nodes = *learn_nodes({&set, 1});
  const auto weakened = [](const LearnedNodes& of) {
    const auto made = *Upsampler::create(Method::kTetrahedral, Quantity::kReflectance, Bands(), with(of));
    EXPECT_LE(round_trip(made, cube_grid(9)).rgb, 2e-6);
    return UpsamplerAccess::grid(made)->grid.weakened;
  };
  EXPECT_EQ(weakened(nodes), 0U);
  // 0 in one half of the spectrum, 1 in the other: such spectra have one colour.
  for (std::size_t i = 0; i < nodes.offsets.size(); ++i)
    nodes.offsets[i] = i % nodes.wavelengths_nm.size() < 32 ? 1000.0F : -1000.0F;
  EXPECT_GT(weakened(nodes), 50U);
}

TEST(LearnedNodes, WhatCannotBeIsRefusedAndWrittenAsLittle) {
  const ReflectanceSet set = color_checker();
  const LearnedNodes good = *learn_nodes({&set, 1});
  for (int wrong = 0; wrong < 4; ++wrong) {
    LearnedNodes nodes = good;
    if (wrong == 0) nodes.offsets[7] = kNan;
    if (wrong == 1) std::swap(nodes.wavelengths_nm[3], nodes.wavelengths_nm[4]);
    if (wrong == 2) nodes.wavelengths_nm.clear();
    if (wrong == 3) nodes.offsets.pop_back();
    EXPECT_NE(nodes_flaw(nodes), "") << wrong;
    const auto made = Upsampler::create(Method::kTetrahedral, Quantity::kReflectance, Bands(), with(nodes));
    ASSERT_FALSE(made) << wrong;
    EXPECT_EQ(made.error().code, ErrorCode::kBadArgument);
    EXPECT_LT(nodes_to_json(nodes).size(), 3000U) << wrong;
  }
  EXPECT_EQ(nodes_flaw(good), "");
}

TEST(LearnedNodes, ErrorsAreSentences) {
  const ReflectanceSet few = materials(9, 8, 0);
  EXPECT_THAT(learn_nodes({&few, 1}).error().message, HasSubstr("not from 9"));
  ReflectanceSet bad = materials(20, 8, 0);
  bad.reflectances[3] = ConstantSpectrum(kNan);
  EXPECT_EQ(learn_nodes({&bad, 1}).error().code, ErrorCode::kBadArgument);
  ReflectanceSet good = materials(20, 8, 0);
  LearningOptions options;
  options.go_on = [] { return false; };
  EXPECT_EQ(learn_nodes({&good, 1}, options).error().code, ErrorCode::kCancelled);
  EXPECT_EQ(try_learning({&good, 1}, options).error().code, ErrorCode::kCancelled);
}

/// Values of the same recipe made elsewhere, with NumPy, from the same files.
TEST(LearnedNodes, OfPublishedReflectancesAreWhatAnotherProgramMakes) {
  const std::filesystem::path data = std::filesystem::path(SPECTILE_TEST_SHARED) / "data";
  const auto load = [&](const char* name) { return *find_reflectances(data / name, {}); };
  if (!std::filesystem::exists(data / "reflectances_190_patches_5nm.csv")) GTEST_SKIP() << "no " << data;
  ReflectanceSet sets[] = {{"190 patches", load("reflectances_190_patches_5nm.csv").spectra},
                           {"ColorChecker", color_checker().reflectances},
                           {"CES", load("reflectances_ces99_5nm.csv").spectra}};
  const LearnedNodes nodes = *learn_nodes({sets, 1});
  const auto colors = *MeasuredColors::create({});
  const auto upsampler =
      *Upsampler::create(Method::kTetrahedral, Quantity::kReflectance, colors.bands(), with(nodes));
  const double expected[] = {1.109, 0.692, 1.617};
  const char* const lights[] = {"A", "FL2", "FL11", "LED-B3", "HP1"};
  for (std::size_t s = 0; s < 3; ++s) {
    double sum = 0;
    int count = 0;
    for (const Spectrum& r : sets[s].reflectances) {
      const auto rgb = colors.rgb_of(r);
      if (std::min({rgb[0], rgb[1], rgb[2]}) < 0 || std::max({rgb[0], rgb[1], rgb[2]}) > 1) continue;
      const auto made = spectra_of(
          upsampler,
          lanes_of({{static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])}}));
      const auto measured = r.average_over(colors.bands());
      for (const char* light : lights) {
        const auto under = *Projector::reflective(colors.bands(), *illuminant(light));
        std::array<double, 3> want{};
        std::array<double, 3> got{};
        for (std::size_t b = 0; b < measured.size(); ++b) {
          for (std::size_t k = 0; k < 3; ++k) {
            want[k] += under.weights()[b][k] * measured[b];
            got[k] += under.weights()[b][k] * made.at(0, b);
          }
        }
        sum += ciede2000(xyz_to_lab(want, under.white()), xyz_to_lab(got, under.white()));
        ++count;
      }
    }
    EXPECT_NEAR(sum / count, expected[s], 0.02) << sets[s].name;
  }
}

}  // namespace
}  // namespace spectile::test
