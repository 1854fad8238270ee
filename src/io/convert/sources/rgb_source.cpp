// RgbSource: where an image's red, green and blue come from, and what else passes through.
#include "src/io/convert/sources/rgb_source.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/io/channels/spectral_layout.hpp"
#include "src/io/channels/spectral_sets.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"

namespace spectile::io {

Result<std::unique_ptr<RgbSource>> RgbSource::open(const std::string& path, const ChannelChoice& choice,
                                                   int threads, const std::optional<PixelWindow>& region,
                                                   const std::optional<RgbSpace>& stated) {
  std::unique_ptr<RgbSource> source(new RgbSource);
  SPECTILE_ASSIGN(source->input_, ExrInput::open(path, threads));
  SPECTILE_TRY(source->choose(choice));
  if (source->colors_.model == ColorModel::kXyz && !stated) {
    SPECTILE_ASSIGN(source->space_, rgb_space("xyz"));
  } else {
    SPECTILE_ASSIGN(source->space_, input_space_of(source->header(), path, stated, source->notes_));
  }
  SPECTILE_TRY(source->choose_region(region));
  if (source->with_chroma_) {
    SPECTILE_ASSIGN(source->chroma_, LumaChromaReader::open(path, threads));
  }
  return source;
}

Result<void> RgbSource::choose(const ChannelChoice& choice) {
  const std::string& path = input_->path();
  SPECTILE_ASSIGN(const auto found, choose_colors(*input_, choice, notes_));
  for (const StoredChannel& channel : input_->header(found.part).channels()) {
    if (!parse_spectral_channel(channel.name, input_->header(found.part))) continue;
    return make_error(ErrorCode::kBadFile, "{}: holds spectral channels already (\"{}\")", path,
                      channel.name);
  }
  part_ = found.part;
  if (claims_coefficients(header())) {
    return make_error(ErrorCode::kBadFile,
                      "{}: holds coefficients already; expanding turns them into spectra", path);
  }
  colors_ = found;
  take_colors();
  if (!with_chroma_) {
    for (const std::string& name : colors_.names) SPECTILE_TRY(check_sampling(*header().find(name), path));
  }
  choose_passing();
  return {};
}

void RgbSource::take_colors() {
  const PartHeader& h = header();
  const bool luminance = colors_.model == ColorModel::kLuminance;
  // OpenEXR puts luminance and chroma together for the plain channels of a file's first part.
  with_chroma_ = luminance && colors_.prefix.empty() && part_ == 0 && h.find("RY") && h.find("BY");
  for (std::size_t k = 0; k < 3; ++k) {
    const SampleType type = with_chroma_ ? SampleType::kHalf : readable_type(h.find(colors_.names[k])->type);
    planes_.push_back({std::string(1, "RGB"[k]), type});
    // Luminance alone is read once and copied.
    file_names_.push_back(with_chroma_ || (luminance && k > 0) ? std::string() : colors_.names[k]);
  }
}

void RgbSource::choose_passing() {
  const std::string& prefix = colors_.prefix;
  const bool luminance = colors_.model == ColorModel::kLuminance;
  for (const StoredChannel& channel : header().channels()) {
    const std::string& name = channel.name;
    const std::string plain = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
    if (std::find(colors_.names.begin(), colors_.names.end(), name) != colors_.names.end()) continue;
    if (luminance && (plain == "RY" || plain == "BY")) continue;
    if (name == "R" || name == "G" || name == "B") {
      notes_.push_back(fmt::format("channel \"{}\" gives way to the preview of layer \"{}\"", name,
                                   prefix.substr(0, prefix.size() - 1)));
      continue;
    }
    if (is_of_another_view(name)) continue;
    if (!passes(channel, notes_)) continue;
    if (name == colors_.alpha) alpha_ = planes_.size();
    planes_.push_back({name, channel.type});
    file_names_.push_back(name);
  }
  note_other_parts(*input_, {part_}, notes_);
  if (!other_views_.empty()) {
    notes_.push_back(fmt::format("left out: view {} (see --view)", fmt::join(other_views_, ", ")));
  }
}

/// True for a channel of a view that is not the one taken, which is then noted.
bool RgbSource::is_of_another_view(const std::string& name) {
  const std::string view = view_of(name, header().views());
  if (view.empty() || view == colors_.view) return false;
  other_views_.insert(view);
  return true;
}

Result<std::shared_ptr<Strip>> RgbSource::read(int first_line, int lines) {
  SPECTILE_ASSIGN(auto strip, make_strip(planes_, width(), first_line, lines));
  std::vector<PlaneSpec> wanted = planes_;
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i].name = file_names_[i];
  if (with_chroma_) SPECTILE_TRY(chroma_->fill(whole(), offset()[0], offset()[1], *strip));
  SPECTILE_TRY(fill(wanted, *strip));
  if (!with_chroma_ && file_names_[1].empty()) {
    // Luminance alone: green and blue are copies of it.
    const std::size_t bytes = strip->stride_bytes[0] * static_cast<std::size_t>(lines);
    for (std::size_t i : {1U, 2U}) std::memcpy(strip->planes[i].data(), strip->planes[0].data(), bytes);
  }
  return strip;
}

void RgbSource::float_rows(const kernels::KernelTable& kernels, const Strip& strip, int line,
                           float* const rgb[3]) const {
  const auto w = static_cast<std::size_t>(strip.width);
  const std::size_t padded = blocks_for(w) * kLanesPerBlock;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::byte* row = strip.row(k, line);
    if (planes_[k].type == SampleType::kHalf) {
      kernels.half_to_float(rgb[k], reinterpret_cast<const std::uint16_t*>(row), padded);
    } else {
      std::memcpy(rgb[k], row, w * sizeof(float));
    }
    std::fill(rgb[k] + w, rgb[k] + padded, 0.0F);
  }
}

}  // namespace spectile::io
