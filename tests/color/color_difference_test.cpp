// CIEDE2000 against the published pairs, a second way of computing them, and over batches.
#include <gmock/gmock.h>

#include <numbers>
#include <spectile/color/color_difference.hpp>
#include <spectile/color/colorimetry.hpp>

#include "tests/color/white.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

struct Pair {
  Lab reference, sample;
  double difference;
};

// Sharma, Wu and Dalal (2005), table 1: to four decimals.
constexpr Pair kPublished[] = {
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};
static_assert(std::size(kPublished) == 34);

/// CIEDE2000 with vectors in place of angles: the hue difference from the dot product, the mean hue from the
/// sum of the two directions.
double by_vectors(const Lab& x, const Lab& y) {
  const auto vivid = [](double c) { return 1 / std::sqrt(1 + std::pow(25 / c, 7)); };
  const double g = 1.5 - 0.5 * vivid((std::hypot(x.a, x.b) + std::hypot(y.a, y.b)) / 2);
  const double cx = std::hypot(g * x.a, x.b);
  const double cy = std::hypot(g * y.a, y.b);
  const double dot = g * x.a * g * y.a + x.b * y.b;
  const double cross = g * x.a * y.b - g * y.a * x.b;
  const double dh = std::copysign(std::sqrt(std::max(0.0, 2 * (cx * cy - dot))), cross);
  constexpr double kDegree = std::numbers::pi / 180;
  const double hue = std::atan2(x.b / cx + y.b / cy, g * x.a / cx + g * y.a / cy);
  const double t = 1 - 0.17 * std::cos(hue - 30 * kDegree) + 0.24 * std::cos(2 * hue) +
                   0.32 * std::cos(3 * hue + 6 * kDegree) - 0.2 * std::cos(4 * hue - 63 * kDegree);
  const double from_blue = (hue / kDegree + (hue < 0 ? 360 : 0) - 275) / 25;
  const double turn = 60 * kDegree * std::exp(-std::pow(from_blue, 2));
  const double c = (cx + cy) / 2;
  const double l2 = std::pow((x.l + y.l) / 2 - 50, 2);
  const double vl = (y.l - x.l) / (1 + 0.015 * l2 / std::sqrt(20 + l2));
  const double vc = (cy - cx) / (1 + 0.045 * c);
  const double vh = dh / (1 + 0.015 * c * t);
  return std::sqrt(vl * vl + vc * vc + vh * vh - std::sin(turn) * 2 * vivid(c) * vc * vh);
}

std::vector<Lab> random_colors(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> l(0, 100);
  std::uniform_real_distribution<double> ab(-120, 120);
  std::vector<Lab> colors(count);
  for (Lab& color : colors) color = {l(random), ab(random), ab(random)};
  return colors;
}

/// Lanes of colours around the white's, from slightly negative to over 1.
ColorLanes color_lanes(std::size_t lanes, const Floats& values) {
  auto out = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.at(i, k) = values[(3 * i + k) % values.size()];
  }
  return out;
}

float scalar(const ColorLanes& a, const ColorLanes& b, std::size_t i, const std::array<double, 3>& white) {
  const Lab x = xyz_to_lab({a.at(i, 0), a.at(i, 1), a.at(i, 2)}, white);
  const Lab y = xyz_to_lab({b.at(i, 0), b.at(i, 1), b.at(i, 2)}, white);
  return static_cast<float>(ciede2000(x, y));
}

TEST(Ciede2000, OfThePublishedPairsIsThePublished) {
  for (const Pair& p : kPublished) {
    EXPECT_NEAR(ciede2000(p.reference, p.sample), p.difference, 5e-5) << "pair " << &p - kPublished + 1;
  }
}

TEST(Ciede2000, IsTheSameBothWaysRound) {
  for (const Pair& p : kPublished)
    EXPECT_EQ(ciede2000(p.reference, p.sample), ciede2000(p.sample, p.reference));
  const auto x = random_colors(20000, 1);
  for (std::size_t i = 1; i < x.size(); ++i) {
    ASSERT_EQ(ciede2000(x[i], x[i - 1]), ciede2000(x[i - 1], x[i])) << i;
    // Hues exactly opposite, chroma not the same.
    const Lab opposite{x[i - 1].l, -2 * x[i].a, -2 * x[i].b};
    ASSERT_EQ(ciede2000(x[i], opposite), ciede2000(opposite, x[i])) << i;
  }
}

TEST(Ciede2000, IsZeroForEqualColorsAndOnlyForThem) {
  for (const Lab& x : random_colors(2000, 2)) {
    EXPECT_EQ(ciede2000(x, x), 0);
    EXPECT_GT(ciede2000(x, {x.l + 1e-3, x.a, x.b}), 0);
    EXPECT_GT(ciede2000(x, {x.l, x.a + 1e-3, x.b}), 0);
    EXPECT_GT(ciede2000(x, {x.l, x.a, x.b + 1e-3}), 0);
  }
  EXPECT_EQ(ciede2000({}, {}), 0);
  EXPECT_EQ(ciede2000({-5, 0, 0}, {-5, 0, 0}), 0);
}

TEST(Ciede2000, AgreesWithTheWayByVectors) {
  const auto x = random_colors(50000, 3);
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double want = by_vectors(x[i - 1], x[i]);
    ASSERT_NEAR(ciede2000(x[i - 1], x[i]), want, 1e-9 * want) << i;
    const Lab near{x[i].l + 0.1, 1.01 * x[i].a - 0.2, x[i].b + 0.3};
    ASSERT_NEAR(ciede2000(x[i], near), by_vectors(x[i], near), 1e-9) << i;
  }
}

TEST(Ciede2000, OfGreysIsTheWeightedLightness) {
  // S_L is 1 for a mean of 50, and 1 + 0.015 x 2500 / sqrt(2520) for 0 and for 100.
  EXPECT_DOUBLE_EQ(ciede2000({0, 0, 0}, {100, 0, 0}), 100);
  EXPECT_DOUBLE_EQ(ciede2000({-1, 0, 0}, {1, 0, 0}), 2 / (1 + 37.5 / std::sqrt(2520.0)));
  EXPECT_DOUBLE_EQ(ciede2000({99, 0, 0}, {101, 0, 0}), 2 / (1 + 37.5 / std::sqrt(2520.0)));
}

TEST(Ciede2000, GreyHasNoHueOfItsOwn) {
  for (const Lab& x : random_colors(200, 4)) {
    // Lightness and chroma alone.
    const double stretch = 1.5 - 0.5 / std::sqrt(1 + std::pow(50 / std::hypot(x.a, x.b), 7));
    const double c = std::hypot(stretch * x.a, x.b);
    const double l2 = std::pow((x.l + 40) / 2 - 50, 2);
    const double l = (x.l - 40) / (1 + 0.015 * l2 / std::sqrt(20 + l2));
    const double want = std::hypot(l, c / (1 + 0.045 * c / 2));
    for (const double sign : {1.0, -1.0}) {
      for (const Lab& grey : {Lab{40, 0 * sign, 0}, Lab{40, 0 * sign, -0.0}, Lab{40, 1e-200 * sign, 0}}) {
        EXPECT_NEAR(ciede2000(grey, x), want, 1e-12);
        EXPECT_EQ(ciede2000(x, grey), ciede2000(grey, x));
      }
      // Hardly off grey is hardly elsewhere, whatever the hue.
      EXPECT_NEAR(ciede2000({40, 1e-15 * sign, 0}, x), want, 1e-5);
      EXPECT_NEAR(ciede2000({40, 0, 1e-15 * sign}, x), want, 1e-5);
    }
  }
}

TEST(Ciede2000, OppositeHuesAverageWithoutATurn) {
  for (const Lab& x : random_colors(2000, 5)) {
    // The mean of h and h + 180 is h + 90, as from a hair less than opposite; a hair more is where it jumps.
    const Lab first = x.b > 0 ? x : Lab{x.l, -x.a, -x.b};
    const Lab less{x.l, -first.a - 1e-9 * first.b, -first.b + 1e-9 * first.a};
    EXPECT_NEAR(ciede2000(first, {x.l, -first.a, -first.b}), ciede2000(first, less), 1e-6);
    EXPECT_NEAR(ciede2000(first, {x.l, -first.a / 2, -first.b / 2}),
                ciede2000(first, {x.l, less.a / 2, less.b / 2}), 1e-6);
  }
  EXPECT_GT(ciede2000({50, 2.49, -0.001}, {50, -2.49, 0.001 + 1e-9}), 7.21);
}

TEST(Ciede2000, OfNanOrInfinityIsNan) {
  for (const double bad : {double{kNan}, double{kInf}, -double{kInf}}) {
    for (const Lab& other : {Lab{0, 0, 0}, Lab{50, 20, -30}, Lab{bad, 0, 0}, Lab{bad, bad, bad}}) {
      for (const Lab& x : {Lab{bad, 0, 0}, Lab{0, bad, 0}, Lab{0, 0, bad}, Lab{50, bad, 1}, Lab{50, 1, bad},
                           Lab{bad, bad, bad}}) {
        EXPECT_TRUE(std::isnan(ciede2000(x, other))) << x.l << " " << x.a << " " << x.b;
        EXPECT_TRUE(std::isnan(ciede2000(other, x))) << x.l << " " << x.a << " " << x.b;
      }
    }
  }
}

TEST(Ciede2000Batch, HasTheBitsOfTheScalarOne) {
  for (const std::size_t lanes : kSizes) {
    const auto a = color_lanes(lanes, plain_floats(20011, 6, -0.05F, 1.2F));
    const auto b = color_lanes(lanes, plain_floats(20021, 7, -0.05F, 1.2F));
    auto got = *ScalarLanes::create(blocks_for(lanes) * kLanesPerBlock);
    for (std::size_t i = 0; i < got.lanes(); ++i) got[i] = -1;
    ASSERT_TRUE(ciede2000(a.view(), b.view(), kWhite, {got.span().data, lanes}));
    for (std::size_t i = 0; i < lanes; ++i) {
      ASSERT_TRUE(same_bits(got[i], scalar(a, b, i, kWhite))) << i << " of " << lanes;
    }
    for (std::size_t i = lanes; i < got.lanes(); ++i) ASSERT_EQ(got[i], -1) << "padding " << i;
  }
}

TEST(Ciede2000Batch, WritesOverAnInput) {
  const auto a = color_lanes(4099, plain_floats(20011, 8));
  auto b = color_lanes(4099, plain_floats(20021, 9));
  auto want = *ScalarLanes::create(4099);
  ASSERT_TRUE(ciede2000(a.view(), b.view(), kWhite, want.span()));
  ASSERT_TRUE(ciede2000(a.view(), b.view(), kWhite, {b.span().c[1], 4099}));
  EXPECT_TRUE(same_bits(b.view().c[1], want.view().data, 4099));
}

TEST(Ciede2000Batch, KeepsBadLanesToThemselves) {
  const auto good = color_lanes(129, plain_floats(20011, 10));
  auto other = color_lanes(129, plain_floats(20021, 11));
  const float bad[] = {kNan, kInf, -kInf};
  const float fine[] = {0.0F, -0.0F, -1.0F, kTiny, -kTiny, kMost, -kMost};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < std::size(bad); ++i) other.at(10 * i + k, k) = bad[i];
    for (std::size_t i = 0; i < std::size(fine); ++i) other.at(100 + i, k) = fine[i];
  }
  auto out = *ScalarLanes::create(129);
  ASSERT_TRUE(ciede2000(good.view(), other.view(), kWhite, out.span()));
  for (std::size_t i = 0; i < 129; ++i) {
    const bool is_bad = i < 30 && i % 10 < 3;
    EXPECT_EQ(std::isnan(out[i]), is_bad) << i;
    EXPECT_EQ(std::isfinite(out[i]), !is_bad) << i;
  }
}

TEST(Ciede2000Batch, ThreadsAndTilesDoNotChangeBits) {
  constexpr std::size_t kLanes = 20001;
  const auto a = color_lanes(kLanes, arbitrary_floats(20011, 12));
  const auto b = color_lanes(kLanes, plain_floats(20021, 13));
  auto want = *ScalarLanes::create(kLanes);
  ASSERT_TRUE(ciede2000(a.view(), b.view(), kWhite, want.span(), {1, kLanes}));
  for (const Execution& execution : {Execution{1, 64}, Execution{2, 64}, Execution{3, 100}, Execution{}}) {
    auto got = *ScalarLanes::create(kLanes);
    ASSERT_TRUE(ciede2000(a.view(), b.view(), kWhite, got.span(), execution));
    EXPECT_TRUE(same_bits(got.view().data, want.view().data, kLanes));
  }
}

TEST(Ciede2000Batch, OtherLanesOrABadWhiteAreAnError) {
  const auto a = *ColorLanes::create(17);
  const auto b = *ColorLanes::create(18);
  auto out = *ScalarLanes::create(17);
  const auto check = [&](ColorView x, ColorView y, LanesSpan to, ErrorCode want) {
    EXPECT_EQ(code_of(ciede2000(x, y, kWhite, to)), code(want));
  };
  check(a.view(), b.view(), out.span(), ErrorCode::kSizeMismatch);
  check(b.view(), a.view(), out.span(), ErrorCode::kSizeMismatch);
  check(b.view(), b.view(), out.span(), ErrorCode::kSizeMismatch);
  EXPECT_THAT(ciede2000(b.view(), b.view(), kWhite, out.span()).error().message,
              testing::AllOf(testing::HasSubstr("17"), testing::HasSubstr("18")));
  ColorView off = a.view();
  off.c[2] += 1;
  check(off, a.view(), out.span(), ErrorCode::kBadArgument);
  check(a.view(), off, out.span(), ErrorCode::kBadArgument);
  check(a.view(), a.view(), {out.span().data + 1, 17}, ErrorCode::kBadArgument);
  for (const double bad : {0.0, -0.0, -1.0, double{kNan}, double{kInf}}) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> white = kWhite;
      white[k] = bad;
      const auto result = ciede2000(a.view(), a.view(), white, out.span());
      EXPECT_EQ(code_of(result), code(ErrorCode::kBadArgument)) << bad;
    }
  }
}

TEST(ColorError, ThePercentileIsTheSmallestValueThat95Of100DoNotExceed) {
  for (const std::size_t count : {1U, 19U, 20U, 21U, 40U, 100U, 101U}) {
    std::vector<double> values;
    for (std::size_t i = count; i > 0; --i) values.push_back(static_cast<double>(i));
    const ColorError e = summarize(values);
    EXPECT_EQ(e.percentile95, std::ceil(static_cast<double>(count) * 95 / 100)) << count;
    EXPECT_EQ(e.maximum, static_cast<double>(count));
    EXPECT_NEAR(e.mean, (static_cast<double>(count) + 1) / 2, 1e-12);
  }
  EXPECT_EQ(summarize({}).maximum, 0);
}

}  // namespace
}  // namespace spectile::test
