// Memory that adding one batch to a film works in, kept for the next one.
#pragma once

#include <cstdint>
#include <spectile/lanes/sampled_spectra.hpp>
#include <vector>

namespace spectile {

/// Grows to what the film's kinds of sums ask for, once.
struct FilmScratch {
  std::size_t quad_floats = 0;  ///< from one response's quads to the next one's
  FloatBuffer quads, band_quads, hits, padded, profiles;
  std::vector<std::int32_t> reasons, more_reasons, address, sorted_address, band;
  std::vector<std::uint32_t> sample, sorted_sample;
  std::vector<float> factor, sorted_factor;
  std::vector<const float*> radiance, lambda_nm, density;
};

}  // namespace spectile
