// Kernels for colours at lanes' own wavelengths: every instruction set gives the reference's bits.
#include "src/lanes/knot_index.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::CentreTable;
using kernels::kLanes;
using kernels::kSmitsRow;

constexpr std::size_t kOwnBlocks = 5;
constexpr std::size_t kOwnLanes = kOwnBlocks * kLanes;
constexpr std::size_t kOwnCount = 3;

/// Centres of bands: even ones, uneven ones, two of them at one place in float, or a single one.
struct Centres {
  explicit Centres(std::vector<float> at, bool even = false) : nm(std::move(at)) {
    table.first_nm = nm.front();
    table.last_nm = nm.back();
    table.intervals = static_cast<std::int32_t>(std::max<std::size_t>(nm.size() - 1, 1));
    if (nm.size() == 1) return;
    if (even) {
      table.per_nm = static_cast<float>(nm.size() - 1) / (nm.back() - nm.front());
      return;
    }
    index = *index_knots(nm);
    for (std::size_t i = 0; i + 1 < nm.size(); ++i)
      per_width.push_back(nm[i + 1] > nm[i] ? 1 / (nm[i + 1] - nm[i]) : 0.0F);
    table.knots = index.knots.data();
    table.per_width = per_width.data();
    table.start = index.start.data();
    table.buckets_per_nm = index.buckets_per_nm;
    table.buckets = static_cast<std::int32_t>(index.start.size());
    table.halvings = index.halvings;
  }
  std::vector<float> nm;
  KnotIndex index;
  std::vector<float> per_width;
  CentreTable table;
};

std::vector<Centres> all_centres() {
  std::vector<float> even;
  for (int i = 0; i < 60; ++i) even.push_back(402.5F + 5 * static_cast<float>(i));
  std::vector<Centres> out;
  out.emplace_back(even, true);
  out.emplace_back(even);
  out.emplace_back(std::vector<float>{380, 401.5F, 401.5F, 402, 455, 455.25F, 600, 780});
  out.emplace_back(std::vector<float>{400, 700});
  out.emplace_back(std::vector<float>{550});
  return out;
}

/// Wavelengths in and around the visible range, some at the centres, some no numbers.
Floats own_wavelengths(const Centres& centres, std::uint32_t seed) {
  Floats out = plain_floats(kOwnCount * kOwnLanes, seed, 340, 850);
  const Floats strange = arbitrary_floats(kOwnCount * kOwnLanes, seed + 1);
  for (std::size_t i = 0; i < kOwnCount * kOwnLanes; ++i) {
    if (i % 7 == 0) out[i] = strange[i];
    if (i % 5 == 1) out[i] = centres.nm[i % centres.nm.size()];
  }
  return out;
}

/// Colours, of which some are no numbers.
Floats colors(std::uint32_t seed) {
  Floats out = plain_floats(3 * kOwnLanes, seed, -0.25F, 1.5F);
  const Floats strange = arbitrary_floats(3 * kOwnLanes, seed + 1);
  for (std::size_t i = 0; i < 3 * kOwnLanes; ++i) {
    if (i % 9 == 0) out[i] = strange[i];
    if (i % 11 == 0) out[i] = static_cast<float>(i % 2);
  }
  return out;
}

class OwnWavelengthKernels : public KernelTest {
 protected:
  template <class Kernel>
  void expect_same(Kernel kernel, const char* what) {
    Floats got(kOwnCount * kOwnLanes);
    Floats want(kOwnCount * kOwnLanes);
    kernel(k(), got.data());
    kernel(ref(), want.data());
    EXPECT_TRUE(same_bits(got, want)) << what;
    EXPECT_TRUE(got.guard_holds()) << what;
  }
};

TEST_P(OwnWavelengthKernels, MixturesAreTheReferences) {
  const Floats rgb = colors(1);
  const float* const planes[3] = {rgb.data(), rgb.data() + kOwnLanes, rgb.data() + 2 * kOwnLanes};
  for (const Centres& centres : all_centres()) {
    const Floats lambda = own_wavelengths(centres, 3);
    const Floats ends = plain_floats(2 * kSmitsRow * centres.nm.size(), 5, -0.1F, 1.0F);
    for (const float lowest : {0.0F, -kInf}) {
      expect_same(
          [&](const auto& t, float* out) {
            t.mixtures_at(out, planes, {ends.data(), lowest}, centres.table, lambda.data(), kOwnCount,
                          kOwnBlocks);
          },
          "mixtures");
    }
  }
}

TEST_P(OwnWavelengthKernels, MixedWeightsAreTheReferences) {
  Floats weights = plain_floats(kOwnLanes * kSmitsRow, 7, -0.25F, 1.5F);
  const Floats strange = arbitrary_floats(weights.size(), 8);
  for (std::size_t i = 0; i < weights.size(); i += 61) weights[i] = strange[i];
  for (const Centres& centres : all_centres()) {
    const Floats lambda = own_wavelengths(centres, 9);
    const Floats ends = plain_floats(2 * kSmitsRow * centres.nm.size(), 10, -0.1F, 1.0F);
    for (const float lowest : {0.0F, -kInf}) {
      expect_same(
          [&](const auto& t, float* out) {
            t.bases_at(out, weights.data(), {ends.data(), lowest}, centres.table, lambda.data(), kOwnCount,
                       kOwnBlocks);
          },
          "weights");
    }
  }
}

TEST_P(OwnWavelengthKernels, GridsAreTheReferences) {
  const Floats rgb = colors(11);
  const Floats scale = plain_floats(kOwnLanes, 12, 0, 4);
  const float* const planes[3] = {rgb.data(), rgb.data() + kOwnLanes, rgb.data() + 2 * kOwnLanes};
  const float levels[] = {0, 0.35F, 1};
  const float per_width[] = {1 / 0.35F, 1 / 0.65F};
  for (const Centres& centres : all_centres()) {
    const Floats lambda = own_wavelengths(centres, 13);
    const std::size_t stride = (centres.nm.size() + 15) / 16 * 16;
    const Floats nodes = plain_floats(27 * stride, 14, -0.1F, 1.0F);
    for (const bool homogeneous : {false, true}) {
      for (const bool scaled : {false, true}) {
        const kernels::GridSpectra spectra = {
            planes,
            scaled ? scale.data() : nullptr,
            {nodes.data(), stride, centres.nm.size(), levels, per_width, 3, 0.0F, homogeneous}};
        expect_same(
            [&](const auto& t, float* out) {
              t.grid_at(out, spectra, centres.table, lambda.data(), kOwnCount, kOwnBlocks);
            },
            "grid");
      }
    }
  }
}

TEST_P(OwnWavelengthKernels, SigmoidsAreTheReferences) {
  Floats c = plain_floats(3 * kOwnLanes, 21, -20, 20);
  const Floats strange = arbitrary_floats(3 * kOwnLanes, 22);
  for (std::size_t i = 0; i < 3 * kOwnLanes; i += 9) c[i] = strange[i];
  const Floats scale = plain_floats(kOwnLanes, 23, 0, 4);
  const Floats lambda = own_wavelengths(all_centres().front(), 24);
  const Floats pairs = plain_floats(2 * 300, 25, -2.0F, 2.0F);
  const float* const planes[3] = {c.data(), c.data() + kOwnLanes, c.data() + 2 * kOwnLanes};
  for (const auto form : {kernels::SigmoidForm::kQuadratic, kernels::SigmoidForm::kFunctions}) {
    for (const bool scaled : {false, true}) {
      const kernels::SigmoidLanes sigmoids = {planes,
                                              scaled ? scale.data() : nullptr,
                                              402.5F,
                                              697.5F,
                                              form,
                                              {pairs.data(), 400, 1, 299},
                                              {pairs.data() + 2, 400, 1, 299}};
      expect_same([&](const auto& t,
                      float* out) { t.sigmoids_at(out, sigmoids, lambda.data(), kOwnCount, kOwnBlocks); },
                  "sigmoids");
    }
  }
}

SPECTILE_FOR_EVERY_ISA(OwnWavelengthKernels);

}  // namespace
}  // namespace spectile::test
