// The reference's exp and pow against the C library's in double: errors in ULP, and special values as C
// defines them.
#include <atomic>
#include <thread>

#include "src/reference/table.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

// The double result's own error, below 1 ULP of double, is 2e-9 ULP of float: nothing beside the bound.
constexpr double kBound = 0.501;

/// Error of `got` in units of the last place that floats near `exact` have. Infinity counts as 2^128, the
/// value that would follow the largest float, so that rounding to it is held to the same bound.
double ulp_error(float got, double exact) {
  constexpr double kBeyond = 0x1p128;
  const double value = std::isinf(got) ? std::copysign(kBeyond, got) : static_cast<double>(got);
  const double held = std::clamp(exact, -kBeyond, kBeyond);
  int exponent = 0;
  std::frexp(held, &exponent);
  const double ulp = held == 0 ? 0x1p-149 : std::ldexp(1.0, std::clamp(exponent - 24, -149, 104));
  return std::fabs(value - held) / ulp;
}

/// Largest error of exp over the floats with bits from `first` to `last`, `step` apart; NaN where NaN and
/// number mix.
double worst_exp(std::uint64_t first, std::uint64_t last, std::uint64_t step) {
  constexpr std::size_t kChunk = 1024;
  alignas(64) float in[kChunk];
  alignas(64) float out[kChunk];
  double worst = first <= last ? 0 : std::numeric_limits<double>::quiet_NaN();
  for (std::uint64_t at = first; at <= last;) {
    std::size_t n = 0;
    for (; n < kChunk && at <= last; at += step)
      in[n++] = std::bit_cast<float>(static_cast<std::uint32_t>(at));
    reference::kKernelTable.exp(out, in, n);
    for (std::size_t i = 0; i < n; ++i) {
      if (std::isnan(in[i]) != std::isnan(out[i])) return std::numeric_limits<double>::quiet_NaN();
      if (std::isnan(in[i])) continue;
      worst = std::max(worst, ulp_error(out[i], std::exp(static_cast<double>(in[i]))));
    }
  }
  return worst;
}

double worst_pow(float y, std::uint64_t first, std::uint64_t last, std::uint64_t step) {
  constexpr std::size_t kChunk = 1024;
  alignas(64) float in[kChunk];
  alignas(64) float out[kChunk];
  double worst = first <= last ? 0 : std::numeric_limits<double>::quiet_NaN();
  for (std::uint64_t at = first; at <= last;) {
    std::size_t n = 0;
    for (; n < kChunk && at <= last; at += step)
      in[n++] = std::bit_cast<float>(static_cast<std::uint32_t>(at));
    reference::kKernelTable.pow(out, in, y, n);
    for (std::size_t i = 0; i < n; ++i) {
      const double exact = std::pow(static_cast<double>(in[i]), static_cast<double>(y));
      if (std::isnan(exact) != std::isnan(out[i])) return std::numeric_limits<double>::quiet_NaN();
      if (std::isnan(exact)) continue;
      if (std::signbit(exact) != std::signbit(out[i])) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, ulp_error(out[i], exact));
    }
  }
  return worst;
}

/// The largest of f(i) for i below n, on every core.
template <class F>
double worst_in_parallel(std::size_t n, F f) {
  std::atomic<std::size_t> next = 0;
  std::vector<double> worst(std::max(1U, std::thread::hardware_concurrency()), 0.0);
  std::vector<std::thread> threads;
  for (double& mine : worst) {
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < n; i = next++) {
        const double value = f(i);
        if (!(value <= mine)) mine = value;
        if (std::isnan(mine)) return;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double value : worst) {
    if (std::isnan(value)) return value;
  }
  return *std::max_element(worst.begin(), worst.end());
}

float ref_exp(float x) {
  float out = 0;
  reference::kKernelTable.exp(&out, &x, 1);
  return out;
}

float ref_pow(float x, float y) {
  float out = 0;
  reference::kKernelTable.pow(&out, &x, y, 1);
  return out;
}

constexpr std::uint32_t bits(float f) {
  return std::bit_cast<std::uint32_t>(f);
}

TEST(Exponential, UlpErrorMeasuresWhatItSays) {
  EXPECT_EQ(ulp_error(1.0F, 1.0), 0.0);
  EXPECT_EQ(ulp_error(1.0F + 0x1p-23F, 1.0), 1.0);
  EXPECT_EQ(ulp_error(1.0F, 1.0 + 0x1p-24), 0.5);
  EXPECT_EQ(ulp_error(kTiny, 0.0), 1.0);
  EXPECT_EQ(ulp_error(kInf, std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_EQ(ulp_error(kInf, static_cast<double>(kMost)), 1.0);
  EXPECT_GT(ulp_error(kMost, 1e39), 0.9);
}

TEST(Exponential, ExpIsWithinItsBoundOnAStrideOverAllFloats) {
  EXPECT_LE(worst_exp(0, 0xFFFFFFFFU, 1021), kBound);  // 4.2 million floats; 1021 is a prime
}

TEST(Exponential, ExpIsWithinItsBoundNearOverflowAndUnderflow) {
  EXPECT_LE(worst_exp(bits(88.7F), bits(88.75F), 1), kBound);
  EXPECT_LE(worst_exp(bits(-87.2F), bits(-87.4F), 1), kBound);    // where denormals begin
  EXPECT_LE(worst_exp(bits(-103.0F), bits(-104.1F), 1), kBound);  // where zero begins
}

TEST(Exponential, ExpHasItsSpecialValues) {
  EXPECT_EQ(ref_exp(0.0F), 1.0F);
  EXPECT_EQ(ref_exp(-0.0F), 1.0F);
  EXPECT_EQ(ref_exp(kInf), kInf);
  EXPECT_EQ(bits(ref_exp(-kInf)), bits(0.0F));
  EXPECT_TRUE(std::isnan(ref_exp(kNan)));
  EXPECT_EQ(ref_exp(kTiny), 1.0F);
  EXPECT_EQ(ref_exp(kMost), kInf);
  EXPECT_EQ(bits(ref_exp(-kMost)), bits(0.0F));
  // The logarithm of the largest float, 88.7228390, lies between these neighbours.
  EXPECT_EQ(ref_exp(88.72284F), kInf);
  EXPECT_EQ(ref_exp(std::nextafter(88.72284F, 0.0F)), static_cast<float>(std::exp(88.72283172607421875)));
  EXPECT_EQ(ref_exp(-103.97F), kTiny);
  EXPECT_EQ(ref_exp(-103.98F), 0.0F);
}

TEST(Exponential, PowIsWithinItsBound) {
  for (const float y :
       {2.4F, 1.0F / 2.4F, 2.2F,  0.5F,   -0.5F, 1.0F / 3.0F, 2.0F, 3.0F,        -1.0F,     -3.0F,
        7.0F, 1e-3F,       37.5F, -37.5F, 1e-8F, 1000.0F,     1e6F, 16777215.0F, 0.999999F, 1.0F}) {
    EXPECT_LE(worst_pow(y, 0, 0xFFFFFFFFU, 65521), kBound) << y;  // a prime
    EXPECT_LE(worst_pow(y, bits(0.99F), bits(1.01F), 11), kBound) << y;
    EXPECT_LE(worst_pow(y, 0, bits(kSmallestNormal), 1021), kBound) << y;
  }
}

TEST(Exponential, PowOfTheWholeExponentIsExact) {
  for (int i = 1; i <= 10; ++i)
    EXPECT_EQ(ref_pow(static_cast<float>(i), 3.0F), static_cast<float>(i * i * i));
  for (int i = -149; i <= 127; ++i) EXPECT_EQ(ref_pow(2.0F, static_cast<float>(i)), std::ldexp(1.0F, i));
  EXPECT_EQ(ref_pow(2.0F, -150.0F), 0.0F);
  EXPECT_EQ(ref_pow(2.0F, 128.0F), kInf);
}

TEST(Exponential, PowHasCsSpecialValues) {
  struct Case {
    float x, y, want;
  };
  const Case cases[] = {
      // C17 F.10.4.4, in its order: zero bases ...
      {0.0F, -1.0F, kInf},
      {-0.0F, -1.0F, -kInf},
      {-0.0F, -3.0F, -kInf},
      {0.0F, -2.0F, kInf},
      {-0.0F, -2.0F, kInf},
      {-0.0F, -0.5F, kInf},
      {0.0F, -kInf, kInf},
      {-0.0F, -kInf, kInf},
      {0.0F, 3.0F, 0.0F},
      {-0.0F, 3.0F, -0.0F},
      {-0.0F, 2.0F, 0.0F},
      {-0.0F, 0.5F, 0.0F},
      {0.0F, kInf, 0.0F},
      {-0.0F, kInf, 0.0F},
      // ... ones, whatever goes with them ...
      {-1.0F, kInf, 1.0F},
      {-1.0F, -kInf, 1.0F},
      {1.0F, kNan, 1.0F},
      {1.0F, kInf, 1.0F},
      {1.0F, -kInf, 1.0F},
      {kNan, 0.0F, 1.0F},
      {kNan, -0.0F, 1.0F},
      {kInf, 0.0F, 1.0F},
      {-kInf, -0.0F, 1.0F},
      {0.0F, 0.0F, 1.0F},
      // ... negative bases ...
      {-2.0F, 0.5F, kNan},
      {-kTiny, 0.5F, kNan},
      {-2.0F, 3.0F, -8.0F},
      {-2.0F, 2.0F, 4.0F},
      {-2.0F, -1.0F, -0.5F},
      {-1.0F, 16777215.0F, -1.0F},
      {-1.0F, 16777216.0F, 1.0F},
      {-1.0F, 8388607.5F, kNan},
      {-1.0F, 1e30F, 1.0F},
      // ... infinite exponents ...
      {0.5F, -kInf, kInf},
      {-0.5F, -kInf, kInf},
      {2.0F, -kInf, 0.0F},
      {-2.0F, -kInf, 0.0F},
      {0.5F, kInf, 0.0F},
      {-0.5F, kInf, 0.0F},
      {2.0F, kInf, kInf},
      {-2.0F, kInf, kInf},
      {1.0F - 0x1p-24F, kInf, 0.0F},
      {1.0F + 0x1p-23F, kInf, kInf},
      {kTiny, kInf, 0.0F},
      {kTiny, -kInf, kInf},
      // ... infinite bases ...
      {-kInf, -1.0F, -0.0F},
      {-kInf, -3.0F, -0.0F},
      {-kInf, -2.0F, 0.0F},
      {-kInf, -0.5F, 0.0F},
      {-kInf, 3.0F, -kInf},
      {-kInf, 2.0F, kInf},
      {-kInf, 0.5F, kInf},
      {kInf, -1.0F, 0.0F},
      {kInf, 0.5F, kInf},
      {kInf, kInf, kInf},
      {kInf, -kInf, 0.0F},
      {-kInf, kInf, kInf},
      {-kInf, -kInf, 0.0F},
      // ... and NaN in all other cases.
      {kNan, 1.0F, kNan},
      {kNan, kInf, kNan},
      {2.0F, kNan, kNan},
      {0.0F, kNan, kNan},
      {-1.0F, kNan, kNan},
      {kInf, kNan, kNan},
      {kNan, kNan, kNan},
      // Denormals and the range's ends.
      {kTiny, 1.0F, kTiny},
      {-kTiny, 1.0F, -kTiny},
      {kTiny, 0.5F, 0x1p-74F * std::sqrt(0.5F)},
      {kTiny, 2.0F, 0.0F},
      {-kTiny, 3.0F, -0.0F},
      {kMost, 1.0F, kMost},
      {kMost, 2.0F, kInf},
      {-kMost, 3.0F, -kInf},
      {kMost, -2.0F, 0.0F},
  };
  for (const Case& c : cases) {
    // The table itself is C's: the library's pow for double has the same cases.
    EXPECT_TRUE(
        same_bits(static_cast<float>(std::pow(static_cast<double>(c.x), static_cast<double>(c.y))), c.want))
        << c.x << " to the " << c.y;
    EXPECT_TRUE(same_bits(ref_pow(c.x, c.y), c.want))
        << c.x << " to the " << c.y << " gives " << ref_pow(c.x, c.y);
  }
}

TEST(Exponential, PowTreatsEveryPairOfSpecialValuesLikeC) {
  for (const float x : special_values()) {
    for (const float y : special_values()) {
      const double exact = std::pow(static_cast<double>(x), static_cast<double>(y));
      const float got = ref_pow(x, y);
      if (std::isnan(exact)) {
        EXPECT_TRUE(std::isnan(got)) << x << " to the " << y;
        continue;
      }
      EXPECT_EQ(std::signbit(got), std::signbit(exact)) << x << " to the " << y;
      EXPECT_LE(ulp_error(got, exact), kBound)
          << x << " to the " << y << " gives " << got << ", not " << exact;
    }
  }
}

TEST(Exponential, EveryFloat) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  const double worst =
      worst_in_parallel(4096, [](std::size_t i) { return worst_exp(i * kPiece, (i + 1) * kPiece - 1, 1); });
  EXPECT_LE(worst, kBound);
}

TEST(Exponential, PowOfManyFloats) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 24;
  for (const float y : {2.4F, 1.0F / 2.4F, 2.2F, 1.0F / 2.2F, 0.5F, 3.0F, -1.0F, 100.0F}) {
    const double worst = worst_in_parallel(
        256, [y](std::size_t i) { return worst_pow(y, i * kPiece, (i + 1) * kPiece - 1, 127); });
    EXPECT_LE(worst, kBound) << y;
  }
}

}  // namespace
}  // namespace spectile::test
