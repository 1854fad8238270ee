// The film: samples a second in every order, against the textbook's film, ordinary sums, and what memory
// allows, with the error of the pixels beside each. usage: spectile_bench_film [--quick]
//
// What samples carry (radiance, wavelengths, densities; 4096 samples of them) stays in the second-level cache
// for all alike; positions come from memory, and films of 1920 x 1080 pixels do not fit into a core's caches.
// A pass over all samples is a repetition; lines take turns in random order. First touch of a film's memory
// is measured apart.
#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <random>

#include "bench/micro/film_lines.hpp"
#include "bench/micro/machine.hpp"

namespace {

using bench::Line;
using Clock = std::chrono::steady_clock;

// Enough for quartiles, and few enough for three minutes; on a slow or busy machine fewer.
constexpr std::size_t kRounds = 9;
constexpr std::size_t kQuickRounds = 2;
constexpr double kMaxSeconds = 140;
/// Floats that are copied: a GiB read and written, beyond what the caches of today's servers hold.
constexpr std::size_t kCopied = std::size_t{1} << 27;
/// What a sample carries beside its position: 4 wavelengths with radiance and density, and a weight.
constexpr double kSampleBytes = 52;

struct Timed {
  Line line;
  double first_touch = 0;  // seconds, as all
  double error = 0;
  std::vector<double> seconds;

  double quantile(double q) const {
    return seconds[static_cast<std::size_t>(q * static_cast<double>(seconds.size() - 1) + 0.5)];
  }
  double rate() const { return line.samples / quantile(0.5); }
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_of(const std::function<void()>& what) {
  const auto start = Clock::now();
  what();
  return seconds_since(start);
}

/// Names are those of a line without its order.
struct Comparison {
  std::string line, baseline;
  double tile_target = 0, random_target = 0;  // least ratios; 0 for none
};

// Targets: those of the film's specification.
const std::vector<Comparison> kComparisons = {
    {"spectile", "textbook", 6, 3},
    {"spectile", "textbook, hand-tuned"},
    {"spectile", "plain doubles", 0.6, 0.6},
    {"spectile, drawing", "textbook, drawing"},
    {"spectile, 60 buckets", "textbook, 60 buckets"},
    {"spectile, variance", "spectile"},
    {"spectile, batches of 512", "spectile"},
    {"spectile, batches of 65536", "spectile"},
    {"spectile, 2 threads", "spectile"},
};

void print_lines(const std::vector<Timed>& lines, double copy_rate) {
  fmt::print("{:<28} {:<16} {:>10} {:>10} {:>7} {:>12} {:>9} {:>8} {:>9}\n", "", "order", "Msample/s",
             "ns/sample", "spread", "first touch", "error", "B/pixel", "of copy");
  for (const Timed& t : lines) {
    const double median = t.quantile(0.5);
    fmt::print("{:<28} {:<16} {:>10.1f} {:>10.2f} {:>6.1f}% {:>9.2f} ns {:>9.1e} {:>8} {:>8.0f}%\n",
               t.line.name, t.line.order, t.rate() * 1e-6, median / t.line.samples * 1e9,
               50 * (t.quantile(0.75) - t.quantile(0.25)) / median, t.first_touch / t.line.samples * 1e9,
               t.error, t.line.bytes_per_pixel, 100 * t.line.bytes * t.rate() / copy_rate);
  }
}

int print_ratios(const std::vector<Timed>& lines) {
  int missed = 0;
  fmt::print("\n{:<28} {:<24} {:<16} {:>7} {:>10} {:>7}\n", "", "against", "order", "ratio", "best/best",
             "target");
  for (const Comparison& c : kComparisons) {
    for (const Timed& t : lines) {
      if (t.line.name != c.line) continue;
      const auto base = std::find_if(lines.begin(), lines.end(), [&](const Timed& b) {
        return b.line.name == c.baseline && b.line.order == t.line.order;
      });
      if (base == lines.end()) continue;
      const double ratio = t.rate() / base->rate();
      // Of the fastest passes, which other load on the machine disturbs least.
      const double best = (t.line.samples / t.seconds[0]) / (base->line.samples / base->seconds[0]);
      const double target = t.line.order == "random"           ? c.random_target
                            : t.line.order.starts_with("tile") ? c.tile_target
                                                               : 0;
      fmt::print("{:<28} {:<24} {:<16} {:>7.2f} {:>10.2f}", c.line, c.baseline, t.line.order, ratio, best);
      if (target > 0) {
        missed += ratio < target ? 1 : 0;
        fmt::print(" {:>7.1f} {}", target, ratio < target ? "MISSED" : "met");
      }
      fmt::print("\n");
    }
  }
  return missed;
}

void print_limits(double copy_rate) {
  const auto limit = [&](double bytes) {
    return fmt::format("{:.0f} M/s at {:.0f} B", copy_rate / bytes * 1e-6, bytes);
  };
  fmt::print(
      "\ncopying memory: {:.1f} GB/s, read and written counted. Of samples at random with 64 bytes a pixel "
      "it "
      "allows {} (position and pixel, as here), or {} where all that a sample carries comes from memory; a "
      "film that a shared cache holds goes beyond\n",
      copy_rate * 1e-9, limit(8 + 128), limit(8 + kSampleBytes + 128));
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc == 2 && std::strcmp(argv[1], "--quick") == 0;
  if (argc > 1 && !quick) {
    fmt::print(stderr, "usage: {} [--quick]\n", argv[0]);
    return 2;
  }
  const std::size_t rounds = quick ? kQuickRounds : kRounds;
  const auto isa = report::need(spectile::active_isa());
  const auto start = Clock::now();
  std::vector<Line> ways;
  bench::add_baselines(ways);
  bench::add_films(ways);
  std::vector<Timed> lines;
  // Lines of a kind share a film: the last of each kind leaves all of it touched.
  for (Line& way : ways) {
    Timed t{std::move(way), 0, 0, {}};
    t.line.fresh();
    t.first_touch = seconds_of(t.line.pass);
    t.error = t.line.error();
    lines.push_back(std::move(t));
  }
  auto from = report::need(spectile::FloatBuffer::create(kCopied));
  auto to = report::need(spectile::FloatBuffer::create(kCopied));
  machine::fill(from.data(), 1.0F, kCopied);
  machine::fill(to.data(), 0.0F, kCopied);
  std::vector<double> copies;
  std::vector<std::size_t> turns(lines.size() + 1);
  for (std::size_t i = 0; i < turns.size(); ++i) turns[i] = i;
  std::mt19937 engine(5);
  while (copies.size() < rounds && (copies.size() < kQuickRounds || seconds_since(start) < kMaxSeconds)) {
    std::shuffle(turns.begin(), turns.end(), engine);
    for (const std::size_t turn : turns) {
      const auto copy = [&] { machine::copy(to.data(), from.data(), kCopied); };
      if (turn == lines.size()) {
        copies.push_back(seconds_of(copy));
      } else {
        lines[turn].seconds.push_back(seconds_of(lines[turn].line.pass));
      }
    }
  }
  for (Timed& t : lines) std::sort(t.seconds.begin(), t.seconds.end());
  std::sort(copies.begin(), copies.end());
  const double copy_rate = 2 * sizeof(float) * static_cast<double>(kCopied) / copies[copies.size() / 2];

  fmt::print(
      "one thread where no more are named, kernels {}, 4 wavelengths a sample, batches of {}; 1920 x "
      "1080 pixels, those with buckets 640 x 360; medians of {} interleaved passes\n\n",
      isa, bench::kBatch, rounds);
  print_lines(lines, copy_rate);
  print_limits(copy_rate);
  return print_ratios(lines) == 0 ? 0 : 1;
}
