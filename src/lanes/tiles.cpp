// Tiles over threads: the parallel loop over blocks and the ordered pipeline. The only user of oneTBB.
#include "src/lanes/tiles.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <spectile/threads.hpp>
#include <vector>

#include "src/lanes/handover.hpp"

namespace spectile::tiles {

int thread_count(int requested) {
  return requested > 0 ? requested : std::max(1, tbb::info::default_concurrency());
}

namespace {

/// The worker threads of oneTBB, made one after the other by the thread that asks for them. Left to itself
/// oneTBB has its workers make each other, and ends the process where one of them cannot.
class Workers {
 public:
  Workers() { created_.give(); }

  /// Sees to it that calls can run on `threads` threads, the calling one among them. Returns how many there
  /// are.
  int make(int threads) {
    if (threads <= ready_.load(std::memory_order_acquire)) return threads;
    const std::scoped_lock lock(mutex_);
    const int ready = ready_.load(std::memory_order_relaxed);
    // A failed attempt is not repeated: each leaves oneTBB one worker short of those it counts.
    if (threads > ready && !failed_) {
      failed_ = !grow(threads);
      if (!failed_) ready_.store(threads, std::memory_order_release);
    }
    return std::min(threads, ready_.load(std::memory_order_relaxed));
  }

  /// True where the system refused a thread, or memory ended while one was made.
  bool failed() const noexcept { return failed_; }

 private:
  /// Memory that is full shows here, and not in the middle of oneTBB. Throws: std::bad_alloc.
  static void make_room() {
    // No new expression: a compiler may leave those out.
    ::operator delete(::operator new(kRoomToStart));
  }

  /// Objects of oneTBB that exist while its workers are made.
  struct Start {
    std::optional<tbb::global_control> allowance;
    std::vector<std::unique_ptr<tbb::task_arena>> arenas;
  };

  /// Keeps every worker busy until the last one is there, so that none of them makes the next. Returns false
  /// where the system refuses one; ready_ then counts those that were made.
  bool grow(int threads) {
    std::unique_ptr<Start> start;
    const int round = begin_round();
    int made = 1;
    bool refused = false;
    try {
      make_room();
      start = std::make_unique<Start>();
      start->allowance.emplace(tbb::global_control::max_allowed_parallelism,
                               static_cast<std::size_t>(threads));
      for (; made < threads; ++made) {
        start->arenas.push_back(std::make_unique<tbb::task_arena>(2, 1));
        start->arenas.back()->enqueue([this, round] { wait_inside(round); });
        std::unique_lock lock(gate_);
        // Workers that are busy elsewhere in this process exist already.
        constexpr auto kLongest = std::chrono::milliseconds(100);
        if (!changed_.wait_for(lock, kLongest, [&] { return inside_ == made; })) break;
      }
    } catch (const std::bad_alloc&) {
      // Those that exist stay, and oneTBB is left alone from here: it waits forever for those it could not
      // make, also in their destructors.
      static_cast<void>(start.release());
      ready_.store(1, std::memory_order_release);
      begin_round();
      return false;
    } catch (const std::exception&) {
      refused = true;
    }
    begin_round();
    if (refused) ready_.store(std::max(made, ready_.load()), std::memory_order_release);
    return !refused;
  }

  /// Lets those go who wait in the last round. Returns the new one's number.
  int begin_round() {
    const std::scoped_lock lock(gate_);
    inside_ = 0;
    changed_.notify_all();
    return ++round_;
  }

  /// Waits for the end of a round; one that begins after it does not wait.
  void wait_inside(int round) {
    created_.take();
    std::unique_lock lock(gate_);
    if (round_ != round) return;
    ++inside_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return round_ != round; });
  }

  static constexpr std::size_t kRoomToStart = 64
                                              << 10;  // bytes; oneTBB 2021.8 takes 7 KiB for its first worker

  std::atomic<int> ready_ = 1;  // threads that calls can run on
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  // Where workers wait for each other.
  std::mutex gate_;
  std::condition_variable changed_;
  int inside_ = 0;
  int round_ = 0;
  Handover created_;
};

Workers& workers() {
  // Never destroyed: calls of other threads may outlast any destructor.
  static Workers* const instance = new Workers;
  return *instance;
}

/// Threads of a call, and what oneTBB must be told for them: it keeps one worker less than the cores.
class Allowance {
 public:
  explicit Allowance(int threads)
      : control_(tbb::global_control::max_allowed_parallelism, allowed(threads)) {}

 private:
  static std::size_t allowed(int threads) {
    return static_cast<std::size_t>(workers().failed() ? threads
                                                       : std::max(threads, tbb::info::default_concurrency()));
  }
  tbb::global_control control_;
};

}  // namespace

void for_blocks(std::size_t blocks, const Execution& execution,
                const std::function<void(std::size_t first, std::size_t count)>& work) {
  const std::size_t tile = std::max<std::size_t>(1, blocks_for(execution.tile_lanes));
  const std::size_t tiles = (blocks + tile - 1) / tile;
  const auto run = [&](std::size_t t) { work(t * tile, std::min(tile, blocks - t * tile)); };
  const int threads = tiles <= 1 ? 1 : available_threads(execution.threads);
  if (threads == 1) {
    for (std::size_t t = 0; t < tiles; ++t) run(t);
    return;
  }
  const Allowance allowance(threads);
  Handover begin;
  Handover end;
  const auto run_task = [&](std::size_t t) {
    begin.take();
    const GiveAtEnd done(end);
    run(t);
  };
  tbb::task_arena arena(threads);
  begin.give();
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, tiles, run_task, tbb::simple_partitioner{}); });
  end.take();
}

void ordered_pipeline(std::size_t items, int threads, const std::function<bool(std::size_t slot)>& produce,
                      const std::function<void(std::size_t slot)>& transform,
                      const std::function<void(std::size_t slot)>& consume) {
  const int count = available_threads(threads);
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
  // The stages that run one item at a time, and the way of each item through all of them.
  Handover producing;
  Handover consuming;
  std::vector<Handover> item(items);
  const auto produce_next = [&](tbb::flow_control& control) -> std::size_t {
    producing.take();
    const GiveAtEnd done(producing);
    std::size_t slot = 0;
    {
      const std::scoped_lock lock(mutex);
      slot = free.back();
      free.pop_back();
    }
    const GiveAtEnd produced(item[slot]);
    if (!produce(slot)) control.stop();
    return slot;
  };
  const auto transform_item = [&](std::size_t slot) {
    item[slot].take();
    const GiveAtEnd transformed(item[slot]);
    transform(slot);
    return slot;
  };
  const auto consume_item = [&](std::size_t slot) {
    consuming.take();
    const GiveAtEnd done(consuming);
    item[slot].take();
    consume(slot);
    const std::scoped_lock lock(mutex);
    free.push_back(slot);
  };
  const Allowance allowance(count);
  tbb::task_arena arena(count);
  producing.give();
  consuming.give();
  arena.execute([&] {
    using tbb::filter_mode;
    tbb::parallel_pipeline(
        items, tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, produce_next) &
                   tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, transform_item) &
                   tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, consume_item));
  });
  producing.take();
  consuming.take();
}

}  // namespace spectile::tiles

namespace spectile {

int available_threads(int requested) {
  return tiles::workers().make(tiles::thread_count(requested));
}

bool threads_refused() noexcept {
  return tiles::workers().failed();
}

}  // namespace spectile
