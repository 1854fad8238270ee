// Element-wise arithmetic over whole batches of spectra, and reductions over the samples of each lane.
//
// Rules common to all. Shapes: every batch has the same lanes and samples, on bands or at
// wavelengths of each lane's own; `out` may be one of the inputs.
// Numbers: float32 as IEEE 754 says, each operation rounded once; NaN and infinities go through. Errors:
// kBandsMismatch, kSizeMismatch, and those of active_isa(). Padding lanes are computed too and mean nothing.
#pragma once

#include <cstdint>
#include <span>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>

namespace spectile {

/// out = a + b.
Result<void> add(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                 const Execution& execution = {});
/// out = a - b.
Result<void> subtract(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                      const Execution& execution = {});
/// out = a * b.
Result<void> multiply(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                      const Execution& execution = {});
/// out = a / b.
Result<void> divide(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                    const Execution& execution = {});
/// out = b is 0 ? 0 : a / b; a NaN divisor gives NaN.
Result<void> divide_or_zero(SampledSpectraView a, SampledSpectraView b, SampledSpectraSpan out,
                            const Execution& execution = {});
/// out = a with every sign flipped, zeros and NaN included.
Result<void> negate(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution = {});
/// out = a * factor.
Result<void> scale(SampledSpectraView a, float factor, SampledSpectraSpan out,
                   const Execution& execution = {});
/// out = a * the lane's own factor: a cosine, one over a density. Shapes: factor [lanes].
Result<void> scale(SampledSpectraView a, LanesView factor, SampledSpectraSpan out,
                   const Execution& execution = {});
/// out = a * one spectrum for all lanes. Shapes: spectrum [samples], any
/// alignment.
Result<void> multiply(SampledSpectraView a, std::span<const float> spectrum, SampledSpectraSpan out,
                      const Execution& execution = {});
/// out = 1 - a.
Result<void> complement(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution = {});
/// out = (a * b) + c, two roundings.
Result<void> multiply_add(SampledSpectraView a, SampledSpectraView b, SampledSpectraView c,
                          SampledSpectraSpan out, const Execution& execution = {});
/// The same with the lane's own factor in place of b: radiance that a weight is added to. Shapes: factor
/// [lanes].
Result<void> multiply_add(SampledSpectraView a, LanesView factor, SampledSpectraView c,
                          SampledSpectraSpan out, const Execution& execution = {});
/// out = (1 - t) * a + t * b; exactly a at t = 0 and b at t = 1 for finite samples.
Result<void> lerp(SampledSpectraView a, SampledSpectraView b, float t, SampledSpectraSpan out,
                  const Execution& execution = {});
/// The same with the lane's own t. Shapes: t [lanes].
Result<void> lerp(SampledSpectraView a, SampledSpectraView b, LanesView t, SampledSpectraSpan out,
                  const Execution& execution = {});
/// out = square root of a, correctly rounded; below 0 gives NaN.
Result<void> sqrt(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution = {});
/// out = e to the a, error below 0.501 ULP on the whole range.
Result<void> exp(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution = {});
/// out = e^-(sigma * distance), the share of light that passes a medium with the extinction sigma over the
/// lane's own distance; error below 1.1 ULP on the whole range, however large the product. 0 times infinity
/// gives NaN. Shapes: distance [lanes]. Units: of sigma one over those of distance.
Result<void> transmittance(SampledSpectraView sigma, LanesView distance, SampledSpectraSpan out,
                           const Execution& execution = {});
/// out = a to the exponent, error below 0.501 ULP; special values as C's pow.
Result<void> pow(SampledSpectraView a, float exponent, SampledSpectraSpan out,
                 const Execution& execution = {});
/// out = a limited to [lowest, highest]; NaN stays. Errors: also kBadArgument for lowest > highest or NaN
/// limits.
Result<void> clamp(SampledSpectraView a, float lowest, float highest, SampledSpectraSpan out,
                   const Execution& execution = {});
/// out = a limited to 0 and above; NaN stays.
Result<void> clamp_zero(SampledSpectraView a, SampledSpectraSpan out, const Execution& execution = {});

/// One bounce of paths: out = throughput * scattering / density, with the lane's own density of the direction
/// (times what does not depend on wavelength, such as one over a cosine); 0 where that is not a number of
/// 2^-126 or more. Then Russian roulette, unless `u` is of no lanes: a path goes on with the probability q =
/// min(1, largest sample), and its samples are divided by q; with u at or above q they become 0 and its bit
/// of the mask is set. NaN is passed over in q; a path ends where nothing else is left, or less than 2^-126
/// of throughput * scattering. Numbers: p = throughput * scattering, m its largest: u * density < m, p * (1 /
/// min(m, density)): relative error below 4 u where p is a normal number. Shapes: density, u [lanes].
Result<LaneMask> update_throughput(SampledSpectraView throughput, SampledSpectraView scattering,
                                   LanesView density, LanesView u, SampledSpectraSpan out,
                                   const Execution& execution = {});

/// Lane i of `out` = lane lanes[i] of `from`: live paths moved together, the lanes of one material picked
/// out. Shapes: as many indices as `out` has lanes; the samples of both on one axis. Errors: kBandsMismatch,
/// kSizeMismatch; kBadArgument for an index that is no lane of `from`, and for batches that share memory.
Result<void> gather_lanes(SampledSpectraView from, std::span<const std::uint32_t> lanes,
                          SampledSpectraSpan out, const Execution& execution = {});

/// out[lane] = least sample; NaN is passed over, and a lane of nothing but NaN gives +infinity.
Result<void> minimum(SampledSpectraView a, LanesSpan out, const Execution& execution = {});
/// out[lane] = greatest sample; NaN is passed over, and a lane of nothing but NaN gives -infinity.
Result<void> maximum(SampledSpectraView a, LanesSpan out, const Execution& execution = {});
/// out[lane] = average over wavelength: samples on bands weighted with their widths, those at wavelengths of
/// the lane's own alike; relative error at most (samples + 1) * 2^-24 for samples of one sign. Errors:
/// kBadArgument for bands that overlap.
Result<void> average(SampledSpectraView a, LanesSpan out, const Execution& execution = {});

/// Lanes whose samples are all 0 (of either sign).
Result<LaneMask> is_black(SampledSpectraView a, const Execution& execution = {});
/// Lanes with at least one NaN sample.
Result<LaneMask> has_nan(SampledSpectraView a, const Execution& execution = {});
/// Lanes equal in every sample (NaN equals nothing, +0 equals -0).
Result<LaneMask> equal_lanes(SampledSpectraView a, SampledSpectraView b, const Execution& execution = {});
/// True if every lane is equal.
Result<bool> equal(SampledSpectraView a, SampledSpectraView b, const Execution& execution = {});

}  // namespace spectile
