// Entries sorted by the locks of their tiles, and added under them.
#include "src/film/entries.hpp"

#include <algorithm>
#include <mutex>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

using kernels::FilmEntries;
using kernels::KernelTable;
using kernels::kFilmTilePixels;
using State = FilmAccess::State;

constexpr int kTileShift = 2 * kernels::kFilmTileLog2;
static_assert(kFilmTilePixels == std::size_t{1} << kTileShift);

/// Additions to a tile after which its carries are normalized: with what a chunk adds on top, no rest of 2^43
/// steps a contribution comes near the end of its limb.
constexpr std::uint64_t kNormalizeAfter = std::uint64_t{1} << 18;

/// Runs within a tile that are taken one by one, and entries that each must hold for that to pay: else they
/// are sorted first.
constexpr std::size_t kMaxRuns = 128;
constexpr std::size_t kEntriesARun = 8;

std::size_t tile_index(std::int32_t address) {
  return static_cast<std::size_t>(address) >> kTileShift;
}

/// A tile is about to get `count` more entries, each of `weight` contributions to a pixel at most. Its mutex
/// held. False where there is no memory.
bool reserve_tile(State& s, std::size_t tile, std::size_t count, std::size_t weight) {
  if (s.touch(tile) == nullptr) return false;
  // Before these are counted: they are not in yet, and must not pass for normalized.
  if (s.additions[tile] + count * weight - s.normalized[tile] > kNormalizeAfter) s.normalize_carries(tile);
  s.additions[tile] += count * weight;
  return true;
}

/// Has the processor fetch what will be added to of a pixel, all of a share's pixels at once: one after the
/// other each would be waited for.
void prefetch_pixel(const State& s, const std::int64_t* tile, std::size_t pixel) {
  constexpr int kToWrite = 1;
  const FilmTileLayout& l = s.layout;
  for (std::size_t q = 0; q < l.quads; ++q) {
    __builtin_prefetch(tile + kernels::kFilmQuadLimbs * (pixel * l.quads + q), kToWrite);
  }
  if (l.moments) __builtin_prefetch(tile + l.moments_at + kernels::kFilmMomentLimbs * pixel, kToWrite);
}

/// Adds entries whose tiles have memory and whose mutexes are held.
void run_kernels(State& s, const KernelTable& table, const FilmContributions& c, const FilmEntries& entries,
                 const FilmScratch& scratch) {
  const FilmTileLayout& l = s.layout;
  std::int64_t* const* const tiles = s.tiles.data();
  for (std::size_t q = 0; q < l.quads; ++q) {
    table.film_add({tiles, kernels::kFilmQuadLimbs * q, kernels::kFilmQuadLimbs * l.quads}, s.grid, entries,
                   scratch.quads.data() + q * scratch.quad_floats, 1);
  }
  const kernels::FilmSums spectrum = {tiles, l.spectrum_at, l.spectrum_limbs()};
  if (l.bands > 0 && l.own_weights) {
    table.film_add_hits(spectrum, s.band_grid, entries,
                        {scratch.band.data(), scratch.hits.data(), c.wavelengths, c.samples});
  } else if (l.bands > 0) {
    table.film_add(spectrum, s.band_grid, entries, scratch.band_quads.data(), l.band_quads());
  }
  if (l.moments) {
    table.film_add_moments({tiles, l.moments_at, kernels::kFilmMomentLimbs}, s.moment_grid, entries,
                           scratch.quads.data());
  }
  if (l.counts) table.film_count({tiles, l.counts_at, 1}, entries);
}

Error no_memory() {
  return make_error(ErrorCode::kOutOfMemory, "no memory for another tile of the film");
}

/// The entries from `first` on, all in `tile` unless that is -1.
FilmEntries subrange(const FilmEntries& e, std::size_t first, std::size_t count, std::int32_t tile,
                     std::uint32_t* numbers) {
  FilmEntries out = {e.sample, e.address + first, e.factor, count, tile};
  if (out.factor != nullptr) out.factor += first;
  if (out.sample != nullptr) {
    out.sample += first;
  } else if (first > 0) {
    for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(first + i);
    out.sample = numbers;
  }
  return out;
}

/// Sorts entries by the mutex of their tiles, in their order within each; `ends` gets where each share ends.
FilmEntries sort_by_stripe(const FilmEntries& e, FilmScratch& scratch,
                           std::array<std::size_t, State::kStripes>& ends) {
  scratch.sorted_address.resize(std::max(scratch.sorted_address.size(), e.count));
  scratch.sorted_sample.resize(std::max(scratch.sorted_sample.size(), e.count));
  if (e.factor != nullptr) scratch.sorted_factor.resize(std::max(scratch.sorted_factor.size(), e.count));
  std::array<std::size_t, State::kStripes> next{};
  const auto stripe_index = [](std::int32_t address) { return tile_index(address) % State::kStripes; };
  for (std::size_t i = 0; i < e.count; ++i) {
    if (e.address[i] >= 0) ++next[stripe_index(e.address[i])];
  }
  std::size_t sum = 0;
  for (std::size_t& v : next) sum += std::exchange(v, sum);
  for (std::size_t i = 0; i < e.count; ++i) {
    if (e.address[i] < 0) continue;
    const std::size_t to = next[stripe_index(e.address[i])]++;
    scratch.sorted_address[to] = e.address[i];
    scratch.sorted_sample[to] = e.sample == nullptr ? static_cast<std::uint32_t>(i) : e.sample[i];
    if (e.factor != nullptr) scratch.sorted_factor[to] = e.factor[i];
  }
  ends = next;
  return {scratch.sorted_sample.data(), scratch.sorted_address.data(),
          e.factor == nullptr ? nullptr : scratch.sorted_factor.data(), sum};
}

}  // namespace

Result<void> add_entries(State& s, const KernelTable& table, const FilmContributions& contributions,
                         const FilmEntries& entries, FilmScratch& scratch) {
  const std::size_t weight = s.layout.bands > 0 && s.layout.own_weights ? contributions.wavelengths : 1;
  if (entries.tile >= 0) {
    const auto tile = static_cast<std::size_t>(entries.tile);
    const std::scoped_lock lock(s.tile_mutex(tile));
    if (!reserve_tile(s, tile, entries.count, weight)) return no_memory();
    run_kernels(s, table, contributions, entries, scratch);
    return {};
  }
  // Runs of entries in one tile; those that reach no pixel belong to the run around them.
  std::array<std::size_t, kMaxRuns> run_ends{};
  std::array<std::size_t, kMaxRuns> run_tiles{};
  const std::size_t most = std::clamp<std::size_t>(entries.count / kEntriesARun, 1, kMaxRuns);
  std::size_t runs = 0;
  std::int32_t last = -1;
  for (std::size_t i = 0; i < entries.count && runs <= most; ++i) {
    const std::int32_t tile = entries.address[i] >> kTileShift;
    if (tile == last || entries.address[i] < 0) continue;
    if (runs > 0) run_ends[runs - 1] = i;
    if (runs < most) run_tiles[runs] = static_cast<std::size_t>(tile);
    ++runs;
    last = tile;
  }
  if (runs == 0) return {};
  if (runs <= most) {
    run_ends[runs - 1] = entries.count;
    scratch.sample.resize(std::max(scratch.sample.size(), entries.count));
    std::size_t first = 0;
    for (std::size_t r = 0; r < runs; ++r) {
      const std::scoped_lock lock(s.tile_mutex(run_tiles[r]));
      if (!reserve_tile(s, run_tiles[r], run_ends[r] - first, weight)) return no_memory();
      run_kernels(s, table, contributions,
                  subrange(entries, first, run_ends[r] - first, static_cast<std::int32_t>(run_tiles[r]),
                           scratch.sample.data()),
                  scratch);
      first = run_ends[r];
    }
    return {};
  }
  std::array<std::size_t, State::kStripes> ends{};
  const FilmEntries sorted = sort_by_stripe(entries, scratch, ends);
  for (std::size_t stripe = 0; stripe < State::kStripes; ++stripe) {
    const std::size_t first = stripe == 0 ? 0 : ends[stripe - 1];
    if (first == ends[stripe]) continue;
    const std::scoped_lock lock(s.stripes[stripe].mutex);
    for (std::size_t i = first; i < ends[stripe];) {
      const std::size_t tile = tile_index(sorted.address[i]);
      std::size_t end = i + 1;
      while (end < ends[stripe] && tile_index(sorted.address[end]) == tile) ++end;
      if (!reserve_tile(s, tile, end - i, weight)) return no_memory();
      for (; i < end; ++i) {
        prefetch_pixel(s, s.tiles[tile], static_cast<std::size_t>(sorted.address[i]) % kFilmTilePixels);
      }
    }
    run_kernels(s, table, contributions, subrange(sorted, first, ends[stripe] - first, -1, nullptr), scratch);
  }
  return {};
}

}  // namespace spectile
