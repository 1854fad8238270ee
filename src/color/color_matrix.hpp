// Small helpers on colour matrices that the operations share.
#pragma once

#include <array>
#include <spectile/color/rgb_space.hpp>

namespace spectile::color {

inline std::array<float, 9> to_float(const Matrix3& m) {
  std::array<float, 9> out{};
  for (std::size_t i = 0; i < 9; ++i) out[i] = static_cast<float>(m[i]);
  return out;
}

}  // namespace spectile::color
