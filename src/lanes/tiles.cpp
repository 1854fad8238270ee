// Tiles over threads: the parallel loop over blocks and the ordered pipeline. The only user of oneTBB.
#include "src/lanes/tiles.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <vector>

namespace spectile::tiles {

int thread_count(int requested) {
  return requested > 0 ? requested : std::max(1, tbb::info::default_concurrency());
}

namespace {

/// oneTBB keeps one worker less than the cores; more threads than that, where asked for, need a word to it.
class Allowance {
 public:
  explicit Allowance(int threads)
      : control_(tbb::global_control::max_allowed_parallelism, allowed(threads)) {}

 private:
  static std::size_t allowed(int threads) {
    return static_cast<std::size_t>(std::max(threads, tbb::info::default_concurrency()));
  }
  tbb::global_control control_;
};

}  // namespace

void for_blocks(std::size_t blocks, const Execution& execution,
                const std::function<void(std::size_t first, std::size_t count)>& work) {
  const std::size_t tile = std::max<std::size_t>(1, blocks_for(execution.tile_lanes));
  const std::size_t tiles = (blocks + tile - 1) / tile;
  const auto run = [&](std::size_t t) { work(t * tile, std::min(tile, blocks - t * tile)); };
  const int threads = thread_count(execution.threads);
  if (threads == 1 || tiles <= 1) {
    for (std::size_t t = 0; t < tiles; ++t) run(t);
    return;
  }
  const Allowance allowance(threads);
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, tiles, run, tbb::simple_partitioner{}); });
}

void ordered_pipeline(std::size_t items, int threads, const std::function<bool(std::size_t slot)>& produce,
                      const std::function<void(std::size_t slot)>& transform,
                      const std::function<void(std::size_t slot)>& consume) {
  const int count = thread_count(threads);
  if (count == 1) {
    while (produce(0)) {
      transform(0);
      consume(0);
    }
    return;
  }
  std::mutex mutex;
  std::vector<std::size_t> free(items);
  for (std::size_t i = 0; i < items; ++i) free[i] = items - 1 - i;
  const Allowance allowance(count);
  tbb::task_arena arena(count);
  arena.execute([&] {
    tbb::parallel_pipeline(
        items,
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                            [&](tbb::flow_control& control) -> std::size_t {
                                              std::size_t slot = 0;
                                              {
                                                const std::scoped_lock lock(mutex);
                                                slot = free.back();
                                                free.pop_back();
                                              }
                                              if (!produce(slot)) control.stop();
                                              return slot;
                                            }) &
            tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel,
                                                       [&](std::size_t slot) {
                                                         transform(slot);
                                                         return slot;
                                                       }) &
            tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, [&](std::size_t slot) {
              consume(slot);
              const std::scoped_lock lock(mutex);
              free.push_back(slot);
            }));
  });
}

}  // namespace spectile::tiles
