// CoefficientSource: an open image of a method's coefficients, the method, and what else passes through.
#include "src/io/convert/sources/coefficient_source.hpp"

#include <algorithm>

#include "src/base/errors.hpp"
#include "src/io/channels/spectral_layout.hpp"
#include "src/io/channels/spectral_sets.hpp"
#include "src/io/convert/sources/method_attributes.hpp"

namespace spectile::io {
namespace {

constexpr const char* kNames[] = {"spectile.c0", "spectile.c1", "spectile.c2", "spectile.scale"};

bool is_coefficient(const std::string& name) {
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

}  // namespace

bool claims_coefficients(const PartHeader& header) {
  bool spectral = false;
  for (const StoredChannel& channel : header.channels()) {
    if (is_coefficient(channel.name)) return true;
    spectral = spectral || parse_spectral_channel(channel.name, header).has_value();
  }
  return !spectral && header.has_attribute("spectileCoefficients");
}

Result<std::unique_ptr<CoefficientSource>> CoefficientSource::open(std::unique_ptr<ExrInput> input,
                                                                   const std::optional<PixelWindow>& region) {
  const std::string& path = input->path();
  int part = 0;
  while (part < input->parts() && (input->header(part).deep() || !claims_coefficients(input->header(part))))
    ++part;
  if (part == input->parts()) {
    return make_error(ErrorCode::kBadFile,
                      "{}: holds no coefficients (channels spectile.c0, spectile.c1, spectile.c2), which "
                      "upsample --store coefficients writes",
                      path);
  }
  SPECTILE_ASSIGN(auto upsampler, upsampler_of(input->header(part), path));
  std::unique_ptr<CoefficientSource> source(new CoefficientSource);
  source->input_ = std::move(input);
  source->part_ = part;
  source->upsampler_ = std::make_unique<Upsampler>(std::move(upsampler));
  SPECTILE_TRY(source->choose_channels());
  SPECTILE_TRY(source->choose_region(region));
  return source;
}

Result<void> CoefficientSource::choose_channels() {
  const std::string& path = input_->path();
  const bool straight = has_straight_coefficients(header(), *upsampler_);
  for (const std::string& name : coefficient_channels(*upsampler_, straight)) {
    const StoredChannel* const channel = header().find(name);
    if (channel == nullptr)
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" is missing", path, name);
    SPECTILE_TRY(check_sampling(*channel, path));
    if (channel->type == SampleType::kUint32) {
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" holds integers, not coefficients", path,
                        name);
    }
    planes_.push_back({name, SampleType::kFloat});
  }
  coefficients_ = planes_.size();
  for (const StoredChannel& channel : header().channels()) {
    const std::string& name = channel.name;
    if (parse_spectral_channel(name, header())) {
      return make_error(ErrorCode::kBadFile, "{}: holds spectral channels already (\"{}\")", path, name);
    }
    if (is_coefficient(name)) {
      const auto known = planes_.begin() + static_cast<std::ptrdiff_t>(coefficients_);
      if (std::any_of(planes_.begin(), known, [&](const auto& plane) { return plane.name == name; }))
        continue;
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" is none of {}'s coefficients for {}", path,
                        name, to_string(upsampler_->method()), to_string(upsampler_->quantity()));
    }
    if (passes(channel, notes_)) planes_.push_back({name, channel.type});
  }
  note_other_parts(*input_, {part_}, notes_);
  return {};
}

}  // namespace spectile::io
