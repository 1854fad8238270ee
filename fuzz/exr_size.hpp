// How large an image an EXR file claims to be, told from its bytes, so that cases stay within milliseconds.
#pragma once

#include <cstring>

#include "fuzz/support.hpp"

namespace spectile::fuzz {

/// True if every window in the bytes, and so every part's image, is of at most `most` pixels. Windows that
/// make no sense count as small: they are refused soon enough.
inline bool is_small_image(Bytes bytes, std::int64_t most = 1 << 14) {
  constexpr std::string_view kBox("Window\0box2i\0\x10\0\0\0", 17);
  const std::string_view text = text_of(bytes);
  for (std::size_t at = text.find(kBox); at != std::string_view::npos; at = text.find(kBox, at + 1)) {
    std::int32_t box[4];
    if (at + kBox.size() + sizeof(box) > text.size()) return true;
    std::memcpy(box, text.data() + at + kBox.size(), sizeof(box));
    const std::int64_t width = std::int64_t{box[2]} - box[0] + 1;
    const std::int64_t height = std::int64_t{box[3]} - box[1] + 1;
    if (width > most || height > most || (width > 0 && height > 0 && width * height > most)) return false;
  }
  return true;
}

}  // namespace spectile::fuzz
