// Strips: runs of lines of some channels of one part, each channel a plane in its own sample type.
#include "src/io/exr/strips.hpp"

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfRgbaFile.h>

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {

namespace {

std::size_t padded_bytes(const PlaneSpec& plane, int width) {
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
    const std::size_t stride = padded_bytes(plane, width);
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
    planes[i].type = from.sample_bytes(i) == 2 ? SampleType::kHalf : SampleType::kFloat;
  }
  SPECTILE_ASSIGN(auto out, make_strip(planes, width, first_line, lines));
  out->first_x = from.first_x + x;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::size_t skipped = static_cast<std::size_t>(x) * from.sample_bytes(i);
    for (int line = first_line; line < first_line + lines; ++line) {
      std::memcpy(out->row(i, line), from.row(i, line) + skipped, out->row_bytes[i]);
    }
  }
  return out;
}

int strip_lines(const PartHeader& header, const std::vector<PlaneSpec>& planes, int at_least) {
  constexpr std::size_t kStripBytes = std::size_t{16} << 20;
  constexpr std::size_t kMaxStripBytes = 8 * kStripBytes;
  // The largest chunk of the common compressions; tiles may be higher.
  const int unit = header.tiles() ? header.chunk_lines() : 32;
  std::size_t line = 1;
  for (const PlaneSpec& plane : planes) line += padded_bytes(plane, header.width());
  const auto fitting = static_cast<int>(std::min<std::size_t>(kStripBytes / line, 256));
  const int lines = std::max({fitting / unit * unit, unit, at_least});
  // Thousands of channels: what is decoded at once has no more to do with the output's chunks.
  if (!header.tiles() && line * static_cast<std::size_t>(std::min(lines, header.height())) > kMaxStripBytes) {
    return std::clamp(fitting, 1, header.height());
  }
  return std::clamp(lines, 1, header.height());
}

void add_slices(Imf::FrameBuffer& target, const std::vector<PlaneSpec>& planes, int x, int y, int width,
                Strip& strip) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].name.empty()) continue;
    const Imf::PixelType type = planes[i].type == SampleType::kHalf    ? Imf::HALF
                                : planes[i].type == SampleType::kFloat ? Imf::FLOAT
                                                                       : Imf::UINT;
    target.insert(planes[i].name,
                  Imf::Slice::Make(type, strip.planes[i].data(), Imath::V2i(x, y), width, strip.lines,
                                   planes[i].sample_bytes(), strip.stride_bytes[i]));
  }
}

Result<void> fill_strip(ExrInput& input, int part, const std::vector<PlaneSpec>& planes, Strip& strip) {
  const PixelWindow& window = input.header(part).data_window();
  const int y0 = window.y0 + strip.first_line;
  Imf::FrameBuffer target;
  add_slices(target, planes, window.x0, y0, window.width(), strip);
  return input.read(part, target, y0, y0 + strip.lines - 1);
}

Result<void> fill_tiles(ExrInput& input, int part, const std::vector<PlaneSpec>& planes,
                        const ExrInput::TileRange& tiles, int x, Strip& strip) {
  const PixelWindow& window = input.header(part).data_window();
  Imf::FrameBuffer target;
  add_slices(target, planes, window.x0 + x, window.y0 + strip.first_line, strip.width, strip);
  return input.read_tiles(part, target, tiles);
}

struct LumaChromaReader::File {
  Imf::RgbaInputFile input;
};

LumaChromaReader::LumaChromaReader() = default;

LumaChromaReader::~LumaChromaReader() = default;

Result<std::unique_ptr<LumaChromaReader>> LumaChromaReader::open(const std::string& path, int threads) {
  std::unique_ptr<LumaChromaReader> reader(new LumaChromaReader);
  reader->path_ = path;
  SPECTILE_TRY(guarded(path, [&] {
    reader->file_.reset(new File{Imf::RgbaInputFile(path.c_str(), threads > 1 ? threads : 0)});
  }));
  return reader;
}

Result<void> LumaChromaReader::fill(const PartHeader& header, int left, int top, Strip& strip) {
  // OpenEXR gives whole lines of the file.
  const PixelWindow& window = header.data_window();
  const auto width = static_cast<std::size_t>(strip.width);
  std::vector<Imf::Rgba> whole(static_cast<std::size_t>(header.width()));
  const Imf::Rgba* const line = whole.data() + left;
  return guarded(path_, [&] {
    for (int y = strip.first_line; y < strip.first_line + strip.lines; ++y) {
      file_->input.setFrameBuffer(whole.data() - window.x0, 1, 0);
      file_->input.readPixels(window.y0 + top + y);
      for (std::size_t x = 0; x < width; ++x) {
        const std::uint16_t rgb[3] = {line[x].r.bits(), line[x].g.bits(), line[x].b.bits()};
        for (std::size_t k = 0; k < 3; ++k) {
          std::memcpy(strip.row(k, y) + 2 * x, &rgb[k], sizeof(std::uint16_t));
        }
      }
    }
  });
}

}  // namespace spectile::io
