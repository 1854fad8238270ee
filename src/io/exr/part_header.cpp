// PartHeader: the header of one part of an OpenEXR file, in types of the standard library.
#include "src/io/exr/part_header.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTileDescription.h>

#include <algorithm>

#include "src/base/enum_names.hpp"
#include "src/io/exr/compression.hpp"

namespace spectile::io {
namespace {

PixelWindow window_from(const Imath::Box2i& box) {
  return PixelWindow::inclusive(box.min.x, box.min.y, box.max.x, box.max.y);
}

Imath::Box2i box_from(const PixelWindow& window) {
  return {{window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}};
}

SampleType sample_type(Imf::PixelType type) {
  if (type == Imf::HALF) return SampleType::kHalf;
  return type == Imf::UINT ? SampleType::kUint32 : SampleType::kFloat;
}

int tile_side(unsigned side) {
  return static_cast<int>(std::clamp(side, 1U, static_cast<unsigned>(PartHeader::kMaxSide)));
}

/// True for "LAYER00.R": a layer's name, the number of a rank, a component.
bool is_rank_of(std::string_view channel, std::string_view layer) {
  if (!channel.starts_with(layer)) return false;
  channel.remove_prefix(layer.size());
  const std::size_t digits = std::min(channel.find_first_not_of("0123456789"), channel.size());
  return digits > 0 && digits < channel.size() && channel[digits] == '.';
}

}  // namespace

Result<void> check_sampling(const StoredChannel& channel, const std::string& path) {
  if (!channel.subsampled()) return {};
  return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" is subsampled {} x {}, which is not supported",
                    path, channel.name, channel.x_sampling, channel.y_sampling);
}

std::string possible_view(std::string_view channel) {
  const std::size_t last = channel.rfind('.');
  if (last == std::string_view::npos || last == 0) return {};
  const std::size_t before = channel.rfind('.', last - 1);
  const std::size_t first = before == std::string_view::npos ? 0 : before + 1;
  return std::string(channel.substr(first, last - first));
}

bool passes(const StoredChannel& channel, std::vector<std::string>& notes) {
  if (!channel.subsampled()) return true;
  notes.push_back(fmt::format("channel \"{}\" is left out: it is subsampled {} x {}", channel.name,
                              channel.x_sampling, channel.y_sampling));
  return false;
}

PartHeader::PartHeader(const PixelWindow& display, const PixelWindow& data)
    : PartHeader(Imf::Header(box_from(display), box_from(data))) {}

PartHeader::PartHeader(const Imf::Header& header)
    : imf_(std::make_shared<const Imf::Header>(header)),
      data_(window_from(header.dataWindow())),
      display_(window_from(header.displayWindow())),
      deep_(header.hasType() && Imf::isDeepData(header.type())),
      compression_(compression_kind(header.compression())) {
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tiles = header.tileDescription();
    tiles_ = Tiles{tile_side(tiles.xSize), tile_side(tiles.ySize), tiles.mode != Imf::ONE_LEVEL};
  }
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const Imf::Channel& channel = it.channel();
    channels_.push_back({it.name(), sample_type(channel.type), channel.xSampling, channel.ySampling});
  }
}

PartHeader PartHeader::with_data_window(const PixelWindow& window) const {
  PartHeader out = *this;
  out.data_ = window;
  return out;
}

PartHeader PartHeader::with_display_window(const PixelWindow& window) const {
  PartHeader out = *this;
  out.display_ = window;
  return out;
}

int PartHeader::chunk_lines() const {
  // Tiles may be as high as the image.
  constexpr int kMaxLines = 4096;
  if (tiles_) return std::min(tiles_->height, kMaxLines);
  return compression_ ? lines_per_chunk(*compression_) : 1;
}

std::size_t PartHeader::chunk_bytes() const {
  const auto width = static_cast<std::size_t>(tiles_ ? tiles_->width : this->width());
  std::size_t pixel = 0;
  for (const StoredChannel& channel : channels_) pixel += channel.type == SampleType::kHalf ? 2 : 4;
  return pixel * width * static_cast<std::size_t>(chunk_lines());
}

const StoredChannel* PartHeader::find(std::string_view name) const {
  const auto at = std::lower_bound(
      channels_.begin(), channels_.end(), name,
      [](const StoredChannel& channel, std::string_view text) { return channel.name < text; });
  return at != channels_.end() && at->name == name ? &*at : nullptr;
}

std::optional<std::string> PartHeader::text(const std::string& name) const {
  const auto* const found = imf_->findTypedAttribute<Imf::StringAttribute>(name);
  if (found == nullptr) return {};
  return found->value();
}

std::optional<double> PartHeader::number(const std::string& name) const {
  if (imf_ == nullptr) return {};
  if (const auto* d = imf_->findTypedAttribute<Imf::DoubleAttribute>(name)) return d->value();
  if (const auto* f = imf_->findTypedAttribute<Imf::FloatAttribute>(name)) return double{f->value()};
  if (const auto* i = imf_->findTypedAttribute<Imf::IntAttribute>(name)) return i->value();
  return {};
}

std::vector<std::string> PartHeader::views() const {
  if (imf_ == nullptr) return {};
  const auto* const found = imf_->findTypedAttribute<Imf::StringVectorAttribute>("multiView");
  return found == nullptr ? std::vector<std::string>() : found->value();
}

std::string PartHeader::attribute_type(const std::string& name) const {
  const auto found = imf_->find(name);
  return found == imf_->end() ? std::string() : found.attribute().typeName();
}

bool PartHeader::has_attribute(const std::string& name) const {
  return imf_->find(name) != imf_->end();
}

std::vector<std::string> PartHeader::object_ids() const {
  std::vector<std::string> layers;
  for (const auto& [name, layer] : texts()) {
    if (name.starts_with(kManifestStart) && name.ends_with(kManifestName) && !layer.empty()) {
      layers.push_back(layer);
    }
  }
  std::vector<std::string> out;
  for (const StoredChannel& channel : channels_) {
    const bool ranked = std::any_of(layers.begin(), layers.end(), [&](const std::string& layer) {
      return is_rank_of(channel.name, layer);
    });
    if (ranked || channel.type == SampleType::kUint32) out.push_back(channel.name);
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> PartHeader::texts() const {
  std::vector<std::pair<std::string, std::string>> out;
  for (auto it = imf_->begin(); it != imf_->end(); ++it) {
    const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text != nullptr && std::string_view(it.name()) != "type") out.emplace_back(it.name(), text->value());
  }
  return out;
}

std::optional<PartHeader::Primaries> PartHeader::chromaticities() const {
  const auto* const found = imf_->findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities");
  if (found == nullptr) return {};
  const Imf::Chromaticities& c = found->value();
  return Primaries{
      {{c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}}};
}

}  // namespace spectile::io

std::string_view spectile::to_string(SampleType type) {
  constexpr EnumName<SampleType> kNames[] = {
      {SampleType::kFloat, "float"}, {SampleType::kHalf, "half"}, {SampleType::kUint32, "uint"}};
  return enum_name(kNames, type);
}
