// PartHeader: the header of one part of an OpenEXR file, in types of the standard library; sizes of mip
// levels.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <spectile/image/image.hpp>
#include <spectile/pixel_window.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spectile::io {

/// Width and height of an image or of one of its mip levels.
struct LevelSize {
  int width = 0;
  int height = 0;
  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
  friend bool operator==(const LevelSize&, const LevelSize&) = default;
};

/// Size of a mip level, rounded down; level 0 is the image. Source: Technical Introduction to OpenEXR.
inline LevelSize level_size(LevelSize image, int level) {
  return {std::max(1, image.width >> level), std::max(1, image.height >> level)};
}
/// Levels down to one pixel, level 0 among them.
inline int level_count(LevelSize image) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(image.width, image.height))));
}

/// Bytes of a sample.
constexpr std::size_t sample_bytes(SampleType type) {
  return type == SampleType::kHalf ? 2 : 4;
}

/// The type as which samples to compute with are read: integers as floats.
constexpr SampleType readable_type(SampleType stored) {
  return stored == SampleType::kHalf ? SampleType::kHalf : SampleType::kFloat;
}

/// Names of the attributes in which a Cryptomatte layer says its name: "cryptomatte/KEY/name".
/// Source: Friedman, Jones, Cryptomatte Specification 1.2.
inline constexpr std::string_view kManifestStart = "cryptomatte/";
inline constexpr std::string_view kManifestName = "/name";

/// A channel as it is stored.
struct StoredChannel {
  std::string name;
  SampleType type = SampleType::kHalf;
  int x_sampling = 1;
  int y_sampling = 1;
  bool subsampled() const { return x_sampling != 1 || y_sampling != 1; }
};

/// Errors: kBadFile for a channel that is subsampled.
Result<void> check_sampling(const StoredChannel& channel, const std::string& path);

/// True for a channel that can be copied to an output. Notes one that cannot, since it is subsampled.
bool passes(const StoredChannel& channel, std::vector<std::string>& notes);

/// The last but one part of a channel's name, which is its view where a file has one of that name.
/// Source: OpenEXR, Storing Multi-View Images.
std::string possible_view(std::string_view channel);

/// A part's header. Cheap to copy but for its channels; copies share the attributes.
class PartHeader {
 public:
  /// Sides of tiles, at most kMaxSide.
  struct Tiles {
    int width = 1;
    int height = 1;
    bool has_levels = false;
  };
  /// Chromaticities x, y of red, green, blue and white.
  using Primaries = std::array<std::array<float, 2>, 4>;

  /// Pixels along a side that are believed; more is taken for damage.
  static constexpr int kMaxSide = 1 << 18;

  PartHeader() = default;
  /// Of an image to be written: windows alone.
  PartHeader(const PixelWindow& display, const PixelWindow& data);
  explicit PartHeader(const Imf::Header& header);

  const PixelWindow& data_window() const noexcept { return data_; }
  const PixelWindow& display_window() const noexcept { return display_; }
  /// Of the data window.
  int width() const noexcept { return data_.width(); }
  int height() const noexcept { return data_.height(); }
  /// The same header with another data window, or another display window.
  PartHeader with_data_window(const PixelWindow& window) const;
  PartHeader with_display_window(const PixelWindow& window) const;

  bool deep() const noexcept { return deep_; }
  /// None for scanlines.
  const std::optional<Tiles>& tiles() const noexcept { return tiles_; }
  /// None for a method that is not known.
  std::optional<CompressionKind> compression() const noexcept { return compression_; }
  /// Lines that are decoded at once, at most 4096.
  int chunk_lines() const;
  /// Bytes that are decoded at once: all channels of these lines, or of a tile.
  std::size_t chunk_bytes() const;

  /// In the order of their names.
  const std::vector<StoredChannel>& channels() const noexcept { return channels_; }
  /// The channel of a name, or null.
  const StoredChannel* find(std::string_view name) const;

  /// An attribute of type string. The name, type and view of a part are among them.
  std::optional<std::string> text(const std::string& name) const;
  /// An attribute of type int, float or double.
  std::optional<double> number(const std::string& name) const;
  /// The attribute multiView: the views of a part that holds several, the default one first.
  std::vector<std::string> views() const;
  /// All attributes of type string but the part's type.
  std::vector<std::pair<std::string, std::string>> texts() const;
  /// OpenEXR's name of the type of an attribute; empty where there is none of this name.
  std::string attribute_type(const std::string& name) const;
  /// True if there is an attribute of this name, whatever its type.
  bool has_attribute(const std::string& name) const;
  /// Names of the channels whose samples name objects, so that no arithmetic makes sense of them: integers,
  /// and the ranks of Cryptomatte layers, ids beside the coverage that belongs to each.
  std::vector<std::string> object_ids() const;
  /// The attribute chromaticities.
  std::optional<Primaries> chromaticities() const;

  /// The header that OpenEXR read; for this room only.
  const Imf::Header& imf() const noexcept { return *imf_; }

 private:
  std::shared_ptr<const Imf::Header> imf_;
  PixelWindow data_;
  PixelWindow display_;
  bool deep_ = false;
  std::optional<Tiles> tiles_;
  std::optional<CompressionKind> compression_;
  std::vector<StoredChannel> channels_;
};

}  // namespace spectile::io
