// ImageSource: one part of an open image, or a region of it, read in strips.
#include "src/io/convert/sources/image_source.hpp"

#include <algorithm>

#include "src/base/errors.hpp"

namespace spectile::io {

Result<void> ImageSource::choose_region(const std::optional<PixelWindow>& region) {
  if (!region) return {};
  SPECTILE_ASSIGN(region_, RegionReader::create(*input_, part_, *region, notes_));
  return {};
}

Result<void> ImageSource::fill(const std::vector<PlaneSpec>& planes, Strip& strip) {
  const bool any = std::any_of(planes.begin(), planes.end(), [](const auto& p) { return !p.name.empty(); });
  if (any) SPECTILE_TRY(region_ ? region_->fill(planes, strip) : fill_strip(*input_, part_, planes, strip));
  // The last lines: all of it is of one file.
  if (strip.first_line + strip.lines == height()) SPECTILE_TRY(input_->unchanged());
  return {};
}

Result<std::shared_ptr<Strip>> ImageSource::read(int first_line, int lines) {
  SPECTILE_ASSIGN(auto strip, make_strip(planes_, width(), first_line, lines));
  SPECTILE_TRY(fill(planes_, *strip));
  return strip;
}

}  // namespace spectile::io
