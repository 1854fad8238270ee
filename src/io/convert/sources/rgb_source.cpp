// RgbSource: where an image's red, green and blue come from, and what else passes through.
#include "src/io/convert/sources/rgb_source.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfRgba.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/spectral_layout.hpp"

namespace spectile::io {
namespace {

std::string part_name(const Imf::Header& header) {
  std::string name = header.hasName() ? header.name() : "";
  return name;
}

bool has_view(const Imf::Header& header, const std::string& view) {
  return header.hasView() && header.view() == view;
}

Imf::PixelType read_type(Imf::PixelType stored) {
  return stored == Imf::HALF ? Imf::HALF : Imf::FLOAT;
}

}  // namespace

Result<std::unique_ptr<RgbSource>> RgbSource::open(const std::string& path, const std::string& layer,
                                                   int threads, const Crop& region) {
  SPECTILE_ASSIGN(auto input, ExrInput::open(path, threads));
  std::unique_ptr<RgbSource> source(new RgbSource);
  source->input_ = std::move(input);
  SPECTILE_TRY(source->choose(layer));
  SPECTILE_ASSIGN(source->space_, color_space_of(source->header(), path));
  if (region) {
    SPECTILE_ASSIGN(source->region_,
                    RegionReader::create(*source->input_, source->part_, *region, source->notes_));
  }
  if (source->with_chroma_) {
    SPECTILE_TRY(guarded(path, [&] {
      source->chroma_ = std::make_unique<Imf::RgbaInputFile>(path.c_str(), threads > 1 ? threads : 0);
    }));
  }
  return source;
}

Result<void> RgbSource::choose(const std::string& layer) {
  const std::string& path = input_->path();
  bool found = false;
  for (int part = 0; part < input_->parts() && !found; ++part) {
    if (input_->deep(part)) continue;
    const Imf::Header& h = input_->header(part);
    if (layer.empty()) {
      found = choose_in_part(part, "");
    } else {
      found = choose_in_part(part, layer + ".");
      if (!found && (part_name(h) == layer || has_view(h, layer))) found = choose_in_part(part, "");
    }
  }
  if (!found) {
    if (layer.empty()) return make_error(ErrorCode::kBadFile, "{}: has no channels R, G, B (nor Y)", path);
    return make_error(ErrorCode::kBadFile, "{}: has no layer, view or part \"{}\" with channels R, G, B",
                      path, layer);
  }
  for (auto it = header().channels().begin(); it != header().channels().end(); ++it) {
    if (parse_spectral_channel(it.name())) {
      return make_error(ErrorCode::kBadFile, "{}: holds spectral channels already (\"{}\")", path, it.name());
    }
  }
  if (claims_coefficients(header())) {
    return make_error(ErrorCode::kBadFile,
                      "{}: holds coefficients already; expanding turns them into spectra", path);
  }
  const Imf::ChannelList& channels = header().channels();
  for (const std::string& name : {red_, green_, blue_}) {
    const Imf::Channel& channel = channels[name.c_str()];
    if (!with_chroma_ && (channel.xSampling != 1 || channel.ySampling != 1)) {
      return make_error(ErrorCode::kBadFile,
                        "{}: channel \"{}\" is subsampled {} x {}, which is not supported", path, name,
                        channel.xSampling, channel.ySampling);
    }
  }
  return {};
}

bool RgbSource::choose_in_part(int part, const std::string& prefix) {
  const Imf::ChannelList& channels = input_->header(part).channels();
  const auto has = [&](const char* name) { return channels.findChannel(prefix + name) != nullptr; };
  const auto type = [&](const std::string& name) { return read_type(channels[name.c_str()].type); };
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
    const Imf::PixelType plane_type = with_chroma_ ? Imf::HALF : type(red_);
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
  const Imf::ChannelList& channels = header().channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string name = it.name();
    const std::string plain = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
    if (plain == "R" || plain == "G" || plain == "B") continue;
    if (red_ == prefix + "Y" && (plain == "Y" || plain == "RY" || plain == "BY")) continue;
    if (name == "R" || name == "G" || name == "B") {
      notes_.push_back(fmt::format("channel \"{}\" gives way to the preview of layer \"{}\"", name,
                                   prefix.substr(0, prefix.size() - 1)));
      continue;
    }
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      notes_.push_back(fmt::format("channel \"{}\" is left out: it is subsampled {} x {}", name,
                                   it.channel().xSampling, it.channel().ySampling));
      continue;
    }
    if (plain == "A") alpha_ = planes_.size();
    planes_.push_back({name, it.channel().type});
    file_names_.push_back(name);
  }
  if (input_->parts() > 1) {
    notes_.push_back(fmt::format("{} other parts of the file are left out", input_->parts() - 1));
  }
}

Result<std::shared_ptr<Strip>> RgbSource::read(int first_line, int lines) {
  SPECTILE_ASSIGN(auto strip, make_strip(planes_, width(), first_line, lines));
  std::vector<PlaneSpec> wanted = planes_;
  bool any = false;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    wanted[i].name = file_names_[i];
    any = any || !file_names_[i].empty();
  }
  if (any) {
    SPECTILE_TRY(region_ ? region_->fill(wanted, *strip) : fill_strip(*input_, part_, wanted, *strip));
  }
  if (with_chroma_) {
    SPECTILE_TRY(read_chroma(*strip));
  } else if (file_names_[1].empty()) {
    // Luminance alone: green and blue are copies of it.
    const std::size_t bytes = strip->stride_bytes[0] * static_cast<std::size_t>(lines);
    for (std::size_t i : {1U, 2U}) std::memcpy(strip->planes[i].data(), strip->planes[0].data(), bytes);
  }
  // The last lines: all of it is of one file.
  if (first_line + lines == height()) SPECTILE_TRY(input_->unchanged());
  return strip;
}

Result<void> RgbSource::read_chroma(Strip& strip) {
  // OpenEXR gives whole lines of the file.
  const Imath::Box2i window = input_->header(part_).dataWindow();
  const auto [left, top] = offset();
  const auto w = static_cast<std::size_t>(width());
  std::vector<Imf::Rgba> whole(static_cast<std::size_t>(width_of(input_->header(part_))));
  const Imf::Rgba* const line = whole.data() + left;
  return guarded(input_->path(), [&, first = top] {
    for (int i = 0; i < strip.lines; ++i) {
      const int y = window.min.y + first + strip.first_line + i;
      chroma_->setFrameBuffer(whole.data() - window.min.x, 1, 0);
      chroma_->readPixels(y);
      for (std::size_t x = 0; x < w; ++x) {
        const std::uint16_t rgb[3] = {line[x].r.bits(), line[x].g.bits(), line[x].b.bits()};
        for (std::size_t k = 0; k < 3; ++k) {
          std::memcpy(strip.row(k, strip.first_line + i) + 2 * x, &rgb[k], sizeof(std::uint16_t));
        }
      }
    }
  });
}

void RgbSource::float_rows(const kernels::KernelTable& kernels, const Strip& strip, int line,
                           float* const rgb[3]) const {
  const auto w = static_cast<std::size_t>(strip.width);
  const std::size_t padded = blocks_for(w) * kLanesPerBlock;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::byte* row = strip.row(k, line);
    if (planes_[k].type == Imf::HALF) {
      kernels.half_to_float(rgb[k], reinterpret_cast<const std::uint16_t*>(row), padded);
    } else {
      std::memcpy(rgb[k], row, w * sizeof(float));
    }
    std::fill(rgb[k] + w, rgb[k] + padded, 0.0F);
  }
}

}  // namespace spectile::io
