// A bounce and Russian roulette: what is left is right on average, and who ends is known.
#include <spectile/lanes/arithmetic.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

/// Throughput and scattering of lanes between 0 and 1, and densities around 1.
struct Paths {
  explicit Paths(const SpectralAxis& axis, std::size_t lanes)
      : throughput(batch_from_plain(axis, lanes, 1)),
        scattering(batch_from_plain(axis, lanes, 2)),
        density(*ScalarLanes::create(lanes)),
        u(*ScalarLanes::create(lanes)) {
    const Floats d = plain_floats(lanes, 3, 0.5F, 2);
    const Floats r = plain_floats(lanes, 4);
    for (std::size_t i = 0; i < lanes; ++i) {
      density[i] = d[i];
      u[i] = r[i];
    }
  }
  static SampledSpectra batch_from_plain(const SpectralAxis& axis, std::size_t lanes, std::uint32_t seed) {
    const Floats v = plain_floats(lanes * axis.count(), seed);
    return batch_of(axis, lanes, [&](std::size_t i, std::size_t k) { return v[i * axis.count() + k]; });
  }
  SampledSpectra throughput, scattering;
  ScalarLanes density, u;
};

std::vector<SpectralAxis> axes() {
  return {*SpectralAxis::own_wavelengths(4), Bands(), *Bands::uniform(400, 700, 300)};
}

TEST(UpdateThroughput, MultipliesAndDividesAndEndsPaths) {
  for (const SpectralAxis& axis : axes()) {
    Paths p(axis, 333);
    p.density[7] = 0;
    auto plain = *SampledSpectra::create(axis, 333);
    EXPECT_EQ(*update_throughput(p.throughput, p.scattering, p.density, {}, plain), LaneMask(6, 0));
    auto out = *SampledSpectra::create(axis, 333);
    const LaneMask ended = *update_throughput(p.throughput, p.scattering, p.density, p.u, out, {2, 64});
    std::size_t count = 0;
    for (std::size_t i = 0; i < 333; ++i) {
      double largest = 0;
      for (std::size_t k = 0; k < axis.count(); ++k) {
        const double product =
            static_cast<double>(p.throughput.at(i, k)) * static_cast<double>(p.scattering.at(i, k));
        const double want = i == 7 ? 0 : product / static_cast<double>(p.density[i]);
        ASSERT_NEAR(plain.at(i, k), want, 4e-7 * want);
        largest = std::max(largest, static_cast<double>(plain.at(i, k)));
      }
      const bool ends = ((ended[i / 64] >> (i % 64)) & 1U) != 0;
      count += ends ? 1 : 0;
      const double survival = std::min(1.0, largest);
      ASSERT_EQ(ends, static_cast<double>(p.u[i]) >= survival) << i;
      for (std::size_t k = 0; k < axis.count(); ++k) {
        const double want = ends ? 0 : static_cast<double>(plain.at(i, k)) / survival;
        ASSERT_NEAR(out.at(i, k), want, 4e-7 * want);
      }
    }
    EXPECT_GT(count, 10U);
    EXPECT_LT(count, 330U);
    // In place.
    ASSERT_EQ(*update_throughput(p.throughput, p.scattering, p.density, p.u, p.throughput), ended);
    EXPECT_TRUE(same_lanes(p.throughput, out));
  }
}

TEST(UpdateThroughput, KeepsTheMean) {
  constexpr std::size_t kMany = 200000;
  const SpectralAxis axis = *SpectralAxis::own_wavelengths(2);
  const auto throughput =
      batch_of(axis, kMany, [](std::size_t, std::size_t k) { return k == 0 ? 0.3F : 0.1F; });
  const auto scattering = *SampledSpectra::constant(axis, kMany, 0.5F);
  Paths p(axis, kMany);
  for (std::size_t i = 0; i < kMany; ++i) p.density[i] = 1;
  auto out = *SampledSpectra::create(axis, kMany);
  ASSERT_TRUE(update_throughput(throughput, scattering, p.density, p.u, out));
  double sums[2] = {};
  for (std::size_t i = 0; i < kMany; ++i) {
    for (std::size_t k = 0; k < 2; ++k) sums[k] += static_cast<double>(out.at(i, k)) / kMany;
  }
  // q = 0.15: a path that goes on has 1 and 1/3; four standard deviations.
  const double deviation = std::sqrt(0.15 * 0.85 / kMany);
  EXPECT_NEAR(sums[0], 0.15, 4 * deviation);
  EXPECT_NEAR(sums[1], 0.05, 4 * deviation / 3);
}

TEST(UpdateThroughput, PathsWithNothingLeftEnd) {
  const SpectralAxis axis = *SpectralAxis::own_wavelengths(2);
  Paths p(axis, 5);
  for (std::size_t i = 0; i < 5; ++i) p.u[i] = 0;
  for (std::size_t k = 0; k < 2; ++k) p.throughput.at(0, k) = 0;
  for (std::size_t k = 0; k < 2; ++k) p.throughput.at(1, k) = kNan;
  p.throughput.at(2, 0) = kNan;
  p.u[3] = kNan;
  auto out = *SampledSpectra::create(axis, 5);
  EXPECT_EQ(*update_throughput(p.throughput, p.scattering, p.density, p.u, out), LaneMask{0b01011});
  EXPECT_EQ(out.at(1, 0), 0);
  EXPECT_TRUE(std::isnan(out.at(2, 0)));
  // No number or next to none of a density, and of what is left.
  p.density[2] = kNan;
  p.density[4] = 1e-39F;
  p.u[3] = 0;
  p.throughput.at(3, 0) = 1e-20F;
  p.throughput.at(3, 1) = 0;
  p.scattering.at(3, 0) = 1e-19F;
  EXPECT_EQ(*update_throughput(p.throughput, p.scattering, p.density, p.u, out), LaneMask{0b11111});
  EXPECT_EQ(*update_throughput(p.throughput, p.scattering, p.density, {}, out), LaneMask{0});
  EXPECT_EQ(out.at(2, 1), 0);
  EXPECT_EQ(out.at(4, 0), 0);
  EXPECT_EQ(update_throughput(p.throughput, p.scattering, p.density, {nullptr, 5}, out).error().code,
            ErrorCode::kBadArgument);
  const auto wrong = *ScalarLanes::create(6);
  EXPECT_EQ(update_throughput(p.throughput, p.scattering, wrong, p.u, out).error().code,
            ErrorCode::kSizeMismatch);
  EXPECT_EQ(update_throughput(p.throughput, p.scattering, p.density, wrong, out).error().code,
            ErrorCode::kSizeMismatch);
}

}  // namespace
}  // namespace spectile::test
