// Headers of the parts that an ExrWriter writes.
#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "src/base/errors.hpp"
#include "src/io/exr/compression.hpp"
#include "src/io/exr/exr_writer.hpp"

namespace spectile::io {
namespace {

// Longest name that every version of OpenEXR reads.
constexpr std::size_t kShortName = 31;

}  // namespace

bool ImageSpec::has_long_names() const {
  for (const ChannelSpec& channel : channels) {
    if (channel.name.size() > kShortName) return true;
  }
  const Imf::Header& header = source->imf();
  for (auto it = header.begin(); it != header.end(); ++it) {
    if (std::strlen(it.name()) > kShortName || std::strlen(it.attribute().typeName()) > kShortName) {
      return true;
    }
  }
  return false;
}

AttributeRules ImageSpec::rules() const {
  AttributeRules out = {change, {}, replaced, view};
  for (const ChannelSpec& channel : channels) out.channels.insert(channel.name);
  for (const auto& [name, text] : text_attributes) out.replaced.push_back(name);
  for (const auto& [name, number] : number_attributes) out.replaced.push_back(name);
  return out;
}

std::optional<std::string> left_out_note(const ImageSpec& spec) {
  // Filters have a curve for each channel.
  constexpr std::size_t kMaxNames = 8;
  std::vector<std::string> names = attributes_left_out(spec.source->imf(), spec.rules());
  if (names.empty()) return {};
  const std::size_t more = names.size() > kMaxNames ? names.size() - kMaxNames : 0;
  names.resize(names.size() - more);
  return fmt::format("attributes left out, since they describe what the output does not hold: {}{}",
                     fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

Result<void> ExrWriter::start_part(const ImageSpec& spec, const std::string& name) {
  Layout out;
  out.tiled = spec.tile.has_value();
  int part = 0;
  SPECTILE_TRY(check(
      exr_add_part(context_, name.c_str(), out.tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part)));
  const Imf::Header& source = spec.source->imf();
  const PixelWindow& data = spec.source->data_window();
  const PixelWindow& display = spec.source->display_window();
  const exr_attr_box2i_t data_window = {{data.x0, data.y0}, {data.x1 - 1, data.y1 - 1}};
  const exr_attr_box2i_t display_window = {{display.x0, display.y0}, {display.x1 - 1, display.y1 - 1}};
  const exr_attr_v2f_t centre = {source.screenWindowCenter().x, source.screenWindowCenter().y};
  SPECTILE_TRY(check(exr_initialize_required_attr(
      context_, part, &display_window, &data_window, source.pixelAspectRatio(), &centre,
      source.screenWindowWidth(), EXR_LINEORDER_INCREASING_Y, compression_type(spec.compression.kind))));
  if (out.tiled) {
    SPECTILE_TRY(check(exr_set_tile_descriptor(context_, part, static_cast<std::uint32_t>((*spec.tile)[0]),
                                               static_cast<std::uint32_t>((*spec.tile)[1]),
                                               spec.mipmap ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL,
                                               EXR_TILE_ROUND_DOWN)));
  }
  SPECTILE_TRY(check(copy_attributes(source, context_, part, spec.rules())));
  for (const auto& [attribute, text] : spec.text_attributes) {
    SPECTILE_TRY(check(exr_attr_set_string(context_, part, attribute.c_str(), text.c_str())));
  }
  for (const auto& [attribute, number] : spec.number_attributes) {
    SPECTILE_TRY(check(exr_attr_set_double(context_, part, attribute.c_str(), number)));
  }

  out.image = {data.width(), data.height()};
  out.levels = out.tiled && spec.mipmap ? level_count(out.image) : 1;
  out.first_y = data.y0;
  out.lines_per_chunk = out.tiled ? (*spec.tile)[1] : io::lines_per_chunk(spec.compression.kind);
  out.chunk_width = out.tiled ? (*spec.tile)[0] : out.image.width;
  // A line's channels lie in the order of their names.
  std::vector<std::size_t> order(spec.channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return spec.channels[a].name < spec.channels[b].name; });
  out.offsets.resize(order.size());
  out.channels = spec.channels;
  out.compression = spec.compression;
  for (const std::size_t i : order) {
    const ChannelSpec& channel = spec.channels[i];
    SPECTILE_TRY(check(exr_add_channel(context_, part, channel.name.c_str(), pixel_type(channel.type),
                                       EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1)));
    out.offsets[i] = out.pixel_bytes;
    out.pixel_bytes += channel.sample_bytes();
  }
  layouts_.push_back(std::move(out));
  return {};
}

}  // namespace spectile::io
