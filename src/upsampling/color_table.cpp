// ColorTable: the coefficients of every colour that was solved, so that each is solved once.
#include "src/upsampling/color_table.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <thread>

#include "src/base/errors.hpp"

namespace spectile::rows {
namespace {

// Entries at most: 32 MiB.
constexpr std::uint64_t kMaxEntries = std::uint64_t{1} << 20;
// Entries that are probed for a colour.
constexpr std::uint32_t kProbes = 16;
// Lanes after which a batch evaluates whether the table pays, and lines of the back-off where it does not.
constexpr std::uint64_t kEvaluatedLanes = 4096;
constexpr int kMinBackOff = 16;
constexpr int kMaxBackOff = 1024;

// An entry's state, in the order in which it goes through them.
constexpr std::uint32_t kFree = 0;
constexpr std::uint32_t kClaimed = 1;  // the colour is not there yet
constexpr std::uint32_t kNamed = 2;    // its coefficients are not
constexpr std::uint32_t kInside = 3;
constexpr std::uint32_t kOutside = 4;

std::uint32_t hash_color(const float* const rgb[3], std::size_t i) {
  // Odd constants from the digits of the golden ratio and of e.
  std::uint64_t h = std::bit_cast<std::uint32_t>(rgb[0][i]) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ std::bit_cast<std::uint32_t>(rgb[1][i])) * 0xB7E151628AED2A6BULL;
  h = (h ^ (h >> 29) ^ std::bit_cast<std::uint32_t>(rgb[2][i])) * 0x9E3779B97F4A7C15ULL;
  return static_cast<std::uint32_t>(h >> 32);
}

/// A state that others are about to leave, once they have.
std::uint32_t after(const std::atomic<std::uint32_t>& state, std::uint32_t passing) {
  std::uint32_t now = state.load(std::memory_order_acquire);
  for (int spins = 0; now <= passing && now != kFree; now = state.load(std::memory_order_acquire)) {
    if (++spins > 64) std::this_thread::yield();
  }
  return now;
}

}  // namespace

Result<ColorTable::Batch> ColorTable::Batch::create(std::size_t lanes) {
  Batch batch;
  const std::size_t padded = blocks_for(lanes) * kLanesPerBlock;
  SPECTILE_ASSIGN(batch.memory_, FloatBuffer::create(7 * padded));
  for (std::size_t k = 0; k < 3; ++k) batch.rgb_[k] = batch.memory_.data() + k * padded;
  for (std::size_t k = 0; k < 4; ++k) batch.c_[k] = batch.memory_.data() + (3 + k) * padded;
  batch.unsolved_.resize(padded / kLanesPerBlock);
  batch.outside_.resize(padded);
  batch.hash_.resize(lanes);
  batch.place_.resize(lanes);
  batch.claimed_.resize(lanes);
  return batch;
}

ColorTable::ColorTable(const kernels::KernelTable& kernels, const Upsampler& upsampler, GamutPolicy policy,
                       std::uint64_t lanes)
    : kernels_(kernels), upsampler_(upsampler), policy_(policy) {
  const std::uint64_t entries = std::clamp<std::uint64_t>(std::bit_ceil(2 * lanes), 1024, kMaxEntries);
  entries_ = std::make_unique<Entry[]>(entries);
  mask_ = static_cast<std::uint32_t>(entries - 1);
}

bool ColorTable::worth_while(Batch& batch) const {
  if (batch.idle_lines_ > 0) {
    --batch.idle_lines_;
    return false;
  }
  if (batch.recent_lanes_ >= kEvaluatedLanes) {
    // Looking a colour up costs about as much as half a solution.
    const bool good = 2 * batch.recent_colors_ <= batch.recent_lanes_;
    batch.recent_lanes_ = batch.recent_colors_ = 0;
    batch.back_off_ = good ? 0 : std::clamp(4 * batch.back_off_, kMinBackOff, kMaxBackOff);
    batch.idle_lines_ = batch.back_off_;
  }
  return true;
}

std::int64_t ColorTable::find(const std::uint32_t rgb[3], std::uint32_t hash, bool& claimed) {
  for (std::uint32_t probe = 0; probe < kProbes; ++probe) {
    const std::uint32_t at = (hash + probe) & mask_;
    Entry& entry = entries_[at];
    std::uint32_t state = kFree;
    if (entry.state.load(std::memory_order_relaxed) == kFree &&
        entry.state.compare_exchange_strong(state, kClaimed, std::memory_order_acquire)) {
      std::copy_n(rgb, 3, entry.rgb);
      entry.state.store(kNamed, std::memory_order_release);
      claimed = true;
      return at;
    }
    after(entry.state, kClaimed);
    if (std::equal(rgb, rgb + 3, entry.rgb)) return at;
  }
  return -1;
}

void ColorTable::add(Batch& batch, const float* const rgb[3], std::size_t n) {
  // Hashes first, so that the entries are on their way when they are looked at.
  for (std::size_t i = 0; i < n; ++i) batch.hash_[i] = hash_color(rgb, i);
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < n; ++i) {
    if (i + kAhead < n) __builtin_prefetch(&entries_[batch.hash_[i + kAhead] & mask_]);
    const std::uint32_t bits[3] = {std::bit_cast<std::uint32_t>(rgb[0][i]),
                                   std::bit_cast<std::uint32_t>(rgb[1][i]),
                                   std::bit_cast<std::uint32_t>(rgb[2][i])};
    const std::size_t lane = batch.lanes_++;
    if (i > 0 && batch.hash_[i] == batch.hash_[i - 1] &&
        bits[0] == std::bit_cast<std::uint32_t>(rgb[0][i - 1]) &&
        bits[1] == std::bit_cast<std::uint32_t>(rgb[1][i - 1]) &&
        bits[2] == std::bit_cast<std::uint32_t>(rgb[2][i - 1])) {
      batch.place_[lane] = batch.place_[lane - 1];
      continue;
    }
    bool claimed = false;
    const std::int64_t place = find(bits, batch.hash_[i], claimed);
    batch.place_[lane] = place;
    if (place >= 0 && !claimed) continue;
    const std::size_t color = batch.colors_++;
    if (place < 0) batch.place_[lane] = -1 - static_cast<std::int64_t>(color);
    batch.claimed_[color] = place;
    for (std::size_t k = 0; k < 3; ++k) batch.rgb_[k][color] = rgb[k][i];
  }
  batch.looked_up += n;
}

void ColorTable::solve(Batch& batch) {
  const std::size_t n = batch.colors_;
  batch.recent_lanes_ += batch.lanes_;
  batch.recent_colors_ += n;
  batch.solved += n;
  if (n == 0) return;
  const std::size_t padded = blocks_for(n) * kLanesPerBlock;
  batch.lanes_solved += padded;
  for (float* const row : batch.rgb_) std::fill(row + n, row + padded, 0.0F);
  const bool scaled = has_scale(upsampler_);
  const auto start = std::chrono::steady_clock::now();
  gamut_clip(kernels_, upsampler_, batch.rgb_, policy_, n, batch.outside_.data());
  rows::solve(kernels_, upsampler_, batch.rgb_,
              {{batch.c_[0], batch.c_[1], batch.c_[2]}, scaled ? batch.c_[3] : nullptr},
              batch.unsolved_.data(), padded);
  batch.solving_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (std::size_t i = 0; i < n; ++i) {
    if (batch.claimed_[i] < 0) continue;
    Entry& entry = entries_[static_cast<std::size_t>(batch.claimed_[i])];
    for (std::size_t k = 0; k < (scaled ? 4U : 3U); ++k) entry.c[k] = batch.c_[k][i];
    entry.state.store(batch.outside_[i] != 0 ? kOutside : kInside, std::memory_order_release);
  }
}

void ColorTable::take(const Batch& batch, std::size_t first, std::size_t n, const Coefficients& out,
                      std::uint8_t* outside) const {
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t place = batch.place_[first + i];
    if (place < 0) {
      const auto color = static_cast<std::size_t>(-1 - place);
      for (std::size_t k = 0; k < 3; ++k) out.c[k][i] = batch.c_[k][color];
      if (out.scale != nullptr) out.scale[i] = batch.c_[3][color];
      outside[i] = batch.outside_[color];
      continue;
    }
    const Entry& entry = entries_[static_cast<std::size_t>(place)];
    // Whoever claimed it solves it before waiting for others, so this ends.
    outside[i] = after(entry.state, kNamed) == kOutside ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) out.c[k][i] = entry.c[k];
    if (out.scale != nullptr) out.scale[i] = entry.c[3];
  }
}

void ColorTable::clear(Batch& batch) {
  batch.lanes_ = batch.colors_ = 0;
}

}  // namespace spectile::rows
