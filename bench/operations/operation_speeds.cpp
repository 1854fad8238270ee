// Speeds of operations against the machine's limits.
#include "bench/operations/operation_speeds.hpp"

#include <algorithm>
#include <memory>

#include "bench/operations/lane_memory.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// Lanes that are filled with numbers of their own and whose results are judged.
constexpr std::size_t kJudgedBlocks = 32;

/// An operation with its memory.
struct Entry {
  const Operation* operation = nullptr;
  FloatBuffer own;  ///< where each has its own
  std::unique_ptr<LaneMemory> memory;
  Timed timed;
  double items = 0;  ///< a run
};

void prepare(Entry& entry, float* memory, const SpeedPlace& place) {
  const Operation& op = *entry.operation;
  const std::size_t bytes = place.level == MemoryLevel::kCache
                                ? place.bytes * static_cast<std::size_t>(place.threads)
                                : place.bytes;
  entry.memory =
      std::make_unique<LaneMemory>(op, memory, std::max(bytes / op.dear, LaneMemory::least_bytes(op)));
  Random random(place.seed);
  std::vector<float> values(op.in.values());
  const std::size_t filled = std::min(entry.memory->blocks(), kJudgedBlocks);
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

OperationSpeed speed_of(const Entry& entry, const LimitLoops& limits, const SpeedPlace& place) {
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
  // Once more for the judge: what was timed has been added up many times over.
  const Arrays again = entry.memory->arrays(0, std::min(entry.memory->blocks(), kJudgedBlocks), non_temporal);
  if (op.clear) op.clear(again);
  op.run(*place.table, again);
  Judged judged;
  judge(op, *entry.memory, kJudgedBlocks * kernels::kLanes, false, judged);
  out.error = judged.worst;
  out.bound = op.bound;
  out.error_unit = op.unit;
  // What keeps it from the limit is said where it does.
  const double asked = place.level == MemoryLevel::kCache ? 0.7 : 0.8;
  if (out.fraction < asked) out.note = op.binds;
  return out;
}

Result<SpeedsFound> in_cache(const std::vector<Operation>& operations, const SpeedPlace& place) {
  const std::size_t bytes = place.bytes * static_cast<std::size_t>(place.threads);
  SPECTILE_ASSIGN(auto memory, FloatBuffer::create(bytes / sizeof(float)));
  LimitLoops limits(*place.table, memory.data(), bytes / sizeof(float), place.threads, place.level);
  std::vector<Entry> entries(operations.size());
  std::vector<Timed*> work = limits.timed();
  for (std::size_t i = 0; i < operations.size(); ++i) {
    entries[i].operation = &operations[i];
    SPECTILE_ASSIGN(auto own, FloatBuffer::create(std::max(bytes, LaneMemory::least_bytes(operations[i])) /
                                                  sizeof(float)));
    entries[i].own = std::move(own);
    prepare(entries[i], entries[i].own.data(), place);
    work.push_back(&entries[i].timed);
  }
  time_in_turn(work, place.patience);
  SpeedsFound out;
  out.limit = limits.limit();
  for (const Entry& entry : entries) out.operations.push_back(speed_of(entry, limits, place));
  return out;
}

Result<SpeedsFound> in_memory(const std::vector<Operation>& operations, const SpeedPlace& place) {
  SPECTILE_ASSIGN(auto mine, FloatBuffer::create(place.bytes / sizeof(float)));
  SPECTILE_ASSIGN(auto theirs, FloatBuffer::create(place.bytes / sizeof(float)));
  LimitLoops limits(*place.table, mine.data(), place.bytes / sizeof(float), place.threads, place.level);
  const std::vector<Timed*> loops = limits.timed();
  time_in_turn(loops, place.patience);
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
    time_in_turn(work, place.patience);
    out.operations.push_back(speed_of(entry, limits, place));
  }
  return out;
}

}  // namespace

Result<SpeedsFound> measure_speeds(const std::vector<Operation>& operations, const SpeedPlace& place) {
  return place.level == MemoryLevel::kCache ? in_cache(operations, place) : in_memory(operations, place);
}

}  // namespace spectile::measure
