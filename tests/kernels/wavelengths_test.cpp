// Kernels for spectra at single wavelengths: every instruction set gives the reference's bits.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

constexpr std::size_t kAll = 4160;

Floats wavelengths(std::uint32_t seed) {
  Floats out = arbitrary_floats(kAll, seed);
  const Floats plain = plain_floats(kAll, seed + 1, 340, 850);
  for (std::size_t i = 0; i < kAll; ++i) {
    if (i % 3 != 0) out[i] = plain[i];
    if (i % 16 == 1) out[i] = std::round(out[i]);
  }
  return out;
}

class WavelengthKernels : public KernelTest {
 protected:
  template <class Kernel>
  void expect_same(Kernel kernel, const char* what) {
    Floats got(kAll);
    Floats want(kAll);
    kernel(k(), got.data());
    kernel(ref(), want.data());
    EXPECT_TRUE(same_bits(got, want)) << what;
  }
};

TEST_P(WavelengthKernels, LookUpsAreTheReferences) {
  const Floats lambda = wavelengths(1);
  const Floats pairs = arbitrary_floats(2 * 471, 2);
  const Floats plain = plain_floats(2 * 471, 3);
  for (const Floats* table : {&pairs, &plain}) {
    for (const std::int32_t intervals : {1, 2, 470}) {
      const kernels::EvenTable even = {table->data(), 360, 1, intervals};
      expect_same([&](const auto& t, float* out) { t.interpolate_even(out, lambda.data(), even, kAll); },
                  "even");
    }
  }
  const float knots[] = {400, 410, 410, 455.5F, 600, 700, kInf, kInf, kInf, kInf};
  const std::int32_t start[] = {0, 2, 3, 4};
  for (const bool held : {false, true}) {
    const kernels::KnotTable table = {knots, plain.data(), 6, start, 4.0F / 300.0F, 4, 2, held};
    expect_same([&](const auto& t, float* out) { t.interpolate_knots(out, lambda.data(), table, kAll); },
                "knots");
  }
}

TEST_P(WavelengthKernels, FormulasAreTheReferences) {
  const Floats lambda = wavelengths(4);
  for (const float exponent : {1e-3F, 3.0F, 40.0F, 1e9F}) {
    const kernels::PlanckTable table = {1e5F, exponent, exponent * 3e-8F};
    expect_same([&](const auto& t, float* out) { t.planck(out, lambda.data(), table, kAll); }, "planck");
  }
  const kernels::GaussianLobe lobes[] = {{1, 550, 0.1, 0.02}, {-0.5, 600, 1e3, 1e-3}, {3, 0, 1, 1}};
  expect_same([&](const auto& t, float* out) { t.gaussians(out, lambda.data(), lobes, 3, kAll); },
              "gaussians");
  kernels::SigmoidSpectrum spectrum = {{-3, 2, 0.5F}, 402.5F, 697.5F, 3};
  expect_same([&](const auto& t, float* out) { t.sigmoid_at(out, lambda.data(), spectrum, kAll); },
              "sigmoid");
  const Floats pairs = plain_floats(2 * 300, 8, -2.0F, 2.0F);
  spectrum.form = kernels::SigmoidForm::kFunctions;
  spectrum.p = {pairs.data(), 400, 1, 299};
  spectrum.q = {pairs.data() + 2, 400, 1, 299};
  for (const auto& [low, high] : {std::pair(402.5F, 697.5F), std::pair(400.0F, 699.0F)}) {
    spectrum.lowest_nm = low;
    spectrum.highest_nm = high;
    expect_same([&](const auto& t, float* out) { t.sigmoid_at(out, lambda.data(), spectrum, kAll); },
                "sigmoid of two functions");
  }
}

TEST_P(WavelengthKernels, DrawnWavelengthsAndTheirSumsAreTheReferences) {
  Floats u = plain_floats(kAll, 5);
  const Floats arbitrary = arbitrary_floats(kAll, 6);
  for (std::size_t i = 0; i < kAll; i += 5) u[i] = arbitrary[i];
  const kernels::WavelengthDensity d = {360, 470, 538, 1 / 0.0072, 0.85691062, 1.82750197, 0.0039398042};
  constexpr std::size_t kCount = 5;
  const Floats pairs = plain_floats(3 * 2 * 470, 7);
  for (const bool visible : {false, true}) {
    Floats got[2] = {Floats(kCount * kAll), Floats(kCount * kAll)};
    Floats want[2] = {Floats(kCount * kAll), Floats(kCount * kAll)};
    const auto draw = [&](const kernels::KernelTable& t, Floats* out) {
      (visible ? t.visible_wavelengths : t.even_wavelengths)(out[0].data(), out[1].data(), u.data(), d,
                                                             kCount, kAll / kernels::kLanes);
    };
    draw(k(), got);
    draw(ref(), want);
    ASSERT_TRUE(same_bits(got[0], want[0])) << visible;
    ASSERT_TRUE(same_bits(got[1], want[1])) << visible;
    for (std::size_t i = 0; i < kCount * kAll; i += 7) got[1][i] = 0;  // terminated
    const Floats values = arbitrary_floats(kCount * kAll, 8);
    const auto project = [&](const kernels::KernelTable& t, Floats& out) {
      kernels::EvenTable curves[3];
      for (std::size_t c = 0; c < 3; ++c) curves[c] = {pairs.data() + c * 2 * 470, 360, 1, 470};
      float* const dst[3] = {out.data(), out.data() + kAll, out.data() + 2 * kAll};
      t.project_wavelengths(dst, {values.data(), got[0].data(), got[1].data(), kCount}, curves, 0.2F,
                            kAll / kernels::kLanes);
    };
    Floats sums(3 * kAll);
    Floats expected(3 * kAll);
    project(k(), sums);
    project(ref(), expected);
    ASSERT_TRUE(same_bits(sums, expected)) << visible;
  }
}

TEST_P(WavelengthKernels, WavelengthsOfATableAreTheReferences) {
  Floats u = plain_floats(kAll, 15);
  const Floats arbitrary = arbitrary_floats(kAll, 16);
  for (std::size_t i = 0; i < kAll; i += 5) u[i] = arbitrary[i];
  // Shares of five nanometres, of which two are never drawn.
  const float knots[] = {0, 0.25F, 0.25F, 0.7F, 1, kInf, kInf, kInf, kInf};
  const std::int32_t start[] = {0, 2, 2, 3};
  const float bins[] = {4, 0.25F, 0, 0, 1 / 0.45F, 0.45F, 1 / 0.3F, 0.3F, 0, 0};
  const kernels::BinTable table = {knots, bins, 5, 400, start, 4, 4, 2};
  constexpr std::size_t kCount = 3;
  Floats got[2] = {Floats(kCount * kAll), Floats(kCount * kAll)};
  Floats want[2] = {Floats(kCount * kAll), Floats(kCount * kAll)};
  const std::size_t blocks = kAll / kernels::kLanes;
  k().table_wavelengths(got[0].data(), got[1].data(), u.data(), table, kCount, blocks);
  ref().table_wavelengths(want[0].data(), want[1].data(), u.data(), table, kCount, blocks);
  EXPECT_TRUE(same_bits(got[0], want[0]));
  EXPECT_TRUE(same_bits(got[1], want[1]));
  EXPECT_TRUE(got[0].guard_holds());
  for (std::size_t i = 0; i < kCount * kAll; ++i) EXPECT_FALSE(got[0][i] >= 401 && got[0][i] < 402) << i;
}

SPECTILE_FOR_EVERY_ISA(WavelengthKernels);

}  // namespace
}  // namespace spectile::test
