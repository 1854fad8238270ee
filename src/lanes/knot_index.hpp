// KnotIndex: ascending numbers made ready for the kernels' search.
#pragma once

#include <cstdint>
#include <span>
#include <spectile/lanes/sampled_spectra.hpp>
#include <vector>

namespace spectile {

/// The knots and buckets that kernels::KnotTable and kernels::BucketTable search.
struct KnotIndex {
  FloatBuffer knots;                ///< [count + 2^halvings], infinities from count on
  std::vector<std::int32_t> start;  ///< [buckets]
  float buckets_per_nm = 0;
  std::int32_t halvings = 0;
};

/// Of knots in ascending order, at least one, their range finite. Errors: kOutOfMemory.
Result<KnotIndex> index_knots(std::span<const float> knots);

}  // namespace spectile
