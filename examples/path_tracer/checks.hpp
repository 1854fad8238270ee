// The program's checks of itself, which the tests run.
#pragma once

#include <string_view>

#include "render.hpp"

namespace tracer {

/// Runs a check by name, prints its figures, and returns true if all are good. Errors: kUnknownName.
Result<bool> run_check(std::string_view name);

}  // namespace tracer
