// Averages of sampled spectra over other bands, as weighted sums of samples side by side.
#pragma once

#include <cstddef>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

namespace spectile::io {

/// A new band's sample: the sum of weights[i] * sample[first + i].
struct BandAverage {
  std::size_t first = 0;
  std::vector<double> weights;  ///< one where nothing but 0 is there to sum up
};

/// The averages over the bands `to` of spectra that are constant over each of the bands `from`. Between those
/// bands, and beyond them, light is 0 and a reflectance that of the nearest band; a gap is shared at its
/// middle. Each is noted. Weights of one average add up to 1 but for light that is 0 in part of it.
std::vector<BandAverage> band_averages(const Bands& from, const Bands& to, Quantity quantity,
                                       std::vector<std::string>& notes);

}  // namespace spectile::io
