// Arithmetic on batches: what each operation gives, its numbers' rules, its errors, and its independence of
// tiling.
#include <gmock/gmock.h>

#include <functional>
#include <spectile/lanes/arithmetic.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

/// Every operation from three batches to one, with the plain C++ that says the same.
struct Operation {
  const char* name;
  std::function<Result<void>(SampledSpectraView, SampledSpectraView, SampledSpectraView, SampledSpectraSpan,
                             const Execution&)>
      run;
  std::function<float(float, float, float)> fact;
};

std::vector<Operation> operations() {
  using V = SampledSpectraView;
  using S = SampledSpectraSpan;
  using E = Execution;
  const float inf = kInf;
  return {
      {"add", [](V a, V b, V, S o, const E& e) { return add(a, b, o, e); },
       [](float a, float b, float) { return a + b; }},
      {"subtract", [](V a, V b, V, S o, const E& e) { return subtract(a, b, o, e); },
       [](float a, float b, float) { return a - b; }},
      {"multiply", [](V a, V b, V, S o, const E& e) { return multiply(a, b, o, e); },
       [](float a, float b, float) { return a * b; }},
      {"divide", [](V a, V b, V, S o, const E& e) { return divide(a, b, o, e); },
       [](float a, float b, float) { return a / b; }},
      {"divide_or_zero", [](V a, V b, V, S o, const E& e) { return divide_or_zero(a, b, o, e); },
       [](float a, float b, float) { return b == 0 ? 0.0F : a / b; }},
      {"negate", [](V a, V, V, S o, const E& e) { return negate(a, o, e); },
       [](float a, float, float) { return -a; }},
      {"scale", [](V a, V, V, S o, const E& e) { return scale(a, 0.3F, o, e); },
       [](float a, float, float) { return a * 0.3F; }},
      {"multiply_add", [](V a, V b, V c, S o, const E& e) { return multiply_add(a, b, c, o, e); },
       [](float a, float b, float c) {
         const float product = a * b;
         return product + c;
       }},
      {"lerp", [](V a, V b, V, S o, const E& e) { return lerp(a, b, 0.3F, o, e); },
       [](float a, float b, float) {
         const float rest = 1.0F - 0.3F;
         return rest * a + 0.3F * b;
       }},
      {"sqrt", [](V a, V, V, S o, const E& e) { return sqrt(a, o, e); },
       [](float a, float, float) { return std::sqrt(a); }},
      // The double results rounded once: the same bits unless they lie within 0.001 ULP of a middle, which
      // none does of the samples here.
      {"exp", [](V a, V, V, S o, const E& e) { return exp(a, o, e); },
       [inf](float a, float, float) {
         return a == inf ? inf : static_cast<float>(std::exp(static_cast<double>(a)));
       }},
      {"pow", [](V a, V, V, S o, const E& e) { return pow(a, 2.0F, o, e); },
       [](float a, float, float) {
         return static_cast<float>(static_cast<double>(a) * static_cast<double>(a));
       }},
      {"clamp", [](V a, V, V, S o, const E& e) { return clamp(a, 0.25F, 0.5F, o, e); },
       [](float a, float, float) { return std::isnan(a) ? a : std::min(0.5F, std::max(0.25F, a)); }},
      {"clamp_zero", [](V a, V, V, S o, const E& e) { return clamp_zero(a, o, e); },
       [](float a, float, float) { return a < 0 ? 0.0F : a; }},
  };
}

TEST(Arithmetic, EveryOperationIsItsFormulaForEverySizeAndWildSamples) {
  const Bands bands = *Bands::uniform(400, 430, 10);
  for (const std::size_t lanes : kSizes) {
    const auto a = batch_from(bands, lanes, arbitrary_floats(3 * lanes, 1));
    const auto b = batch_from(bands, lanes, arbitrary_floats(3 * lanes, 2));
    const auto c = batch_from(bands, lanes, arbitrary_floats(3 * lanes, 3));
    for (const Operation& op : operations()) {
      auto out = *SampledSpectra::create(bands, lanes);
      ASSERT_TRUE(op.run(a.view(), b.view(), c.view(), out.span(), {})) << op.name;
      const auto want = batch_of(bands, lanes, [&](std::size_t lane, std::size_t band) {
        return op.fact(a.at(lane, band), b.at(lane, band), c.at(lane, band));
      });
      EXPECT_TRUE(same_lanes(out, want)) << op.name << " of " << lanes;
    }
  }
}

TEST(Arithmetic, OutputMayBeAnyOfTheInputs) {
  const Bands bands = *Bands::uniform(400, 450, 10);
  constexpr std::size_t kLanes = 4099;
  for (const Operation& op : operations()) {
    for (int which = 0; which < 3; ++which) {
      SampledSpectra in[3] = {batch_from(bands, kLanes, arbitrary_floats(997, 1)),
                              batch_from(bands, kLanes, arbitrary_floats(997, 2)),
                              batch_from(bands, kLanes, arbitrary_floats(997, 3))};
      auto want = *SampledSpectra::create(bands, kLanes);
      ASSERT_TRUE(op.run(in[0].view(), in[1].view(), in[2].view(), want.span(), {}));
      ASSERT_TRUE(op.run(in[0].view(), in[1].view(), in[2].view(), in[which].span(), {}));
      EXPECT_TRUE(same_lanes(in[which], want)) << op.name << " onto " << which;
    }
  }
}

TEST(Arithmetic, ThreadsAndTilesDoNotChangeBits) {
  const Bands bands = *Bands::uniform(400, 450, 10);
  constexpr std::size_t kLanes = 70001;
  const auto a = batch_from(bands, kLanes, arbitrary_floats(10007, 1));
  const auto b = batch_from(bands, kLanes, arbitrary_floats(10009, 2));
  const auto c = batch_from(bands, kLanes, arbitrary_floats(10037, 3));
  for (const Operation& op : operations()) {
    auto want = *SampledSpectra::create(bands, kLanes);
    ASSERT_TRUE(op.run(a.view(), b.view(), c.view(), want.span(), {1, kLanes}));
    for (const Execution& execution :
         {Execution{1, 64}, Execution{2, 64}, Execution{3, 100}, Execution{2, 65536}, Execution{3, 4096},
          Execution{0, 1}, Execution{}}) {
      auto out = *SampledSpectra::create(bands, kLanes);
      ASSERT_TRUE(op.run(a.view(), b.view(), c.view(), out.span(), execution));
      EXPECT_TRUE(same_bits(out.view().data, want.view().data, want.view().floats()))
          << op.name << " with " << execution.threads << " threads, tiles of " << execution.tile_lanes;
    }
  }
}

TEST(Arithmetic, OtherBandsAreAnError) {
  const auto a = *SampledSpectra::create(*Bands::uniform(400, 700, 5), 17);
  const auto b = *SampledSpectra::create(*Bands::uniform(400, 700, 10), 17);
  // As many bands, elsewhere.
  const auto c = *SampledSpectra::create(*Bands::uniform(401, 701, 5), 17);
  for (const Operation& op : operations()) {
    auto out = *SampledSpectra::constant(a.axis(), 17, 3.0F);
    EXPECT_EQ(code_of(op.run(b.view(), b.view(), b.view(), out.span(), {})), code(ErrorCode::kBandsMismatch))
        << op.name;
    EXPECT_EQ(code_of(op.run(c.view(), c.view(), c.view(), out.span(), {})), code(ErrorCode::kBandsMismatch))
        << op.name;
    EXPECT_EQ(out.at(16, 59), 3.0F) << op.name << " wrote";
  }
  auto out = *SampledSpectra::create(a.axis(), 17);
  EXPECT_EQ(code_of(add(a.view(), b.view(), out.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(multiply_add(a.view(), a.view(), c.view(), out.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(equal(a.view(), b.view())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(equal_lanes(a.view(), c.view())), code(ErrorCode::kBandsMismatch));
  EXPECT_THAT(add(a.view(), b.view(), out.span()).error().message, testing::HasSubstr("400:700:10"));
}

TEST(Arithmetic, OtherLanesAreAnError) {
  const Bands bands;
  const auto a = *SampledSpectra::create(bands, 17);
  const auto b = *SampledSpectra::create(bands, 16);  // as many blocks
  for (const Operation& op : operations()) {
    auto out = *SampledSpectra::create(bands, 17);
    EXPECT_EQ(code_of(op.run(b.view(), b.view(), b.view(), out.span(), {})), code(ErrorCode::kSizeMismatch))
        << op.name;
  }
  auto out = *SampledSpectra::create(bands, 17);
  EXPECT_EQ(code_of(subtract(a.view(), b.view(), out.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(equal(a.view(), b.view())), code(ErrorCode::kSizeMismatch));
  auto lanes = *ScalarLanes::create(16);
  EXPECT_EQ(code_of(minimum(a.view(), lanes.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(maximum(a.view(), lanes.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(average(a.view(), lanes.span())), code(ErrorCode::kSizeMismatch));
}

TEST(Arithmetic, EmptyBatchesAreNoError) {
  const Bands bands;
  const auto a = *SampledSpectra::create(bands, 0);
  auto out = *SampledSpectra::create(bands, 0);
  for (const Operation& op : operations())
    EXPECT_TRUE(op.run(a.view(), a.view(), a.view(), out.span(), {})) << op.name;
  EXPECT_TRUE(is_black(a.view())->empty());
  EXPECT_TRUE(*equal(a.view(), out.view()));
}

TEST(Arithmetic, ClampRejectsLimitsThatAreNotInOrder) {
  auto a = *SampledSpectra::constant(Bands(), 1, 0.5F);
  EXPECT_EQ(code_of(clamp(a.view(), 1.0F, 0.0F, a.span())), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(clamp(a.view(), kNan, 1.0F, a.span())), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(clamp(a.view(), 0.0F, kNan, a.span())), code(ErrorCode::kBadArgument));
  EXPECT_EQ(a.at(0, 0), 0.5F);
  EXPECT_TRUE(clamp(a.view(), 1.0F, 1.0F, a.span()));
  EXPECT_EQ(a.at(0, 0), 1.0F);
}

TEST(Arithmetic, LerpIsExactAtItsEnds) {
  const Bands bands;
  const auto a = batch_from(bands, 65, plain_floats(997, 1, -1e6F, 1e6F));
  const auto b = batch_from(bands, 65, plain_floats(991, 2, -1.0F, 1.0F));
  auto out = *SampledSpectra::create(bands, 65);
  ASSERT_TRUE(lerp(a.view(), b.view(), 0.0F, out.span()));
  EXPECT_TRUE(*equal(out.view(), a.view()));
  ASSERT_TRUE(lerp(a.view(), b.view(), 1.0F, out.span()));
  EXPECT_TRUE(*equal(out.view(), b.view()));
}

TEST(Arithmetic, DivideOrZeroGivesZeroForZerosOfEitherSign) {
  const Bands bands = *Bands::parse("500,510");
  const auto numerators = {1.0F, -1.0F, 0.0F, kInf, kNan};
  for (const float a : numerators) {
    auto x = *SampledSpectra::constant(bands, 1, a);
    auto y = *SampledSpectra::constant(bands, 1, 0.0F);
    y.at(0, 1) = -0.0F;
    ASSERT_TRUE(divide_or_zero(x.view(), y.view(), y.span()));
    EXPECT_TRUE(same_bits(y.at(0, 0), 0.0F)) << a;
    EXPECT_TRUE(same_bits(y.at(0, 1), 0.0F)) << a;
  }
  auto one = *SampledSpectra::constant(bands, 1, 1.0F);
  const auto nan = *SampledSpectra::constant(bands, 1, kNan);
  ASSERT_TRUE(divide_or_zero(one.view(), nan.view(), one.span()));
  EXPECT_TRUE(std::isnan(one.at(0, 0)));
}

TEST(Arithmetic, NegateFlipsTheSignOfZeroAndNan) {
  const Bands bands = *Bands::parse("500,510");
  auto a = *SampledSpectra::constant(bands, 1, 0.0F);
  a.at(0, 1) = std::copysign(kNan, 1.0F);
  ASSERT_TRUE(negate(a.view(), a.span()));
  EXPECT_TRUE(std::signbit(a.at(0, 0)));
  EXPECT_TRUE(std::isnan(a.at(0, 1)));
  EXPECT_TRUE(std::signbit(a.at(0, 1)));
}

TEST(Arithmetic, SamplesMustBeAligned) {
  auto a = *SampledSpectra::create(Bands(), 64);
  SampledSpectraView shifted = a.view();
  shifted.data += 1;
  EXPECT_EQ(code_of(negate(shifted, a.span())), code(ErrorCode::kBadArgument));
}

}  // namespace
}  // namespace spectile::test
