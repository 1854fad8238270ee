// Rows of spectral samples on their way into an output line: what is not finite, what a half cannot hold.
#include "src/io/convert/stages/sample_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <spectile/lanes/sampled_spectra.hpp>
#include <vector>

#include "src/io/convert/stages/band_channels.hpp"

namespace spectile::io {

void sanitize_samples(std::span<float* const> rows, std::size_t width, int line, NonFinite policy,
                      LineStats& stats) {
  const auto is_good = [](float v) { return std::fabs(v) <= std::numeric_limits<float>::max(); };
  bool all_good = true;
  for (const float* const row : rows) all_good = all_good && is_good(largest_magnitude(row, width));
  for (std::size_t x = 0; x < width && !all_good; ++x) {
    bool good = true;
    for (const float* const row : rows) good = good && is_good(row[x]);
    if (good) continue;
    stats.nonfinite.add(1, static_cast<int>(x), line);
    if (policy != NonFinite::kZero) continue;
    for (float* const row : rows) row[x] = 0;
  }
}

std::uint64_t clamp_samples(const kernels::KernelTable& kernels, std::span<float* const> rows,
                            std::size_t width) {
  std::vector<float*> beyond;
  for (float* const row : rows) {
    if (!(largest_magnitude(row, width) <= kernels::kHalfMax)) beyond.push_back(row);
  }
  if (beyond.empty()) return 0;
  std::uint64_t clamped = 0;
  for (std::size_t x = 0; x < width; ++x) {
    clamped +=
        std::ranges::any_of(beyond, [x](const float* r) { return std::fabs(r[x]) > kernels::kHalfMax; }) ? 1
                                                                                                         : 0;
  }
  for (float* const row : beyond) {
    kernels.clamp(row, row, -kernels::kHalfMax, kernels::kHalfMax, blocks_for(width) * kLanesPerBlock);
  }
  return clamped;
}

}  // namespace spectile::io
