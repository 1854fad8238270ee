// The bands of a spectral output: their channels, the attributes that go with them, and their samples,
// packed.
#include "src/io/convert/stages/band_channels.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "src/base/errors.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/channels/spectral_layout.hpp"
#include "src/io/convert/sources/method_attributes.hpp"

namespace spectile::io {
namespace {

/// The coefficients of `of` from pixel `at` on.
LineCoefficients from(const LineCoefficients& of, std::size_t at) {
  return {{of.c[0] + at, of.c[1] + at, of.c[2] + at}, of.scale == nullptr ? nullptr : of.scale + at};
}

/// Packed rows of floats may lie at any even address.
template <class Sample>
void fill_row(std::byte* row, std::size_t at, std::size_t n, Sample sample) {
  std::byte* const to = row + at * sizeof(Sample);
  for (std::size_t i = 0; i < n; ++i) std::memcpy(to + i * sizeof(Sample), &sample, sizeof(Sample));
}

}  // namespace

void add_band_channels(std::vector<ChannelSpec>& channels, const Bands& bands, Quantity quantity,
                       SampleType type) {
  const auto kind = quantity == Quantity::kIlluminant ? SpectralKind::kEmissive : SpectralKind::kReflective;
  for (const Band& band : bands.list())
    channels.push_back({spectral_channel_name(kind, band.centre_nm), type});
}

std::vector<std::string> layout_attribute_names() {
  return {"spectralLayoutVersion", "emissiveUnits", kPlanAttribute};
}

std::vector<std::string> spectral_attribute_names() {
  std::vector<std::string> out = method_attribute_names();
  for (std::string& name : layout_attribute_names()) out.push_back(std::move(name));
  return out;
}

void add_layout_attributes(TextAttributes& texts, Quantity quantity, const Bands& bands) {
  texts.emplace_back("spectralLayoutVersion", "1.0");
  if (quantity == Quantity::kIlluminant) texts.emplace_back("emissiveUnits", "W.m^-2.sr^-1");
  add_plan_attribute(texts, bands);
}

float largest_magnitude(const float* row, std::size_t n) {
  // Without their signs, floats are in the order of their bits, which compilers take several at a time.
  std::int32_t largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    largest =
        std::max(largest, std::bit_cast<std::int32_t>(row[i]) & std::numeric_limits<std::int32_t>::max());
  }
  return std::bit_cast<float>(largest);
}

BandPacker::BandPacker(const kernels::KernelTable& kernels, const rows::SampledRows& rows,
                       const ImageOptions& options)
    : kernels_(kernels), rows_(rows), half_(options.pixel == SampleType::kHalf) {
  segment_ = std::max<std::size_t>(kLanesPerBlock, options.tile_lanes / kLanesPerBlock * kLanesPerBlock);
}

Result<BandPacker::Work> BandPacker::work() const {
  Work out;
  out.rows.resize(rows_.count());
  SPECTILE_ASSIGN(out.block, FloatBuffer::create((rows_.count() + 2) * kLanesPerBlock));
  out.filler.resize(rows_.count());
  return out;
}

std::uint64_t BandPacker::line(Work& work, const LineCoefficients& of, std::size_t width,
                               const ExrWriter& writer, std::size_t first, std::byte* packed) const {
  run(work, of, {0, width, width}, writer, first, packed);
  return clamped(work, of, width);
}

void BandPacker::run(Work& work, const LineCoefficients& of, const Part& part, const ExrWriter& writer,
                     std::size_t first, std::byte* packed) const {
  const std::size_t sample_bytes = half_ ? 2 : 4;
  const std::size_t end = part.at + part.pixels;
  for (std::size_t at = part.at; at < end; at += segment_) {
    for (std::size_t b = 0; b < rows_.count(); ++b) {
      work.rows[b] = packed + writer.channel_offset(first + b, part.width) + at * sample_bytes;
    }
    const LineCoefficients segment = from(of, at);
    rows_.expand_rows(kernels_, segment.c, segment.scale, work.rows.data(), half_,
                      std::min(segment_, end - at));
  }
}

void BandPacker::fill(Work& work, const LineCoefficients& of, const Part& part, const ExrWriter& writer,
                      std::size_t first, std::byte* packed) const {
  const LineCoefficients segment = from(of, part.at);
  std::array<std::uint32_t, 4> bits{};
  for (std::size_t k = 0; k < 3; ++k) bits[k] = std::bit_cast<std::uint32_t>(segment.c[k][0]);
  if (segment.scale != nullptr) bits[3] = std::bit_cast<std::uint32_t>(segment.scale[0]);
  if (!work.has_filler || bits != work.filler_of) {
    for (std::size_t b = 0; b < rows_.count(); ++b) work.rows[b] = &work.filler[b];
    rows_.expand_rows(kernels_, segment.c, segment.scale, work.rows.data(), half_, 1);
    work.filler_of = bits;
    work.has_filler = true;
  }
  for (std::size_t b = 0; b < rows_.count(); ++b) {
    std::byte* const row = packed + writer.channel_offset(first + b, part.width);
    if (half_) {
      fill_row(row, part.at, part.pixels, static_cast<std::uint16_t>(work.filler[b]));
    } else {
      fill_row(row, part.at, part.pixels, work.filler[b]);
    }
  }
}

std::uint64_t BandPacker::clamped(Work& work, const LineCoefficients& of, std::size_t width) const {
  return half_ && may_exceed_half(of, width) ? count_clamped(work, of, width) : 0;
}

bool BandPacker::may_exceed_half(const LineCoefficients& of, std::size_t width) const {
  std::array<float, 4> largest{};
  for (std::size_t k = 0; k < 3; ++k) largest[k] = largest_magnitude(of.c[k], width);
  if (of.scale != nullptr) largest[3] = largest_magnitude(of.scale, width);
  return rows_.bound(largest) > kernels::kHalfMax;
}

std::uint64_t BandPacker::count_clamped(Work& work, const LineCoefficients& of, std::size_t width) const {
  float* const greatest = work.block.data() + rows_.count() * kLanesPerBlock;
  float* const least = greatest + kLanesPerBlock;
  std::uint64_t count = 0;
  for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
    const LineCoefficients segment = from(of, at);
    rows_.expand_blocks(kernels_, segment.c, segment.scale, work.block.data(), 1);
    kernels_.maximum(greatest, work.block.data(), rows_.count(), 1);
    kernels_.minimum(least, work.block.data(), rows_.count(), 1);
    for (std::size_t i = 0; i < std::min(kLanesPerBlock, width - at); ++i) {
      count += greatest[i] > kernels::kHalfMax || least[i] < -kernels::kHalfMax ? 1 : 0;
    }
  }
  return count;
}

}  // namespace spectile::io
