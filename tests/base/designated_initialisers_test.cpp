// Options, given by name with the rest left out, compile without a warning under -Wall -Wextra.
#include <gtest/gtest.h>

#include <spectile/bench/benchmark.hpp>
#include <spectile/spectile.hpp>

namespace spectile::test {
namespace {

TEST(DesignatedInitialisers, OfAllOptionsLeaveTheRestAsItIs) {
  EXPECT_TRUE(BenchmarkOptions{.quick = true}.threads.empty());
  EXPECT_TRUE(ChannelChoice{.view = "right"}.layer.empty());
  EXPECT_TRUE(MappedChannel{.name = "R"}.band == Band());
  EXPECT_EQ(Execution{.threads = 2}.tile_lanes, Execution().tile_lanes);
  EXPECT_EQ(FilmOptions{.width = 4}.range, FilmOptions().range);
  EXPECT_FALSE(LearningOptions{.observer = Observer::kCie1964}.light.has_value());
  EXPECT_FALSE(PlannerOptions{.bands = 8}.max_error.has_value());
  EXPECT_FALSE(SensorOptions{.exposure = 2}.white_balance.has_value());
  EXPECT_FALSE(SpectrumFileOptions{.ends = Ends::kHeld}.missing.has_value());
  EXPECT_FALSE(UpsamplerOptions{.observer = Observer::kCie1964}.light.has_value());
  EXPECT_TRUE(WavelengthSamples{.x = {}}.weight.empty());
  EXPECT_TRUE(BandSamples{.x = {}}.weight.empty());
  EXPECT_TRUE(SamplePositions{.x = {}}.weight.empty());
  EXPECT_EQ(RowsView{.count = 1}.data, nullptr);
  EXPECT_EQ(SampledSpectraView{.lanes = 3}.data, nullptr);
  EXPECT_FALSE(ImageOptions{.threads = 2}.region.has_value());
}

}  // namespace
}  // namespace spectile::test
