// Errors and times of the representations against a reference picture.
#pragma once

#include "render.hpp"

namespace tracer {

/// Prints where the time of a rendering went.
void print_stats(Representation representation, const Rendered& rendered, const RenderSettings& settings);

/// Prints the mean CIEDE2000 of each representation at several sample counts; `samples` is the reference's.
Result<bool> compare_representations(const RenderSettings& settings);

}  // namespace tracer
