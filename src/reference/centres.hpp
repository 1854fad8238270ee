// Where a wavelength lies between the centres of bands, as the kernels find it.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/abi/wavelengths.hpp"

namespace spectile::reference {

/// Sample k of lane i in blocks of `count` samples a lane.
inline std::size_t own_sample(std::size_t i, std::size_t k, std::size_t count) {
  return ((i / kernels::kLanes) * count + k) * kernels::kLanes + i % kernels::kLanes;
}

/// The knot of a table that is last at or below a wavelength within it.
template <class Table>
std::int32_t last_knot(const Table& table, float held) {
  const float bucket =
      std::min(static_cast<float>(table.buckets - 1), (held - table.knots[0]) * table.buckets_per_nm);
  std::int32_t knot = table.start[static_cast<std::int32_t>(bucket)];
  for (std::int32_t step = (1 << table.halvings) >> 1; step > 0; step >>= 1) {
    if (table.knots[knot + step] <= held) knot += step;
  }
  return knot;
}

struct CentrePlace {
  std::size_t interval;
  float part;
};

/// Of a wavelength that is a number.
inline CentrePlace place_between(const kernels::CentreTable& centres, float lambda) {
  const float held = std::clamp(lambda, centres.first_nm, centres.last_nm);
  const float at = (held - centres.first_nm) * centres.per_nm;
  const std::int32_t i =
      std::min(centres.knots == nullptr ? static_cast<std::int32_t>(at) : last_knot(centres, held),
               centres.intervals - 1);
  const float part = centres.knots == nullptr ? at - static_cast<float>(i)
                                              : (held - centres.knots[i]) * centres.per_width[i];
  return {static_cast<std::size_t>(i), 1.0F < part ? 1.0F : part};
}

/// Linear from a to b.
inline float between(float a, float b, float part) {
  return a + part * (b - a);
}

}  // namespace spectile::reference
