// Block sizes that every kernel shares.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectile::kernels {

/// Lanes of a block, the unit in which every kernel works.
inline constexpr std::size_t kLanes = 64;

/// Bands in a run of a sum: the error then grows with kSumRun + bands / kSumRun, not with the bands.
inline constexpr std::size_t kSumRun = 8;

/// Largest finite half; rows of halves are clamped to it, so that a finite sample stays finite.
inline constexpr float kHalfMax = 65504.0F;

}  // namespace spectile::kernels
