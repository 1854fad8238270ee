// SpectraJob: rows of spectra in memory as lines of a spectral image, with preview and alpha.
#include "src/io/write/spectra_job.hpp"

#include <algorithm>
#include <cstring>

#include "src/color/color_matrix.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/io/convert/stages/sample_rows.hpp"

namespace spectile::io {

std::byte* KeptLines::add(int line, std::size_t line_bytes) {
  if (range_.count == 0) {
    range_.first = line;
    line_bytes_ = line_bytes;
  }
  const std::size_t at = static_cast<std::size_t>(range_.count++) * line_bytes;
  // Growing by and by it would hold up to three times as much.
  bytes_.reserve(max_bytes_);
  if (bytes_.size() < at + line_bytes) bytes_.resize(at + line_bytes);
  return bytes_.data() + at;
}

const std::byte* KeptLines::line(int line) const {
  return bytes_.data() + static_cast<std::size_t>(line - range_.first) * line_bytes_;
}

SpectraJob::SpectraJob(int width, const Bands& bands, const SpectralImageOptions& options,
                       std::optional<Projector> preview, const kernels::KernelTable& kernels)
    : width_(width),
      bands_(bands.count()),
      pixel_(options.pixel),
      nonfinite_(options.nonfinite),
      preview_(std::move(preview)),
      kernels_(kernels) {
  add_band_channels(channels_, bands, options.quantity, pixel_);
  if (options.alpha) channels_.push_back({"A", pixel_});
  if (!preview_) return;
  to_srgb_ = color::to_float(color_matrix(*preview_, ColorTarget::kSrgb, Adaptation::kNone));
  for (const char* const name : color_channels(ColorTarget::kSrgb)) channels_.push_back({name, pixel_});
}

Result<void> SpectraJob::prepare(const ExrWriter& writer, std::size_t slots) {
  writer_ = &writer;
  const std::size_t padded = blocks_for(static_cast<std::size_t>(width_)) * kLanesPerBlock;
  for (std::size_t i = 0; i < slots; ++i) {
    Work work;
    SPECTILE_ASSIGN(work.block, FloatBuffer::create(bands_ * kLanesPerBlock));
    SPECTILE_ASSIGN(work.rows, FloatBuffer::create(channels_.size() * padded));
    SPECTILE_ASSIGN(work.halves, FloatBuffer::create(padded / 2));
    for (std::size_t k = 0; k < channels_.size(); ++k) work.each.push_back(work.rows.data() + k * padded);
    works_.push_back(std::move(work));
  }
  return {};
}

Result<std::shared_ptr<Strip>> SpectraJob::read(int first_line, int lines) {
  return make_strip({}, width_, first_line, lines);
}

void SpectraJob::keep(int line, LineStats& stats) {
  Work& work = works_.front();
  const auto width = static_cast<std::size_t>(width_);
  std::byte* const packed = kept_.add(line, writer_->line_bytes(width_));
  make_rows(work, {line, 0, width}, work.each.data(), stats);
  stats.clamped += pack(work, width, packed);
}

void SpectraJob::line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) {
  const auto x = static_cast<std::size_t>(strip.first_x);
  const auto width = static_cast<std::size_t>(strip.width);
  if (!kept_.holds(line)) {
    Work& work = works_[slot];
    make_rows(work, {line, x, width}, work.each.data(), stats);
    if (packed != nullptr) stats.clamped += pack(work, width, packed);
    return;
  }
  if (packed == nullptr) return;
  const std::byte* const from = kept_.line(line);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const std::size_t bytes = channels_[k].sample_bytes();
    std::memcpy(packed + writer_->channel_offset(k, width), from + writer_->channel_offset(k) + x * bytes,
                width * bytes);
  }
}

void SpectraJob::filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) {
  LineStats counted_before;
  make_rows(works_[slot], {line, 0, static_cast<std::size_t>(strip.width)}, rows, counted_before);
}

void SpectraJob::level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) {
  Work& work = works_[slot];
  const auto width = static_cast<std::size_t>(strip.width);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    std::memcpy(work.each[k], strip.row(k, line), width * sizeof(float));
    std::fill(work.each[k] + width, work.each[k] + blocks_for(width) * kLanesPerBlock, 0.0F);
  }
  pack(work, width, packed);
}

/// Rows of whole blocks, one a channel.
void SpectraJob::make_rows(Work& work, const Part& part, float* const* rows, LineStats& stats) const {
  const std::size_t given = channels_.size() - (preview_ ? 3 : 0);
  rows_.load(part.line, part.x, part.width, rows);
  for (std::size_t k = 0; k < given; ++k) {
    std::fill(rows[k] + part.width, rows[k] + blocks_for(part.width) * kLanesPerBlock, 0.0F);
  }
  sanitize_samples({rows, given}, part.width, part.line, nonfinite_, stats);
  if (preview_) add_preview(work, part.width, rows);
}

void SpectraJob::add_preview(Work& work, std::size_t width, float* const* rows) const {
  // So large that the matrix cannot overflow.
  constexpr float kLargest = kLargestComponent;
  float* const* const color = rows + (channels_.size() - 3);
  const std::size_t padded = blocks_for(width) * kLanesPerBlock;
  for (std::size_t at = 0; at < padded; at += kLanesPerBlock) {
    for (std::size_t k = 0; k < bands_; ++k) {
      std::memcpy(work.block.data() + k * kLanesPerBlock, rows[k] + at, kLanesPerBlock * sizeof(float));
    }
    float* const to[3] = {color[0] + at, color[1] + at, color[2] + at};
    kernels_.project(to, work.block.data(), ProjectorAccess::weights(*preview_), bands_, 1);
  }
  for (std::size_t c = 0; c < 3; ++c) kernels_.clamp(color[c], color[c], -kLargest, kLargest, padded);
  const float* const xyz[3] = {color[0], color[1], color[2]};
  kernels_.transform3(color, xyz, to_srgb_.data(), padded);
}

/// Packs the slot's rows, and returns how many pixels were clamped.
std::uint64_t SpectraJob::pack(Work& work, std::size_t width, std::byte* packed) const {
  const std::uint64_t clamped = pixel_ == SampleType::kHalf ? clamp_samples(kernels_, work.each, width) : 0;
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    store_row(kernels_, work.each[k], width, pixel_, work.halves.data(),
              packed + writer_->channel_offset(k, width));
  }
  return clamped;
}

}  // namespace spectile::io
