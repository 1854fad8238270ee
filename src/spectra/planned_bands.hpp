// What bands of a plan weigh by: the sensor and the lights of their plan.
#pragma once

#include <cstddef>
#include <spectile/plan/plan.hpp>

namespace spectile {

/// A spectrum's sample in a band: its average, or its value at the centre where bands are points.
double sample_in(const MeasuredSpectrum& spectrum, const Bands& bands, std::size_t band);

/// A light's sample in a band: its plan's emission for planned bands, else its average over the band.
/// Errors: kBadArgument for a light that the bands' plan has not, naming those it has.
Result<std::vector<double>> light_samples(const MeasuredSpectrum& light, const Bands& bands);

/// Which of a plan's lights one is, on any scale. Errors: kBadArgument as above.
Result<std::size_t> planned_light(const Plan& plan, const MeasuredSpectrum& light);

/// Errors: kBadArgument for an observer that is not the plan's.
Result<void> check_observer(const Plan& plan, Observer observer);

}  // namespace spectile
