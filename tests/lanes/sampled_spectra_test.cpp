// Laws that hold for every input, tried on generated ones (rapidcheck, with a fixed seed unless RC_PARAMS
// says else).
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <numeric>
#include <spectile/color/colorimetry.hpp>
#include <spectile/lanes/arithmetic.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "src/dispatch/dispatch.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

// rapidcheck reads the variable at the first property.
const int kSeeded = ::setenv("RC_PARAMS", "seed=20240229 max_success=200", 0);

rc::Gen<float> any_float() {
  return rc::gen::map(rc::gen::arbitrary<std::uint32_t>(),
                      [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
}

/// Multiples of 2^-20 from `low` to `high`.
rc::Gen<float> between(int low, int high) {
  return rc::gen::map(rc::gen::inRange(low << 20, (high << 20) + 1),
                      [](int v) { return static_cast<float>(v) * 0x1p-20F; });
}

std::size_t any_lanes() {
  return *rc::gen::inRange<std::size_t>(1, 200);
}

Bands any_bands() {
  const auto widths = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 40)));
  std::vector<Band> list;
  double at = 400;
  for (const int width : widths) {
    if (list.size() == 40) break;
    list.push_back({at, at + 0.5 * width, at + width});
    at += width * (width % 3 == 0 ? 1.5 : 1.0);  // some gaps
  }
  return *Bands::from_list(list);
}

ColorLanes any_colors(std::size_t lanes, const rc::Gen<float>& component) {
  const auto values = *rc::gen::container<std::vector<float>>(3 * lanes, component);
  auto rgb = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = values[3 * i + k];
  }
  return rgb;
}

SampledSpectra any_spectra(const Bands& bands, std::size_t lanes, const rc::Gen<float>& sample) {
  const auto values = *rc::gen::container<std::vector<float>>(lanes * bands.count(), sample);
  return batch_of(bands, lanes,
                  [&](std::size_t lane, std::size_t band) { return values[lane * bands.count() + band]; });
}

Upsampler any_upsampler(const Bands& bands, NegativeSamples negative) {
  return *Upsampler::create(*rc::gen::element(Method::kSmits, Method::kSmits1999),
                            *rc::gen::element(Quantity::kReflectance, Quantity::kIlluminant), bands,
                            negative);
}

std::vector<std::size_t> any_order(std::size_t n) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

RC_GTEST_PROP(SampledSpectraBatches, PermutedColoursGivePermutedSpectra, ()) {
  const std::size_t lanes = any_lanes();
  const Bands bands = any_bands();
  const auto rgb = any_colors(lanes, any_float());
  const auto order = any_order(lanes);
  auto permuted = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) permuted.at(i, k) = rgb.at(order[i], k);
  }
  const auto upsampler =
      any_upsampler(bands, *rc::gen::element(NegativeSamples::kClampToZero, NegativeSamples::kKeep));
  auto a = *SampledSpectra::create(bands, lanes);
  auto b = *SampledSpectra::create(bands, lanes);
  RC_ASSERT(static_cast<bool>(upsample_srgb(upsampler, rgb.view(), a.span())));
  RC_ASSERT(static_cast<bool>(upsample_srgb(upsampler, permuted.view(), b.span())));
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < bands.count(); ++k) RC_ASSERT(same_bits(b.at(i, k), a.at(order[i], k)));
  }
}

RC_GTEST_PROP(SampledSpectraBatches, PermutedSpectraGivePermutedColours, ()) {
  const std::size_t lanes = any_lanes();
  const Bands bands = any_bands();
  const auto spectra = any_spectra(bands, lanes, any_float());
  const auto order = any_order(lanes);
  const auto permuted = batch_of(
      bands, lanes, [&](std::size_t lane, std::size_t band) { return spectra.at(order[lane], band); });
  const auto projector = *Projector::emissive(bands);
  auto a = *ColorLanes::create(lanes);
  auto b = *ColorLanes::create(lanes);
  RC_ASSERT(static_cast<bool>(project(projector, spectra.view(), a.span())));
  RC_ASSERT(static_cast<bool>(project(projector, permuted.view(), b.span())));
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(same_bits(b.at(i, k), a.at(order[i], k)));
  }
}

RC_GTEST_PROP(SampledSpectraBatches, ProjectionIsLinearWithinItsRoundings, ()) {
  const std::size_t lanes = *rc::gen::inRange<std::size_t>(1, 20);
  const Bands bands = any_bands();
  const auto x = any_spectra(bands, lanes, between(-4, 4));
  const auto y = any_spectra(bands, lanes, between(-4, 4));
  const float a = *between(-3, 3);
  const float b = *between(-3, 3);
  const auto projector = *Projector::emissive(bands);
  auto ax = *SampledSpectra::create(bands, lanes);
  auto mixed = *SampledSpectra::create(bands, lanes);
  RC_ASSERT(static_cast<bool>(scale(x.view(), a, ax.span())));
  RC_ASSERT(static_cast<bool>(scale(y.view(), b, mixed.span())));
  RC_ASSERT(static_cast<bool>(add(ax.view(), mixed.view(), mixed.span())));
  ColorLanes of[3] = {*ColorLanes::create(lanes), *ColorLanes::create(lanes), *ColorLanes::create(lanes)};
  RC_ASSERT(static_cast<bool>(project(projector, x.view(), of[0].span())));
  RC_ASSERT(static_cast<bool>(project(projector, y.view(), of[1].span())));
  RC_ASSERT(static_cast<bool>(project(projector, mixed.view(), of[2].span())));
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      double size = 0;
      for (std::size_t band = 0; band < bands.count(); ++band) {
        size += std::abs(projector.weights()[band][k]) *
                (std::abs(double(a) * x.at(i, band)) + std::abs(double(b) * y.at(i, band)));
      }
      // Two projections' bounds and the two roundings of the mixture.
      const double bound = (2.0 * static_cast<double>(bands.count() + 2) + 2) * 0x1p-24 * size;
      RC_ASSERT(std::abs(of[2].at(i, k) - (double(a) * of[0].at(i, k) + double(b) * of[1].at(i, k))) <=
                bound);
    }
  }
}

RC_GTEST_PROP(SampledSpectraBatches, PowersOfTwoPassThroughUpsamplingAndProjectionExactly, ()) {
  const std::size_t lanes = any_lanes();
  const Bands bands = any_bands();
  const float factor = std::ldexp(1.0F, *rc::gen::inRange(-20, 21));
  // Multiples of 2^-20: neither the products with factor nor those with basis and weights come near the
  // denormals.
  const auto rgb = any_colors(lanes, between(-2, 4));
  auto scaled = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) scaled.at(i, k) = factor * rgb.at(i, k);
  }
  const auto upsampler = any_upsampler(bands, NegativeSamples::kClampToZero);
  const auto projector = *Projector::emissive(bands);
  auto a = *SampledSpectra::create(bands, lanes);
  auto b = *SampledSpectra::create(bands, lanes);
  RC_ASSERT(static_cast<bool>(upsample_srgb(upsampler, rgb.view(), a.span())));
  RC_ASSERT(static_cast<bool>(upsample_srgb(upsampler, scaled.view(), b.span())));
  auto p = *ColorLanes::create(lanes);
  auto q = *ColorLanes::create(lanes);
  RC_ASSERT(static_cast<bool>(project(projector, a.view(), p.span())));
  RC_ASSERT(static_cast<bool>(project(projector, b.view(), q.span())));
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < bands.count(); ++k) RC_ASSERT(b.at(i, k) == factor * a.at(i, k));
    for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(q.at(i, k) == factor * p.at(i, k));
  }
}

RC_GTEST_PROP(SampledSpectraBatches, ClampedSpectraAndTheirColoursAreNotNegative, ()) {
  const std::size_t lanes = any_lanes();
  const Bands bands = any_bands();
  const auto rgb = any_colors(lanes, any_float());
  auto spectra = *SampledSpectra::create(bands, lanes);
  RC_ASSERT(static_cast<bool>(
      upsample_srgb(any_upsampler(bands, NegativeSamples::kClampToZero), rgb.view(), spectra.span())));
  auto xyz = *ColorLanes::create(lanes);
  RC_ASSERT(static_cast<bool>(project(*Projector::emissive(bands), spectra.view(), xyz.span())));
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < bands.count(); ++k) RC_ASSERT(!(spectra.at(i, k) < 0));
    for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(!(xyz.at(i, k) < 0));
  }
}

RC_GTEST_PROP(SampledSpectraBatches, HalvesGoToFloatAndBackUnchanged, ()) {
  const auto some = *rc::gen::container<std::vector<std::uint16_t>>(64, rc::gen::arbitrary<std::uint16_t>());
  for (const kernels::KernelTable* table : dispatch::available()) {
    Floats floats(64);
    std::vector<std::uint16_t> back(64);
    table->half_to_float(floats.data(), some.data(), 64);
    table->float_to_half(back.data(), floats.data(), 64);
    for (std::size_t i = 0; i < 64; ++i) {
      if (std::isnan(floats[i])) {
        RC_ASSERT((back[i] | 0x200) == (some[i] | 0x200));  // quiet, otherwise the same
      } else {
        RC_ASSERT(back[i] == some[i]);
      }
    }
  }
}

RC_GTEST_PROP(SampledSpectraBatches, AverageLiesBetweenTheExtremes, ()) {
  const std::size_t lanes = any_lanes();
  const Bands bands = any_bands();
  const auto spectra = any_spectra(bands, lanes, between(0, 4));
  auto low = *ScalarLanes::create(lanes);
  auto high = *ScalarLanes::create(lanes);
  auto mean = *ScalarLanes::create(lanes);
  RC_ASSERT(static_cast<bool>(minimum(spectra.view(), low.span())));
  RC_ASSERT(static_cast<bool>(maximum(spectra.view(), high.span())));
  RC_ASSERT(static_cast<bool>(average(spectra.view(), mean.span())));
  const double slack = static_cast<double>(bands.count() + 1) * 0x1p-24;
  for (std::size_t i = 0; i < lanes; ++i) {
    RC_ASSERT(mean[i] >= low[i] * (1 - slack));
    RC_ASSERT(mean[i] <= high[i] * (1 + slack));
  }
}

RC_GTEST_PROP(SampledSpectraBatches, CoarseBandsHoldTheMeanOfTheirFineOnes, ()) {
  const auto wavelengths = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
      rc::gen::map(rc::gen::inRange(3500, 8000), [](int v) { return 0.1 * v; })));
  const auto values = *rc::gen::container<std::vector<double>>(
      wavelengths.size(), rc::gen::map(rc::gen::inRange(0, 1000), [](int v) { return 0.001 * v; }));
  const auto fine = *average_over(*Bands::uniform(400, 700, 5), wavelengths, values);
  const auto coarse = *average_over(*Bands::uniform(400, 700, 20), wavelengths, values);
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    double mean = 0;
    for (std::size_t k = 0; k < 4; ++k) mean += 0.25 * fine[4 * i + k];
    RC_ASSERT(std::abs(coarse[i] - mean) <= 2 * 0x1p-24 * mean + 1e-12);  // each average is rounded once
  }
}

TEST(SampledSpectraBatches, SeedIsSet) {
  EXPECT_EQ(kSeeded, 0);
  ASSERT_NE(std::getenv("RC_PARAMS"), nullptr);
}

}  // namespace
}  // namespace spectile::test
