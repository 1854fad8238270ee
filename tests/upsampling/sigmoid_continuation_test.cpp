// The way from grey to a colour: what the quick search misses is found, and what no sigmoid has ends where
// the sigmoids end.
#include "src/reference/upsampling/sigmoid.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"
#include "tests/kernels/kernel_fixture.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

using kernels::KernelTable;
using kernels::SigmoidTable;

Upsampler make_sigmoid(Method method, const char* bands = "400:700:5", const char* space = "srgb",
                       const char* light = "D65", Quantity quantity = Quantity::kReflectance) {
  UpsamplerOptions options;
  options.primaries = rgb_space(space)->chromaticities;
  options.light = *illuminant(light);
  return *Upsampler::create(method, quantity, *Bands::parse(bands), options);
}

std::uint64_t unsolved(const Upsampler& upsampler, const ColorLanes& rgb) {
  auto out = *CoefficientLanes::create(upsampler, rgb.lanes());
  EXPECT_TRUE(coefficients(upsampler, rgb.view(), out));
  return out.unsolved.outside;
}

/// Linear RGB of the spectra of colours.
std::vector<std::array<double, 3>> returned(const Upsampler& upsampler, const ColorLanes& rgb) {
  const auto spectra = spectra_of(upsampler, rgb);
  const Matrix3 to_rgb = inverse(upsampler.rgb_to_xyz());
  const auto projector = *Projector::reflective(upsampler.bands(), *illuminant("D65"));
  auto xyz = *ColorLanes::create(rgb.lanes());
  EXPECT_TRUE(project(projector, spectra.view(), xyz.span()));
  std::vector<std::array<double, 3>> out;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    out.push_back(times(to_rgb, {xyz.at(i, 0), xyz.at(i, 1), xyz.at(i, 2)}));
  }
  return out;
}

double largest_difference(const std::array<double, 3>& a, const ColorLanes& b, std::size_t i) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(a[k] - static_cast<double>(b.at(i, k))));
  return most;
}

struct Reached {
  Floats c, part;
};

Reached reached(const KernelTable& t, const Upsampler& upsampler, const Floats& rgb) {
  const std::size_t n = rgb.size() / 3;
  Reached out{Floats(3 * n), Floats(n)};
  const float* const in[3] = {rgb.data(), rgb.data() + n, rgb.data() + 2 * n};
  float* const c[3] = {out.c.data(), out.c.data() + n, out.c.data() + 2 * n};
  t.sigmoid_continuation(c, out.part.data(), in, UpsamplerAccess::sigmoid(upsampler)->table,
                         upsampler.luminance().data(), n);
  return out;
}

class SigmoidContinuation : public KernelTest {};

TEST_P(SigmoidContinuation, IsTheReferencesForEveryKindOfColour) {
  const float values[] = {0.0F,  kTiny, 1e-6F, 0.02F, 0.5F, 1.0F,  1.2F, -1e-3F,
                          -0.3F, kMost, kNan,  kInf,  0.9F, -kInf, 3.0F, 0.25F};
  constexpr std::size_t kCount = std::size(values);
  constexpr std::size_t kAll = kCount * kCount * kCount;
  static_assert(kAll % kernels::kLanes == 0);
  Floats rgb(3 * kAll);
  for (std::size_t i = 0; i < kAll; ++i) {
    rgb[i] = values[i % kCount];
    rgb[kAll + i] = values[i / kCount % kCount];
    rgb[2 * kAll + i] = values[i / kCount / kCount];
  }
  for (const auto& [method, space] :
       {std::pair(Method::kSigmoid, "srgb"), std::pair(Method::kSigmoid, "acescg"),
        std::pair(Method::kSigmoidObserver, "srgb"), std::pair(Method::kSigmoidObserver, "acescg")}) {
    const auto upsampler = make_sigmoid(method, "400:700:10", space);
    Floats plain = plain_floats(3 * 4160, 2, -0.2F, 1.1F);
    for (const Floats* colors : {&rgb, &plain}) {
      const Reached got = reached(k(), upsampler, *colors);
      const Reached want = reached(ref(), upsampler, *colors);
      ASSERT_TRUE(same_bits(got.part, want.part)) << space;
      ASSERT_TRUE(same_bits(got.c, want.c)) << space;
    }
  }
}

TEST_P(SigmoidContinuation, BrightGreysHaveTheReferencesZeros) {
  const auto upsampler = make_sigmoid(Method::kSigmoid);
  Floats rgb(3 * 64);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(i % 64) / 63;
  const Reached got = reached(k(), upsampler, rgb);
  const Reached want = reached(ref(), upsampler, rgb);
  EXPECT_TRUE(same_bits(got.c, want.c));
  Floats solved(3 * 64);
  Floats expected(3 * 64);
  std::uint64_t bits = 0;
  const float* const in[3] = {rgb.data(), rgb.data() + 64, rgb.data() + 128};
  float* const out[3] = {solved.data(), solved.data() + 64, solved.data() + 128};
  float* const other[3] = {expected.data(), expected.data() + 64, expected.data() + 128};
  k().sigmoid_solve(out, in, UpsamplerAccess::sigmoid(upsampler)->table, &bits, 64);
  ref().sigmoid_solve(other, in, UpsamplerAccess::sigmoid(upsampler)->table, &bits, 64);
  EXPECT_TRUE(same_bits(solved, expected));
}

SPECTILE_FOR_EVERY_ISA(SigmoidContinuation);

/// Every test runs for both kinds of sigmoid.
class SigmoidFromGrey : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, SigmoidFromGrey,
                         testing::Values(Method::kSigmoid, Method::kSigmoidObserver), sigmoid_method_name);

template <class... Arguments>
Upsampler sigmoid_on(Arguments... arguments) {
  return make_sigmoid(SigmoidFromGrey::GetParam(), arguments...);
}

TEST_P(SigmoidFromGrey, TheCubeIsReachedWithoutTheQuickSearch) {
  const auto upsampler = sigmoid_on();
  const auto grid = cube_grid(9);
  for (std::size_t i = 0; i < grid.lanes(); ++i) {
    const float rgb[3] = {grid.at(i, 0), grid.at(i, 1), grid.at(i, 2)};
    float c[3];
    const float part = reference::sigmoid_continuation(c, rgb, UpsamplerAccess::sigmoid(upsampler)->table,
                                                       upsampler.luminance().data());
    const bool end =
        (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) || (rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1);
    ASSERT_EQ(part, end ? 0.0F : 1.0F) << rgb[0] << " " << rgb[1] << " " << rgb[2];
  }
}

TEST_P(SigmoidFromGrey, DarkPurplesOverWideRangesReturn) {
  const auto rgb = lanes_of({{1.21500016e-5F, 0, 4.55625059e-6F},
                             {9.11250117e-6F, 0, 4.55625059e-6F},
                             {8.61131468e-8F, 0, 1.23018786e-8F}});
  for (const char* bands : {"380:780:5", "360:830:5"}) {
    const auto upsampler = sigmoid_on(bands);
    EXPECT_LE(round_trip(upsampler, rgb).rgb, 2.5e-7) << bands;
    EXPECT_EQ(unsolved(upsampler, rgb), 0U) << bands;
  }
}

/// Purples, reds, blues and their neighbours down to black by powers: purples rise at both ends of the range.
ColorLanes saturated_down_to(int levels) {
  std::vector<Rgb> colors;
  for (int level = 0; level < levels; ++level) {
    const float z = std::ldexp(1.0F, -level);
    for (int i = 0; i < 17; ++i) {
      const auto part = static_cast<float>(i) / 16;
      const float u = part * part * part;
      colors.insert(colors.end(),
                    {{z, 0, u * z}, {u * z, 0, z}, {z, u * z, 0}, {0, z, u * z}, {0, u * z, z}});
    }
  }
  return lanes_of(colors);
}

TEST_P(SigmoidFromGrey, NoColourOfTheCubeIsMissedOverWideRanges) {
  for (const char* bands : {"380:780:5", "360:830:5"}) {
    const auto upsampler = sigmoid_on(bands);
    EXPECT_EQ(unsolved(upsampler, saturated_down_to(20)), 0U) << bands;
    // Still darker, rounding may hide the way, but not the colour.
    EXPECT_LE(round_trip(upsampler, saturated_down_to(24)).rgb, 1e-6) << bands;
  }
}

TEST_P(SigmoidFromGrey, WhatMissesIsReported) {
  // In the cubes of wide primaries.
  for (const char* space : {"display-p3", "rec2020", "acescg"}) {
    const auto upsampler = sigmoid_on("380:780:5", space);
    const auto grid = cube_grid(17);
    auto out = *CoefficientLanes::create(upsampler, grid.lanes());
    ASSERT_TRUE(coefficients(upsampler, grid.view(), out));
    std::uint64_t missed = 0;
    const auto back = returned(upsampler, grid);
    for (std::size_t i = 0; i < grid.lanes(); ++i) {
      if (largest_difference(back[i], grid, i) > 2e-5) ++missed;
    }
    EXPECT_GT(missed, 0U) << space;
    EXPECT_LE(missed, out.unsolved.outside) << space;
  }
}

TEST_P(SigmoidFromGrey, ColoursOfSigmoidsAreSolved) {
  // Those of c = (-4.68274, 5.64237, 3.48688); (-5.36523, 9.02882, 0.827151); (-5.21705, 8.56587, 0.0522521).
  EXPECT_EQ(
      unsolved(sigmoid_on("380:780:5", "acescg"), lanes_of({{0.948412836F, 1.00075197F, 0.165978804F}})), 0U);
  EXPECT_EQ(unsolved(sigmoid_on("380:780:5", "acescg", "FL11"),
                     lanes_of({{0.937835217F, 0.737627983F, 0.0199290421F}})),
            0U);
  EXPECT_EQ(unsolved(sigmoid_on("380:780:5", "rec2020", "FL11"),
                     lanes_of({{0.889452815F, 0.487919688F, -0.0109059243F}})),
            0U);
}

TEST_P(SigmoidFromGrey, ColoursOfRandomSigmoidsAreSolved) {
  // Of moderate coefficients: a colour's own, so it is inside by construction, wherever the cube is.
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 4);
  for (const char* space : {"srgb", "rec2020", "acescg"}) {
    const auto upsampler = sigmoid_on("380:780:5", space);
    const kernels::SigmoidTable& table = UpsamplerAccess::sigmoid(upsampler)->table;
    std::vector<Rgb> colors;
    for (int i = 0; i < 4000; ++i) {
      const float c[3] = {static_cast<float>(normal(random)), static_cast<float>(normal(random)),
                          static_cast<float>(normal(random))};
      double sum[3] = {};
      for (std::size_t b = 0; b < table.bands; ++b) {
        const float* const row = table.rows + b * kernels::kSigmoidRow;
        const double x = c[0] * row[kernels::kSigmoidP] + c[1] * row[kernels::kSigmoidQ] + c[2];
        for (std::size_t k = 0; k < 3; ++k) {
          sum[k] += table.weights[4 * b + k] * (0.5 + 0.5 * x / std::sqrt(1 + x * x));
        }
      }
      colors.push_back({static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
    }
    EXPECT_EQ(unsolved(upsampler, lanes_of(colors)), 0U) << space;
  }
}

TEST_P(SigmoidFromGrey, WhatIsUnsolvedIsNoFurtherAwayThanItsGrey) {
  for (const char* space : {"display-p3", "rec2020", "acescg"}) {
    const auto upsampler = sigmoid_on("380:780:5", space);
    const auto grid = cube_grid(17);
    const auto back = returned(upsampler, grid);
    for (std::size_t i = 0; i < grid.lanes(); ++i) {
      const Rgb rgb = {grid.at(i, 0), grid.at(i, 1), grid.at(i, 2)};
      float grey = 0;
      for (std::size_t k = 0; k < 3; ++k) grey += upsampler.luminance()[k] * rgb[k];
      double furthest = 0;
      for (const float v : rgb) furthest = std::max(furthest, std::abs(static_cast<double>(v - grey)));
      ASSERT_LE(largest_difference(back[i], grid, i), furthest + 1e-5) << space << " " << i;
    }
  }
}

TEST_P(SigmoidFromGrey, FewBandsAreNoFurtherAwayThanGreyEither) {
  const auto few = sigmoid_on("380.3,395.1,401,450.7,455,530,545,560,590,620,622,650,690");
  EXPECT_LE(round_trip(few, lanes_of({{0, 1, 1}})).rgb, 0.8);
}

TEST_P(SigmoidFromGrey, ColoursInTheCubeOfWidePrimariesAreLimitedToo) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded}) {
    const auto upsampler = sigmoid_on("380:780:5", "rec2020", "D65", quantity);
    auto rgb = cube_grid(9);
    const std::uint64_t before = unsolved(upsampler, rgb);
    EXPECT_GE(before, 10U);
    EXPECT_EQ(gamut_clip(upsampler, rgb.span(), GamutPolicy::kKeep)->outside, before);
    EXPECT_EQ(gamut_clip(upsampler, rgb.span())->outside, before);
    EXPECT_EQ(unsolved(upsampler, rgb), 0U);
  }
}

TEST_P(SigmoidFromGrey, WhatIsUnsolvedHasTheSpectrumOfWhereItWouldMove) {
  const auto upsampler = sigmoid_on("400:700:5", "acescg");
  const auto rgb = cube_grid(9);
  auto moved = cube_grid(9);
  ASSERT_TRUE(gamut_clip(upsampler, moved.span()));
  const auto back = returned(upsampler, rgb);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) ASSERT_LE(largest_difference(back[i], moved, i), 2e-3) << i;
}

TEST_P(SigmoidFromGrey, FiniteColoursOfUnboundedOnesStayFinite) {
  const auto upsampler = sigmoid_on("400:700:5", "srgb", "D65", Quantity::kUnbounded);
  const auto rgb = lanes_of({{2e38F, 1e38F, 1e38F}, {kMost, 0, 1e38F}, {kMost, kMost, kMost}});
  const auto spectra = spectra_of(upsampler, rgb);
  for (std::size_t b = 0; b < 60; ++b) {
    for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(std::isfinite(spectra.at(i, b))) << b;
  }
}

}  // namespace
}  // namespace spectile::test
