// Spectra at single wavelengths, sampled wavelengths, and their projection.
#pragma once

#include "kernels/abi/wavelengths.hpp"
#include "kernels/exponential_series.inl"
#include "kernels/simd/convert.hpp"
#include "kernels/simd/tables.hpp"
#include "kernels/simd/vector.hpp"
#include "kernels/upsampling/sigmoid_point.inl"

namespace spectile::kernels {
namespace {

/// Where a wavelength is in a table at even wavelengths.
struct EvenPlace {
  I32 interval;
  F32 part;
  Mask inside;
};

inline EvenPlace place_in(const EvenTable& table, F32 lambda) noexcept {
  const F32 t = (lambda - F32(table.first_nm)) * F32(table.per_nm);
  EvenPlace out;
  out.inside = (t >= F32(0.0F)) & (t <= F32(static_cast<float>(table.intervals)));
  const F32 safe = xsimd::select(out.inside, t, F32(0.0F));
  out.interval = xsimd::min(xsimd::to_int(safe), I32(table.intervals - 1));
  out.part = safe - xsimd::to_float(out.interval);
  return out;
}

inline F32 value_at(const float* pairs, const EvenPlace& place) noexcept {
  const Pair pair = gather_pair(pairs, place.interval);
  return xsimd::select(place.inside, pair.first + place.part * pair.second, F32(0.0F));
}

inline F32 or_nan(F32 lambda, F32 value) noexcept {
  return xsimd::select(is_nan(lambda), lambda, value);
}

void interpolate_even(float* dst, const float* lambda_nm, const EvenTable& table, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 lambda = load(lambda_nm + i);
    store(dst + i, or_nan(lambda, value_at(table.pairs, place_in(table, lambda))));
  }
}

void interpolate_knots(float* dst, const float* lambda_nm, const KnotTable& table, std::size_t n) noexcept {
  const F32 first(table.knots[0]);
  const F32 last(table.knots[table.count - 1]);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 lambda = load(lambda_nm + i);
    const Mask inside = (lambda >= first) & (lambda <= last);
    const F32 held = xsimd::select(lambda < first, first, xsimd::select(lambda > last, last, lambda));
    const F32 safe = xsimd::select(is_nan(lambda), first, held);
    const I32 knot = last_knot(table.knots, table, safe);
    const Pair pair = gather_pair(table.pairs, knot);
    const F32 value = pair.first + (safe - gather(table.knots, knot)) * pair.second;
    const F32 out = table.held ? value : xsimd::select(inside, value, F32(0.0F));
    store(dst + i, or_nan(lambda, out));
  }
}

/// f of the lanes in double, rounded once.
template <class Function>
inline F32 in_double(F32 v, Function f) noexcept {
  return narrow(f(widen_low(v)), f(widen_high(v)));
}

/// 2^-n for integers n from 0 to 126.
inline F32 two_to_minus(I32 n) noexcept {
  return bits_as<float>((I32(127) - n) << 23);
}

void planck(float* dst, const float* lambda_nm, const PlanckTable& table, std::size_t n) noexcept {
  const F32 zero(0.0F);
  const F32 one(1.0F);
  const F32 magic(kRoundMagicFloat);
  const F32 exponent(table.exponent);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 lambda = load(lambda_nm + i);
    const Mask good = (lambda > zero) & (lambda - lambda == zero);
    const F32 l = min(F32(kPlanckLongest), xsimd::select(good, lambda, one) * F32(1.0F / kPlanckUnit));
    const F32 inverse = divide(one, l);
    const F32 x = exponent * inverse;
    const Mask live = good & (x < F32(kPlanckLimit));
    const F32 near = xsimd::select(live, x, zero);
    // The rounding error of the product.
    const F32 rest = (fused_minus(near, l, exponent) + F32(table.exponent_rest)) * inverse;
    const F32 whole = (near + magic) - magic;
    const F32 t = ((near - whole) + xsimd::select(live, rest, zero)) * F32(kLn2Float);
    F32 p(kPlanckSeries[kPlanckTerms - 1]);
    for (std::size_t k = kPlanckTerms - 1; k-- > 0;) p = fused(p, t, F32(kPlanckSeries[k]));
    const F32 q = fused(p, t * t, t);
    const I32 power = xsimd::to_int(whole);
    const I32 half = power >> 1;
    const F32 first = two_to_minus(half);
    const F32 second = two_to_minus(power - half);
    const F32 square = l * l;
    const F32 divisor = ((square * square) * l) * (q + (one - first * second));
    const F32 value = divide(F32(table.factor) * first, divisor) * second;
    store(dst + i, or_nan(lambda, xsimd::select(live, value, zero)));
  }
}

void gaussians(float* dst, const float* lambda_nm, const GaussianLobe* lobes, std::size_t count,
               std::size_t n) noexcept {
  const F64 to_exponent(-0.5 * kLog2E);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 lambda = load(lambda_nm + i);
    store(dst + i, in_double(lambda, [&](F64 l) {
            F64 sum(0.0);
            for (std::size_t k = 0; k < count; ++k) {
              const GaussianLobe& lobe = lobes[k];
              const F64 from_mean = l - F64(lobe.mean_nm);
              const F64 per_sigma =
                  xsimd::select(from_mean < F64(0.0), F64(lobe.per_sigma_left), F64(lobe.per_sigma_right));
              const F64 z = from_mean * per_sigma;
              sum = sum + F64(lobe.amplitude) * exp2_double(hold((z * z) * to_exponent, kExponentLimit));
            }
            return sum;
          }));
  }
}

/// The sigmoid at a wavelength limited to its range; a NaN is taken for some wavelength there. Table:
/// SigmoidSpectrum or SigmoidLanes.
template <class Table>
inline F32 sigmoid_of(const Table& table, const Coefficients& a, F32 low, F32 high, F32 lambda) noexcept {
  const F32 held = xsimd::select(lambda < low, low, xsimd::select(lambda > high, high, lambda));
  if (table.form == SigmoidForm::kFunctions) {
    const EvenPlace place = place_in(table.q, xsimd::select(is_nan(lambda), low, held));
    Functions at;
    at.p = value_at(table.p.pairs, place);
    at.q = value_at(table.q.pairs, place);
    return sigmoid_sample(a, at);
  }
  Quadratic at;
  at.q = divide(held - F32(550.0F), F32(150.0F));
  return sigmoid_sample(a, at);
}

void sigmoid_at(float* dst, const float* lambda_nm, const SigmoidSpectrum& spectrum, std::size_t n) noexcept {
  const SigmoidSpectrum s = spectrum;  // a copy that stores leave alone
  const Coefficients a = {{F32(s.c[0]), F32(s.c[1]), F32(s.c[2])}};
  const F32 low(s.lowest_nm);
  const F32 high(s.highest_nm);
  const F32 scale(s.scale);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 lambda = load(lambda_nm + i);
    store(dst + i, or_nan(lambda, sigmoid_of(s, a, low, high, lambda) * scale));
  }
}

/// Calls put(k, u_k) for the `count` numbers that one random number stands for.
template <class Put>
inline void spread(F32 u, std::size_t count, Put put) noexcept {
  const F32 one(1.0F);
  const F32 first = min(F32(1.0F - 0x1p-24F), max(F32(0.0F), u));
  for (std::size_t k = 0; k < count; ++k) {
    const F32 moved = first + F32(static_cast<float>(k) / static_cast<float>(count));
    put(k, or_nan(u, xsimd::select(moved >= one, moved - one, moved)));
  }
}

/// Where lane i's own sample k lies in blocks of `count` samples a lane.
inline std::size_t own_sample(std::size_t i, std::size_t k, std::size_t count) noexcept {
  return ((i / kLanes) * count + k) * kLanes + i % kLanes;
}

void even_wavelengths(float* lambda_nm, float* density, const float* u, const WavelengthDensity& d,
                      std::size_t count, std::size_t blocks) noexcept {
  const F32 flat(1.0F / d.range_nm);
  for (std::size_t i = 0; i < blocks * kLanes; i += kWidth) {
    spread(load(u + i), count, [&](std::size_t k, F32 v) {
      const std::size_t at = own_sample(i, k, count);
      store(lambda_nm + at, F32(d.first_nm) + v * F32(d.range_nm));
      store(density + at, flat);
    });
  }
}

void visible_wavelengths(float* lambda_nm, float* density, const float* u, const WavelengthDensity& d,
                         std::size_t count, std::size_t blocks) noexcept {
  // atanh(y) = log2((1 + y) / (1 - y)) * ln(2) / 2
  const F64 per_log2(0.5 * kLn2 * d.per_steepness_nm);
  const F64 one(1.0);
  for (std::size_t i = 0; i < blocks * kLanes; i += kWidth) {
    spread(load(u + i), count, [&](std::size_t k, F32 v) {
      const auto tanh_at = [&](F64 w) { return F64(d.from) - w * F64(d.by); };
      const F32 lambda = in_double(v, [&](F64 w) {
        const F64 y = tanh_at(w);
        return F64(d.centre_nm) - log2_double((one + y) / (one - y)) * per_log2;
      });
      const F32 pdf = in_double(v, [&](F64 w) {
        const F64 y = tanh_at(w);
        return F64(d.peak) * (one - y * y);
      });
      const std::size_t at = own_sample(i, k, count);
      store(lambda_nm + at, or_nan(v, lambda));
      store(density + at, pdf);
    });
  }
}

void table_wavelengths(float* lambda_nm, float* density, const float* u, const BinTable& table,
                       std::size_t count, std::size_t blocks) noexcept {
  const BinTable t = table;  // a copy that stores leave alone
  const F32 one(1.0F);
  for (std::size_t i = 0; i < blocks * kLanes; i += kWidth) {
    spread(load(u + i), count, [&](std::size_t k, F32 v) {
      const F32 share = xsimd::select(is_nan(v), F32(0.0F), v);
      const I32 bin = last_knot(t.knots, t, share);
      const Pair pair = gather_pair(t.bins, bin);
      const F32 low = F32(t.first_nm) + xsimd::to_float(bin);
      const F32 lambda = low + (share - gather(t.knots, bin)) * pair.first;
      const std::size_t at = own_sample(i, k, count);
      store(lambda_nm + at, or_nan(v, min((low + one) * F32(1.0F - 0x1p-24F), lambda)));
      store(density + at, pair.second);
    });
  }
}

void project_wavelengths(float* const dst[3], const WavelengthBlocks& samples, const EvenTable curves[3],
                         float factor, std::size_t blocks) noexcept {
  const F32 zero(0.0F);
  for (std::size_t i = 0; i < blocks * kLanes; i += kWidth) {
    F32 sums[3] = {zero, zero, zero};
    for (std::size_t k = 0; k < samples.count; ++k) {
      const std::size_t at = own_sample(i, k, samples.count);
      const F32 lambda = load(samples.lambda_nm + at);
      const F32 pdf = load(samples.density + at);
      const Mask live = differ(pdf, zero);
      const F32 weight = divide(load(samples.values + at), pdf);
      const EvenPlace place = place_in(curves[0], lambda);
      for (std::size_t c = 0; c < 3; ++c) {
        const F32 value = or_nan(lambda, value_at(curves[c].pairs, place));
        sums[c] = xsimd::select(live, sums[c] + value * weight, sums[c]);
      }
    }
    for (std::size_t c = 0; c < 3; ++c) store(dst[c] + i, F32(factor) * sums[c]);
  }
}

}  // namespace
}  // namespace spectile::kernels
