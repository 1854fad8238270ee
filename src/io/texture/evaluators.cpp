// Evaluators: how samples at wavelengths come from the channels of a strip, for textures.
#include "src/io/texture/evaluators.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace spectile::io {
void load_plane(const kernels::KernelTable& kernels, const Piece& piece, std::size_t plane, SampleType type,
                float* to) {
  const std::byte* const row = piece.strip.row(plane, piece.line);
  if (type == SampleType::kHalf) {
    alignas(64) std::uint16_t halves[kLanesPerBlock] = {};
    std::memcpy(halves, row + piece.x * sizeof(std::uint16_t), piece.n * sizeof(std::uint16_t));
    kernels.half_to_float(to, halves, kLanesPerBlock);
    return;
  }
  std::memcpy(to, row + piece.x * sizeof(float), piece.n * sizeof(float));
  std::fill(to + piece.n, to + kLanesPerBlock, 0.0F);
}

void CompactEvaluator::piece(const kernels::KernelTable& kernels, const Piece& piece,
                             void* const* out) const {
  alignas(64) float rows[4][kLanesPerBlock] = {};
  bool bad[kLanesPerBlock] = {};
  bool any_bad = false;
  for (std::size_t k = 0; k < planes_.size(); ++k) {
    load_plane(kernels, piece, k, SampleType::kFloat, rows[k]);
    for (std::size_t i = 0; i < piece.n; ++i) {
      bad[i] = bad[i] || !(std::fabs(rows[k][i]) <= rows_.limits()[k]);
      any_bad = any_bad || bad[i];
    }
  }
  const float* const c[3] = {rows[0], rows[1], rows[2]};
  rows_.expand_rows(kernels, c, planes_.size() > 3 ? rows[3] : nullptr, out, false, piece.n);
  for (std::size_t i = 0; i < piece.n && any_bad; ++i) {
    for (std::size_t b = 0; b < rows_.count() && bad[i]; ++b) {
      static_cast<float*>(out[b])[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

FullEvaluator::FullEvaluator(const Bands& bands, const std::vector<PlaneSpec>& channels,
                             std::span<const double> wavelengths_nm) {
  const auto list = bands.list();
  for (const double nm : wavelengths_nm) {
    const auto after = std::upper_bound(list.begin(), list.end(), nm,
                                        [](double v, const Band& band) { return v < band.centre_nm; });
    const auto next = static_cast<std::size_t>(after - list.begin());
    const std::size_t band = next == 0 ? 0 : next - 1;
    Mixture mixture;
    mixture.first = mixture.second = plane(channels[band]);
    if (next > 0 && next < list.size() && nm > list[band].centre_nm) {
      const double span_nm = list[next].centre_nm - list[band].centre_nm;
      mixture.second = plane(channels[next]);
      mixture.t = static_cast<float>((nm - list[band].centre_nm) / span_nm);
    }
    mixtures_.push_back(mixture);
  }
}

std::size_t FullEvaluator::plane(const PlaneSpec& channel) {
  // Wavelengths ascend: a channel that is there already is one of the last two.
  const std::size_t count = planes_.size();
  for (std::size_t i = count; i > 0 && i + 2 > count; --i) {
    if (planes_[i - 1].name == channel.name) return i - 1;
  }
  planes_.push_back(channel);
  return count;
}

void FullEvaluator::piece(const kernels::KernelTable& kernels, const Piece& piece, void* const* out) const {
  // Wavelengths ascend, so that holding two planes at a time suffices.
  alignas(64) float samples[2][kLanesPerBlock];
  alignas(64) float mixed[kLanesPerBlock];
  std::size_t held[2] = {planes_.size(), planes_.size()};
  const auto hold = [&](std::size_t plane) -> const float* {
    const std::size_t slot = plane % 2;
    if (held[slot] != plane) load_plane(kernels, piece, plane, planes_[plane].type, samples[slot]);
    held[slot] = plane;
    return samples[slot];
  };
  for (std::size_t b = 0; b < mixtures_.size(); ++b) {
    const Mixture& mixture = mixtures_[b];
    const float* from = hold(mixture.first);
    if (mixture.second != mixture.first) {
      kernels.lerp(mixed, from, hold(mixture.second), mixture.t, kLanesPerBlock);
      from = mixed;
    }
    std::memcpy(out[b], from, piece.n * sizeof(float));
  }
}

}  // namespace spectile::io
