// One batch type: what holds of samples on bands holds of those at each lane's own wavelengths.
#include <spectile/color/response_curves.hpp>
#include <spectile/lanes/arithmetic.hpp>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

constexpr std::size_t kCount = 4;
constexpr std::size_t kBatch = 200;

const Bands& four_bands() {
  static const Bands bands = *Bands::uniform(400, 720, 80);
  return bands;
}

SampledSpectra batch(const SpectralAxis& axis, std::uint32_t seed) {
  const Floats values = arbitrary_floats(kBatch * kCount, seed);
  return batch_of(axis, kBatch, [&](std::size_t i, std::size_t k) { return values[i * kCount + k]; });
}

/// Runs operation(axis, out) on both axes: the same bits.
template <class Operation>
void expect_alike(const char* name, Operation operation) {
  const SpectralAxis own = *SpectralAxis::own_wavelengths(kCount);
  auto got = *SampledSpectra::create(own, kBatch);
  auto want = *SampledSpectra::create(four_bands(), kBatch);
  ASSERT_TRUE(operation(own, got)) << name;
  ASSERT_TRUE(operation(four_bands(), want)) << name;
  EXPECT_TRUE(same_lanes(got, want)) << name;
}

TEST(OwnWavelengths, EveryOperationTakesThem) {
  const std::vector<float> spectrum = {0.5F, 2, -1, 0};
  auto numbers = *ScalarLanes::create(kBatch);
  for (std::size_t i = 0; i < kBatch; ++i) numbers[i] = static_cast<float>(i) * 0.01F;
  using Axis = const SpectralAxis&;
  using Out = SampledSpectra&;
  const auto a = [](Axis axis) { return batch(axis, 1); };
  const auto b = [](Axis axis) { return batch(axis, 2); };
  expect_alike("add", [&](Axis x, Out out) { return add(a(x), b(x), out); });
  expect_alike("subtract", [&](Axis x, Out out) { return subtract(a(x), b(x), out); });
  expect_alike("multiply", [&](Axis x, Out out) { return multiply(a(x), b(x), out); });
  expect_alike("divide", [&](Axis x, Out out) { return divide(a(x), b(x), out); });
  expect_alike("safe division", [&](Axis x, Out out) { return divide_or_zero(a(x), b(x), out); });
  expect_alike("negate", [&](Axis x, Out out) { return negate(a(x), out); });
  expect_alike("scale", [&](Axis x, Out out) { return scale(a(x), 3, out); });
  expect_alike("factors", [&](Axis x, Out out) { return scale(a(x), numbers, out); });
  expect_alike("one spectrum", [&](Axis x, Out out) { return multiply(a(x), spectrum, out); });
  expect_alike("complement", [&](Axis x, Out out) { return complement(a(x), out); });
  expect_alike("multiply-add", [&](Axis x, Out out) { return multiply_add(a(x), b(x), a(x), out); });
  expect_alike("lerp", [&](Axis x, Out out) { return lerp(a(x), b(x), 0.25F, out); });
  expect_alike("lerp by lane", [&](Axis x, Out out) { return lerp(a(x), b(x), numbers, out); });
  expect_alike("sqrt", [&](Axis x, Out out) { return sqrt(a(x), out); });
  expect_alike("exp", [&](Axis x, Out out) { return exp(a(x), out); });
  expect_alike("transmittance", [&](Axis x, Out out) { return transmittance(a(x), numbers, out); });
  expect_alike("pow", [&](Axis x, Out out) { return pow(a(x), 2.4F, out); });
  expect_alike("clamp", [&](Axis x, Out out) { return clamp(a(x), -1, 1, out); });
  expect_alike("clamp to 0", [&](Axis x, Out out) { return clamp_zero(a(x), out); });

  const SpectralAxis own = *SpectralAxis::own_wavelengths(kCount);
  const auto reduced = [&](auto reduction) {
    auto got = *ScalarLanes::create(kBatch);
    auto want = *ScalarLanes::create(kBatch);
    EXPECT_TRUE(reduction(a(own), got));
    EXPECT_TRUE(reduction(a(four_bands()), want));
    for (std::size_t i = 0; i < kBatch; ++i) EXPECT_TRUE(same_bits(got[i], want[i])) << i;
  };
  reduced([](const SampledSpectra& s, LanesSpan out) { return minimum(s, out); });
  reduced([](const SampledSpectra& s, LanesSpan out) { return maximum(s, out); });
  reduced([](const SampledSpectra& s, LanesSpan out) { return average(s, out); });
  EXPECT_EQ(*is_black(a(own)), *is_black(a(four_bands())));
  EXPECT_EQ(*has_nan(a(own)), *has_nan(a(four_bands())));
  EXPECT_EQ(*equal_lanes(a(own), b(own)), *equal_lanes(a(four_bands()), b(four_bands())));
}

TEST(OwnWavelengths, TheirAverageIsTheMeanHoweverWideTheBands) {
  auto s = own_batch(3, 3);
  for (std::size_t k = 0; k < 3; ++k) s.at(1, k) = static_cast<float>(k + 1);
  auto out = *ScalarLanes::create(3);
  ASSERT_TRUE(average(s, out));
  EXPECT_FLOAT_EQ(out[1], 2);
  EXPECT_EQ(out[0], 0);
}

TEST(OwnWavelengths, AreNotTakenForBands) {
  auto four = own_batch(kBatch, 4);
  const auto on_bands = *SampledSpectra::create(four_bands(), kBatch);
  const auto refused = add(four, on_bands, four);
  EXPECT_EQ(refused.error().code, ErrorCode::kBandsMismatch);
  EXPECT_EQ(refused.error().message,
            "one batch has bands 400:720:80, the other 4 wavelengths of each lane's own");
  EXPECT_EQ(add(four, own_batch(kBatch, 5), four).error().code, ErrorCode::kBandsMismatch);
  auto color = *ColorLanes::create(kBatch);
  EXPECT_EQ(project(*Projector::emissive(four_bands()), four, color).error().code, ErrorCode::kBandsMismatch);
  const auto upsampler = *Upsampler::create(Method::kSmits, Quantity::kReflectance, four_bands());
  EXPECT_EQ(upsample_srgb(upsampler, color, four).error().code, ErrorCode::kBandsMismatch);
  // Nor bands for wavelengths, in whichever place.
  SampledWavelengths w = {*on_bands.clone(), *on_bands.clone()};
  const auto u = *ScalarLanes::create(kBatch);
  EXPECT_EQ(sample_wavelengths(WavelengthSampling::kVisible, u, w).error().code, ErrorCode::kBandsMismatch);
  EXPECT_EQ(project(*ResponseCurves::of_observer(), on_bands, w, color).error().message,
            "wavelengths are each lane's own, the batch has bands 400:720:80");
  EXPECT_EQ(four.axis().bands(), nullptr);
  EXPECT_EQ(*on_bands.axis().bands(), four_bands());
  EXPECT_EQ(SpectralAxis::own_wavelengths(1)->description(), "1 wavelength of each lane's own");
  EXPECT_FALSE(*SpectralAxis::own_wavelengths(60) == SpectralAxis());
}

TEST(OwnWavelengths, ARangeOfThemIsTheSameMemory) {
  auto s = own_batch(kBatch, 3);
  const SampledSpectraSpan part = s.span().range(64, 136);
  part.at(70, 2) = 5;
  EXPECT_EQ(s.at(134, 2), 5);
  EXPECT_EQ(part.row(1, 2), &s.at(128, 2));
  EXPECT_EQ(part.blocks(), 3U);
  EXPECT_EQ(s.view().floats(), 4U * 3 * 64);
}

}  // namespace
}  // namespace spectile::test
