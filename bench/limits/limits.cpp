// The machine's own limits: how fast it loads, stores, copies, multiplies and divides.
#include "bench/limits/limits.hpp"

#include <algorithm>

#include "src/lanes/tiles.hpp"

namespace spectile::measure {
namespace {

using kernels::kLanes;
using kernels::kPeakChains;

/// Steps of a chain: a few microseconds, against which starting counts for nothing.
constexpr std::size_t kSteps = 256;

/// Calls work(first float, floats) for each thread's part of the memory, so often in a row.
template <class Work>
std::function<void()> in_parts(std::size_t floats, int threads, std::size_t passes, Work work) {
  return [=] {
    over_parts(floats / kLanes, threads, passes,
               [&](std::size_t first, std::size_t count) { work(first * kLanes, count * kLanes); });
  };
}

double rate(double amount, const Timed& timed) {
  return timed.seconds > 0 ? amount / timed.seconds : 0;
}

}  // namespace

std::size_t passes_at(MemoryLevel level) {
  return level == MemoryLevel::kCache ? 16 : 1;
}

void over_parts(std::size_t blocks, int threads, std::size_t passes,
                const std::function<void(std::size_t first, std::size_t count)>& work) {
  const auto parts = static_cast<std::size_t>(threads);
  tiles::for_blocks(blocks, {threads, (blocks + parts - 1) / parts * kLanes},
                    [&](std::size_t first, std::size_t count) {
                      for (std::size_t i = 0; i < passes; ++i) work(first, count);
                    });
}

LimitLoops::LimitLoops(const kernels::KernelTable& table, float* memory, std::size_t floats, int threads,
                       MemoryLevel level)
    : isa_(table.name), threads_(threads), level_(level) {
  // The target of a copy starts half a page and a line behind a whole page from its source: loads would wait
  // for stores whose addresses end alike.
  constexpr std::size_t kApart = 544;
  const std::size_t half = (floats - kApart) / 2 / 1024 * 1024;
  const std::size_t passes = passes_at(level);
  bytes_ = static_cast<double>(2 * half * sizeof(float) * passes);
  std::fill_n(memory, floats, 1.0F);
  const kernels::KernelTable* k = &table;
  load_.run = in_parts(2 * half, threads, passes, [=](std::size_t first, std::size_t n) {
    std::uint32_t bits[kLanes];
    k->peak_load(bits, memory + first, n);
  });
  store_.run = in_parts(2 * half, threads, passes, [=](std::size_t first, std::size_t n) {
    k->peak_store(memory + first, 1.0F, n, false);
  });
  stream_.run = in_parts(2 * half, threads, passes, [=](std::size_t first, std::size_t n) {
    k->peak_store(memory + first, 1.0F, n, true);
  });
  copy_.run = in_parts(half, threads, passes, [=](std::size_t first, std::size_t n) {
    k->peak_copy(memory + half + kApart + first, memory + first, n);
  });
  // Arithmetic needs no memory to speak of: a few kilobytes a thread.
  const std::size_t chains = 4 * kPeakChains;
  steps_ = static_cast<double>(chains) * static_cast<double>(kSteps) * threads;
  const auto chain = [&](auto step) {
    return [=] {
      tiles::for_blocks(static_cast<std::size_t>(threads), {threads, kLanes},
                        [&](std::size_t first, std::size_t count) {
                          alignas(64) float x[chains];
                          for (std::size_t i = first; i < first + count; ++i) {
                            std::fill_n(x, chains, 1.0F);
                            step(x);
                          }
                        });
    };
  };
  multiply_add_.run = chain([=](float* x) { k->peak_multiply_add(x, x, 0.999F, 1e-3F, kSteps, chains); });
  fused_.run = chain([=](float* x) { k->peak_fused(x, x, 0.999F, 1e-3F, kSteps, chains); });
  divide_.run = chain([=](float* x) { k->peak_divide(x, x, 1.5F, kSteps, chains); });
}

std::vector<Timed*> LimitLoops::timed() {
  return {&load_, &store_, &stream_, &copy_, &multiply_add_, &fused_, &divide_};
}

MachineLimit LimitLoops::limit() const {
  MachineLimit out;
  out.isa = isa_;
  out.threads = threads_;
  out.level = level_;
  out.load = rate(bytes_, load_);
  out.store = rate(bytes_, store_);
  out.stream = rate(bytes_, stream_);
  out.copy = rate(bytes_, copy_);
  out.multiply_add = rate(2 * steps_, multiply_add_);
  out.fused_multiply_add = rate(steps_, fused_);
  out.divide = rate(steps_, divide_);
  out.spread = std::max({load_.spread, store_.spread, stream_.spread, copy_.spread, multiply_add_.spread,
                         fused_.spread, divide_.spread});
  return out;
}

double LimitLoops::item_seconds(std::size_t round, const Cost& cost, bool non_temporal,
                                std::string* bottleneck) const {
  const auto per_byte = [&](const Timed& t) { return t.rounds[round] / bytes_; };
  const double load = per_byte(load_);
  const double copy = per_byte(copy_);
  double memory = 0;
  const char* name = "load";
  if (non_temporal) {
    memory = cost.read_bytes * load + cost.written_bytes * per_byte(stream_);
    name = cost.written_bytes > 0 ? "stream" : "load";
  } else {
    // Bytes both read and written are copied at best; the rest is loaded or stored.
    const double both = std::min(cost.read_bytes, cost.written_bytes);
    const double more = std::max(cost.read_bytes, cost.written_bytes) - both;
    const bool reads = cost.read_bytes > cost.written_bytes;
    memory = 2 * both * copy + more * (reads ? load : per_byte(store_));
    name = more > 2 * both ? (reads ? "load" : "store") : "copy";
  }
  const double arithmetic = cost.operations * multiply_add_.rounds[round] / (2 * steps_) +
                            cost.divisions * divide_.rounds[round] / steps_;
  if (bottleneck != nullptr) {
    const bool divider = cost.divisions * divide_.rounds[round] / steps_ > 0.5 * arithmetic;
    *bottleneck = memory >= arithmetic ? name : divider ? "divide" : "multiply-add";
  }
  return std::max(memory, arithmetic);
}

double LimitLoops::fraction(const Timed& work, double items, const Cost& cost, bool non_temporal,
                            std::string* bottleneck) const {
  Timed limit;
  Timed actual;
  for (std::size_t round = 0; round < std::min(work.rounds.size(), load_.rounds.size()); ++round) {
    limit.rounds.push_back(items * item_seconds(round, cost, non_temporal, bottleneck));
    actual.rounds.push_back(work.rounds[round]);
  }
  return median_ratio(limit, actual);
}

}  // namespace spectile::measure
