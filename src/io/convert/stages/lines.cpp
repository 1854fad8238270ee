// Operations on one line of colour that the image jobs share.
#include "src/io/convert/stages/lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"

namespace spectile::io {

Result<ColorLine> ColorLine::create(int width) {
  ColorLine line;
  line.padded = blocks_for(static_cast<std::size_t>(width)) * kLanesPerBlock;
  SPECTILE_ASSIGN(line.memory, FloatBuffer::create(3 * line.padded));
  for (std::size_t k = 0; k < 3; ++k) line.rows[k] = line.memory.data() + k * line.padded;
  return line;
}

namespace {

kernels::RgbScan scan(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width) {
  const float* const in[3] = {rows[0], rows[1], rows[2]};
  kernels::RgbScan found;
  kernels.scan_rgb(&found, in, blocks_for(width) * kLanesPerBlock);
  return found;
}

/// First x for which test(x) holds; only called when there is one.
template <class Test>
int first_where(std::size_t width, Test test) {
  for (std::size_t x = 0; x < width; ++x) {
    if (test(x)) return static_cast<int>(x);
  }
  return -1;
}

}  // namespace

void sanitize_nonfinite(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width,
                        int line, NonFinite policy, LineStats& stats) {
  const kernels::RgbScan found = scan(kernels, rows, width);
  if (found.nonfinite == 0 && found.negative == 0 && found.maximum <= kLargestComponent) return;
  for (std::size_t x = 0; x < width; ++x) {
    bool good = true;
    for (std::size_t k = 0; k < 3; ++k) good = good && std::fabs(rows[k][x]) <= kLargestComponent;
    if (good) continue;
    stats.nonfinite.add(1, static_cast<int>(x), line);
    if (policy == NonFinite::kZero) rows[0][x] = rows[1][x] = rows[2][x] = 0.0F;
  }
}

float sanitize_range(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width, int line,
                     NegativeInput policy, LineStats& stats) {
  const kernels::RgbScan found = scan(kernels, rows, width);
  stats.over_one += found.over_one;
  float largest = found.maximum;
  if (found.negative > 0) {
    const auto below = [&](std::size_t x) { return rows[0][x] < 0 || rows[1][x] < 0 || rows[2][x] < 0; };
    stats.negative.add(found.negative, first_where(width, below), line);
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, -rows[k][x]);
    }
    if (policy == NegativeInput::kClip) {
      const std::size_t padded = blocks_for(width) * kLanesPerBlock;
      for (std::size_t k = 0; k < 3; ++k) {
        kernels.clamp(rows[k], rows[k], 0.0F, std::numeric_limits<float>::infinity(), padded);
      }
    }
  }
  return largest;
}

}  // namespace spectile::io
