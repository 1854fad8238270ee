// ConvertJob: spectral samples under other names, in other bands and units, line by line.
#include "src/io/convert/jobs/convert_job.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "src/base/errors.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/io/convert/stages/sample_rows.hpp"

namespace spectile::io {

ConvertJob::ConvertJob(SetsSource& source, std::vector<SampleSum> sums, const ImageOptions& options,
                       const kernels::KernelTable& kernels)
    : source_(source), sums_(std::move(sums)), options_(options), kernels_(kernels) {}

std::vector<ChannelSpec> ConvertJob::channels() const {
  std::vector<ChannelSpec> out;
  for (const SampleSum& sum : sums_) out.push_back(sum.channel);
  for (const auto& [plane, spec] : passing()) out.push_back({spec.name, spec.type});
  return out;
}

Result<void> ConvertJob::prepare(const ExrWriter& writer, std::size_t slots) {
  writer_ = &writer;
  const std::size_t padded = blocks_for(static_cast<std::size_t>(writer.width())) * kLanesPerBlock;
  for (std::size_t i = 0; i < slots; ++i) {
    Work work;
    SPECTILE_ASSIGN(work.block, FloatBuffer::create(source_.samples() * kLanesPerBlock));
    SPECTILE_ASSIGN(work.rows, FloatBuffer::create(sums_.size() * padded));
    SPECTILE_ASSIGN(work.halves, FloatBuffer::create(padded / 2));
    for (std::size_t k = 0; k < sums_.size(); ++k) work.each.push_back(work.rows.data() + k * padded);
    works_.push_back(std::move(work));
  }
  return {};
}

void ConvertJob::line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) {
  Work& work = works_[slot];
  make_rows(work, strip, line, work.each.data(), stats);
  if (packed == nullptr) return;
  stats.clamped += pack(work, static_cast<std::size_t>(strip.width), packed);
  pass(strip, line, source_.samples(), packed);
}

std::vector<std::pair<std::size_t, PlaneSpec>> ConvertJob::passing() const {
  std::vector<std::pair<std::size_t, PlaneSpec>> out;
  for (std::size_t i = source_.samples(); i < source_.planes().size(); ++i) {
    out.emplace_back(i, source_.planes()[i]);
  }
  return out;
}

void ConvertJob::filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) {
  LineStats counted_before;
  make_rows(works_[slot], strip, line, rows, counted_before);
}

void ConvertJob::level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) {
  Work& work = works_[slot];
  const auto width = static_cast<std::size_t>(strip.width);
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    std::memcpy(work.each[k], strip.row(passing_count() + k, line), width * sizeof(float));
    std::fill(work.each[k] + width, work.each[k] + blocks_for(width) * kLanesPerBlock, 0.0F);
  }
  pack(work, width, packed);
  pass(strip, line, 0, packed);
}

/// The sums of a line, in rows of whole blocks.
void ConvertJob::make_rows(Work& work, const Strip& strip, int line, float* const* rows,
                           LineStats& stats) const {
  const auto width = static_cast<std::size_t>(strip.width);
  for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
    source_.block(kernels_, strip, line, at, work.block.data());
    make_block(work.block.data(), at, rows);
  }
  sanitize_samples({rows, sums_.size()}, width, line, options_.nonfinite, stats);
}

void ConvertJob::make_block(const float* block, std::size_t at, float* const* rows) const {
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    const SampleSum& sum = sums_[k];
    const float* const samples = block + sum.first * kLanesPerBlock;
    float* const to = rows[k] + at;
    if (sum.weights.size() > 1) {
      kernels_.weighted_sum(to, samples, sum.weights.data(), sum.weights.size(), 1);
    } else if (sum.weights[0] == 1) {
      std::memcpy(to, samples, kLanesPerBlock * sizeof(float));
    } else {
      kernels_.scale(to, samples, sum.weights[0], kLanesPerBlock);
    }
  }
}

/// Packs the slot's rows, and returns how many pixels were clamped.
std::uint64_t ConvertJob::pack(Work& work, std::size_t width, std::byte* packed) const {
  std::vector<float*> halves;
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    if (sums_[k].channel.type == SampleType::kHalf) halves.push_back(work.each[k]);
  }
  const std::uint64_t clamped = clamp_samples(kernels_, halves, width);
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    store_row(kernels_, work.each[k], width, sums_[k].channel.type, work.halves.data(),
              packed + writer_->channel_offset(k, width));
  }
  return clamped;
}

void ConvertJob::pass(const Strip& strip, int line, std::size_t first_plane, std::byte* packed) const {
  const auto width = static_cast<std::size_t>(strip.width);
  for (std::size_t i = 0; i < passing_count(); ++i) {
    const std::size_t plane = first_plane + i;
    std::memcpy(packed + writer_->channel_offset(sums_.size() + i, width), strip.row(plane, line),
                strip.row_bytes[plane]);
  }
}

}  // namespace spectile::io
