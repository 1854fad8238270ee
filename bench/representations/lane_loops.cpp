// Choice of the loops' compilation for an instruction set.
#include "bench/representations/lane_loops.hpp"

#include <spectile/lanes/sampled_spectra.hpp>

#include "bench/limits/processor_level.hpp"

namespace spectile::measure {

static_assert(kLoopLanes == kLanesPerBlock);

extern const LaneLoops lane_loops_generic;
#if defined(__x86_64__)
extern const LaneLoops lane_loops_v2;
extern const LaneLoops lane_loops_v3;
extern const LaneLoops lane_loops_v4;
#endif

const LaneLoops& lane_loops([[maybe_unused]] std::string_view isa) {
#if defined(__x86_64__)
  static const LaneLoops* const kLevels[] = {&lane_loops_generic, &lane_loops_v2, &lane_loops_v3,
                                             &lane_loops_v4};
  return *kLevels[level_of(isa)];
#else
  return lane_loops_generic;
#endif
}

}  // namespace spectile::measure
