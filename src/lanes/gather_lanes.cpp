// Lanes of a batch by index.
#include <algorithm>
#include <functional>
#include <spectile/lanes/arithmetic.hpp>

#include "src/base/errors.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

bool share_memory(const SampledSpectraView& a, const SampledSpectraView& b) {
  const std::less<> before;
  return a.lanes != 0 && b.lanes != 0 && before(a.data, b.data + b.floats()) &&
         before(b.data, a.data + a.floats());
}

Result<void> check(const SampledSpectraView& from, std::span<const std::uint32_t> lanes,
                   const SampledSpectraSpan& out) {
  if (!(from.axis == out.axis)) {
    return make_error(ErrorCode::kBandsMismatch,
                      "lanes are taken from a batch with {}, and put into one with {}",
                      from.axis.description(), out.axis.description());
  }
  if (lanes.size() != out.lanes) {
    return make_error(ErrorCode::kSizeMismatch, "{} lanes are chosen for a batch of {}", lanes.size(),
                      out.lanes);
  }
  SPECTILE_TRY(shape::aligned(from.data));
  SPECTILE_TRY(shape::aligned(out.data));
  if (share_memory(from, out)) {
    return make_error(ErrorCode::kBadArgument, "lanes cannot be moved within one batch");
  }
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (lanes[i] < from.lanes) continue;
    return make_error(ErrorCode::kBadArgument, "lane {} of {} is to come from lane {} of a batch of {}", i,
                      lanes.size(), lanes[i], from.lanes);
  }
  return {};
}

}  // namespace

Result<void> gather_lanes(SampledSpectraView from, std::span<const std::uint32_t> lanes,
                          SampledSpectraSpan out, const Execution& execution) {
  SPECTILE_TRY(check(from, lanes, out));
  const std::size_t count = out.axis.count();
  tiles::for_blocks(out.blocks(), execution, [&](std::size_t first, std::size_t blocks) {
    for (std::size_t block = first; block < first + blocks; ++block) {
      const std::size_t lane = block * kLanesPerBlock;
      const std::size_t n = std::min(kLanesPerBlock, out.lanes - lane);
      // Where the lanes' first samples are; the next ones of each lane are a row on.
      const float* at[kLanesPerBlock];
      for (std::size_t i = 0; i < n; ++i) at[i] = &from.at(lanes[lane + i], 0);
      for (std::size_t k = 0; k < count; ++k) {
        float* const row = out.row(block, k);
        for (std::size_t i = 0; i < n; ++i) row[i] = at[i][k * kLanesPerBlock];
        std::fill(row + n, row + kLanesPerBlock, 0.0F);
      }
    }
  });
  return {};
}

}  // namespace spectile
