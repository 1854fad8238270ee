// Blocks from and to floats and halves at two strides, by the kernels where elements lie side by side.
#include "src/lanes/arrays/strided_array.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "src/base/errors.hpp"

namespace spectile::arrays {
namespace {

using kernels::KernelTable;

/// Halves are converted in runs of this many: the longest vector.
constexpr std::size_t kHalfRun = 16;
/// Samples of halves that are transposed at once: 64 lanes of them stay in the first-level cache.
constexpr std::size_t kHalfSamples = 64;

std::size_t magnitude(std::ptrdiff_t stride) {
  return stride < 0 ? std::size_t{0} - static_cast<std::size_t>(stride) : static_cast<std::size_t>(stride);
}

/// True where the samples of a lane lie side by side, aligned as their type, and the lanes do not.
template <class Element, class Byte>
bool in_rows(const StridedArray<Byte>& array) {
  constexpr std::ptrdiff_t kBytes = sizeof(Element);
  return array.sample_stride == kBytes && array.lane_stride != kBytes && array.lane_stride % kBytes == 0 &&
         reinterpret_cast<std::uintptr_t>(array.data) % sizeof(Element) == 0;
}

/// Rows that the kernels take: at strides whose multiples fit 32 bits.
template <class Byte>
bool float_rows(const StridedArray<Byte>& array) {
  constexpr std::ptrdiff_t kMaxStride = std::ptrdiff_t{1} << 27;
  return array.type == ElementType::kFloat && in_rows<float>(array) && array.lane_stride > 0 &&
         array.lane_stride <= kMaxStride;
}

template <class Byte>
bool half_rows(const StridedArray<Byte>& array) {
  return array.type == ElementType::kHalf && in_rows<std::uint16_t>(array);
}

/// Elements that lie side by side; a whole block has a constant size, which compilers copy faster.
template <class Element>
void copy_run(void* dst, const void* src, std::size_t n) {
  if (n == kLanesPerBlock) {
    std::memcpy(dst, src, kLanesPerBlock * sizeof(Element));
  } else {
    std::memcpy(dst, src, n * sizeof(Element));
  }
}

template <class Element>
void gather(Element* dst, const std::byte* from, std::ptrdiff_t stride, std::size_t n) {
  if (stride == sizeof(Element)) {
    copy_run<Element>(dst, from, n);
  } else {
    for (std::size_t i = 0; i < n; ++i)
      std::memcpy(dst + i, from + static_cast<std::ptrdiff_t>(i) * stride, sizeof(Element));
  }
}

template <class Element>
void scatter(std::byte* to, std::ptrdiff_t stride, const Element* src, std::size_t n) {
  if (stride == sizeof(Element)) {
    copy_run<Element>(to, src, n);
  } else {
    for (std::size_t i = 0; i < n; ++i)
      std::memcpy(to + static_cast<std::ptrdiff_t>(i) * stride, src + i, sizeof(Element));
  }
}

// Rows of three numbers, RGB, pass through rows of four, which the kernels transpose by vectors.

/// Shapes: dst [3][64]; rows [n][3] and one more float.
void load_triples(const KernelTable& table, const float* rows, std::size_t n, float* dst) {
  alignas(64) float quads[4][kLanesPerBlock];
  table.rows_to_blocks(quads[0], rows, 3, 4, n);
  for (std::size_t k = 0; k < 3; ++k) std::memcpy(dst + k * kLanesPerBlock, quads[k], sizeof(quads[k]));
}

/// Shapes: quads [64][4], of which the fourth is of no use, and 0 beyond n; src [3][64].
void store_triples(const KernelTable& table, const float* src, float* quads, std::size_t n) {
  alignas(64) float planes[4][kLanesPerBlock];
  for (std::size_t k = 0; k < 4; ++k) std::memcpy(planes[k], src + k % 3 * kLanesPerBlock, sizeof(planes[k]));
  table.blocks_to_rows(quads, 4, planes[0], 4, n);
  std::fill(quads + 4 * n, quads + 4 * kLanesPerBlock, 0.0F);
}

/// Three elements of each of n rows of four, to rows at a stride, at least 3 elements.
template <class Element>
void scatter_triples(std::byte* to, std::ptrdiff_t stride, const Element* quads, std::size_t n) {
  std::size_t i = 0;
  if (stride == 3 * sizeof(Element)) {
    // The fourth element is overwritten by the next row.
    for (; i + 1 < n; ++i) std::memcpy(to + i * 3 * sizeof(Element), quads + 4 * i, 4 * sizeof(Element));
  }
  for (; i < n; ++i)
    std::memcpy(to + static_cast<std::ptrdiff_t>(i) * stride, quads + 4 * i, 3 * sizeof(Element));
}

void load_plane(const KernelTable& table, const StridedView& array, std::size_t first, std::size_t k,
                float* dst) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  if (array.type == ElementType::kFloat) {
    gather(dst, array.at(first, k), array.lane_stride, n);
    std::fill(dst + n, dst + kLanesPerBlock, 0.0F);
  } else {
    alignas(64) std::uint16_t halves[kLanesPerBlock];
    gather(halves, array.at(first, k), array.lane_stride, n);
    std::fill(halves + n, halves + kLanesPerBlock, std::uint16_t{0});
    table.half_to_float(dst, halves, kLanesPerBlock);
  }
}

void store_plane(const KernelTable& table, const float* src, const StridedSpan& array, std::size_t first,
                 std::size_t k) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  if (array.type == ElementType::kFloat) {
    scatter(array.at(first, k), array.lane_stride, src, n);
  } else {
    alignas(64) std::uint16_t halves[kLanesPerBlock];
    table.float_to_half(halves, src, kLanesPerBlock);
    scatter(array.at(first, k), array.lane_stride, halves, n);
  }
}

void load_float_rows(const KernelTable& table, const StridedView& array, std::size_t first, float* dst) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  const auto* const rows = reinterpret_cast<const float*>(array.at(first, 0));
  const std::size_t stride = static_cast<std::size_t>(array.lane_stride) / sizeof(float);
  // The float behind a packed triple is the next lane's.
  if (array.samples == 3 && stride == 3 && first + n < array.lanes) {
    load_triples(table, rows, n, dst);
  } else {
    table.rows_to_blocks(dst, rows, stride, array.samples, n);
  }
}

void store_float_rows(const KernelTable& table, const float* src, const StridedSpan& array,
                      std::size_t first) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  if (array.samples == 3) {
    alignas(64) float quads[4 * kLanesPerBlock];
    store_triples(table, src, quads, n);
    scatter_triples(array.at(first, 0), array.lane_stride, quads, n);
  } else {
    table.blocks_to_rows(reinterpret_cast<float*>(array.at(first, 0)),
                         static_cast<std::size_t>(array.lane_stride) / sizeof(float), src, array.samples, n);
  }
}

/// Rows of a block, `count` halves each, to packed rows of floats.
void widen_rows(const KernelTable& table, const StridedView& array, std::size_t first, std::size_t k,
                std::size_t count, float* rows) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  const auto row = [&](std::size_t i) {
    return reinterpret_cast<const std::uint16_t*>(array.at(first + i, k));
  };
  if (n == kLanesPerBlock &&
      array.lane_stride == static_cast<std::ptrdiff_t>(count * sizeof(std::uint16_t))) {
    table.half_to_float(rows, row(0), n * count);
    return;
  }
  const std::size_t runs = count / kHalfRun * kHalfRun;
  for (std::size_t i = 0; i < n; ++i) {
    table.half_to_float(rows + i * count, row(i), runs);
    // The last run overlaps the one before.
    if (runs < count)
      table.half_to_float(rows + (i + 1) * count - kHalfRun, row(i) + count - kHalfRun, kHalfRun);
  }
}

/// Packed rows of floats to rows of a block, `count` halves each.
void narrow_rows(const KernelTable& table, const float* rows, const StridedSpan& array, std::size_t first,
                 std::size_t k, std::size_t count) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  const auto row = [&](std::size_t i) { return reinterpret_cast<std::uint16_t*>(array.at(first + i, k)); };
  if (n == kLanesPerBlock &&
      array.lane_stride == static_cast<std::ptrdiff_t>(count * sizeof(std::uint16_t))) {
    table.float_to_half(row(0), rows, n * count);
    return;
  }
  const std::size_t runs = count / kHalfRun * kHalfRun;
  for (std::size_t i = 0; i < n; ++i) {
    table.float_to_half(row(i), rows + i * count, runs);
    if (runs < count)
      table.float_to_half(row(i) + count - kHalfRun, rows + (i + 1) * count - kHalfRun, kHalfRun);
  }
}

/// True where a block's rows of `count` halves are whole runs, or each row holds one.
template <class Byte>
bool in_runs(const StridedArray<Byte>& array, std::size_t first, std::size_t count) {
  return count >= kHalfRun ||
         (first + kLanesPerBlock <= array.lanes &&
          array.lane_stride == static_cast<std::ptrdiff_t>(count * sizeof(std::uint16_t)));
}

/// Halves [lanes][samples], transposed some samples at a time.
void load_half_rows(const KernelTable& table, const StridedView& array, std::size_t first, float* dst) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  alignas(64) float rows[kLanesPerBlock * kHalfSamples];
  for (std::size_t k = 0; k < array.samples; k += kHalfSamples) {
    const std::size_t count = std::min(kHalfSamples, array.samples - k);
    float* const to = dst + k * kLanesPerBlock;
    if (!in_runs(array, first, count)) {
      for (std::size_t j = 0; j < count; ++j) load_plane(table, array, first, k + j, to + j * kLanesPerBlock);
      continue;
    }
    widen_rows(table, array, first, k, count, rows);
    if (count == 3) {
      rows[n * count] = 0;
      load_triples(table, rows, n, to);
    } else {
      table.rows_to_blocks(to, rows, count, count, n);
    }
  }
}

void store_half_rows(const KernelTable& table, const float* src, const StridedSpan& array,
                     std::size_t first) {
  const std::size_t n = lanes_of_block(array.lanes, first);
  if (array.samples == 3) {
    alignas(64) float quads[4 * kLanesPerBlock];
    alignas(64) std::uint16_t halves[4 * kLanesPerBlock];
    store_triples(table, src, quads, n);
    table.float_to_half(halves, quads, 4 * kLanesPerBlock);
    scatter_triples(array.at(first, 0), array.lane_stride, halves, n);
    return;
  }
  alignas(64) float rows[kLanesPerBlock * kHalfSamples];
  for (std::size_t k = 0; k < array.samples; k += kHalfSamples) {
    const std::size_t count = std::min(kHalfSamples, array.samples - k);
    const float* const from = src + k * kLanesPerBlock;
    if (!in_runs(array, first, count)) {
      for (std::size_t j = 0; j < count; ++j)
        store_plane(table, from + j * kLanesPerBlock, array, first, k + j);
      continue;
    }
    table.blocks_to_rows(rows, count, from, count, n);
    narrow_rows(table, rows, array, first, k, count);
  }
}

}  // namespace

Result<void> check_strides(const StridedView& array, const char* lane, const char* sample) {
  if (array.lanes == 0 || array.samples == 0) return {};
  if (array.data == nullptr) {
    return make_error(ErrorCode::kBadArgument, "the array of {} {}s has no data", array.lanes, lane);
  }
  const std::size_t size = element_bytes(array.type);
  const std::size_t by_lane = magnitude(array.lane_stride);
  const std::size_t by_sample = magnitude(array.sample_stride);
  if (array.lanes > 1 && by_lane < size) {
    return make_error(ErrorCode::kBadArgument, "a {} stride of {} bytes is less than an element, {} bytes",
                      lane, array.lane_stride, size);
  }
  if (array.samples > 1 && by_sample < size) {
    return make_error(ErrorCode::kBadArgument, "a {} stride of {} bytes is less than an element, {} bytes",
                      sample, array.sample_stride, size);
  }
  constexpr auto kMaxBytes = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / 4;
  if ((array.lanes > 1 && array.lanes - 1 > kMaxBytes / by_lane) ||
      (array.samples > 1 && array.samples - 1 > kMaxBytes / by_sample)) {
    return make_error(ErrorCode::kBadArgument,
                      "{} {}s at a stride of {} bytes, of {} {}s at a stride of {} bytes, exceed the memory",
                      array.lanes, lane, array.lane_stride, array.samples, sample, array.sample_stride);
  }
  if (array.lanes == 1 || array.samples == 1) return {};
  const bool rows_apart = by_lane >= size && (by_lane - size) / by_sample >= array.samples - 1;
  const bool planes_apart = by_sample >= size && (by_sample - size) / by_lane >= array.lanes - 1;
  if (rows_apart || planes_apart) return {};
  return make_error(ErrorCode::kBadArgument,
                    "{} {}s at a stride of {} bytes, of {} {}s at a stride of {} bytes, overlap", array.lanes,
                    lane, array.lane_stride, array.samples, sample, array.sample_stride);
}

void load_block(const KernelTable& table, const StridedView& array, std::size_t first, float* dst) {
  if (float_rows(array)) {
    load_float_rows(table, array, first, dst);
  } else if (half_rows(array)) {
    load_half_rows(table, array, first, dst);
  } else {
    for (std::size_t k = 0; k < array.samples; ++k)
      load_plane(table, array, first, k, dst + k * kLanesPerBlock);
  }
}

void store_block(const KernelTable& table, const float* src, const StridedSpan& array, std::size_t first) {
  if (float_rows(array)) {
    store_float_rows(table, src, array, first);
  } else if (half_rows(array)) {
    store_half_rows(table, src, array, first);
  } else {
    for (std::size_t k = 0; k < array.samples; ++k)
      store_plane(table, src + k * kLanesPerBlock, array, first, k);
  }
}

}  // namespace spectile::arrays
