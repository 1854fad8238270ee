// Every operation on lanes over the whole range of float.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "bench/operations/lane_memory.hpp"
#include "bench/stress/stress.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// A set of inputs: fills a lane's numbers.
struct InputSet {
  const char* name;
  void (*fill)(Random& random, float* values, std::size_t count);
};

float random_bits(Random& random) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(random() >> 32U));
}

float random_magnitude(Random& random) {
  const auto exponent = static_cast<int>(random() % 277) - 149;  // 2^-149 to 2^127
  const float sign = (random() & 1U) == 0 ? 1.0F : -1.0F;
  return sign * std::ldexp(uniform(random, 1.0F, 2.0F), exponent);
}

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kSpecial[] = {0.0F,
                              -0.0F,
                              0x1p-149F,
                              -0x1p-149F,
                              0x1.fffffcp-127F,
                              0x1p-126F,
                              -0x1p-126F,
                              0x1p-25F,
                              0x1p-24F,
                              0.5F,
                              1.0F - 0x1p-24F,
                              1.0F,
                              -1.0F,
                              1.0F + 0x1p-23F,
                              2.0F,
                              65504.0F,
                              65520.0F,
                              0x1p24F,
                              kLargest,
                              -kLargest,
                              kInfinity,
                              -kInfinity,
                              kNan};

/// Numbers that are drawn one by one.
template <auto draw>
void each(Random& random, float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) values[i] = draw(random);
}

const InputSet kSets[] = {
    {"all bit patterns", each<random_bits>},
    {"special values", each<[](Random& random) { return kSpecial[random() % std::size(kSpecial)]; }>},
    {"all magnitudes", each<random_magnitude>},
    {"one magnitude",
     [](Random& random, float* v, std::size_t n) {
       const float scale = std::abs(random_magnitude(random));
       for (std::size_t i = 0; i < n; ++i) v[i] = scale * uniform(random, 0.5F, 1.0F);
     }},
    {"cancelling pairs",
     [](Random& random, float* v, std::size_t n) {
       const float scale = std::ldexp(1.0F, static_cast<int>(random() % 200) - 100);
       for (std::size_t i = 0; i < n; ++i) {
         // Each undoes the one before it but for some steps of its last place.
         const auto steps = static_cast<float>(random() % 8);
         v[i] = i % 2 == 0 ? scale * uniform(random, 0.5F, 1.0F) : -v[i - 1] * (1.0F + steps * 0x1p-23F);
       }
     }},
    {"one line, all else 0",
     [](Random& random, float* v, std::size_t n) {
       std::fill_n(v, n, 0.0F);
       v[random() % n] = std::abs(random_magnitude(random));
     }},
    {"a rounding around 0 and 1",
     [](Random& random, float* v, std::size_t n) {
       constexpr float kNear[] = {0.0F,     -0.0F,           0x1p-149F, -0x1p-24F,
                                  0x1p-24F, 1.0F - 0x1p-24F, 1.0F,      1.0F + 0x1p-23F};
       for (std::size_t i = 0; i < n; ++i) v[i] = kNear[random() % std::size(kNear)];
     }},
    {"1e-30 and 1e30", each<[](Random& random) {
       return uniform(random, 0.0F, 1.0F) * ((random() & 1U) == 0 ? 1e-30F : 1e30F);
     }>},
    {"0 to 1", each<[](Random& random) { return uniform(random, 0.0F, 1.0F); }>},
    {"greys and dark colours",
     [](Random& random, float* v, std::size_t n) {
       const float grey = std::ldexp(uniform(random, 0.5F, 1.0F), -static_cast<int>(random() % 40));
       for (std::size_t i = 0; i < n; ++i) v[i] = (random() & 3U) == 0 ? 0.0F : grey;
     }},
    {"wavelengths", each<[](Random& random) { return uniform(random, 300.0F, 900.0F); }>},
};

/// Numbers below the smallest normal one are taken and given as 0 while it exists, where the processor can.
class FlushToZero {
 public:
  explicit FlushToZero(bool on) {
#if defined(__x86_64__)
    // Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, 10.2.3: FTZ, DAZ.
    constexpr unsigned kFlush = 0x8040U;
    saved_ = __builtin_ia32_stmxcsr();
    if (on) __builtin_ia32_ldmxcsr(saved_ | kFlush);
#else
    static_cast<void>(on);
#endif
  }
  ~FlushToZero() {
#if defined(__x86_64__)
    __builtin_ia32_ldmxcsr(saved_);
#endif
  }
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;
  static constexpr bool possible() {
#if defined(__x86_64__)
    return true;
#else
    return false;
#endif
  }

 private:
  unsigned saved_ = 0;
};

std::string described(const std::vector<float>& values) {
  std::string out;
  for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 3); ++i) {
    out += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", values[i]);
  }
  return values.size() > 3 ? fmt::format("{}, ... ({} numbers)", out, values.size()) : out;
}

/// All that was tried of one operation.
struct Found {
  StressResult result;
  double part = 0;  ///< of its bound that the worst case reaches: bounds grow with the bands
};

void try_set(const Operation& op, const char* set, const std::function<void(Random&, float*)>& fill,
             bool flushed, const std::string& where, const StressSettings& settings,
             std::vector<float>& memory, Found& found) {
  const std::size_t lanes = std::max<std::size_t>(
      kernels::kLanes,
      settings.samples / op.expense / (op.in.values() + op.out.values()) / kernels::kLanes * kernels::kLanes);
  const std::size_t blocks = lanes / kernels::kLanes;
  memory.resize(LaneMemory::min_bytes(op, blocks) / sizeof(float) + 32);
  float* aligned = memory.data();
  while (reinterpret_cast<std::uintptr_t>(aligned) % 64 != 0) ++aligned;
  LaneMemory at(op, aligned, LaneMemory::min_bytes(op, blocks));
  Random random(settings.seed);
  std::vector<float> values(op.in.values());
  for (std::size_t lane = 0; lane < at.lanes(); ++lane) {
    fill(random, values.data());
    if (op.admit) op.admit(values.data());
    at.write(lane, values.data());
  }
  if (op.clear) op.clear(at.arrays(0, at.blocks(), false));
  {
    const FlushToZero mode(flushed);
    op.run(*settings.table, at.arrays(0, at.blocks(), false));
  }
  Evaluation evaluation;
  evaluate_errors(op, at, at.lanes(), flushed, evaluation);
  StressResult& r = found.result;
  r.cases += evaluation.cases;
  r.beyond += evaluation.beyond;
  const double part = op.bound > 0 ? evaluation.worst / op.bound : evaluation.worst;
  if (evaluation.cases > 0 && (r.worst_case.empty() || !(part <= found.part))) {
    found.part = part;
    r.worst = evaluation.worst;
    r.bound = op.bound;
    r.worst_case = fmt::format("{}{}{}: {}", set, where, flushed ? ", flushed to zero" : "",
                               described(evaluation.worst_input));
  }
}

void try_all(const Operation& op, const std::string& where, const StressSettings& settings,
             std::vector<float>& memory, Found& found) {
  for (const bool flushed : {false, true}) {
    if (flushed && !FlushToZero::possible()) continue;
    try_set(op, "typical", op.fill, flushed, where, settings, memory, found);
    for (const InputSet& set : kSets) {
      try_set(
          op, set.name, [&](Random& random, float* v) { set.fill(random, v, op.in.values()); }, flushed,
          where, settings, memory, found);
    }
  }
}

}  // namespace

Result<std::vector<StressResult>> stress_operations(const StressSettings& settings) {
  struct List {
    const char* text;
    std::string where;
  };
  std::vector<List> lists = {{"400:700:5", ""}, {"360:830:470", ", 1 band of 470 nm"}};
  if (!settings.few_bands) {
    lists.push_back({"400:700:100", ", 3 bands"});
    lists.push_back({"400:670:30", ", 9 bands"});
    lists.push_back({"390:799.6:0.1", ", 4096 bands of 0.1 nm"});
  }
  std::vector<Found> found;
  std::vector<float> memory;
  for (const List& list : lists) {
    SPECTILE_ASSIGN(auto bands, Bands::parse(list.text));
    SPECTILE_ASSIGN(auto operations, lane_operations(bands));
    for (const Operation& op : operations) {
      if (!is_chosen(op.name, settings.only)) continue;
      if (settings.stop && settings.stop())
        return make_error(ErrorCode::kCancelled, "stopped at {}", op.name);
      const bool on_bands = op.in.rows * op.out.rows > 1 || op.out.planes > 8 ||
                            op.name.starts_with("sigmoid") || op.name.starts_with("relight") ||
                            op.name.ends_with("on bands");
      if (!list.where.empty() && !on_bands) continue;
      auto known = std::find_if(found.begin(), found.end(),
                                [&](const Found& f) { return f.result.operation == op.name; });
      if (known == found.end()) {
        found.push_back({});
        known = found.end() - 1;
        known->result.operation = op.name;
        known->result.unit = op.unit;
        known->result.inputs = on_bands ? "whole range of float, on 1 to 4096 bands, flushed to zero or not"
                                        : "whole range of float, flushed to zero or not";
      }
      try_all(op, list.where, settings, memory, *known);
    }
  }
  std::vector<StressResult> out;
  out.reserve(found.size());
  for (Found& f : found) out.push_back(std::move(f.result));
  return out;
}

}  // namespace spectile::measure
