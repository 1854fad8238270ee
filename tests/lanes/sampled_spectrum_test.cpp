// The samples of one lane as a value: the same numbers as the operations of batches.
#include <spectile/lanes/arithmetic.hpp>
#include <spectile/lanes/sampled_spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using Four = SampledSpectrum<4>;

constexpr std::size_t kOperands = 128;

SampledSpectra any_four(std::uint32_t seed) {
  const Floats values = arbitrary_floats(kOperands * 4, seed);
  SampledSpectra out = own_batch(kOperands, 4);
  std::copy_n(values.data(), values.size(), out.span().data);
  return out;
}

class SampledSpectrumTest : public testing::Test {
 protected:
  template <class Batch, class Value>
  void expect_same(Batch batch, Value value) {
    SampledSpectra out = own_batch(kOperands, 4);
    ASSERT_TRUE(batch(out.span()));
    for (std::size_t i = 0; i < kOperands; ++i) {
      const Four got = value(Four::of(a_, i), Four::of(b_, i));
      for (std::size_t k = 0; k < 4; ++k) ASSERT_TRUE(same_bits(got[k], out.at(i, k))) << i << ' ' << k;
    }
  }
  const SampledSpectra a_ = any_four(1);
  const SampledSpectra b_ = any_four(2);
};

TEST_F(SampledSpectrumTest, OperatorsAreTheBatchesOperations) {
  expect_same([&](auto out) { return add(a_, b_, out); }, [](Four a, Four b) { return a + b; });
  expect_same([&](auto out) { return subtract(a_, b_, out); }, [](Four a, Four b) { return a - b; });
  expect_same([&](auto out) { return multiply(a_, b_, out); }, [](Four a, Four b) { return a * b; });
  expect_same([&](auto out) { return divide(a_, b_, out); }, [](Four a, Four b) { return a / b; });
  expect_same([&](auto out) { return divide_or_zero(a_, b_, out); },
              [](Four a, Four b) { return divide_or_zero(a, b); });
  expect_same([&](auto out) { return scale(a_, 0.3F, out); }, [](Four a, Four) { return 0.3F * a; });
  expect_same([&](auto out) { return negate(a_, out); }, [](Four a, Four) { return -a; });
  expect_same([&](auto out) { return lerp(a_, b_, 0.3F, out); },
              [](Four a, Four b) { return lerp(a, b, 0.3F); });
  expect_same([&](auto out) { return clamp(a_, -1, 2, out); }, [](Four a, Four) { return clamp(a, -1, 2); });
  expect_same([&](auto out) { return sqrt(a_, out); }, [](Four a, Four) { return sqrt(a); });
}

TEST_F(SampledSpectrumTest, FoldsAreTheBatchesFolds) {
  auto least = *ScalarLanes::create(kOperands);
  auto most = *ScalarLanes::create(kOperands);
  ASSERT_TRUE(minimum(a_, least));
  ASSERT_TRUE(maximum(a_, most));
  const LaneMask black = *is_black(a_);
  const LaneMask nan = *has_nan(a_);
  for (std::size_t i = 0; i < kOperands; ++i) {
    const Four a = Four::of(a_, i);
    EXPECT_EQ(a.min_value(), least[i]);
    EXPECT_EQ(a.max_value(), most[i]);
    EXPECT_EQ(static_cast<bool>(a), (black[i / 64] >> (i % 64) & 1) == 0);
    EXPECT_EQ(a.has_nan(), (nan[i / 64] >> (i % 64) & 1) != 0);
  }
}

TEST_F(SampledSpectrumTest, ALaneIsWrittenWhereItIsRead) {
  SampledSpectra out = own_batch(kOperands, 4);
  Four(std::array<float, 4>{1, 2, 3, 4}).store(out, 70);
  EXPECT_EQ(Four::of(out, 70), Four(std::array<float, 4>{1, 2, 3, 4}));
  EXPECT_FALSE(Four::of(out, 69));
  EXPECT_FLOAT_EQ(Four::of(out, 70).average(), 2.5F);
  EXPECT_FLOAT_EQ(exp(Four(1))[3], std::exp(1.0F));
  EXPECT_FLOAT_EQ(pow(Four(2), 3)[0], 8);
  static_assert((Four(1) + 2 * Four(3))[0] == 7);
}

}  // namespace
}  // namespace spectile::test
