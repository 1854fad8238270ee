// Strips: runs of lines of some channels of one part, each channel a plane in its own sample type.
#include "src/io/exr/strips.hpp"

#include <OpenEXR/ImfTileDescription.h>

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {

int width_of(const Imf::Header& header) {
  return header.dataWindow().max.x - header.dataWindow().min.x + 1;
}

int height_of(const Imf::Header& header) {
  return header.dataWindow().max.y - header.dataWindow().min.y + 1;
}

namespace {

std::size_t stride_of(const PlaneSpec& plane, int width) {
  return blocks_for(static_cast<std::size_t>(width)) * kLanesPerBlock * plane.sample_bytes();
}

}  // namespace

Result<std::shared_ptr<Strip>> make_strip(const std::vector<PlaneSpec>& planes, int width, int first_line,
                                          int lines) {
  auto strip = std::make_shared<Strip>();
  strip->first_line = first_line;
  strip->lines = lines;
  strip->width = width;
  for (const PlaneSpec& plane : planes) {
    const std::size_t stride = stride_of(plane, width);
    SPECTILE_ASSIGN(auto buffer,
                    FloatBuffer::create(stride * static_cast<std::size_t>(lines) / sizeof(float)));
    strip->planes.push_back(std::move(buffer));
    strip->stride_bytes.push_back(stride);
    strip->row_bytes.push_back(static_cast<std::size_t>(width) * plane.sample_bytes());
  }
  return strip;
}

Result<std::shared_ptr<Strip>> cut_strip(const Strip& from, int x, int width, int first_line, int lines) {
  std::vector<PlaneSpec> planes(from.planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i].type = from.sample_bytes(i) == 2 ? Imf::HALF : Imf::FLOAT;
  }
  SPECTILE_ASSIGN(auto out, make_strip(planes, width, first_line, lines));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::size_t skipped = static_cast<std::size_t>(x) * from.sample_bytes(i);
    for (int line = first_line; line < first_line + lines; ++line) {
      std::memcpy(out->row(i, line), from.row(i, line) + skipped, out->row_bytes[i]);
    }
  }
  return out;
}

int strip_lines(const Imf::Header& header, const std::vector<PlaneSpec>& planes, int at_least) {
  constexpr std::size_t kStripBytes = std::size_t{16} << 20;
  // The largest chunk of the common compressions; tiles may be higher.
  int unit = 32;
  if (header.hasTileDescription()) unit = static_cast<int>(std::min(header.tileDescription().ySize, 4096U));
  std::size_t line = 1;
  for (const PlaneSpec& plane : planes) line += stride_of(plane, width_of(header));
  const auto fitting = static_cast<int>(std::min<std::size_t>(kStripBytes / line, 256));
  const int lines = std::max({fitting / unit * unit, unit, at_least});
  return std::clamp(lines, 1, height_of(header));
}

Result<void> fill_strip(ExrInput& input, int part, const std::vector<PlaneSpec>& planes, Strip& strip) {
  const Imath::Box2i window = input.header(part).dataWindow();
  const int y0 = window.min.y + strip.first_line;
  Imf::FrameBuffer target;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].name.empty()) continue;
    target.insert(planes[i].name,
                  Imf::Slice::Make(planes[i].type, strip.planes[i].data(), Imath::V2i(window.min.x, y0),
                                   window.max.x - window.min.x + 1, strip.lines, planes[i].sample_bytes(),
                                   strip.stride_bytes[i]));
  }
  return input.read(part, target, y0, y0 + strip.lines - 1);
}

}  // namespace spectile::io
