// Choice of the AoS baseline's compilation that runs here.
#include "bench/baseline/aos_baseline.hpp"

#include "bench/limits/processor_level.hpp"

namespace spectile::measure {

extern const AosBaseline aos_baseline_generic;
#if defined(__x86_64__)
extern const AosBaseline aos_baseline_v2;
extern const AosBaseline aos_baseline_v3;
extern const AosBaseline aos_baseline_v4;
#endif

const AosBaseline& aos_baseline() {
#if defined(__x86_64__)
  static const AosBaseline* const kLevels[] = {&aos_baseline_generic, &aos_baseline_v2, &aos_baseline_v3,
                                               &aos_baseline_v4};
  return *kLevels[processor_level()];
#else
  return aos_baseline_generic;
#endif
}

}  // namespace spectile::measure
