// Projection of radiance at sampled wavelengths: unbiased estimates, their variance, and any three responses.
#include <cmath>
#include <spectile/color/response_curves.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>

#include "src/data/tables.hpp"
#include "tests/lanes/wavelengths_support.hpp"

namespace spectile::test {
namespace {

constexpr double kU = 0x1p-24;

struct Estimate {
  std::array<double, 3> mean{}, variance{};  // of one lane; the mean's own is that over the lanes
};

Estimate estimate(const Spectrum& light, WavelengthSampling sampling, std::size_t count, bool terminate,
                  std::size_t lanes = 100000) {
  auto w = drawn_wavelengths(sampling, lanes, count, 21);
  if (terminate) {
    LaneMask hit(blocks_for(lanes));
    for (std::size_t i = 0; i < lanes; ++i) hit[i / 64] |= std::uint64_t{i % 3 != 0} << (i % 64);
    EXPECT_TRUE(terminate_secondary(w, hit));
  }
  auto radiance = own_batch(lanes, count);
  EXPECT_TRUE(sample(light, w.lambda_nm.view(), radiance.span()));
  auto xyz = *ColorLanes::create(lanes);
  EXPECT_TRUE(project(*ResponseCurves::of_observer(), radiance.view(), w, xyz.span()));
  Estimate out;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      sum += xyz.at(i, c);
      squares += static_cast<double>(xyz.at(i, c)) * xyz.at(i, c);
    }
    const double n = static_cast<double>(lanes);
    out.mean[c] = sum / n;
    out.variance[c] = squares / n - out.mean[c] * out.mean[c];
  }
  return out;
}

std::array<double, 3> reference_xyz(const Spectrum& light) {
  const data::MatchingFunctions& cie = data::kCie1931;
  const std::span<const double> bars[3] = {cie.x_bar, cie.y_bar, cie.z_bar};
  std::array<double, 3> out{};
  double whole = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto curve = *DenselySampledSpectrum::from_values(360, {bars[c].begin(), bars[c].end()});
    out[c] = inner_product(curve, light);
    if (c == 1) whole = curve.integral(360, 830);
  }
  for (double& v : out) v /= whole;
  return out;
}

TEST(ProjectWavelengths, EstimatesAreUnbiased) {
  // 99.99 % of all means lie within four standard errors; the seeds are fixed. Stratified lanes of the
  // smoothest light have almost no variance: rounding is allowed for.
  const Spectrum lights[] = {ConstantSpectrum(1),
                             *BlackbodySpectrum::create(2856, BlackbodySpectrum::Scale::kNormalized),
                             PiecewiseLinearSpectrum(*illuminant("FL11")).scaled(0.01)};
  for (const Spectrum& light : lights) {
    const auto want = reference_xyz(light);
    for (const auto sampling : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
      for (const std::size_t count : {1, 4, 8}) {
        for (const bool terminate : {false, true}) {
          const Estimate got = estimate(light, sampling, count, terminate);
          for (std::size_t c = 0; c < 3; ++c) {
            const double error = std::sqrt(got.variance[c] / 100000);
            EXPECT_NEAR(got.mean[c], want[c], 4 * error + 1e-6 * want[c])
                << light.to_text() << " " << count << " component " << c;
          }
        }
      }
    }
  }
}

TEST(ProjectWavelengths, VisibleOnesHaveTheLowerVariance) {
  for (const Spectrum& light :
       {Spectrum(ConstantSpectrum(1)), Spectrum(PiecewiseLinearSpectrum(*illuminant("D65")))}) {
    for (const std::size_t count : {1, 4}) {
      const Estimate uniform = estimate(light, WavelengthSampling::kUniform, count, false);
      const Estimate visible = estimate(light, WavelengthSampling::kVisible, count, false);
      EXPECT_LT(visible.variance[1], uniform.variance[1]) << count;
    }
    // Of single wavelengths, in luminance, to less than half.
    EXPECT_LT(estimate(light, WavelengthSampling::kVisible, 1, false).variance[1],
              0.5 * estimate(light, WavelengthSampling::kUniform, 1, false).variance[1]);
  }
}

TEST(ResponseCurves, AnyThreeWillDo) {
  const auto box = *PiecewiseLinearSpectrum::from_samples(std::array{500.0, 600.0}, std::array{1.0, 1.0});
  const auto curves =
      *ResponseCurves::create({box, ConstantSpectrum(1), *BlackbodySpectrum::create(5000)}, {2, 0.5, 1e-9});
  auto w = drawn_wavelengths(WavelengthSampling::kUniform, 10000, 8, 6);
  auto radiance = own_batch(10000, 8);
  ASSERT_TRUE(sample(ConstantSpectrum(3), w.lambda_nm.view(), radiance.span()));
  auto rgb = *ColorLanes::create(10000);
  ASSERT_TRUE(project(curves, radiance.view(), w, rgb.span()));
  double sums[2] = {};
  for (std::size_t i = 0; i < 10000; ++i) {
    sums[0] += rgb.at(i, 0) / 10000.0;
    sums[1] += rgb.at(i, 1) / 10000.0;
  }
  // The box's own edges are a nanometre wide in the table.
  EXPECT_NEAR(sums[0], 2 * 3 * 101, 12);
  EXPECT_NEAR(sums[1], 0.5 * 3 * 470, 1e-2);
}

TEST(ProjectWavelengths, SteepCurvesAreWithinTheBound) {
  // From 0.7 at 500 nm to 0 at 501 nm: near the end the interpolation cancels.
  const double nm[] = {500, 501};
  const double v[] = {0.7, 0};
  const Spectrum fall = *PiecewiseLinearSpectrum::from_samples(nm, v);
  const auto curves = *ResponseCurves::create({fall, fall, fall});
  auto w = *SampledWavelengths::create(64, 1);
  auto radiance = own_batch(64, 1);
  for (std::size_t i = 0; i < 64; ++i) {
    w.lambda_nm.at(i, 0) = 501 - static_cast<float>(i + 1) * 0x1p-15F;
    w.density.at(i, 0) = radiance.at(i, 0) = 1;
  }
  auto out = *ColorLanes::create(64);
  ASSERT_TRUE(project(curves, radiance.view(), w, out.span()));
  double worst = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    const double want = fall(static_cast<double>(w.lambda_nm.at(i, 0)));
    worst = std::max(worst, std::abs(out.at(i, 1) - want) / (0.7 * kU));
  }
  EXPECT_LE(worst, 1 + 6);  // (K + 6) u
}

}  // namespace
}  // namespace spectile::test
