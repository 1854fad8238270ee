// PixelMask: which pixels of an image need no spectra, by its own alpha or by another image.
#include "src/io/convert/sources/pixel_mask.hpp"

#include <algorithm>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

/// `zero` leaves of a sample what says whether it is 0: all bits, or all but the sign.
template <class Sample>
std::uint64_t zeros(const std::byte* row, Sample zero, std::uint8_t* masked, std::size_t width) {
  const auto* const samples = reinterpret_cast<const Sample*>(row);
  std::uint64_t count = 0;
  for (std::size_t x = 0; x < width; ++x) {
    masked[x] = (samples[x] & zero) == 0 ? 1 : 0;
    count += masked[x];
  }
  return count;
}

/// Notes which samples are not 0, NaN being one.
template <class Sample>
void note_colored(const std::byte* row, Sample zero, std::uint8_t* colored, std::size_t width) {
  const auto* const samples = reinterpret_cast<const Sample*>(row);
  for (std::size_t x = 0; x < width; ++x) {
    colored[x] = static_cast<std::uint8_t>(colored[x] | ((samples[x] & zero) != 0 ? 1 : 0));
  }
}

template <class Sample>
void blacken(std::byte* row, const std::uint8_t* masked, std::size_t width) {
  auto* const samples = reinterpret_cast<Sample*>(row);
  for (std::size_t x = 0; x < width; ++x) samples[x] = masked[x] != 0 ? 0 : samples[x];
}

}  // namespace

Result<PixelMask> PixelMask::open(const UpsampleImageOptions& options, const RgbSource& source, int threads) {
  PixelMask mask;
  const bool from_file = options.masking == Masking::kFile;
  if (from_file == options.mask.empty()) {
    return from_file ? make_error(ErrorCode::kBadArgument, "no file to take the mask from")
                     : make_error(ErrorCode::kBadArgument, "{}: a mask that is not asked for", options.mask);
  }
  if (options.masking == Masking::kAlpha && source.alpha()) {
    mask.plane_ = source.alpha();
    mask.type_ = source.planes()[*mask.plane_].type;
  }
  for (std::size_t k = 0; k < mask.color_types_.size(); ++k) mask.color_types_[k] = source.planes()[k].type;
  if (!from_file) return mask;
  SPECTILE_ASSIGN(mask.file_, ExrInput::open(options.mask, threads));
  SPECTILE_TRY(mask.choose(source));
  mask.plane_ = source.planes().size();
  return mask;
}

Result<void> PixelMask::choose(const RgbSource& source) {
  const std::string& path = file_->path();
  for (int part = 0; part < file_->parts(); ++part) {
    if (file_->header(part).deep()) continue;
    const PartHeader& header = file_->header(part);
    for (const char* const name : {"A", "Y", "R"}) {
      const StoredChannel* const channel = header.find(name);
      if (channel == nullptr) continue;
      if (channel->subsampled()) {
        return make_error(ErrorCode::kBadFile,
                          "{}: channel \"{}\" is subsampled {} x {}, which no mask can be", path, name,
                          channel->x_sampling, channel->y_sampling);
      }
      const PartHeader& whole = source.whole();
      if (header.width() != whole.width() || header.height() != whole.height()) {
        return make_error(ErrorCode::kBadFile, "{}: is {} x {}, the image that it masks {} x {}", path,
                          header.width(), header.height(), whole.width(), whole.height());
      }
      part_ = part;
      channel_ = name;
      choices_ = 0;
      for (const char* const other : {"A", "Y", "R"}) choices_ += header.find(other) != nullptr ? 1 : 0;
      return crop(source);
    }
  }
  return make_error(ErrorCode::kBadFile, "{}: has no channel A, Y or R to be a mask", path);
}

std::string PixelMask::chosen() const {
  return choices_ > 1 ? fmt::format("channel {} of {}", channel_, file_->path()) : std::string();
}

/// The part of the mask that goes with the part of the source, wherever the mask's own data window begins.
Result<void> PixelMask::crop(const RgbSource& source) {
  if (source.width() == source.whole().width() && source.height() == source.whole().height()) return {};
  const PixelWindow& own = file_->header(part_).data_window();
  const int x = own.x0 + source.offset()[0];
  const int y = own.y0 + source.offset()[1];
  std::vector<std::string> notes;
  SPECTILE_ASSIGN(
      region_, RegionReader::create(*file_, part_, {x, y, x + source.width(), y + source.height()}, notes));
  return {};
}

Result<void> PixelMask::read(Strip& strip) {
  if (!file_) return {};
  // Every type that a channel may have comes as float.
  const std::vector<PlaneSpec> wanted = {{channel_, type_}};
  SPECTILE_ASSIGN(auto own, make_strip(wanted, strip.width, strip.first_line, strip.lines));
  SPECTILE_TRY(region_ ? region_->fill(wanted, *own) : fill_strip(*file_, part_, wanted, *own));
  strip.planes.push_back(std::move(own->planes[0]));
  strip.stride_bytes.push_back(own->stride_bytes[0]);
  strip.row_bytes.push_back(own->row_bytes[0]);
  const int height = (region_ ? region_->header() : file_->header(part_)).height();
  if (strip.first_line + strip.lines == height) SPECTILE_TRY(file_->unchanged());
  return {};
}

Result<std::uint64_t> PixelMask::apply(Strip& strip) {
  SPECTILE_TRY(read(strip));
  std::uint64_t count = 0;
  if (!plane_) return count;
  const auto width = static_cast<std::size_t>(strip.width);
  masked_.resize(width);
  colored_.resize(width);
  for (int at = strip.first_line; at < strip.first_line + strip.lines; ++at) {
    if (line(strip, at, masked_.data()) == 0) continue;
    std::fill(colored_.begin(), colored_.end(), std::uint8_t{0});
    for (std::size_t k = 0; k < color_types_.size(); ++k) {
      std::byte* const row = strip.row(k, at);
      if (color_types_[k] == SampleType::kHalf) {
        note_colored<std::uint16_t>(row, 0x7FFF, colored_.data(), width);
        blacken<std::uint16_t>(row, masked_.data(), width);
      } else {
        const std::uint32_t zero = color_types_[k] == SampleType::kFloat ? 0x7FFFFFFF : 0xFFFFFFFF;
        note_colored<std::uint32_t>(row, zero, colored_.data(), width);
        blacken<std::uint32_t>(row, masked_.data(), width);
      }
    }
    for (std::size_t x = 0; x < width; ++x) count += masked_[x] & colored_[x];
  }
  return count;
}

std::uint64_t PixelMask::line(const Strip& strip, int line, std::uint8_t* masked) const {
  if (!plane_) return 0;
  const std::byte* const row = strip.row(*plane_, line);
  const auto width = static_cast<std::size_t>(strip.width);
  switch (type_) {
    case SampleType::kHalf:
      return zeros<std::uint16_t>(row, 0x7FFF, masked, width);
    case SampleType::kFloat:
      return zeros<std::uint32_t>(row, 0x7FFFFFFF, masked, width);
    default:
      return zeros<std::uint32_t>(row, 0xFFFFFFFF, masked, width);
  }
}

}  // namespace spectile::io
