// Wavelengths drawn for paths: their distribution, and sums over them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bench/representations/representation.hpp"

namespace spectile::test {
namespace {

using namespace measure;  // NOLINT(google-build-using-namespace): the subject of all tests here

TEST(DrawnWavelengths, SumUpToTheIntegralOnAverage) {
  for (const char* name : {"D65", "HP1"}) {
    const DensityTable density = wavelength_density(*reference_light(name));
    double last = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double nm = density.inverse(i / 1000.0);
      EXPECT_GE(nm, last);
      last = nm;
      // The share below, by trapezoids of a twentieth of a nanometre.
      if (i % 100 != 50) continue;
      double below = 0;
      for (double at = 360; at < nm; at += 0.05) {
        const double end = std::min(at + 0.05, nm);
        below += 0.5 * (density.at(at) + density.at(end)) * (end - at);
      }
      EXPECT_NEAR(below, i / 1000.0, 1e-9);
    }
    // f has the light's lines and a slope.
    const auto f = [&](double nm) { return density.at(nm) * (1 + (nm - 550) / 300); };
    double integral = 0;
    for (double at = 360; at < 829.999; at += 0.01)
      integral += 0.005 * (f(at) + f(std::min(at + 0.01, 830.0)));
    std::mt19937_64 random(3);
    for (const Drawing drawing : {Drawing::kStratified, Drawing::kHero}) {
      double sum = 0;
      double squares = 0;
      constexpr int kDraws = 20000;
      for (int i = 0; i < kDraws; ++i) {
        std::array<double, 4> jitter{};
        for (double& u : jitter) u = std::uniform_real_distribution<double>(0, 1)(random);
        double estimate = 0;
        for (const DrawnWavelength& d : draw_wavelengths(density, drawing, jitter)) {
          EXPECT_GE(d.nm, 360);
          EXPECT_LE(d.nm, 830);
          estimate += d.weight * f(d.nm);
        }
        sum += estimate;
        squares += estimate * estimate;
      }
      const double mean = sum / kDraws;
      const double deviation = std::sqrt((squares / kDraws - mean * mean) / kDraws);
      EXPECT_LT(deviation, 0.005);
      EXPECT_NEAR(mean, integral, 4 * deviation) << name << (drawing == Drawing::kHero ? ", hero" : "");
    }
  }
}

}  // namespace
}  // namespace spectile::test
