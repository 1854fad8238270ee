// inspect_image: what a file holds.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <spectile/image/image.hpp>

#include "src/base/errors.hpp"
#include "src/io/channels/color_channels.hpp"
#include "src/io/channels/spectral_sets.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/color_space.hpp"
#include "src/io/exr/attribute_texts.hpp"
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
                                     const std::optional<io::SpectralSet>& spectral) {
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
  info.attributes = io::attribute_texts(header);
}

void describe_parts(const io::ExrInput& input, ImageInfo& info) {
  info.parts = input.parts();
  for (int part = 0; part < input.parts(); ++part) {
    const io::PartHeader& header = input.header(part);
    PartInfo p;
    p.name = header.text("name").value_or("");
    p.view = header.text("view").value_or("");
    p.deep = header.deep();
    p.data_window = header.data_window();
    p.display_window = header.display_window();
    p.tiled = header.tiles().has_value();
    p.levels = p.tiled && header.tiles()->has_levels ? io::level_count({header.width(), header.height()}) : 1;
    p.compression = header.compression() ? Compression{*header.compression(), -1}.description() : "unknown";
    p.channels = header.channels().size();
    p.attributes = io::attribute_texts(header);
    info.part_list.push_back(std::move(p));
  }
}

void describe_contents(const io::ExrInput& input, int part, ImageInfo& info) {
  for (const io::SpectralSet& set : io::spectral_sets(input)) info.contents.push_back(set.description());
  std::size_t polarised = 0;
  for (int i = 0; i < input.parts(); ++i) {
    for (const io::StoredChannel& stored : input.header(i).channels()) {
      const auto channel = io::parse_spectral_channel(stored.name, input.header(i));
      polarised += channel && channel->kind == io::SpectralKind::kPolarised ? 1 : 0;
    }
    if (!input.header(i).deep() && io::claims_coefficients(input.header(i))) {
      const std::string method = input.header(i).text("spectileMethod").value_or("unknown");
      info.contents.push_back(
          fmt::format("coefficients of {}; spectile expand turns them into spectra", method));
    }
  }
  if (polarised > 0)
    info.contents.push_back(
        fmt::format("{} channel{} of polarised light (S1, S2, S3)", polarised, polarised == 1 ? "" : "s"));
  for (const io::ColorChannels& c : io::color_sets(input)) {
    info.contents.push_back(io::description(input, c));
    if (c.part != part || !info.color_space.empty()) continue;
    info.alpha = c.alpha;
    if (const auto space = io::color_space_of(input.header(part), input.path())) {
      info.color_space = c.model == io::ColorModel::kXyz ? "CIE XYZ (D65)" : space->description;
    } else {
      info.notes.push_back(space.error().message);
    }
  }
}

Result<ImageInfo> inspect(const std::string& path, std::optional<std::array<int, 2>> pixel, int threads,
                          const ChannelChoice& choice) {
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path, tiles::thread_count(threads)));
  ImageInfo info;
  SPECTILE_ASSIGN(const auto named, io::chosen_part(*input, choice.part));
  auto spectral = io::choose_spectra(*input, choice, std::nullopt, info.notes);
  // A file whose spectra cannot be chosen among is described all the same, unless it was asked for.
  const bool asked = !choice.layer.empty() || !choice.view.empty() || !choice.map.empty();
  if (!spectral && asked) return spectral.error();
  std::optional<io::SpectralSet> set;
  if (spectral) {
    set = *std::move(spectral);
  } else {
    info.notes.push_back(spectral.error().message);
  }
  int part = named.value_or(0);
  while (!named && input->header(part).deep()) ++part;
  if (set && (asked || named)) part = set->part;
  if (set && set->part != part) set.reset();
  const io::PartHeader& header = input->header(part);
  describe_header(header, info);
  describe_parts(*input, info);
  describe_contents(*input, part, info);
  if (set) {
    info.quantity = set->quantity;
    if (set->dialect != nullptr) info.dialect = std::string(set->dialect->name);
    SPECTILE_ASSIGN(info.bands, set->bands(header, path));
  }
  if (pixel &&
      ((*pixel)[0] < 0 || (*pixel)[0] >= info.width || (*pixel)[1] < 0 || (*pixel)[1] >= info.height)) {
    return make_error(ErrorCode::kBadArgument, "{}: pixel {},{} lies outside the image of {} x {}", path,
                      (*pixel)[0], (*pixel)[1], info.width, info.height);
  }
  const std::vector<io::PlaneSpec> planes = planes_of(header, set);
  for (const io::PlaneSpec& plane : planes) {
    ChannelInfo channel;
    channel.name = plane.name;
    channel.type = std::string(to_string(plane.type));
    channel.minimum = std::numeric_limits<float>::infinity();
    channel.maximum = -std::numeric_limits<float>::infinity();
    info.channels.push_back(channel);
  }
  const int step = io::strip_lines(header, planes, 1);
  const std::size_t first_shown = set ? planes.size() - set->names.size() : 0;
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

Result<ImageInfo> inspect_image(const std::string& path, std::optional<std::array<int, 2>> pixel, int threads,
                                const ChannelChoice& choice) {
  return io::contained<ImageInfo>(path, [&] { return inspect(path, pixel, threads, choice); });
}

}  // namespace spectile
