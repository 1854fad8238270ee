// Numbers that rapidcheck draws.
#pragma once

#include <rapidcheck.h>

#include <cstdlib>
#include <limits>

namespace spectile::test {

inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Set before rapidcheck reads it.
inline const int kSeeded = ::setenv("RC_PARAMS", "seed=20240229 max_success=200", 0);

/// A multiple of 2^-30 from low to high.
inline double between(double low, double high) {
  const int step = *rc::gen::inRange(0, (1 << 30) + 1);
  return low + (high - low) * (step * 0x1p-30);
}

}  // namespace spectile::test
