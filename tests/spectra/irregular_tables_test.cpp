// Ten thousand irregular tables: interpolation and averages against an oracle that clips straight pieces in
// long double.
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

struct Table {
  std::vector<double> nm, values;  // ascending
};

/// From two samples to forty: even, bunched, far apart, with steps, values of any sign and size.
Table any_table(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  Table out;
  const std::size_t count = 2 + random() % 39;
  const double scale = std::pow(10.0, 8 * unit(random) - 4);
  double at = 300 + 300 * unit(random);
  std::size_t at_once = 1;
  for (std::size_t i = 0; i < count; ++i) {
    out.nm.push_back(at);
    out.values.push_back(scale * (2 * unit(random) - 0.5));
    const bool step = random() % 8 == 0 && at_once == 1;
    at_once = step ? 2 : 1;
    at += step ? 0 : std::pow(10.0, 5 * unit(random) - 3);
  }
  if (out.nm.front() == out.nm.back()) out.nm.back() += 1;
  return out;
}

/// Integral of the straight pieces between samples, clipped to [a, b]; 0 outside.
long double oracle_integral(const Table& t, double a, double b) {
  long double sum = 0;
  for (std::size_t i = 1; i < t.nm.size(); ++i) {
    const long double x0 = t.nm[i - 1];
    const long double x1 = t.nm[i];
    const long double from = std::max<long double>(x0, a);
    const long double to = std::min<long double>(x1, b);
    if (!(to > from)) continue;
    const auto at = [&](long double x) {
      return t.values[i - 1] +
             (t.values[i] - static_cast<long double>(t.values[i - 1])) * ((x - x0) / (x1 - x0));
    };
    sum += (to - from) * (at(from) + at(to)) / 2;
  }
  return sum;
}

/// The same with constant ends.
long double oracle_with_ends(const Table& t, double a, double b) {
  long double sum = oracle_integral(t, a, b);
  const long double before = std::min<long double>(b, t.nm.front()) - a;
  const long double behind = b - std::max<long double>(a, t.nm.back());
  if (before > 0) sum += before * t.values.front();
  if (behind > 0) sum += behind * t.values.back();
  return sum;
}

double largest(const Table& t) {
  double most = 0;
  for (const double v : t.values) most = std::max(most, std::abs(v));
  return most;
}

/// Bands wholly outside, touching the ends, narrower than the samples' spacing and wider than all.
Bands bands_about(const Table& t, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double first = t.nm.front();
  const double last = t.nm.back();
  std::vector<double> edges = {
      first - 60,  first - 50, first,       first + 1e-3, first + 1e-3 + (last - first) * unit(random),
      last - 1e-4, last,       last + 1e-3, last + 40};
  std::sort(edges.begin(), edges.end());
  std::vector<Band> list;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i] - edges[i - 1] < 1e-9) continue;
    list.push_back({edges[i - 1], 0.5 * (edges[i - 1] + edges[i]), edges[i]});
  }
  return *Bands::from_list(list);
}

TEST(IrregularTables, AveragesAreTheOracles) {
  std::mt19937 random(20260101);
  for (int n = 0; n < 10000; ++n) {
    const Table t = any_table(random);
    const auto measured = *MeasuredSpectrum::from_samples(t.nm, t.values);
    const auto linear = *PiecewiseLinearSpectrum::from_samples(t.nm, t.values);
    const Bands bands = bands_about(t, random);
    const auto with_ends = measured.average_over(bands);
    const auto zero_outside = linear.average_over(bands);
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const double lower = bands[b].lower_nm;
      const double upper = bands[b].upper_nm;
      const double width = bands[b].width_nm();
      // Doubles, and an edge's own rounding against the narrowest band; then one rounding to float.
      const double bound = largest(t) * (0x1p-23 + 1e-10 / width);
      ASSERT_NEAR(with_ends[b], static_cast<double>(oracle_with_ends(t, lower, upper)) / width, bound)
          << n << " " << b;
      ASSERT_NEAR(zero_outside[b], static_cast<double>(oracle_integral(t, lower, upper)) / width, bound)
          << n << " " << b;
    }
    const double whole = static_cast<double>(oracle_integral(t, -1e4, 1e6));
    ASSERT_NEAR(linear.integral(-1e4, 1e6), whole, 1e-12 * largest(t) * (t.nm.back() - t.nm.front() + 1))
        << n;
  }
}

TEST(IrregularTables, InterpolationIsTheOraclesOneByOneAndInBatches) {
  std::mt19937 random(20260102);
  std::uniform_real_distribution<double> unit(0, 1);
  auto lambda = own_batch(64, 1);
  auto values = own_batch(64, 1);
  for (int n = 0; n < 10000; ++n) {
    Table t = any_table(random);
    for (double& nm : t.nm) nm = static_cast<float>(nm);  // where the batch has its knots too
    const auto linear = *PiecewiseLinearSpectrum::from_samples(t.nm, t.values);
    const double range = t.nm.back() - t.nm.front() + 20;
    for (std::size_t i = 0; i < 64; ++i) {
      lambda.at(i, 0) = i < t.nm.size() ? static_cast<float>(t.nm[i])
                                        : static_cast<float>(t.nm.front() - 10 + range * unit(random));
    }
    ASSERT_TRUE(sample(linear, lambda.view(), values.span()));
    for (std::size_t i = 0; i < 64; ++i) {
      const double nm = lambda.at(i, 0);
      long double want = 0;
      // The last piece that begins at or before it; at the very end, the last sample.
      for (std::size_t k = 0; k + 1 < t.nm.size(); ++k) {
        if (t.nm[k] <= nm && nm < t.nm[k + 1]) {
          const long double part =
              (static_cast<long double>(nm) - t.nm[k]) / (static_cast<long double>(t.nm[k + 1]) - t.nm[k]);
          want = t.values[k] + part * (static_cast<long double>(t.values[k + 1]) - t.values[k]);
        }
      }
      if (nm == t.nm.back()) want = t.values.back();
      ASSERT_NEAR(linear(nm), static_cast<double>(want), 1e-14 * largest(t)) << n << " at " << nm;
      ASSERT_NEAR(values.at(i, 0), static_cast<double>(want), 5 * 0x1p-24 * largest(t)) << n << " at " << nm;
    }
  }
}

}  // namespace
}  // namespace spectile::test
