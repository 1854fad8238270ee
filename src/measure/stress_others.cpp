// Films, averages over bands, weights, matrices and colour differences under stress.
#include "src/measure/stress.hpp"

namespace spectile::measure {

Result<std::vector<StressResult>> stress_others(const StressSettings& settings) {
  static_cast<void>(settings);
  return std::vector<StressResult>();
}

}  // namespace spectile::measure
