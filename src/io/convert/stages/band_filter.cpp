// BandFilter: what of a method's spectra is averaged for mip levels, so that averages are those of spectra.
#include "src/io/convert/stages/band_filter.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::io {
namespace {

constexpr std::size_t kWeights = 7;

void mix(const float* const weights[kWeights], const float* basis, std::size_t n, float* out) {
  for (std::size_t x = 0; x < n; ++x) {
    float sample = weights[0][x] * basis[0];
    for (std::size_t k = 1; k < kWeights; ++k) sample += weights[k][x] * basis[k];
    out[x] = sample;
  }
}

}  // namespace

bool linear_in_coefficients(const Upsampler& upsampler) {
  return upsampler.method() == Method::kMallett;
}

LineCoefficients coefficients_in(const Strip& strip, int line, std::size_t first) {
  const auto row = [&](std::size_t k) { return reinterpret_cast<const float*>(strip.row(first + k, line)); };
  return {{row(0), row(1), row(2)}, nullptr};
}

BandFilter::BandFilter(const kernels::KernelTable& kernels, const Upsampler& upsampler,
                       const rows::SampledRows& rows, const BandPacker& packer, const ImageOptions& options,
                       bool stored)
    : kernels_(kernels),
      rows_(rows),
      packer_(packer),
      options_(options),
      stored_(stored),
      coefficients_(linear_in_coefficients(upsampler)),
      linear_(rows.linear(true)),
      linear_above_(rows.linear(false)) {}

Result<BandFilter::Work> BandFilter::work(int width) const {
  Work out;
  const std::size_t padded = blocks_for(static_cast<std::size_t>(width)) * kLanesPerBlock;
  SPECTILE_ASSIGN(out.row, FloatBuffer::create(padded));
  SPECTILE_ASSIGN(out.halves, FloatBuffer::create(padded / 2));
  return out;
}

void BandFilter::scan(const LineCoefficients& of, std::size_t width) {
  if (linear_ || !linear_above_ || below_.load(std::memory_order_relaxed)) return;
  for (const float* const row : of.c) {
    float least = 0;
    for (std::size_t x = 0; x < width; ++x) least = std::min(least, row[x]);
    if (least < 0) below_.store(true, std::memory_order_relaxed);
  }
}

BandFilter::Kind BandFilter::kind() const noexcept {
  if (stored_) return Kind::kCoefficients;
  if (!linear_ && (!linear_above_ || below_.load(std::memory_order_relaxed))) return Kind::kSamples;
  return coefficients_ ? Kind::kCoefficients : Kind::kWeights;
}

std::size_t BandFilter::rows() const noexcept {
  switch (kind()) {
    case Kind::kCoefficients:
      return 3;
    case Kind::kWeights:
      return kWeights;
    case Kind::kSamples:
      break;
  }
  return rows_.count();
}

void BandFilter::filter(const LineCoefficients& of, std::size_t width, float* const* out) const {
  switch (kind()) {
    case Kind::kCoefficients:
      for (std::size_t k = 0; k < 3; ++k) std::memcpy(out[k], of.c[k], width * sizeof(float));
      return;
    case Kind::kWeights:
      return rows::basis_weights(of.c, width, out);
    case Kind::kSamples:
      break;
  }
  std::vector<void*> rows(out, out + rows_.count());
  rows_.expand_rows(kernels_, of.c, of.scale, rows.data(), false, width);
}

void BandFilter::pack(Work& work, BandPacker::Work& bands, const Averages& from, const ExrWriter& writer,
                      std::size_t first, std::byte* packed) const {
  const auto width = static_cast<std::size_t>(from.strip.width);
  const Kind kind = this->kind();
  if (kind == Kind::kCoefficients) {
    const LineCoefficients of = coefficients_in(from.strip, from.line, from.first);
    packer_.run(bands, of, {0, width, width}, writer, first, packed);
    return;
  }
  const auto row = [&](std::size_t i) {
    return reinterpret_cast<const float*>(from.strip.row(from.first + i, from.line));
  };
  const float* weights[kWeights] = {};
  for (std::size_t k = 0; kind == Kind::kWeights && k < kWeights; ++k) weights[k] = row(k);
  for (std::size_t band = 0; band < rows_.count(); ++band) {
    if (kind == Kind::kWeights) mix(weights, rows_.basis(band), width, work.row.data());
    store(work, kind == Kind::kWeights ? work.row.data() : row(band), width,
          packed + writer.channel_offset(first + band, width));
  }
}

void BandFilter::store(Work& work, const float* row, std::size_t width, std::byte* out) const {
  if (options_.pixel != SampleType::kFloat) {
    const std::size_t padded = blocks_for(width) * kLanesPerBlock;
    kernels_.clamp(work.row.data(), row, -kernels::kHalfMax, kernels::kHalfMax, padded);
    row = work.row.data();
  }
  store_row(kernels_, row, width, options_.pixel, work.halves.data(), out);
}

}  // namespace spectile::io
