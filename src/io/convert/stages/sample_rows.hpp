// Rows of spectral samples on their way into an output line: what is not finite, what a half cannot hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/image/image.hpp>

#include "kernels/abi.hpp"
#include "src/io/convert/frame/line_stats.hpp"

namespace spectile::io {

/// Counts the pixels of a line with a sample that is not finite, and makes all their samples 0 where the
/// policy says so. Shapes: a row for each channel.
void sanitize_samples(std::span<float* const> rows, std::size_t width, int line, NonFinite policy,
                      LineStats& stats);

/// Clamps what a half cannot hold, and returns the number of pixels with such a sample. Shapes: a row, of
/// whole blocks, for each channel that becomes halves.
std::uint64_t clamp_samples(const kernels::KernelTable& kernels, std::span<float* const> rows,
                            std::size_t width);

}  // namespace spectile::io
