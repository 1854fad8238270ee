// RegionReader: a part of an image as if it were an image, with no more decoded than it touches.
#include "src/io/exr/region.hpp"

#include <OpenEXR/ImfTileDescription.h>

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

std::string text_of(const Imath::Box2i& box) {
  return fmt::format("{},{},{},{}", box.min.x, box.min.y, box.max.x, box.max.y);
}

/// A side of a tile; believed up to that of an image only.
int tile_side(unsigned side) {
  return static_cast<int>(std::clamp(side, 1U, static_cast<unsigned>(ExrInput::kMaxSide)));
}

}  // namespace

Result<RegionReader> RegionReader::create(ExrInput& input, int part, const std::array<int, 4>& region,
                                          std::vector<std::string>& notes) {
  const Imath::Box2i asked({region[0], region[1]}, {region[2], region[3]});
  const Imath::Box2i file = input.header(part).dataWindow();
  if (asked.min.x > asked.max.x || asked.min.y > asked.max.y) {
    return make_error(ErrorCode::kBadArgument,
                      "the region {} is empty: its last pixel comes before its first", text_of(asked));
  }
  const Imath::Box2i box({std::max(asked.min.x, file.min.x), std::max(asked.min.y, file.min.y)},
                         {std::min(asked.max.x, file.max.x), std::min(asked.max.y, file.max.y)});
  if (box.min.x > box.max.x || box.min.y > box.max.y) {
    return make_error(ErrorCode::kBadArgument, "{}: the region {} lies outside of the data window {}",
                      input.path(), text_of(asked), text_of(file));
  }
  if (box != asked) {
    notes.push_back(fmt::format("the region {} is limited to {}: the data window is {}", text_of(asked),
                                text_of(box), text_of(file)));
  }
  RegionReader out;
  out.input_ = &input;
  out.part_ = part;
  out.header_ = input.header(part);
  out.header_.dataWindow() = box;
  out.x_ = box.min.x - file.min.x;
  out.y_ = box.min.y - file.min.y;
  out.columns_ = width_of(input.header(part));
  if (out.header_.hasTileDescription()) {
    const int side = tile_side(out.header_.tileDescription().xSize);
    out.first_tile_ = out.x_ / side;
    out.last_tile_ = (out.x_ + width_of(out.header_) - 1) / side;
    out.first_column_ = out.first_tile_ * side;
    const std::int64_t end = (std::int64_t{out.last_tile_} + 1) * side;
    out.columns_ = static_cast<int>(std::min<std::int64_t>(end, out.columns_)) - out.first_column_;
  }
  return out;
}

int RegionReader::slab_lines(const std::vector<PlaneSpec>& planes) const {
  if (header_.hasTileDescription()) return tile_side(header_.tileDescription().ySize);
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
  const Imath::Box2i file = input_->header(part_).dataWindow();
  const bool tiled = header_.hasTileDescription();
  // Of tiles all lines come anyway.
  const int least = tiled ? 0 : y_;
  const int most = tiled ? height_of(input_->header(part_)) : y_ + height_of(header_);
  const int first = std::max(slab * lines, least);
  const int last = static_cast<int>(std::min<std::int64_t>((std::int64_t{slab} + 1) * lines, most)) - 1;
  if (!slab_ || slab_->lines != last - first + 1) {
    slab_.reset();
    SPECTILE_ASSIGN(slab_, make_strip(planes, columns_, first, last - first + 1));
  }
  slab_->first_line = first;
  Imf::FrameBuffer target;
  const Imath::V2i origin(file.min.x + first_column_, file.min.y + first);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].name.empty()) continue;
    target.insert(planes[i].name,
                  Imf::Slice::Make(planes[i].type, slab_->planes[i].data(), origin, columns_, slab_->lines,
                                   planes[i].sample_bytes(), slab_->stride_bytes[i]));
  }
  SPECTILE_TRY(tiled ? input_->read_tiles(part_, target, first_tile_, last_tile_, slab)
                     : input_->read(part_, target, file.min.y + first, file.min.y + last));
  loaded_ = slab;
  return {};
}

Result<void> RegionReader::fill(const std::vector<PlaneSpec>& planes, Strip& strip) {
  const int lines = slab_lines(planes);
  const auto width = static_cast<std::size_t>(width_of(header_));
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
