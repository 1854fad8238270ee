// inspect_image: what a file holds.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <spectile/image/image.hpp>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/plan_attribute.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/lanes/tiles.hpp"
#include "src/reference/half.hpp"

namespace spectile {
namespace {

float sample_of(const io::Strip& strip, std::size_t plane, Imf::PixelType type, int line, std::size_t x) {
  const std::byte* row = strip.row(plane, line);
  if (type == Imf::HALF) return reference::float_from_half(reinterpret_cast<const std::uint16_t*>(row)[x]);
  if (type == Imf::UINT) return static_cast<float>(reinterpret_cast<const std::uint32_t*>(row)[x]);
  return reinterpret_cast<const float*>(row)[x];
}

const char* type_name(Imf::PixelType type) {
  return type == Imf::HALF ? "half" : type == Imf::UINT ? "uint" : "float";
}

std::string compression_name(Imf::Compression compression) {
  constexpr const char* kNames[] = {"none",  "rle", "zips", "zip",  "piz",
                                    "pxr24", "b44", "b44a", "dwaa", "dwab"};
  const auto i = static_cast<std::size_t>(compression);
  return i < std::size(kNames) ? kNames[i] : "unknown";
}

/// Channels to look at: ordinary ones by name, then spectral ones by wavelength. Subsampled ones are not.
std::vector<io::PlaneSpec> planes_of(const Imf::Header& header,
                                     const std::optional<io::SpectralChannels>& spectral) {
  std::vector<io::PlaneSpec> planes;
  const auto is_spectral = [&](const std::string& name) {
    return spectral &&
           std::find(spectral->names.begin(), spectral->names.end(), name) != spectral->names.end();
  };
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1 || is_spectral(it.name())) continue;
    planes.push_back({it.name(), it.channel().type});
  }
  if (spectral) {
    for (const std::string& name : spectral->names) {
      planes.push_back({name, header.channels()[name.c_str()].type});
    }
  }
  return planes;
}

void count_line(const io::Strip& strip, std::size_t plane, Imf::PixelType type, int line, std::size_t width,
                ChannelInfo& info) {
  for (std::size_t x = 0; x < width; ++x) {
    const float v = sample_of(strip, plane, type, line, x);
    if (!std::isfinite(v)) {
      ++info.nonfinite;
      continue;
    }
    info.negative += v < 0 ? 1 : 0;
    info.minimum = std::min(info.minimum, v);
    info.maximum = std::max(info.maximum, v);
  }
}

std::array<int, 4> corners(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x, box.max.y};
}

void describe_header(const Imf::Header& header, ImageInfo& info) {
  info.width = io::width_of(header);
  info.height = io::height_of(header);
  info.data_window = corners(header.dataWindow());
  info.display_window = corners(header.displayWindow());
  info.tiled = header.hasTileDescription();
  info.compression = compression_name(header.compression());
  for (auto it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (std::string(it.name()) == "type") continue;
    if (text != nullptr) info.attributes.emplace_back(it.name(), text->value());
  }
}

Result<ImageInfo> inspect(const std::string& path, std::optional<std::array<int, 2>> pixel, int threads) {
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path, tiles::thread_count(threads)));
  int part = 0;
  while (input->deep(part)) ++part;
  const Imf::Header& header = input->header(part);
  ImageInfo info;
  describe_header(header, info);
  info.parts = input->parts();
  const auto spectral = io::spectral_channels(header, std::nullopt);
  if (spectral) {
    info.quantity = spectral->quantity;
    const auto bands = Bands::from_centres(spectral->centres_nm);
    if (!bands) return make_error(ErrorCode::kBadFile, "{}: {}", path, bands.error().message);
    SPECTILE_ASSIGN(info.bands, io::with_plan(header, *bands, path));
  }
  if (pixel &&
      ((*pixel)[0] < 0 || (*pixel)[0] >= info.width || (*pixel)[1] < 0 || (*pixel)[1] >= info.height)) {
    return make_error(ErrorCode::kBadArgument, "pixel {},{} lies outside the image of {} x {}", (*pixel)[0],
                      (*pixel)[1], info.width, info.height);
  }
  const std::vector<io::PlaneSpec> planes = planes_of(header, spectral);
  for (const io::PlaneSpec& plane : planes) {
    ChannelInfo channel;
    channel.name = plane.name;
    channel.type = type_name(plane.type);
    channel.minimum = std::numeric_limits<float>::infinity();
    channel.maximum = -std::numeric_limits<float>::infinity();
    info.channels.push_back(channel);
  }
  const int step = io::strip_lines(header, planes, 1);
  const std::size_t first_shown = spectral ? planes.size() - spectral->names.size() : 0;
  for (int first = 0; first < info.height && !planes.empty(); first += step) {
    const int lines = std::min(step, info.height - first);
    SPECTILE_ASSIGN(auto strip, io::make_strip(planes, info.width, first, lines));
    SPECTILE_TRY(io::fill_strip(*input, part, planes, *strip));
    // Channels side by side over the threads; each has its own counts.
    Execution execution;
    execution.threads = threads;
    execution.tile_lanes = kLanesPerBlock;
    tiles::for_blocks(planes.size(), execution, [&](std::size_t plane, std::size_t) {
      for (int line = first; line < first + lines; ++line) {
        count_line(*strip, plane, planes[plane].type, line, static_cast<std::size_t>(info.width),
                   info.channels[plane]);
      }
    });
    if (pixel && strip->holds((*pixel)[1], 1)) {
      for (std::size_t plane = first_shown; plane < planes.size(); ++plane) {
        info.pixel.push_back(
            sample_of(*strip, plane, planes[plane].type, (*pixel)[1], static_cast<std::size_t>((*pixel)[0])));
      }
    }
  }
  for (ChannelInfo& channel : info.channels) {
    info.nonfinite += channel.nonfinite;
    info.negative += channel.negative;
    if (channel.minimum > channel.maximum) channel.minimum = channel.maximum = std::nanf("");
  }
  return info;
}

}  // namespace

Result<ImageInfo> inspect_image(const std::string& path, std::optional<std::array<int, 2>> pixel,
                                int threads) {
  return io::contained<ImageInfo>(path, [&] { return inspect(path, pixel, threads); });
}

}  // namespace spectile
