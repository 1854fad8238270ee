// Samples of pixel filters: spread as the filter is, with the weights that make means of them right.
#include "tests/film/filter_support.hpp"

namespace spectile::test {
namespace {

TEST(FilterSamples, AreTheInverseOfTheIntegral) {
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    const double r = f.radius_x();
    const auto share = [&](double d) {
      return brute_force([&](double at) { return std::abs(f.along_x(at)); }, -r, d, 200000);
    };
    for (const double u : {0.001, 0.123, 0.2718, 0.41, 0.5, 0.577, 0.83, 0.9991}) {
      EXPECT_NEAR(share(f.sample(u, 0.5).dx) / share(r), u, 8e-7) << text;
    }
  }
}

TEST(FilterSamples, FollowTheMagnitude) {
  // Chi-square over 50 bins an axis, 49 degrees of freedom: below 100 but once in 20000 times; fixed seed.
  constexpr int kBins = 50;
  constexpr int kDraws = 1000000;
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<double> x(kBins);
    std::vector<double> y(kBins);
    const auto bin = [](double d, double r) {
      return std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((d + r) / (2 * r) * kBins));
    };
    for (int i = 0; i < kDraws; ++i) {
      const FilterSample s = f.sample(unit(random), unit(random));
      ASSERT_LE(std::abs(s.dx), f.radius_x());
      ASSERT_LE(std::abs(s.dy), f.radius_y());
      x[bin(s.dx, f.radius_x())] += 1;
      y[bin(s.dy, f.radius_y())] += 1;
    }
    const auto chi_square = [&](const std::vector<double>& seen, auto profile, double r) {
      std::vector<double> want(kBins);
      double total = 0;
      for (int b = 0; b < kBins; ++b) {
        const double from = r * (2.0 * b / kBins - 1);
        want[static_cast<std::size_t>(b)] =
            brute_force([&](double d) { return std::abs(profile(d)); }, from, from + 2 * r / kBins, 2000);
        total += want[static_cast<std::size_t>(b)];
      }
      double sum = 0;
      double rest = 0;  // bins of next to nothing are put together
      double seen_rest = 0;
      for (std::size_t b = 0; b < kBins; ++b) {
        const double n = kDraws * want[b] / total;
        if (n < 20) {
          rest += n;
          seen_rest += seen[b];
        } else {
          sum += (seen[b] - n) * (seen[b] - n) / n;
        }
      }
      if (rest > 20) sum += (seen_rest - rest) * (seen_rest - rest) / rest;
      EXPECT_LE(seen_rest, rest + 30 + 5 * std::sqrt(rest));
      return sum;
    };
    EXPECT_LT(chi_square(
                  x, [&](double d) { return f.along_x(d); }, f.radius_x()),
              100)
        << text;
    EXPECT_LT(chi_square(
                  y, [&](double d) { return f.along_y(d); }, f.radius_y()),
              100)
        << text;
  }
}

TEST(FilterSamples, AverageToTheFilteredMean) {
  const auto g = [](double x, double y) { return 1 + 0.3 * x + 0.2 * y * y + 0.1 * x * x * y; };
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    // 1-D moments by brute force: the mean of g is 1 + 0.2 <y^2> by symmetry.
    const auto moment = [&](int power) {
      return 2 * brute_force([&](double d) { return f.along_y(d) * std::pow(d, power); }, 0, f.radius_y());
    };
    const double want = 1 + 0.2 * moment(2) / moment(0);
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> unit(0, 1);
    constexpr int kDraws = 400000;
    double sum = 0;
    double squares = 0;
    double weights = 0;
    for (int i = 0; i < kDraws; ++i) {
      const FilterSample s = f.sample(unit(random), unit(random));
      const double sign = f(s.dx, s.dy) < 0 ? -1 : 1;
      ASSERT_TRUE(sign * s.weight > 0 || std::abs(f(s.dx, s.dy)) < 1e-9) << text;
      ASSERT_TRUE(f.has_negative_lobes() || s.weight == 1) << text;
      sum += s.weight * g(s.dx, s.dy);
      squares += s.weight * g(s.dx, s.dy) * s.weight * g(s.dx, s.dy);
      weights += s.weight;
    }
    const double mean = sum / kDraws;
    const double error = std::sqrt((squares / kDraws - mean * mean) / kDraws);
    EXPECT_NEAR(mean, want, 4.5 * error) << text;
    // The weights themselves average to 1.
    const double size = std::abs(f.sample(0.5, 0.5).weight);
    EXPECT_NEAR(weights / kDraws, 1, 4.5 * size / std::sqrt(double{kDraws})) << text;
  }
}

TEST(FilterSamples, AscendWithTheirNumbersAndReachTheEnds) {
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    double last = -2 * f.radius_x();
    for (int i = 0; i < 100000; ++i) {
      const double d = f.sample(i / 100000.0, 0.25).dx;
      ASSERT_GE(d, last - 1e-12) << text << " at " << i;
      last = d;
    }
    EXPECT_NEAR(f.sample(0, 0.5).dx, -f.radius_x(), f.kind() == FilterKind::kGaussian ? 4 : 1e-6) << text;
    EXPECT_NEAR(f.sample(0.5, 0.5).dy, 0, 1e-12) << text;
    EXPECT_LT(f.sample(1 - 0x1p-53, 0.5).dx, f.radius_x() * (1 + 1e-15)) << text;
  }
}

}  // namespace
}  // namespace spectile::test
