// Checks of plans that files hold.
#pragma once

#include <cstddef>
#include <spectile/plan/plan.hpp>
#include <string>

namespace spectile::io {

inline constexpr std::size_t kMaxPlanWavelengths = 4096;
inline constexpr std::size_t kMaxPlanLights = 256;

/// The first flaw of a plan, in words; empty for none.
std::string plan_flaw(const Plan& plan);

}  // namespace spectile::io
