// RgbSource: where an image's red, green and blue come from, and what else passes through.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <spectile/image/image.hpp>
#include <string>
#include <vector>

#include "src/dispatch/dispatch.hpp"
#include "src/io/channels/color_channels.hpp"
#include "src/io/convert/sources/color_space.hpp"
#include "src/io/convert/sources/image_source.hpp"

namespace spectile::io {

/// An open RGB image. Planes 0, 1, 2 of its strips are red, green, blue; the others pass through.
class RgbSource : public ImageSource {
 public:
  /// Finds the colour channels that the choice asks for. `stated`: the RGB space, whatever the file says.
  /// Errors: kBadFile, kNoPermission; those of choose_colors() and RegionReader.
  static Result<std::unique_ptr<RgbSource>> open(const std::string& path, const ChannelChoice& choice,
                                                 int threads, const std::optional<PixelWindow>& region = {},
                                                 const std::optional<RgbSpace>& stated = {});

  const RgbSpace& color_space() const noexcept { return space_; }
  /// The view that the colours are of; empty where the file is not stereo.
  const std::string& view() const noexcept { return colors_.view; }
  /// The plane of the colours' own alpha, where they have one.
  std::optional<std::size_t> alpha() const noexcept { return alpha_; }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override;

  /// A line's R, G, B as floats, zero after the last pixel up to a whole block. rgb: three rows of padded
  /// width.
  void float_rows(const kernels::KernelTable& kernels, const Strip& strip, int line,
                  float* const rgb[3]) const;

 private:
  RgbSource() = default;
  Result<void> choose(const ChannelChoice& choice);
  void take_colors();
  void choose_passing();
  bool is_of_another_view(const std::string& name);

  std::unique_ptr<LumaChromaReader> chroma_;  // of luminance and chroma
  ColorChannels colors_;
  std::set<std::string> other_views_;
  bool with_chroma_ = false;
  std::vector<std::string> file_names_;
  std::optional<std::size_t> alpha_;
  RgbSpace space_;
};

}  // namespace spectile::io
