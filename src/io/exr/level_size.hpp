// LevelSize: width and height of an image's mip levels.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace spectile::io {

struct LevelSize {
  int width = 0;
  int height = 0;
  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
  friend bool operator==(const LevelSize&, const LevelSize&) = default;
};

/// Size of a mip level, rounded down; level 0 is the image. Source: Technical Introduction to OpenEXR.
inline LevelSize level_size(LevelSize image, int level) {
  return {std::max(1, image.width >> level), std::max(1, image.height >> level)};
}
/// Levels down to one pixel, level 0 among them.
inline int level_count(LevelSize image) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(image.width, image.height))));
}

}  // namespace spectile::io
