// RgbSource: where an image's red, green and blue come from, and what else passes through.
#include "src/io/convert/sources/rgb_source.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/spectral_layout.hpp"

namespace spectile::io {
Result<std::unique_ptr<RgbSource>> RgbSource::open(const std::string& path, const std::string& layer,
                                                   int threads, const std::optional<PixelWindow>& region,
                                                   const std::optional<RgbSpace>& stated) {
  std::unique_ptr<RgbSource> source(new RgbSource);
  SPECTILE_ASSIGN(source->input_, ExrInput::open(path, threads));
  SPECTILE_TRY(source->choose(layer));
  SPECTILE_ASSIGN(source->space_, input_space_of(source->header(), path, stated, source->notes_));
  SPECTILE_TRY(source->choose_region(region));
  if (source->with_chroma_) {
    SPECTILE_ASSIGN(source->chroma_, LumaChromaReader::open(path, threads));
  }
  return source;
}

Result<void> RgbSource::choose(const std::string& layer) {
  const std::string& path = input_->path();
  bool found = false;
  for (int part = 0; part < input_->parts() && !found; ++part) {
    if (input_->header(part).deep()) continue;
    const PartHeader& h = input_->header(part);
    if (layer.empty()) {
      found = choose_in_part(part, "");
    } else {
      found = choose_in_part(part, layer + ".");
      if (!found && (h.text("name") == layer || h.text("view") == layer)) found = choose_in_part(part, "");
    }
  }
  if (!found) {
    if (layer.empty()) return make_error(ErrorCode::kBadFile, "{}: has no channels R, G, B (nor Y)", path);
    return make_error(ErrorCode::kBadFile, "{}: has no layer, view or part \"{}\" with channels R, G, B",
                      path, layer);
  }
  for (const StoredChannel& channel : header().channels()) {
    if (!parse_spectral_channel(channel.name)) continue;
    return make_error(ErrorCode::kBadFile, "{}: holds spectral channels already (\"{}\")", path,
                      channel.name);
  }
  if (claims_coefficients(header())) {
    return make_error(ErrorCode::kBadFile,
                      "{}: holds coefficients already; expanding turns them into spectra", path);
  }
  for (const std::string& name : {red_, green_, blue_}) {
    if (!with_chroma_) SPECTILE_TRY(check_sampling(*header().find(name), path));
  }
  return {};
}

bool RgbSource::choose_in_part(int part, const std::string& prefix) {
  const PartHeader& h = input_->header(part);
  const auto has = [&](const char* name) { return h.find(prefix + name) != nullptr; };
  const auto type = [&](const std::string& name) { return readable_type(h.find(name)->type); };
  if (has("R") && has("G") && has("B")) {
    red_ = prefix + "R";
    green_ = prefix + "G";
    blue_ = prefix + "B";
    planes_ = {{"R", type(red_)}, {"G", type(green_)}, {"B", type(blue_)}};
    file_names_ = {red_, green_, blue_};
  } else if (has("Y")) {
    // OpenEXR puts luminance and chroma together for the plain channels of a file's first part.
    with_chroma_ = prefix.empty() && part == 0 && has("RY") && has("BY");
    red_ = green_ = blue_ = prefix + "Y";
    const SampleType plane_type = with_chroma_ ? SampleType::kHalf : type(red_);
    planes_ = {{"R", plane_type}, {"G", plane_type}, {"B", plane_type}};
    file_names_ = {red_, "", ""};
    if (with_chroma_) file_names_ = {"", "", ""};
  } else {
    return false;
  }
  part_ = part;
  choose_passing(prefix);
  return true;
}

void RgbSource::choose_passing(const std::string& prefix) {
  for (const StoredChannel& channel : header().channels()) {
    const std::string& name = channel.name;
    const std::string plain = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
    if (plain == "R" || plain == "G" || plain == "B") continue;
    if (red_ == prefix + "Y" && (plain == "Y" || plain == "RY" || plain == "BY")) continue;
    if (name == "R" || name == "G" || name == "B") {
      notes_.push_back(fmt::format("channel \"{}\" gives way to the preview of layer \"{}\"", name,
                                   prefix.substr(0, prefix.size() - 1)));
      continue;
    }
    if (!passes(channel, notes_)) continue;
    if (plain == "A") alpha_ = planes_.size();
    planes_.push_back({name, channel.type});
    file_names_.push_back(name);
  }
  if (input_->parts() > 1) {
    notes_.push_back(fmt::format("{} other parts of the file are left out", input_->parts() - 1));
  }
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
