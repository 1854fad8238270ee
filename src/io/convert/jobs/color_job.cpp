// ColorJob: what the jobs share whose output is a colour.
#include "src/io/convert/jobs/color_job.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {

ColorJob::ColorJob(ImageSource& source, std::size_t first_passing, const std::vector<const char*>& names,
                   const ImageOptions& options, const kernels::KernelTable& kernels)
    : source_(source), options_(options), kernels_(kernels) {
  const SampleType type = options.pixel;
  for (const char* const name : names) channels_.push_back({name, type});
  colors_ = channels_.size();
  const std::vector<PlaneSpec>& planes = source.planes();
  for (std::size_t i = first_passing; i < planes.size(); ++i) {
    const bool taken = std::any_of(channels_.begin(), channels_.end(),
                                   [&](const auto& c) { return c.name == planes[i].name; });
    if (taken) continue;
    channels_.push_back({planes[i].name, planes[i].type});
    passing_.push_back(i);
  }
}

Result<void> ColorJob::prepare(const ExrWriter& writer, std::size_t slots) {
  writer_ = &writer;
  for (std::size_t i = 0; i < slots; ++i) {
    Work work;
    SPECTILE_ASSIGN(work.color, ColorLine::create(writer.width()));
    SPECTILE_ASSIGN(work.halves, FloatBuffer::create(work.color.padded / 2));
    SPECTILE_ASSIGN(work.spectra,
                    FloatBuffer::create(spectra_floats(static_cast<std::size_t>(writer.width()))));
    works_.push_back(std::move(work));
  }
  return {};
}

void ColorJob::line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) {
  Work& work = works_[slot];
  const auto width = static_cast<std::size_t>(strip.width);
  work.color.set_width(width);
  make_colors(slot, strip, line, work.color, stats, packed == nullptr);
  if (packed == nullptr) return;
  stats.clamped += pack_colors(work, width, packed);
  for (std::size_t i = 0; i < passing_.size(); ++i) pass(strip, passing_[i], line, colors_ + i, packed);
}

std::vector<std::pair<std::size_t, PlaneSpec>> ColorJob::passing() const {
  std::vector<std::pair<std::size_t, PlaneSpec>> out;
  for (const std::size_t plane : passing_) out.emplace_back(plane, source_.planes()[plane]);
  return out;
}

void ColorJob::filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) {
  ColorLine& color = works_[slot].color;
  LineStats counted_before;
  color.set_width(static_cast<std::size_t>(strip.width));
  make_colors(slot, strip, line, color, counted_before, false);
  for (std::size_t k = 0; k < colors_; ++k) {
    std::memcpy(rows[k], color.rows[k], color.padded * sizeof(float));
  }
}

void ColorJob::level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) {
  Work& work = works_[slot];
  load_colors(strip, line, passing_.size(), colors_, work.color);
  pack_colors(work, static_cast<std::size_t>(strip.width), packed);
  for (std::size_t i = 0; i < passing_.size(); ++i) pass(strip, i, line, colors_ + i, packed);
}

/// Packs the slot's rows, and returns how many pixels were clamped to what a half holds.
std::uint64_t ColorJob::pack_colors(Work& work, std::size_t width, std::byte* packed) const {
  const bool half = options_.pixel == SampleType::kHalf;
  const std::uint64_t clamped = half ? clamp_to_half(kernels_, work.color, colors_, width) : 0;
  for (std::size_t k = 0; k < colors_; ++k) {
    store_row(kernels_, work.color.rows[k], width, options_.pixel, work.halves.data(),
              packed + writer_->channel_offset(k, width));
  }
  return clamped;
}

void ColorJob::pass(const Strip& strip, std::size_t plane, int line, std::size_t channel,
                    std::byte* packed) const {
  std::memcpy(packed + writer_->channel_offset(channel, static_cast<std::size_t>(strip.width)),
              strip.row(plane, line), strip.row_bytes[plane]);
}

}  // namespace spectile::io
