// Samples of spectra in bands, by the weights of planned bands where they have some.
#pragma once

#include <cstddef>
#include <spectile/spectra/band_weights.hpp>
#include <spectile/spectra/bands.hpp>

namespace spectile {

/// A spectrum's sample in a band: its average, or its value at the centre where bands are points.
double sample_in(const MeasuredSpectrum& spectrum, const Bands& bands, std::size_t band);

/// A light's sample in each band: its emission values in planned bands, else its averages over the bands.
/// Errors: kBadArgument for a light that planned bands have not, naming those they have.
Result<std::vector<double>> light_samples(const MeasuredSpectrum& light, const Bands& bands);

/// Index of a light, on any scale, by its spectrum. Errors: kBadArgument as above.
Result<std::size_t> find_band_light(const BandWeights& weights, const MeasuredSpectrum& light);

/// Errors: kBadArgument for an observer that is not that of the weights.
Result<void> check_observer(const BandWeights& weights, Observer observer);

}  // namespace spectile
