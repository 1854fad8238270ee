// The white that colours are related to in the tests.
#pragma once

#include <array>

namespace spectile::test {

// IEC 61966-2-1:1999: D65 at chromaticity (0.3127, 0.3290).
inline constexpr std::array<double, 3> kWhite = {0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290};

}  // namespace spectile::test
