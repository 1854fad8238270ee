// CoefficientSource: an open image of a method's coefficients, the method, and what else passes through.
#include "src/io/convert/sources/coefficient_source.hpp"

#include <OpenEXR/ImfChannelList.h>

#include <algorithm>

#include "src/base/errors.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/sources/spectral_layout.hpp"

namespace spectile::io {
namespace {

constexpr const char* kNames[] = {"spectile.c0", "spectile.c1", "spectile.c2", "spectile.scale"};

bool is_coefficient(const std::string& name) {
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

}  // namespace

bool claims_coefficients(const Imf::Header& header) {
  bool spectral = false;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (is_coefficient(it.name())) return true;
    spectral = spectral || parse_spectral_channel(it.name()).has_value();
  }
  return !spectral && header.find("spectileCoefficients") != header.end();
}

Result<std::unique_ptr<CoefficientSource>> CoefficientSource::open(std::unique_ptr<ExrInput> input,
                                                                   const Crop& region) {
  const std::string& path = input->path();
  int part = 0;
  while (part < input->parts() && (input->deep(part) || !claims_coefficients(input->header(part)))) ++part;
  if (part == input->parts()) {
    return make_error(ErrorCode::kBadFile,
                      "{}: holds no coefficients (channels spectile.c0, spectile.c1, spectile.c2)", path);
  }
  SPECTILE_ASSIGN(auto upsampler, upsampler_of(input->header(part), path));
  std::unique_ptr<CoefficientSource> source(new CoefficientSource);
  source->input_ = std::move(input);
  source->part_ = part;
  source->upsampler_ = std::make_unique<Upsampler>(std::move(upsampler));
  SPECTILE_TRY(source->choose_channels());
  if (region) {
    SPECTILE_ASSIGN(source->region_, RegionReader::create(*source->input_, part, *region, source->notes_));
  }
  return source;
}

Result<void> CoefficientSource::choose_channels() {
  const std::string& path = input_->path();
  const Imf::ChannelList& channels = header().channels();
  for (const std::string& name : coefficient_channels(*upsampler_)) {
    const Imf::Channel* const channel = channels.findChannel(name);
    if (channel == nullptr)
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" is missing", path, name);
    if (channel->xSampling != 1 || channel->ySampling != 1) {
      return make_error(ErrorCode::kBadFile,
                        "{}: channel \"{}\" is subsampled {} x {}, which is not supported", path, name,
                        channel->xSampling, channel->ySampling);
    }
    if (channel->type == Imf::UINT) {
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" holds whole numbers, not coefficients", path,
                        name);
    }
    planes_.push_back({name, Imf::FLOAT});
  }
  coefficients_ = planes_.size();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string name = it.name();
    if (parse_spectral_channel(name)) {
      return make_error(ErrorCode::kBadFile, "{}: holds spectral channels already (\"{}\")", path, name);
    }
    if (is_coefficient(name)) {
      const auto known = planes_.begin() + static_cast<std::ptrdiff_t>(coefficients_);
      if (std::any_of(planes_.begin(), known, [&](const auto& plane) { return plane.name == name; }))
        continue;
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" is none of {}'s coefficients for {}", path,
                        name, to_string(upsampler_->method()), to_string(upsampler_->quantity()));
    }
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      notes_.push_back(fmt::format("channel \"{}\" is left out: it is subsampled {} x {}", name,
                                   it.channel().xSampling, it.channel().ySampling));
      continue;
    }
    planes_.push_back({name, it.channel().type});
  }
  if (input_->parts() > 1) {
    notes_.push_back(fmt::format("{} other parts of the file are left out", input_->parts() - 1));
  }
  return {};
}

Result<std::shared_ptr<Strip>> CoefficientSource::read(int first_line, int lines) {
  SPECTILE_ASSIGN(auto strip, make_strip(planes_, width(), first_line, lines));
  SPECTILE_TRY(region_ ? region_->fill(planes_, *strip) : fill_strip(*input_, part_, planes_, *strip));
  // The last lines: all of it is of one file.
  if (first_line + lines == height()) SPECTILE_TRY(input_->unchanged());
  return strip;
}

}  // namespace spectile::io
