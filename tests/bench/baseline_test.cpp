// The AoS baseline computes the same as the engine's operations, and its film the same as the engine's.
#include <gtest/gtest.h>

#include <algorithm>
#include <spectile/isa.hpp>

#include "bench/baseline/film_orders.hpp"
#include "bench/baseline/film_workload.hpp"
#include "bench/baseline/lane_baselines.hpp"
#include "src/dispatch/dispatch.hpp"

namespace spectile::test {
namespace {

using measure::LaneBaseline;
using measure::LaneMemory;
using measure::Operation;

TEST(AosBaseline, AgreesWithTheOperationsItStandsBeside) {
  const Bands bands;
  const auto operations = measure::lane_operations(bands);
  ASSERT_TRUE(operations) << operations.error().message;
  int found = 0;
  for (const Operation& op : *operations) {
    const std::size_t bytes = LaneMemory::min_bytes(op, 4);
    auto buffer = FloatBuffer::create(bytes / sizeof(float));
    ASSERT_TRUE(buffer);
    LaneMemory memory(op, buffer->data(), bytes);
    measure::Random random(1);
    std::vector<float> values(op.in.values());
    for (std::size_t lane = 0; lane < memory.lanes(); ++lane) {
      op.fill(random, values.data());
      memory.write(lane, values.data());
    }
    const auto baseline = LaneBaseline::create(op, bands, memory, 1);
    ASSERT_TRUE(baseline) << baseline.error().message;
    if (!baseline->exists()) continue;
    ++found;
    // In plain float: sums one after another, the C library's functions, cancelled differences.
    const double allowed = op.name == "black body" || op.name.starts_with("draw") ? 512 : 64;
    EXPECT_LE(baseline->error(memory.lanes()), allowed * std::max(1.0, op.bound)) << op.name;
    if (baseline->fused.run) {
      EXPECT_LE(baseline->error(memory.lanes(), true), allowed) << op.name;
    }
  }
  EXPECT_EQ(found, 19);
}

TEST(AosBaseline, HasNothingForOtherBands) {
  const auto bands = Bands::parse("400:700:10");
  ASSERT_TRUE(bands);
  const auto operations = measure::lane_operations(*bands);
  ASSERT_TRUE(operations);
  for (const Operation& op : *operations) {
    const std::size_t bytes = LaneMemory::min_bytes(op);
    auto buffer = FloatBuffer::create(bytes / sizeof(float));
    ASSERT_TRUE(buffer);
    const auto baseline = LaneBaseline::create(op, *bands, LaneMemory(op, buffer->data(), bytes), 1);
    ASSERT_TRUE(baseline);
    EXPECT_FALSE(baseline->exists()) << op.name;
  }
}

TEST(ArrivalOrders, HoldTheSameSamplesShuffledOrNot) {
  const auto tiles = measure::by_tile(40, 20, 4, 2, 3000);
  EXPECT_EQ(tiles.size(), 3000U);
  auto random = measure::at_random(tiles);
  EXPECT_NE(random.x, tiles.x);
  std::sort(random.x.begin(), random.x.end());
  auto sorted = tiles.x;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(random.x, sorted);
  EXPECT_EQ(measure::by_scanline(40, 20, 2).size(), 1600U);
}

TEST(FilmOrders, BothFilmsComeToTheMeanOfTheirSamples) {
  measure::FilmOrderSettings settings;
  settings.table = *dispatch::active();
  settings.quick = true;
  settings.timing.rounds = 1;
  settings.only = {"film, tile, 4 a visit", "against plain double sums, random", "60 buckets, tile"};
  const auto found = measure::measure_film_orders(settings);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 3U);
  for (const BaselineSpeed& speed : *found) {
    EXPECT_GT(speed.nanoseconds, 0) << speed.name;
    EXPECT_GT(speed.ratio, 0) << speed.name;
    EXPECT_LT(speed.error, 1e-5) << speed.name;
    // The baseline takes the nearest nanometre of its curves.
    EXPECT_LT(speed.baseline_error, 0.05) << speed.name;
  }
}

}  // namespace
}  // namespace spectile::test
