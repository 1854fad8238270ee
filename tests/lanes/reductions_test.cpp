// Reductions of a lane over its bands: extremes, averages, masks and equality.
#include <spectile/lanes/arithmetic.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

bool bit(const LaneMask& mask, std::size_t lane) {
  return (mask[lane / 64] >> (lane % 64) & 1U) != 0;
}

/// Bits beyond the lanes are 0 and words are as many as needed.
void expect_padding_zero(const LaneMask& mask, std::size_t lanes) {
  ASSERT_EQ(mask.size(), (lanes + 63) / 64);
  for (std::size_t lane = lanes; lane < 64 * mask.size(); ++lane) EXPECT_FALSE(bit(mask, lane)) << lane;
}

/// Samples of which half of the lanes are all zeros; `arbitrary` elsewhere.
SampledSpectra half_black(const Bands& bands, std::size_t lanes) {
  const Floats arbitrary = arbitrary_floats(1009, 3);
  return batch_of(bands, lanes, [&](std::size_t lane, std::size_t band) {
    const std::size_t i = lane * bands.count() + band;
    if (lane % 2 == 0) return i % 3 == 0 ? -0.0F : 0.0F;
    return lane % 3 == 0 && band != 1 ? 0.0F : arbitrary[i % arbitrary.size()];
  });
}

TEST(Lanes, MasksFollowTheirDefinitionAndPaddingBitsAreZero) {
  const Bands bands = *Bands::uniform(400, 430, 10);
  for (const std::size_t lanes : kSizes) {
    const auto a = half_black(bands, lanes);
    auto b = half_black(bands, lanes);
    for (std::size_t lane = 0; lane < lanes; lane += 5) b.at(lane, 2) = 7.0F;
    const auto black = *is_black(a.view());
    const auto nan = *has_nan(a.view());
    const auto same = *equal_lanes(a.view(), b.view());
    for (const LaneMask* mask : {&black, &nan, &same}) expect_padding_zero(*mask, lanes);
    std::size_t equal_count = 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      bool zero = true;
      bool any_nan = false;
      bool all_equal = true;
      for (std::size_t band = 0; band < 3; ++band) {
        zero = zero && a.at(lane, band) == 0.0F;
        any_nan = any_nan || std::isnan(a.at(lane, band));
        all_equal = all_equal && a.at(lane, band) == b.at(lane, band);
      }
      ASSERT_EQ(bit(black, lane), zero) << lane << " of " << lanes;
      ASSERT_EQ(bit(nan, lane), any_nan) << lane << " of " << lanes;
      ASSERT_EQ(bit(same, lane), all_equal) << lane << " of " << lanes;
      equal_count += all_equal ? 1 : 0;
    }
    EXPECT_EQ(*equal(a.view(), b.view()), equal_count == lanes);
  }
}

TEST(Lanes, MasksIgnoreWhatThePaddingHolds) {
  const Bands bands = *Bands::parse("500,510");
  for (const std::size_t lanes : kSizes) {
    auto a = *SampledSpectra::create(bands, lanes);
    auto b = *SampledSpectra::create(bands, lanes);
    for (std::size_t lane = lanes; lane < 64 * a.blocks(); ++lane) a.at(lane, 1) = kNan;
    LaneMask all(a.blocks(), ~std::uint64_t{0});
    if (lanes % 64 != 0) all.back() = (std::uint64_t{1} << lanes % 64) - 1;
    EXPECT_EQ(*is_black(a.view()), all);
    EXPECT_EQ(*is_black(b.view()), all);  // padding is zero here, its bits are not set all the same
    EXPECT_EQ(*has_nan(a.view()), LaneMask(a.blocks(), 0));
    EXPECT_EQ(*equal_lanes(a.view(), b.view()), all);
    EXPECT_TRUE(*equal(a.view(), b.view()));
  }
}

TEST(Lanes, EqualityFollowsTheNumbersAndNotTheBits) {
  const Bands bands = *Bands::parse("500,510");
  const auto zero = *SampledSpectra::constant(bands, 65, 0.0F);
  const auto minus = *SampledSpectra::constant(bands, 65, -0.0F);
  EXPECT_TRUE(*equal(zero.view(), minus.view()));
  for (std::size_t lane = 0; lane < 65; ++lane) {
    auto other = *SampledSpectra::constant(bands, 65, 0.0F);
    other.at(lane, 1) = kTiny;
    ASSERT_FALSE(*equal(zero.view(), other.view())) << lane;
    other.at(lane, 1) = kNan;
    ASSERT_FALSE(*equal(other.view(), other.view())) << lane;
    ASSERT_FALSE(bit(*equal_lanes(other.view(), other.view()), lane));
    ASSERT_FALSE(bit(*is_black(other.view()), lane));
    ASSERT_TRUE(bit(*has_nan(other.view()), lane));
  }
}

TEST(Lanes, ExtremesPassOverNan) {
  const Bands bands = *Bands::uniform(400, 430, 10);
  auto a = *SampledSpectra::create(bands, 4);
  const float rows[4][3] = {{kNan, 2, -1}, {3, kNan, kNan}, {kNan, kNan, kNan}, {-kInf, 0, kInf}};
  const float least[4] = {-1, 3, kInf, -kInf};
  const float most[4] = {2, 3, -kInf, kInf};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    for (std::size_t band = 0; band < 3; ++band) a.at(lane, band) = rows[lane][band];
  }
  auto low = *ScalarLanes::create(4);
  auto high = *ScalarLanes::create(4);
  ASSERT_TRUE(minimum(a.view(), low.span()));
  ASSERT_TRUE(maximum(a.view(), high.span()));
  for (std::size_t lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(low[lane], least[lane]) << lane;
    EXPECT_EQ(high[lane], most[lane]) << lane;
  }
}

TEST(Lanes, ExtremesAreThoseOfEveryLaneForEverySize) {
  for (const std::size_t lanes : kSizes) {
    const auto a = batch_from(Bands(), lanes, plain_floats(10007, 5, -3.0F, 3.0F));
    auto low = *ScalarLanes::create(lanes);
    auto high = *ScalarLanes::create(lanes);
    ASSERT_TRUE(minimum(a.view(), low.span()));
    ASSERT_TRUE(maximum(a.view(), high.span()));
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      float least = kInf;
      float most = -kInf;
      for (std::size_t band = 0; band < 60; ++band) {
        least = std::min(least, a.at(lane, band));
        most = std::max(most, a.at(lane, band));
      }
      ASSERT_EQ(low[lane], least);
      ASSERT_EQ(high[lane], most);
    }
  }
}

TEST(Lanes, AverageWeighsBandsByTheirWidths) {
  // Widths 10, 30 and 60 nm: the plain mean would be 2.
  const Bands bands = *Bands::from_list({{400, 405, 410}, {410, 420, 440}, {500, 530, 560}});
  auto a = *SampledSpectra::broadcast(bands, 1, std::array{1.0F, 2.0F, 3.0F});
  auto out = *ScalarLanes::create(1);
  ASSERT_TRUE(average(a.view(), out.span()));
  EXPECT_NEAR(out[0], 0.1 + 0.6 + 1.8, 4 * 0x1p-24 * 2.5);
}

TEST(Lanes, AverageIsWithinItsBoundOfTheDoubleSum) {
  const Bands uneven = *Bands::parse("380,390,401,415,430,433,470,500,555,610,700");
  for (const Bands& bands : {Bands(), uneven, *Bands::uniform(360, 830, 1)}) {
    const auto a = batch_from(bands, 4099, plain_floats(100003, 6));
    auto out = *ScalarLanes::create(4099);
    ASSERT_TRUE(average(a.view(), out.span()));
    double total = 0;
    for (const Band& band : bands.list()) total += band.width_nm();
    const double bound = static_cast<double>(bands.count() + 1) * 0x1p-24;
    for (std::size_t lane = 0; lane < 4099; ++lane) {
      double exact = 0;
      for (std::size_t b = 0; b < bands.count(); ++b) exact += a.at(lane, b) * bands[b].width_nm() / total;
      ASSERT_LE(std::abs(out[lane] - exact), bound * exact) << lane;
    }
  }
}

TEST(Lanes, AverageLetsNanAndInfinitiesThrough) {
  auto a = *SampledSpectra::constant(Bands(), 3, 1.0F);
  a.at(0, 7) = kNan;
  a.at(1, 7) = kInf;
  auto out = *ScalarLanes::create(3);
  ASSERT_TRUE(average(a.view(), out.span()));
  EXPECT_TRUE(std::isnan(out[0]));
  EXPECT_EQ(out[1], kInf);
  EXPECT_NEAR(out[2], 1.0, 61 * 0x1p-24);
}

TEST(Lanes, ThreadsAndTilesDoNotChangeBits) {
  const Bands bands = *Bands::uniform(400, 450, 10);
  constexpr std::size_t kLanes = 70001;
  const auto a = batch_from(bands, kLanes, arbitrary_floats(10007, 1));
  const auto b = batch_from(bands, kLanes, arbitrary_floats(10007, 1));
  using Fold = Result<void> (*)(SampledSpectraView, LanesSpan, const Execution&);
  const Execution one{1, kLanes};
  for (const Execution& execution :
       {Execution{1, 64}, Execution{2, 64}, Execution{3, 100}, Execution{2, 65536}, Execution{}}) {
    for (const Fold fold : {&minimum, &maximum, &average}) {
      auto got = *ScalarLanes::create(kLanes);
      auto want = *ScalarLanes::create(kLanes);
      ASSERT_TRUE(fold(a.view(), got.span(), execution));
      ASSERT_TRUE(fold(a.view(), want.span(), one));
      EXPECT_TRUE(same_bits(got.view().data, want.view().data, kLanes));
    }
    EXPECT_EQ(*is_black(a.view(), execution), *is_black(a.view(), one));
    EXPECT_EQ(*has_nan(a.view(), execution), *has_nan(a.view(), one));
    EXPECT_EQ(*equal_lanes(a.view(), b.view(), execution), *equal_lanes(a.view(), b.view(), one));
  }
}

}  // namespace
}  // namespace spectile::test
