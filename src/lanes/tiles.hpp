// Tiles over threads: the parallel loop over blocks and the ordered pipeline.
#pragma once

#include <cstddef>
#include <functional>
#include <spectile/lanes/sampled_spectra.hpp>

namespace spectile::tiles {

/// Threads that `requested` stands for: itself, or every core this process may use when 0 or less.
int thread_count(int requested);

/// Calls work(first_block, count) for tiles that cover [0, blocks), in parallel. `work` must not throw.
void for_blocks(std::size_t blocks, const Execution& execution,
                const std::function<void(std::size_t first, std::size_t count)>& work);

/// Runs a pipeline of items: `produce(item)` in order, one at a time, false at the end; `transform(item)` in
/// parallel; `consume(item)` in the order produced, one at a time. At most `items` are under way; item i is
/// slot number i of 0..items-1, not shared by two that are under way at once. None may throw.
void ordered_pipeline(std::size_t items, int threads, const std::function<bool(std::size_t slot)>& produce,
                      const std::function<void(std::size_t slot)>& transform,
                      const std::function<void(std::size_t slot)>& consume);

}  // namespace spectile::tiles
