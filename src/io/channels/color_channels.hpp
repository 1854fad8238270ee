// The channels of a file that hold a colour, and the choice among them.
#pragma once

#include <array>
#include <spectile/image/image.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/exr/exr_input.hpp"

namespace spectile::io {

/// Meaning of three channels.
enum class ColorModel {
  kRgb,
  kXyz,        ///< CIE XYZ
  kLuminance,  ///< Y alone, or with chroma RY, BY
};

struct ColorChannels {
  int part = 0;
  std::string prefix;  ///< of the names, with its last point; empty: plain
  std::string view;    ///< empty where the file is not stereo
  ColorModel model = ColorModel::kRgb;
  std::array<std::string, 3> names;  ///< all the same for luminance
  std::string alpha;                 ///< empty: none
};

/// All colours of a file's flat parts: of each layer and view the clearest names alone (R, G, B before X, Y,
/// Z before r, g, b and red, green, blue before Y), plain ones first.
std::vector<ColorChannels> color_sets(const ExrInput& input);

/// The colour that the choice asks for. What was assumed is added to `notes`. Errors: kBadFile for none, and
/// for several layers of which none is plain, with what there is.
Result<ColorChannels> choose_colors(const ExrInput& input, const ChannelChoice& choice,
                                    std::vector<std::string>& notes);

/// "colour R, G, B of view \"left\"".
std::string description(const ExrInput& input, const ColorChannels& channels);

/// The view that a channel's name puts it in, of those in a part's multiView; empty for none.
std::string view_of(std::string_view channel, const std::vector<std::string>& views);

}  // namespace spectile::io
