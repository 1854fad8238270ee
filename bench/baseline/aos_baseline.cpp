// Choice of the AoS baseline's compilation that runs here.
#include "bench/baseline/aos_baseline.hpp"

#include <string_view>

#include "src/dispatch/dispatch.hpp"

namespace spectile::measure {

extern const AosBaseline aos_baseline_generic;
#if defined(__x86_64__)
extern const AosBaseline aos_baseline_v2;
extern const AosBaseline aos_baseline_v3;
extern const AosBaseline aos_baseline_v4;
#endif

const AosBaseline& aos_baseline() {
#if defined(__x86_64__)
  // The levels ask for what the kernels of these names ask for.
  const char* widest = dispatch::available().back()->name;
  if (std::string_view(widest) == "avx512") return aos_baseline_v4;
  if (std::string_view(widest) == "avx2") return aos_baseline_v3;
  if (std::string_view(widest) == "sse4.2") return aos_baseline_v2;
#endif
  return aos_baseline_generic;
}

}  // namespace spectile::measure
