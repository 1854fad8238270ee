// Speeds of operations against the machine's limits.
#include "bench/operations/operation_speeds.hpp"

#include <algorithm>
#include <memory>

#include "bench/baseline/lane_baselines.hpp"
#include "bench/operations/lane_memory.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// Lanes that are filled with numbers of their own and whose results are evaluated.
constexpr std::size_t kEvaluatedBlocks = 32;

/// An operation with its memory.
struct Entry {
  const Operation* operation = nullptr;
  FloatBuffer own;  ///< where each has its own
  std::unique_ptr<LaneMemory> memory;
  Timed timed;
  double items = 0;  ///< a run
  LaneBaseline baseline;
};

/// Worked on by all threads together.
std::size_t all_bytes(const SpeedPlace& place) {
  return place.level == MemoryLevel::kCache ? place.bytes * static_cast<std::size_t>(place.threads)
                                            : place.bytes;
}

void prepare(Entry& entry, float* memory, const SpeedPlace& place) {
  const Operation& op = *entry.operation;
  entry.memory = std::make_unique<LaneMemory>(
      op, memory, std::max(all_bytes(place) / op.expense, LaneMemory::min_bytes(op)));
  Random random(place.seed);
  std::vector<float> values(op.in.values());
  const std::size_t filled = std::min(entry.memory->blocks(), kEvaluatedBlocks);
  for (std::size_t lane = 0; lane < filled * kernels::kLanes; ++lane) {
    op.fill(random, values.data());
    entry.memory->write(lane, values.data());
  }
  entry.memory->repeat(filled);
  if (op.clear) op.clear(entry.memory->arrays(0, entry.memory->blocks(), false));
  const bool non_temporal = place.level == MemoryLevel::kMemory && op.can_stream;
  const std::size_t passes = passes_at(place.level);
  entry.items = static_cast<double>(entry.memory->lanes() * passes);
  entry.timed.run = [&op, lanes = entry.memory.get(), table = place.table, threads = place.threads, passes,
                     non_temporal] {
    over_parts(lanes->blocks(), threads, passes, [&](std::size_t first, std::size_t count) {
      op.run(*table, lanes->arrays(first, count, non_temporal));
    });
  };
}

OperationSpeed measured_speed(const Entry& entry, const LimitLoops& limits, const SpeedPlace& place) {
  const Operation& op = *entry.operation;
  const Cost cost = op.cost();
  OperationSpeed out;
  out.group = op.group;
  out.name = op.name;
  out.isa = place.table->name;
  out.threads = place.threads;
  out.level = place.level;
  out.item = op.item;
  out.items_per_second = entry.items / entry.timed.seconds;
  out.bytes_per_second = out.items_per_second * (cost.read_bytes + cost.written_bytes);
  out.spread = entry.timed.spread;
  const bool non_temporal = place.level == MemoryLevel::kMemory && op.can_stream;
  out.fraction = limits.fraction(entry.timed, entry.items, cost, non_temporal, &out.limit);
  // Once more for the evaluation: what was timed has been added up many times over.
  const Arrays again =
      entry.memory->arrays(0, std::min(entry.memory->blocks(), kEvaluatedBlocks), non_temporal);
  if (op.clear) op.clear(again);
  op.run(*place.table, again);
  Evaluation evaluation;
  evaluate_errors(op, *entry.memory, kEvaluatedBlocks * kernels::kLanes, false, evaluation);
  out.error = evaluation.worst;
  out.bound = op.bound;
  out.error_unit = op.unit;
  // The bottleneck is reported where the limit is not reached.
  const double asked = place.level == MemoryLevel::kCache ? 0.7 : 0.8;
  if (out.fraction < asked) out.note = op.bottleneck;
  return out;
}

BaselineSpeed beside_baseline(const Entry& entry, const OperationSpeed& speed) {
  const auto nanoseconds = [&](const Timed& t) { return 1e9 * t.seconds / entry.items; };
  BaselineSpeed out;
  out.group = speed.group;
  out.name = speed.name;
  out.item = speed.item;
  out.nanoseconds = nanoseconds(entry.timed);
  out.baseline_nanoseconds = nanoseconds(entry.baseline.plain);
  out.fused_nanoseconds = nanoseconds(entry.baseline.fused);
  out.ratio = median_ratio(entry.baseline.plain, entry.timed);
  out.fused_ratio = median_ratio(entry.baseline.fused, entry.timed);
  out.spread = speed.spread;
  out.limit = speed.limit;
  out.fraction = speed.fraction;
  out.error = speed.error;
  out.baseline_error = entry.baseline.error(kEvaluatedBlocks * kernels::kLanes);
  out.error_unit = speed.error_unit;
  return out;
}

Result<SpeedsFound> in_cache(const std::vector<Operation>& operations, const SpeedPlace& place) {
  const std::size_t bytes = all_bytes(place);
  SPECTILE_ASSIGN(auto memory, FloatBuffer::create(bytes / sizeof(float)));
  LimitLoops limits(*place.table, memory.data(), bytes / sizeof(float), place.threads, place.level);
  std::vector<Entry> entries(operations.size());
  std::vector<Timed*> work = limits.timed();
  for (std::size_t i = 0; i < operations.size(); ++i) {
    entries[i].operation = &operations[i];
    const std::size_t own_bytes = std::max(bytes, LaneMemory::min_bytes(operations[i]));
    SPECTILE_ASSIGN(entries[i].own, FloatBuffer::create(own_bytes / sizeof(float)));
    prepare(entries[i], entries[i].own.data(), place);
    work.push_back(&entries[i].timed);
    if (!place.baseline) continue;
    SPECTILE_ASSIGN(entries[i].baseline, LaneBaseline::create(operations[i], place.bands, *entries[i].memory,
                                                              passes_at(place.level)));
    if (entries[i].baseline.plain.run) work.push_back(&entries[i].baseline.plain);
    if (entries[i].baseline.fused.run) work.push_back(&entries[i].baseline.fused);
  }
  time_in_turn(work, place.timing);
  SpeedsFound out;
  out.limit = limits.limit();
  for (const Entry& entry : entries) {
    out.operations.push_back(measured_speed(entry, limits, place));
    if (entry.baseline.exists()) out.baseline.push_back(beside_baseline(entry, out.operations.back()));
  }
  return out;
}

Result<SpeedsFound> in_memory(const std::vector<Operation>& operations, const SpeedPlace& place) {
  SPECTILE_ASSIGN(auto mine, FloatBuffer::create(place.bytes / sizeof(float)));
  SPECTILE_ASSIGN(auto theirs, FloatBuffer::create(place.bytes / sizeof(float)));
  LimitLoops limits(*place.table, mine.data(), place.bytes / sizeof(float), place.threads, place.level);
  const std::vector<Timed*> loops = limits.timed();
  time_in_turn(loops, place.timing);
  SpeedsFound out;
  out.limit = limits.limit();
  for (const Operation& op : operations) {
    if (op.cache_only) continue;
    const Cost cost = op.cost();
    const double arithmetic = cost.operations / out.limit.multiply_add + cost.divisions / out.limit.divide;
    const double traffic = (cost.read_bytes + cost.written_bytes) / out.limit.copy;
    if (arithmetic > traffic) continue;
    Entry entry;
    entry.operation = &op;
    prepare(entry, theirs.data(), place);
    // With the limits of the same seconds beside it.
    std::vector<Timed*> work = loops;
    work.push_back(&entry.timed);
    time_in_turn(work, place.timing);
    out.operations.push_back(measured_speed(entry, limits, place));
  }
  return out;
}

}  // namespace

Result<SpeedsFound> measure_speeds(const std::vector<Operation>& operations, const SpeedPlace& place) {
  return place.level == MemoryLevel::kCache ? in_cache(operations, place) : in_memory(operations, place);
}

}  // namespace spectile::measure
