// Bands: construction, validation, text forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/spectra/bands.hpp>

namespace spectile {
namespace {

TEST(Bands, DefaultIsSixtyBandsOfFiveNanometres) {
  const Bands bands;
  ASSERT_EQ(bands.count(), 60U);
  EXPECT_EQ(bands[0].lower_nm, 400.0);
  EXPECT_EQ(bands[0].centre_nm, 402.5);
  EXPECT_EQ(bands[59].upper_nm, 700.0);
  EXPECT_EQ(bands.description(), "400:700:5");
}

TEST(Bands, NeighboursShareTheirEdgesExactly) {
  const auto bands = Bands::uniform(380, 780, 0.1);
  ASSERT_TRUE(bands) << bands.error().message;
  ASSERT_EQ(bands->count(), 4000U);
  for (std::size_t i = 1; i < bands->count(); ++i) EXPECT_EQ((*bands)[i].lower_nm, (*bands)[i - 1].upper_nm);
}

TEST(Bands, RejectsWhatIsNotARange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(Bands::uniform(700, 400, 5));
  EXPECT_FALSE(Bands::uniform(400, 700, 0));
  EXPECT_FALSE(Bands::uniform(400, 700, -5));
  EXPECT_FALSE(Bands::uniform(400, 700, 7));
  EXPECT_FALSE(Bands::uniform(0, 700, 5));
  EXPECT_FALSE(Bands::uniform(nan, 700, 5));
  EXPECT_FALSE(Bands::uniform(400, inf, 5));
  EXPECT_FALSE(Bands::uniform(400, 700, 0.01));
}

TEST(Bands, ThoseOfPlansMayOverlap) {
  const std::vector<Band> list = {{400, 420, 440}, {390, 430, 500}, {450, 460, 470}};
  EXPECT_FALSE(Bands::from_list(list));
  const auto bands = Bands::from_overlapping(list);
  ASSERT_TRUE(bands) << bands.error().message;
  EXPECT_TRUE(bands->overlap());
  // The third is within the second.
  EXPECT_TRUE(Bands::from_overlapping({list[1], list[2]})->overlap());
  EXPECT_FALSE(Bands::from_overlapping({list[0], list[2]})->overlap());
  EXPECT_FALSE(Bands().overlap());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const std::vector<Band>& wrong : std::vector<std::vector<Band>>{
           {},
           {{400, 420, 440}, {390, 420, 500}},
           {{400, 420, 440}, {390, 410, 500}},
           {{400, 400, 440}},
           {{440, 420, 400}},
           {{-1, 420, 440}},
           {{400, 420, kInfinity}},
           {{std::nan(""), 420, 440}},
           {{400, std::nan(""), 440}}}) {
    EXPECT_FALSE(Bands::from_overlapping(wrong));
  }
}

TEST(Bands, CentresGetEdgesHalfwayBetween) {
  const auto bands = Bands::from_centres(std::vector<double>{400, 410, 440});
  ASSERT_TRUE(bands);
  EXPECT_EQ((*bands)[0].lower_nm, 395.0);
  EXPECT_EQ((*bands)[0].upper_nm, 405.0);
  EXPECT_EQ((*bands)[1].upper_nm, 425.0);
  EXPECT_EQ((*bands)[2].upper_nm, 455.0);
  EXPECT_FALSE(Bands::from_centres(std::vector<double>{410, 400}));
  EXPECT_FALSE(Bands::from_centres(std::vector<double>{400, 400}));
  EXPECT_FALSE(Bands::from_centres(std::vector<double>{}));
}

TEST(Bands, CentresOfUniformBandsGiveTheSameBands) {
  const auto original = Bands::uniform(400, 700, 5);
  std::vector<double> centres;
  for (const Band& band : original->list()) centres.push_back(band.centre_nm);
  const auto again = Bands::from_centres(centres);
  ASSERT_TRUE(again);
  EXPECT_TRUE(*again == *original);
}

TEST(Bands, ParsesRangesAndLists) {
  EXPECT_EQ(Bands::parse("380:780:5")->count(), 80U);
  EXPECT_EQ(Bands::parse("450, 550 ,650")->count(), 3U);
  EXPECT_EQ(Bands::parse("550")->count(), 1U);
  for (const char* bad :
       {"", ":", "400:700", "400:700:5:6", "a:b:c", "400:700:5nm", "500,400", "nan", "1e999"}) {
    const auto bands = Bands::parse(bad);
    EXPECT_FALSE(bands) << bad;
    if (bands) continue;
    EXPECT_EQ(bands.error().code, ErrorCode::kBadArgument) << bad;
  }
}

}  // namespace
}  // namespace spectile
