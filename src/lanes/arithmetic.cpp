// Element-wise arithmetic over whole batches, and reductions of each lane over its samples.
#include <array>
#include <bit>
#include <limits>
#include <spectile/lanes/arithmetic.hpp>

#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using kernels::KernelTable;

/// Checks `inputs` against `out`, then runs kernel(table, offset, first lane, blocks) tile by tile.
template <std::size_t N, class Kernel>
Result<void> in_blocks(const std::array<SampledSpectraView, N>& inputs, const SampledSpectraSpan& out,
                       const Execution& execution, Kernel kernel) {
  SPECTILE_TRY(shape::aligned(out.data));
  for (const SampledSpectraView& input : inputs) {
    SPECTILE_TRY(shape::same(input, out));
    SPECTILE_TRY(shape::aligned(input.data));
  }
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t block_floats = out.axis.count() * kLanesPerBlock;
  tiles::for_blocks(blocks_for(out.lanes), execution, [&](std::size_t first, std::size_t count) {
    kernel(*table, first * block_floats, first * kLanesPerBlock, count);
  });
  return {};
}

/// The same with kernel(table, offset, floats).
template <std::size_t N, class Kernel>
Result<void> element_wise(const std::array<SampledSpectraView, N>& inputs, const SampledSpectraSpan& out,
                          const Execution& execution, Kernel kernel) {
  const std::size_t block_floats = out.axis.count() * kLanesPerBlock;
  return in_blocks(inputs, out, execution,
                   [&](const KernelTable& k, std::size_t at, std::size_t /*lane*/, std::size_t blocks) {
                     kernel(k, at, blocks * block_floats);
                   });
}

/// Runs a kernel of one batch, and below of two, with the parameters that it takes besides.
template <class Kernel, class... Parameters>
Result<void> unary(Kernel which, const SampledSpectraView& a, const SampledSpectraSpan& out,
                   const Execution& execution, Parameters... parameters) {
  return element_wise<1>({a}, out, execution, [&](const KernelTable& k, std::size_t at, std::size_t n) {
    (k.*which)(out.data + at, a.data + at, parameters..., n);
  });
}

template <class Kernel, class... Parameters>
Result<void> binary(Kernel which, const SampledSpectraView& a, const SampledSpectraView& b,
                    const SampledSpectraSpan& out, const Execution& execution, Parameters... parameters) {
  return element_wise<2>({a, b}, out, execution, [&](const KernelTable& k, std::size_t at, std::size_t n) {
    (k.*which)(out.data + at, a.data + at, b.data + at, parameters..., n);
  });
}

/// Runs kernel(table, offset of samples, first lane, blocks) over batches with one number a lane.
template <std::size_t N, class Kernel>
Result<void> with_lanes(const std::array<SampledSpectraView, N>& inputs, LanesView numbers,
                        const SampledSpectraSpan& out, const Execution& execution, Kernel kernel) {
  SPECTILE_TRY(shape::same_lanes(numbers.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(numbers.data));
  return in_blocks(inputs, out, execution, kernel);
}

/// Runs kernel(table, first block, blocks, samples) over the lanes of `a` into `out`.
template <class Kernel>
Result<void> per_lane(const SampledSpectraView& a, const LanesSpan& out, const Execution& execution,
                      Kernel kernel) {
  SPECTILE_TRY(shape::same_lanes(a.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(a.data));
  SPECTILE_TRY(shape::aligned(out.data));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t block_floats = a.axis.count() * kLanesPerBlock;
  tiles::for_blocks(a.blocks(), execution, [&](std::size_t first, std::size_t count) {
    kernel(*table, out.data + first * kLanesPerBlock, a.data + first * block_floats, count);
  });
  return {};
}

/// Clears the bits of the lanes that pad the last block.
void clear_padding(LaneMask& mask, std::size_t lanes) {
  if (const std::size_t rest = lanes % kLanesPerBlock; rest != 0)
    mask.back() &= (std::uint64_t{1} << rest) - 1;
}

/// Runs kernel(table, words, offset, blocks) for a mask over the lanes of `a`, and clears the padding's bits.
template <class Kernel>
Result<LaneMask> compute_mask(const SampledSpectraView& a, const Execution& execution, Kernel kernel) {
  SPECTILE_TRY(shape::aligned(a.data));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  LaneMask mask(a.blocks());
  tiles::for_blocks(mask.size(), execution, [&](std::size_t first, std::size_t count) {
    kernel(*table, mask.data() + first, first * a.axis.count() * kLanesPerBlock, count);
  });
  clear_padding(mask, a.lanes);
  return mask;
}

}  // namespace

Result<void> add(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                 const Execution& execution) {
  return binary(&KernelTable::add, a, b, out, execution);
}

Result<void> subtract(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                      const Execution& execution) {
  return binary(&KernelTable::subtract, a, b, out, execution);
}

Result<void> multiply(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                      const Execution& execution) {
  return binary(&KernelTable::multiply, a, b, out, execution);
}

Result<void> divide(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                    const Execution& execution) {
  return binary(&KernelTable::divide, a, b, out, execution);
}

Result<void> divide_or_zero(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                            const Execution& execution) {
  return binary(&KernelTable::divide_or_zero, a, b, out, execution);
}

Result<void> negate(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution) {
  return unary(&KernelTable::negate, a, out, execution);
}

Result<void> scale(SampledSpectraView a, float factor, SampledSpectraSpan out, const Execution& execution) {
  return unary(&KernelTable::scale, a, out, execution, factor);
}

Result<void> scale(SampledSpectraView a, LanesView factor, SampledSpectraSpan out,
                   const Execution& execution) {
  return with_lanes<1>({a}, factor, out, execution,
                       [&](const KernelTable& k, std::size_t at, std::size_t lane, std::size_t blocks) {
                         k.scale_lanes(out.data + at, a.data + at, factor.data + lane, out.axis.count(),
                                       blocks);
                       });
}

Result<void> multiply(SampledSpectraView a, std::span<const float> spectrum, SampledSpectraSpan out,
                      const Execution& execution) {
  if (spectrum.size() != out.axis.count()) {
    return make_error(ErrorCode::kBandsMismatch, "a spectrum of {} samples, the batch has {}",
                      spectrum.size(), out.axis.description());
  }
  return in_blocks<1>({a}, out, execution,
                      [&](const KernelTable& k, std::size_t at, std::size_t /*lane*/, std::size_t blocks) {
                        k.scale_bands(out.data + at, a.data + at, spectrum.data(), spectrum.size(), blocks);
                      });
}

Result<void> complement(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution) {
  return unary(&KernelTable::complement, a, out, execution);
}

Result<void> multiply_add(SampledSpectraView a, SampledSpectraView b, SampledSpectraView c,
                          SampledSpectraSpan out, const Execution& execution) {
  return element_wise<3>({a, b, c}, out, execution, [&](const KernelTable& k, std::size_t at, std::size_t n) {
    k.multiply_add(out.data + at, a.data + at, b.data + at, c.data + at, n);
  });
}

Result<void> multiply_add(SampledSpectraView a, LanesView factor, SampledSpectraView c,
                          SampledSpectraSpan out, const Execution& execution) {
  return with_lanes<2>({a, c}, factor, out, execution,
                       [&](const KernelTable& k, std::size_t at, std::size_t lane, std::size_t blocks) {
                         k.multiply_add_lanes(out.data + at, a.data + at, factor.data + lane, c.data + at,
                                              out.axis.count(), blocks);
                       });
}

Result<void> lerp(SampledSpectraView a, SampledSpectraView b, float t, SampledSpectraSpan out,
                  const Execution& execution) {
  return binary(&KernelTable::lerp, a, b, out, execution, t);
}

Result<void> lerp(SampledSpectraView a, SampledSpectraView b, LanesView t, SampledSpectraSpan out,
                  const Execution& execution) {
  return with_lanes<2>({a, b}, t, out, execution,
                       [&](const KernelTable& k, std::size_t at, std::size_t lane, std::size_t blocks) {
                         k.lerp_lanes(out.data + at, a.data + at, b.data + at, t.data + lane,
                                      out.axis.count(), blocks);
                       });
}

Result<void> sqrt(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution) {
  return unary(&KernelTable::sqrt, a, out, execution);
}

Result<void> exp(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution) {
  return unary(&KernelTable::exp, a, out, execution);
}

Result<void> transmittance(SampledSpectraView sigma, LanesView distance, SampledSpectraSpan out,
                           const Execution& execution) {
  return with_lanes<1>({sigma}, distance, out, execution,
                       [&](const KernelTable& k, std::size_t at, std::size_t lane, std::size_t blocks) {
                         k.transmittance(out.data + at, sigma.data + at, distance.data + lane,
                                         out.axis.count(), blocks);
                       });
}

Result<LaneMask> update_throughput(SampledSpectraView throughput, SampledSpectraView scattering,
                                   LanesView density, LanesView u, SampledSpectraSpan out,
                                   const Execution& execution) {
  const bool roulette = u.lanes != 0;
  if (roulette) {
    SPECTILE_TRY(shape::same_lanes(u.lanes, out.lanes));
    SPECTILE_TRY(shape::aligned(u.data));
    if (u.data == nullptr)
      return make_error(ErrorCode::kBadArgument, "{} random numbers are nowhere", u.lanes);
  }
  LaneMask ended(out.blocks());
  SPECTILE_TRY(with_lanes<2>({throughput, scattering}, density, out, execution,
                             [&](const KernelTable& k, std::size_t at, std::size_t lane, std::size_t blocks) {
                               k.update_throughput(out.data + at, ended.data() + lane / kLanesPerBlock,
                                                   throughput.data + at, scattering.data + at,
                                                   density.data + lane, roulette ? u.data + lane : nullptr,
                                                   out.axis.count(), blocks);
                             }));
  clear_padding(ended, out.lanes);
  return ended;
}

Result<void> pow(SampledSpectraView a, float exponent, SampledSpectraSpan out, const Execution& execution) {
  return unary(&KernelTable::pow, a, out, execution, exponent);
}

Result<void> clamp(SampledSpectraView a, float lowest, float highest, SampledSpectraSpan out,
                   const Execution& execution) {
  if (!(lowest <= highest)) {
    return make_error(ErrorCode::kBadArgument, "cannot limit samples to between {} and {}", lowest, highest);
  }
  return unary(&KernelTable::clamp, a, out, execution, lowest, highest);
}

Result<void> clamp_zero(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution) {
  return clamp(a, 0.0F, std::numeric_limits<float>::infinity(), out, execution);
}

Result<void> minimum(SampledSpectraView a, LanesSpan out, const Execution& execution) {
  return per_lane(a, out, execution,
                  [&](const KernelTable& k, float* dst, const float* in, std::size_t blocks) {
                    k.minimum(dst, in, a.axis.count(), blocks);
                  });
}

Result<void> maximum(SampledSpectraView a, LanesSpan out, const Execution& execution) {
  return per_lane(a, out, execution,
                  [&](const KernelTable& k, float* dst, const float* in, std::size_t blocks) {
                    k.maximum(dst, in, a.axis.count(), blocks);
                  });
}

Result<void> average(SampledSpectraView a, LanesSpan out, const Execution& execution) {
  std::vector<float> weights(a.axis.count(), 1.0F / static_cast<float>(a.axis.count()));
  if (const Bands* const bands = a.axis.bands()) {
    if (bands->overlap()) {
      return make_error(ErrorCode::kBadArgument, "bands {} overlap: their average counts light twice",
                        bands->description());
    }
    double total = 0;
    for (const Band& band : bands->list()) total += band.width_nm();
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = static_cast<float>((*bands)[i].width_nm() / total);
  }
  return per_lane(a, out, execution,
                  [&](const KernelTable& k, float* dst, const float* in, std::size_t blocks) {
                    k.weighted_sum(dst, in, weights.data(), weights.size(), blocks);
                  });
}

Result<LaneMask> is_black(SampledSpectraView a, const Execution& execution) {
  return compute_mask(a, execution,
                      [&](const KernelTable& k, std::uint64_t* mask, std::size_t at, std::size_t count) {
                        k.black_mask(mask, a.data + at, a.axis.count(), count);
                      });
}

Result<LaneMask> has_nan(SampledSpectraView a, const Execution& execution) {
  return compute_mask(a, execution,
                      [&](const KernelTable& k, std::uint64_t* mask, std::size_t at, std::size_t count) {
                        k.nan_mask(mask, a.data + at, a.axis.count(), count);
                      });
}

Result<LaneMask> equal_lanes(SampledSpectraView a, SampledSpectraView b, const Execution& execution) {
  SPECTILE_TRY(shape::same(a, b));
  SPECTILE_TRY(shape::aligned(b.data));
  return compute_mask(a, execution,
                      [&](const KernelTable& k, std::uint64_t* mask, std::size_t at, std::size_t count) {
                        k.equal_mask(mask, a.data + at, b.data + at, a.axis.count(), count);
                      });
}

Result<bool> equal(SampledSpectraView a, SampledSpectraView b, const Execution& execution) {
  SPECTILE_ASSIGN(const auto mask, equal_lanes(a, b, execution));
  std::size_t lanes = 0;
  for (const std::uint64_t word : mask) lanes += static_cast<std::size_t>(std::popcount(word));
  return lanes == a.lanes;
}

}  // namespace spectile
