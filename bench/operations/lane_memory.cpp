// Memory of an operation's lanes: filled, handed to kernels in parts, read back in double.
#include "bench/operations/lane_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/reference/half.hpp"

namespace spectile::measure {
namespace {

using kernels::kLanes;

constexpr std::size_t kPage = 4096;
/// Planes start at different places of a page, at whole cache lines: loads would wait for stores, and lines
/// push each other out of a cache, where addresses end alike.
constexpr std::size_t kApart = std::size_t{17} * 64;

/// Number i of a block.
template <class T>
T number_in(const std::byte* block, std::size_t i) {
  T out{};
  std::memcpy(&out, block + i * sizeof(T), sizeof(T));
  return out;
}

template <class T>
void put_number(std::byte* block, std::size_t i, T number) {
  std::memcpy(block + i * sizeof(T), &number, sizeof(T));
}

std::size_t padded_plane_bytes(std::size_t bytes) {
  return (bytes + kPage - 1) / kPage * kPage + kApart;
}

}  // namespace

std::size_t LaneMemory::block_bytes(const Operation& operation) {
  return operation.in.planes * operation.in.block_bytes() +
         operation.out.planes * operation.out.block_bytes();
}

std::size_t LaneMemory::min_bytes(const Operation& operation, std::size_t blocks) {
  return blocks * block_bytes(operation) + (kPage + kApart) * (operation.in.planes + operation.out.planes);
}

LaneMemory::LaneMemory(const Operation& operation, float* memory, std::size_t bytes)
    : in_(operation.in),
      out_(operation.out),
      operation_(&operation),
      source_(reinterpret_cast<std::byte*>(memory)) {
  const std::size_t rounding = (kPage + kApart) * (in_.planes + out_.planes);
  blocks_ = std::max<std::size_t>(1, (bytes - std::min(bytes, rounding)) / block_bytes(operation));
  source_plane_ = padded_plane_bytes(blocks_ * in_.block_bytes());
  target_plane_ = padded_plane_bytes(blocks_ * out_.block_bytes());
  target_ = source_ + in_.planes * source_plane_;
}

Arrays LaneMemory::arrays(std::size_t first, std::size_t count, bool non_temporal) const {
  Arrays out;
  out.source = source_ + first * in_.block_bytes();
  out.target = target_ + first * out_.block_bytes();
  out.source_plane = source_plane_;
  out.target_plane = target_plane_;
  out.blocks = count;
  out.non_temporal = non_temporal;
  return out;
}

std::size_t LaneMemory::index(const Shape& shape, std::size_t lane, std::size_t row) noexcept {
  const bool side_by_side = shape.element == Element::kQuad || shape.element == Element::kLimb;
  return side_by_side ? lane % kLanes * shape.rows + row : row * kLanes + lane % kLanes;
}

void LaneMemory::write(std::size_t lane, const float* values) {
  for (std::size_t plane = 0; plane < in_.planes; ++plane) {
    std::byte* const block = source_ + plane * source_plane_ + lane / kLanes * in_.block_bytes();
    for (std::size_t row = 0; row < in_.rows; ++row) {
      const std::size_t i = index(in_, lane, row);
      const float v = values[plane * in_.rows + row];
      if (in_.element == Element::kLimb) {
        constexpr float kMaxMagnitude = 0x1p53F;
        const float held = std::isnan(v) ? 0.0F : std::clamp(v, -kMaxMagnitude, kMaxMagnitude);
        put_number(block, i, static_cast<std::int64_t>(held));
      } else if (in_.element == Element::kHalf) {
        put_number(block, i, reference::half_from_float(v));
      } else {
        put_number(block, i, v);
      }
    }
  }
}

void LaneMemory::repeat(std::size_t count) {
  const std::size_t bytes = in_.block_bytes();
  for (std::size_t plane = 0; plane < in_.planes; ++plane) {
    std::byte* const first = source_ + plane * source_plane_;
    for (std::size_t at = count; at < blocks_; at += count) {
      std::memcpy(first + at * bytes, first, std::min(count, blocks_ - at) * bytes);
    }
  }
}

void LaneMemory::read(const Shape& shape, const std::byte* at, std::size_t plane_bytes, std::size_t lane,
                      double* values) {
  for (std::size_t plane = 0; plane < shape.planes; ++plane) {
    const std::byte* const block = at + plane * plane_bytes + lane / kLanes * shape.block_bytes();
    for (std::size_t row = 0; row < shape.rows; ++row) {
      double& to = values[plane * shape.rows + row];
      const std::size_t i = index(shape, lane, row);
      switch (shape.element) {
        case Element::kMask:
          to = static_cast<double>((number_in<std::uint64_t>(block, row) >> (lane % kLanes)) & 1U);
          break;
        case Element::kInt:
          to = static_cast<double>(number_in<std::int32_t>(block, i));
          break;
        case Element::kLimb:
          to = static_cast<double>(number_in<std::int64_t>(block, i));
          break;
        case Element::kHalf:
          to = static_cast<double>(reference::float_from_half(number_in<std::uint16_t>(block, i)));
          break;
        default:
          to = static_cast<double>(number_in<float>(block, i));
      }
    }
  }
}

void LaneMemory::read_in(std::size_t lane, double* values) const {
  read(in_, source_, source_plane_, lane, values);
}

void LaneMemory::read_out(std::size_t lane, double* values) const {
  if (operation_->read_block) {
    operation_->read_block(target_ + lane / kLanes * out_.block_bytes(), lane % kLanes, values);
    return;
  }
  read(out_, target_, target_plane_, lane, values);
}

void evaluate_errors(const Operation& operation, const LaneMemory& memory, std::size_t lanes, bool flushed,
                     Evaluation& out) {
  constexpr double kSmallestNormal = 0x1p-126;
  constexpr double kDenormalStep = 0x1p-149;
  lanes = std::min(lanes, memory.lanes());
  if (operation.run_error) {
    const double error = operation.run_error(memory.arrays(0, lanes / kLanes, false), flushed);
    if (error == kOutOfDomain) return;
    out.cases += lanes;
    if (!(error <= operation.bound)) out.beyond += lanes;
    out.worst = std::max(out.worst, error);
    return;
  }
  std::vector<double> in(operation.in.values());
  std::vector<double> result(operation.out.values());
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    memory.read_in(lane, in.data());
    memory.read_out(lane, result.data());
    if (flushed && !operation.bitwise) {
      for (double& v : in) v = std::abs(v) < kSmallestNormal ? std::copysign(0.0, v) : v;
    }
    const double tiny = flushed ? kSmallestNormal : kDenormalStep;
    const double error = operation.error_at ? operation.error_at(lane, in.data(), result.data(), tiny)
                                            : operation.error(in.data(), result.data(), tiny);
    if (error == kOutOfDomain) continue;
    ++out.cases;
    if (!(error <= operation.bound)) ++out.beyond;
    if (out.worst_input.empty() || !(error <= out.worst)) {
      out.worst = error;
      out.worst_input.assign(in.begin(), in.end());
    }
  }
}

}  // namespace spectile::measure
