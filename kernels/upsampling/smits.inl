// Smits upsampling without branches: two table permutes and three multiply-adds a band.
#pragma once

#include "kernels/abi/upsampling.hpp"
#include "kernels/simd/convert.hpp"
#include "kernels/simd/tables.hpp"
#include "kernels/simd/vector.hpp"
#include "kernels/upsampling/smits_weights.inl"

namespace spectile::kernels {
namespace {

/// A mixture ready for permutes of a row.
struct Mixture {
  F32 white, second, first;
  Index second_index, first_index;
};

inline Mixture mixture(F32 r, F32 g, F32 b) noexcept {
  const MixtureWeights m = mixture_weights(r, g, b);
  return {m.white, m.second, m.first, prepare(m.second_basis), prepare(m.first_basis)};
}

inline F32 mixed(const Mixture& m, const Row& row, F32 white, F32 lowest) noexcept {
  const F32 sample =
      (m.white * white + m.second * secondary(row, m.second_index)) + m.first * primary(row, m.first_index);
  return max(lowest, sample);
}

/// Vectors of a block taken at once for non-temporal stores: all, so that memory is written line after line.
inline constexpr std::size_t kWholeBlock = kLanes / kWidth;

/// Calls put(band, lane, sample) for every band and each vector of kLanes pixels at rgb + at, kTogether
/// vectors at once. The minimum comes as a number: where GCC 12 passes a vector to a function of its own, it
/// forgets to clear the registers' upper parts at the end, and every caller's scalar code then takes many
/// times as long.
template <std::size_t kTogether = kGroup, class Put>
inline void smits_lanes(const float* const rgb[3], std::size_t at, const SmitsTable& table,
                        Put put) noexcept {
  const F32 lowest(table.lowest);
  for (std::size_t lane = 0; lane < kLanes; lane += kTogether * kWidth) {
    Mixture m[kTogether];
    for (std::size_t j = 0; j < kTogether; ++j) {
      const std::size_t i = at + lane + j * kWidth;
      m[j] = mixture(load(rgb[0] + i), load(rgb[1] + i), load(rgb[2] + i));
    }
    for (std::size_t band = 0; band < table.bands; ++band) {
      const float* entry = table.rows + band * kSmitsRow;
      const Row row = load_row(entry);
      const F32 white(entry[0]);
      for (std::size_t j = 0; j < kTogether; ++j)
        put(band, lane + j * kWidth, mixed(m[j], row, white, lowest));
    }
  }
}

void smits_blocks(float* dst, const float* const rgb[3], const SmitsTable& table, std::size_t blocks,
                  bool non_temporal) noexcept {
  const SmitsTable t = table;  // a copy that stores through dst leave alone
  for (std::size_t block = 0; block < blocks; ++block, dst += t.bands * kLanes) {
    if (non_temporal) {
      smits_lanes<kWholeBlock>(rgb, block * kLanes, t, [dst](std::size_t band, std::size_t lane, F32 v) {
        stream(dst + band * kLanes + lane, v);
      });
    } else {
      smits_lanes(rgb, block * kLanes, t,
                  [dst](std::size_t band, std::size_t lane, F32 v) { store(dst + band * kLanes + lane, v); });
    }
  }
  if (non_temporal) stream_fence();
}

inline void put_sample(float* p, F32 v) noexcept {
  store_any(p, v);
}
inline void put_sample(std::uint16_t* p, F32 v) noexcept {
  store_half(p, min(F32(kHalfMax), v));
}

template <class Sample>
inline void smits_rows(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                       std::size_t n) noexcept {
  const SmitsTable t = table;
  const F32 low(t.lowest);
  const std::size_t whole = n / kLanes * kLanes;
  for (std::size_t at = 0; at < whole; at += kLanes) {
    smits_lanes(rgb, at, t, [rows, at](std::size_t band, std::size_t lane, F32 v) {
      put_sample(static_cast<Sample*>(rows[band]) + at + lane, v);
    });
  }
  if (whole == n) return;
  // The rest of the row goes through a small buffer a band at a time: what follows a row's end is not ours.
  const std::size_t rest = n - whole;
  Mixture m[kLanes / kWidth];
  for (std::size_t j = 0; j * kWidth < rest; ++j) {
    const std::size_t i = whole + j * kWidth;
    m[j] = mixture(load(rgb[0] + i), load(rgb[1] + i), load(rgb[2] + i));
  }
  for (std::size_t band = 0; band < t.bands; ++band) {
    alignas(64) Sample tail[kLanes];
    const float* entry = t.rows + band * kSmitsRow;
    const Row row = load_row(entry);
    const F32 white(entry[0]);
    for (std::size_t j = 0; j * kWidth < rest; ++j)
      put_sample(tail + j * kWidth, mixed(m[j], row, white, low));
    std::memcpy(static_cast<Sample*>(rows[band]) + whole, tail, rest * sizeof(Sample));
  }
}

void smits_fold(float* const dst[3], const float* const rgb[3], const float* table, std::size_t n) noexcept {
  const Row rows[3] = {load_row(table), load_row(table + kSmitsRow), load_row(table + 2 * kSmitsRow)};
  const F32 white[3] = {F32(table[0]), F32(table[kSmitsRow]), F32(table[2 * kSmitsRow])};
  for (std::size_t i = 0; i < n; i += kWidth) {
    const Mixture m = mixture(load(rgb[0] + i), load(rgb[1] + i), load(rgb[2] + i));
    for (std::size_t k = 0; k < 3; ++k) {
      store(dst[k] + i, (m.white * white[k] + m.second * secondary(rows[k], m.second_index)) +
                            m.first * primary(rows[k], m.first_index));
    }
  }
}

void smits_rows_float(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                      std::size_t n) noexcept {
  smits_rows<float>(rows, rgb, table, n);
}

void smits_rows_half(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                     std::size_t n) noexcept {
  smits_rows<std::uint16_t>(rows, rgb, table, n);
}

}  // namespace
}  // namespace spectile::kernels
