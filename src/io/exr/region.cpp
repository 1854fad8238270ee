// RegionReader: a part of an image as if it were an image, with no more decoded than it touches.
#include "src/io/exr/region.hpp"

#include <OpenEXR/ImfFrameBuffer.h>

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

/// The first and the last pixel, both included.
std::string corners(const PixelWindow& w) {
  return fmt::format("{},{},{},{}", w.x0, w.y0, std::int64_t{w.x1} - 1, std::int64_t{w.y1} - 1);
}

}  // namespace

Result<RegionReader> RegionReader::create(ExrInput& input, int part, const PixelWindow& region,
                                          std::vector<std::string>& notes) {
  const PixelWindow& file = input.header(part).data_window();
  if (region.empty()) {
    return make_error(ErrorCode::kBadArgument,
                      "the region {} is empty: its last pixel comes before its first", corners(region));
  }
  const PixelWindow window = {std::max(region.x0, file.x0), std::max(region.y0, file.y0),
                              std::min(region.x1, file.x1), std::min(region.y1, file.y1)};
  if (window.empty()) {
    return make_error(ErrorCode::kBadArgument, "{}: the region {} lies outside of the data window {}",
                      input.path(), corners(region), corners(file));
  }
  if (window != region) {
    notes.push_back(fmt::format("the region {} is limited to {}: the data window is {}", corners(region),
                                corners(window), corners(file)));
  }
  RegionReader out;
  out.input_ = &input;
  out.part_ = part;
  out.header_ = input.header(part).with_data_window(window);
  out.x_ = window.x0 - file.x0;
  out.y_ = window.y0 - file.y0;
  out.columns_ = file.width();
  if (const auto& tiles = out.header_.tiles()) {
    out.first_tile_ = out.x_ / tiles->width;
    out.last_tile_ = (out.x_ + window.width() - 1) / tiles->width;
    out.first_column_ = out.first_tile_ * tiles->width;
    const std::int64_t end = (std::int64_t{out.last_tile_} + 1) * tiles->width;
    out.columns_ = static_cast<int>(std::min<std::int64_t>(end, out.columns_)) - out.first_column_;
  }
  return out;
}

int RegionReader::slab_lines(const std::vector<PlaneSpec>& planes) const {
  if (header_.tiles()) return header_.tiles()->height;
  constexpr std::size_t kSlabBytes = std::size_t{16} << 20;
  // Whole chunks of the common compressions, none of which is then decoded twice.
  constexpr int kUnit = 32;
  std::size_t line = 1;
  for (const PlaneSpec& plane : planes) line += plane.sample_bytes() * static_cast<std::size_t>(columns_);
  return std::clamp(static_cast<int>(std::min<std::size_t>(kSlabBytes / line, 256)) / kUnit * kUnit, kUnit,
                    256);
}

Result<void> RegionReader::load(const std::vector<PlaneSpec>& planes, int slab, int lines) {
  if (slab == loaded_) return {};
  loaded_ = -1;
  const PixelWindow& file = input_->header(part_).data_window();
  const bool tiled = header_.tiles().has_value();
  // Of tiles all lines come anyway.
  const int begin = tiled ? 0 : y_;
  const int end = tiled ? file.height() : y_ + header_.height();
  const int first = std::max(slab * lines, begin);
  const int last = static_cast<int>(std::min<std::int64_t>((std::int64_t{slab} + 1) * lines, end)) - 1;
  if (!slab_ || slab_->lines != last - first + 1) {
    slab_.reset();
    SPECTILE_ASSIGN(slab_, make_strip(planes, columns_, first, last - first + 1));
  }
  slab_->first_line = first;
  Imf::FrameBuffer target;
  add_slices(target, planes, file.x0 + first_column_, file.y0 + first, columns_, *slab_);
  SPECTILE_TRY(tiled ? input_->read_tiles(part_, target, {first_tile_, last_tile_, slab, slab})
                     : input_->read(part_, target, file.y0 + first, file.y0 + last));
  loaded_ = slab;
  return {};
}

Result<void> RegionReader::fill(const std::vector<PlaneSpec>& planes, Strip& strip) {
  const int lines = slab_lines(planes);
  const auto width = static_cast<std::size_t>(header_.width());
  const auto left = static_cast<std::size_t>(x_ - first_column_);
  for (int line = strip.first_line; line < strip.first_line + strip.lines; ++line) {
    SPECTILE_TRY(load(planes, (y_ + line) / lines, lines));
    for (std::size_t i = 0; i < planes.size(); ++i) {
      if (planes[i].name.empty()) continue;
      const std::size_t bytes = planes[i].sample_bytes();
      std::memcpy(strip.row(i, line), slab_->row(i, y_ + line) + left * bytes, width * bytes);
    }
  }
  return {};
}

}  // namespace spectile::io
