// Samples of a finished row, at any address.
#pragma once

#include <cstddef>
#include <cstring>

#include "kernels/abi/lanes.hpp"
#include "src/reference/half.hpp"

namespace spectile::reference {

/// row[i] = sample.
template <class Sample>
void put(void* row, std::size_t i, Sample sample) {
  std::memcpy(static_cast<unsigned char*>(row) + i * sizeof(Sample), &sample, sizeof(Sample));
}

/// A finite sample as a finite half.
inline std::uint16_t clamped_half(float sample) {
  return half_from_float(kernels::kHalfMax < sample ? kernels::kHalfMax : sample);
}

}  // namespace spectile::reference
