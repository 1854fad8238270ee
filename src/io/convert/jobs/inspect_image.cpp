// inspect_image: what a file holds.

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

float sample_of(const io::Strip& strip, std::size_t plane, SampleType type, int line, std::size_t x) {
  const std::byte* row = strip.row(plane, line);
  if (type == SampleType::kHalf)
    return reference::float_from_half(reinterpret_cast<const std::uint16_t*>(row)[x]);
  if (type == SampleType::kUint32) return static_cast<float>(reinterpret_cast<const std::uint32_t*>(row)[x]);
  return reinterpret_cast<const float*>(row)[x];
}

/// Channels to look at: ordinary ones by name, then spectral ones by wavelength. Subsampled ones are not.
std::vector<io::PlaneSpec> planes_of(const io::PartHeader& header,
                                     const std::optional<io::SpectralChannels>& spectral) {
  std::vector<io::PlaneSpec> planes;
  const auto is_spectral = [&](const std::string& name) {
    return spectral &&
           std::find(spectral->names.begin(), spectral->names.end(), name) != spectral->names.end();
  };
  for (const io::StoredChannel& channel : header.channels()) {
    if (!channel.subsampled() && !is_spectral(channel.name)) planes.push_back({channel.name, channel.type});
  }
  if (spectral) {
    for (const std::string& name : spectral->names) {
      planes.push_back({name, header.find(name)->type});
    }
  }
  return planes;
}

void count_line(const io::Strip& strip, std::size_t plane, SampleType type, int line, std::size_t width,
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

void describe_header(const io::PartHeader& header, ImageInfo& info) {
  info.width = header.width();
  info.height = header.height();
  info.data_window = header.data_window();
  info.display_window = header.display_window();
  info.tiled = header.tiles().has_value();
  info.compression = header.compression() ? Compression{*header.compression(), -1}.description() : "unknown";
  info.attributes = header.texts();
}

Result<ImageInfo> inspect(const std::string& path, std::optional<std::array<int, 2>> pixel, int threads) {
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path, tiles::thread_count(threads)));
  int part = 0;
  while (input->header(part).deep()) ++part;
  const io::PartHeader& header = input->header(part);
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
    channel.type = std::string(to_string(plane.type));
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
    tiles::for_blocks(planes.size(), {threads, kLanesPerBlock}, [&](std::size_t plane, std::size_t) {
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
