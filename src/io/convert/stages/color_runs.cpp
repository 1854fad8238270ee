// Runs of a line's blocks whose spectra need not be computed: black ones, and those of one colour.
#include "src/io/convert/stages/color_runs.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <spectile/lanes/sampled_spectra.hpp>

namespace spectile::io {
namespace {

/// Contents of a block.
struct Block {
  ColorRun::Kind kind = ColorRun::Kind::kComputed;
  std::uint64_t black = 0;
};

Block block_at(const float* const rgb[3], const float* scale, std::size_t at, std::size_t n) {
  std::uint32_t bits[3][kLanesPerBlock];
  for (std::size_t k = 0; k < 3; ++k) std::memcpy(bits[k], rgb[k] + at, n * sizeof(float));
  Block out;
  std::uint32_t differs = 0;
  for (std::size_t i = 1; scale != nullptr && i < n; ++i) {
    differs |= std::bit_cast<std::uint32_t>(scale[at + i]) ^ std::bit_cast<std::uint32_t>(scale[at]);
  }
  std::uint32_t black = 0;
  for (std::size_t i = 0; i < n; ++i) {
    differs |= (bits[0][i] ^ bits[0][0]) | (bits[1][i] ^ bits[1][0]) | (bits[2][i] ^ bits[2][0]);
    black += (bits[0][i] | bits[1][i] | bits[2][i]) == 0 ? 1 : 0;
  }
  out.black = black;
  if (black == n) {
    out.kind = ColorRun::Kind::kBlack;
  } else if (differs == 0) {
    out.kind = ColorRun::Kind::kConstant;
  }
  return out;
}

bool same_color(const float* const rgb[3], const float* scale, std::size_t a, std::size_t b) {
  if (scale != nullptr && std::bit_cast<std::uint32_t>(scale[a]) != std::bit_cast<std::uint32_t>(scale[b])) {
    return false;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::bit_cast<std::uint32_t>(rgb[k][a]) != std::bit_cast<std::uint32_t>(rgb[k][b])) return false;
  }
  return true;
}

}  // namespace

FoundRuns find_runs(const float* const rgb[3], const float* scale, std::size_t width,
                    std::vector<ColorRun>& runs) {
  FoundRuns found;
  runs.clear();
  for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
    const std::size_t n = std::min(kLanesPerBlock, width - at);
    const Block block = block_at(rgb, scale, at, n);
    found.black += block.black;
    if (block.kind == ColorRun::Kind::kConstant) found.constant += n;
    const bool goes_on =
        !runs.empty() && runs.back().kind == block.kind &&
        (block.kind != ColorRun::Kind::kConstant || same_color(rgb, scale, runs.back().first, at));
    if (goes_on) {
      runs.back().pixels += n;
    } else {
      runs.push_back({block.kind, at, n});
    }
  }
  return found;
}

}  // namespace spectile::io
