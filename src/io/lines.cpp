// Operations on one line of colour that the image jobs share.
#include "src/io/lines.hpp"

#include <cmath>
#include <limits>

namespace spectile::io {

Result<ColorLine> ColorLine::create(int width) {
  ColorLine line;
  line.padded = blocks_for(static_cast<std::size_t>(width)) * kLanesPerBlock;
  auto memory = FloatBuffer::create(3 * line.padded);
  if (!memory) return memory.error();
  line.memory = *std::move(memory);
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

std::uint64_t settle_nonfinite(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width, int line,
                               NonFinite policy, LineStats& stats) {
  const std::uint64_t found = scan(kernels, rows, width).nonfinite;
  if (found == 0) return 0;
  const auto bad = [&](std::size_t x) {
    return !std::isfinite(rows[0][x]) || !std::isfinite(rows[1][x]) || !std::isfinite(rows[2][x]);
  };
  stats.nonfinite.add(found, first_where(width, bad), line);
  if (policy == NonFinite::kZero) {
    for (std::size_t x = 0; x < width; ++x) {
      if (bad(x)) rows[0][x] = rows[1][x] = rows[2][x] = 0.0F;
    }
  }
  return found;
}

float settle_range(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width, int line,
                   Negative policy, LineStats& stats) {
  const kernels::RgbScan found = scan(kernels, rows, width);
  stats.over_one += found.over_one;
  if (found.negative > 0) {
    const auto below = [&](std::size_t x) { return rows[0][x] < 0 || rows[1][x] < 0 || rows[2][x] < 0; };
    stats.negative.add(found.negative, first_where(width, below), line);
    if (policy == Negative::kClip) {
      const std::size_t padded = blocks_for(width) * kLanesPerBlock;
      for (std::size_t k = 0; k < 3; ++k) {
        kernels.clamp(rows[k], rows[k], 0.0F, std::numeric_limits<float>::infinity(), padded);
      }
    }
  }
  return found.maximum;
}

}  // namespace spectile::io
