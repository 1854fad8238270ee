// Representations of light and materials side by side, in scenes of some bounces.
#pragma once

#include <spectile/bench/benchmark.hpp>

#include "bench/methods/methods.hpp"

namespace spectile::measure {

/// Paths of 1 to 5 reflectances drawn at random, under the scene's light: three numbers, 30 and 60 even
/// bands, planned bands, and 60 bands of sigmoids made of the reflectances' RGB. Errors: as those that make
/// them.
Result<std::vector<RepresentationSpeed>> measure_representations(const MethodScene& scene,
                                                                 const TimingBudget& timing);

}  // namespace spectile::measure
