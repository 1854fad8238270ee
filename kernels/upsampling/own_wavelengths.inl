// Spectra of colours at wavelengths that each lane has of its own.
#pragma once

#include "kernels/upsampling/grid_places.inl"
#include "kernels/upsampling/sigmoid_point.inl"
#include "kernels/upsampling/smits_weights.inl"
#include "kernels/wavelengths.inl"

namespace spectile::kernels {
namespace {

/// Where wavelengths lie between the centres of bands.
struct CentrePlace {
  I32 interval;
  F32 part;
};

inline CentrePlace place_between(const CentreTable& centres, F32 lambda) noexcept {
  const F32 first(centres.first_nm);
  const F32 last(centres.last_nm);
  const F32 held = xsimd::select(lambda < first, first, xsimd::select(lambda > last, last, lambda));
  const F32 safe = xsimd::select(is_nan(lambda), first, held);
  const I32 last_interval(centres.intervals - 1);
  CentrePlace out;
  if (centres.knots == nullptr) {
    const F32 at = (safe - first) * F32(centres.per_nm);
    out.interval = xsimd::min(xsimd::to_int(at), last_interval);
    out.part = at - xsimd::to_float(out.interval);
  } else {
    out.interval = xsimd::min(last_knot(centres.knots, centres, safe), last_interval);
    out.part = (safe - gather(centres.knots, out.interval)) * gather(centres.per_width, out.interval);
  }
  out.part = min(F32(1.0F), out.part);
  return out;
}

void centre_places(std::int32_t* interval, float* part, const float* lambda_nm, const CentreTable& centres,
                   std::size_t n) noexcept {
  const CentreTable c = centres;  // a copy that stores leave alone
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 lambda = load(lambda_nm + i);
    const CentrePlace place = place_between(c, lambda);
    place.interval.store_aligned(interval + i);
    store(part + i, or_nan(lambda, place.part));
  }
}

/// For each vector of lanes: prepare(first lane) gives a function of the wavelength, whose results at each of
/// the lanes' own are kept.
template <class Prepare>
inline void at_own_wavelengths(float* dst, const float* lambda_nm, std::size_t count, std::size_t blocks,
                               Prepare prepare) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; i += kWidth) {
    const auto sample = prepare(i);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = own_sample(i, k, count);
      const F32 lambda = load(lambda_nm + at);
      store(dst + at, or_nan(lambda, sample(lambda)));
    }
  }
}

void mixtures_at(float* dst, const float* const rgb[3], const MixtureTable& table, const CentreTable& centres,
                 const float* lambda_nm, std::size_t count, std::size_t blocks) noexcept {
  const MixtureTable t = table;  // copies that stores leave alone
  const CentreTable c = centres;
  const float* const in[3] = {rgb[0], rgb[1], rgb[2]};
  at_own_wavelengths(dst, lambda_nm, count, blocks, [&](std::size_t i) {
    const MixtureWeights m = mixture_weights(load(in[0] + i), load(in[1] + i), load(in[2] + i));
    return [m, &t, &c](F32 lambda) {
      const CentrePlace place = place_between(c, lambda);
      const I32 row = place.interval * I32(static_cast<std::int32_t>(kSmitsRow));
      const Pair white = gather_pair(t.ends, row);
      const Pair second = gather_pair(t.ends, row + m.second_basis);
      const Pair first = gather_pair(t.ends, row + m.first_basis);
      const F32 lowest(t.lowest);
      const F32 a = max(lowest, (m.white * white.first + m.second * second.first) + m.first * first.first);
      const F32 b = max(lowest, (m.white * white.second + m.second * second.second) + m.first * first.second);
      return a + place.part * (b - a);
    };
  });
}

void bases_at(float* dst, const float* weights, const MixtureTable& table, const CentreTable& centres,
              const float* lambda_nm, std::size_t count, std::size_t blocks) noexcept {
  const MixtureTable t = table;  // copies that stores leave alone
  const CentreTable c = centres;
  at_own_wavelengths(dst, lambda_nm, count, blocks, [&](std::size_t i) {
    const float* const of = weights + i / kLanes * kLanes * kSmitsRow + i % kLanes;
    return [of, &t, &c](F32 lambda) {
      const CentrePlace place = place_between(c, lambda);
      const I32 row = place.interval * I32(static_cast<std::int32_t>(kSmitsRow));
      const Pair white = gather_pair(t.ends, row);
      F32 a = load(of) * white.first;
      F32 b = load(of) * white.second;
      for (std::size_t k = 1; k + 1 < kSmitsRow; ++k) {
        const Pair basis = gather_pair(t.ends, row + I32(static_cast<std::int32_t>(k)));
        const F32 weight = load(of + k * kLanes);
        a = a + weight * basis.first;
        b = b + weight * basis.second;
      }
      a = max(F32(t.lowest), a);
      b = max(F32(t.lowest), b);
      return a + place.part * (b - a);
    };
  });
}

void grid_at(float* dst, const GridSpectra& spectra, const CentreTable& centres, const float* lambda_nm,
             std::size_t count, std::size_t blocks) noexcept {
  const GridSpectra s = spectra;  // copies that stores leave alone
  const CentreTable c = centres;
  GridPlaces places;
  at_own_wavelengths(dst, lambda_nm, count, blocks, [&](std::size_t i) {
    if (i % kLanes == 0) place_block(places, s, i, s.table.stride);
    return [&places, &s, &c, lane = i % kLanes](F32 lambda) {
      const CentrePlace place = place_between(c, lambda);
      const float* const nodes = s.table.nodes;
      F32 a(0.0F);
      F32 b(0.0F);
      for (std::size_t n = 0; n < 4; ++n) {
        const Pair ends = gather_two<1>(nodes, I32::load_aligned(places.node[n] + lane) + place.interval);
        const F32 weight = load(places.weight[n] + lane);
        a = n == 0 ? weight * ends.first : a + weight * ends.first;
        b = n == 0 ? weight * ends.second : b + weight * ends.second;
      }
      a = max(F32(s.table.lowest), a);
      b = max(F32(s.table.lowest), b);
      return a + place.part * (b - a);
    };
  });
}

void sigmoids_at(float* dst, const SigmoidLanes& sigmoids, const float* lambda_nm, std::size_t count,
                 std::size_t blocks) noexcept {
  const SigmoidLanes s = sigmoids;  // a copy that stores leave alone
  const float* const c[3] = {s.c[0], s.c[1], s.c[2]};
  const F32 low(s.lowest_nm);
  const F32 high(s.highest_nm);
  at_own_wavelengths(dst, lambda_nm, count, blocks, [&](std::size_t i) {
    const Coefficients a = {{load(c[0] + i), load(c[1] + i), load(c[2] + i)}};
    const F32 scale = s.scale == nullptr ? F32(1.0F) : load(s.scale + i);
    return [&, a, scale](F32 lambda) {
      const F32 sample = sigmoid_of(s, a, low, high, lambda);
      return s.scale == nullptr ? sample : sample * scale;
    };
  });
}

}  // namespace
}  // namespace spectile::kernels
