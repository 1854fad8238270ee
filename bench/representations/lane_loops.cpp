// Choice of the loops' compilation that runs here.
#include "bench/representations/lane_loops.hpp"

#include "bench/limits/processor_level.hpp"

namespace spectile::measure {

extern const LaneLoops lane_loops_generic;
#if defined(__x86_64__)
extern const LaneLoops lane_loops_v2;
extern const LaneLoops lane_loops_v3;
extern const LaneLoops lane_loops_v4;
#endif

const LaneLoops& lane_loops() {
#if defined(__x86_64__)
  static const LaneLoops* const kLevels[] = {&lane_loops_generic, &lane_loops_v2, &lane_loops_v3,
                                             &lane_loops_v4};
  return *kLevels[processor_level()];
#else
  return lane_loops_generic;
#endif
}

}  // namespace spectile::measure
