// SpectralSource: an open spectral image, its bands in order, and what else passes through.
#include "src/io/convert/sources/spectral_source.hpp"

#include <OpenEXR/ImfChannelList.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "src/base/errors.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/plan_attribute.hpp"
#include "src/io/convert/sources/spectral_layout.hpp"

namespace spectile::io {

std::optional<SpectralChannels> spectral_channels(const Imf::Header& header, std::optional<Quantity> wanted) {
  std::map<Quantity, std::vector<std::pair<double, std::string>>> found;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const auto channel = parse_spectral_channel(it.name());
    if (!channel || channel->kind == SpectralKind::kPolarised) continue;
    const Quantity quantity =
        channel->kind == SpectralKind::kReflective ? Quantity::kReflectance : Quantity::kIlluminant;
    found[quantity].emplace_back(channel->wavelength_nm, it.name());
  }
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
    if (!found.contains(quantity) || (wanted && *wanted != quantity)) continue;
    auto& list = found[quantity];
    std::sort(list.begin(), list.end());
    SpectralChannels out;
    out.quantity = quantity;
    for (const auto& [centre_nm, name] : list) {
      out.centres_nm.push_back(centre_nm);
      out.names.push_back(name);
    }
    return out;
  }
  return std::nullopt;
}

Result<std::unique_ptr<SpectralSource>> SpectralSource::open(const std::string& path,
                                                             std::optional<Quantity> wanted, int threads,
                                                             const Crop& region) {
  SPECTILE_ASSIGN(auto input, ExrInput::open(path, threads));
  std::unique_ptr<SpectralSource> source(new SpectralSource);
  source->input_ = std::move(input);
  std::optional<SpectralChannels> channels;
  for (int part = 0; part < source->input_->parts() && !channels; ++part) {
    if (source->input_->deep(part)) continue;
    channels = spectral_channels(source->input_->header(part), wanted);
    source->part_ = part;
  }
  for (int part = 0; part < source->input_->parts() && !channels; ++part) {
    if (source->input_->deep(part) || !claims_coefficients(source->input_->header(part))) continue;
    return make_error(ErrorCode::kBadFile, "{}: holds coefficients; expanding turns them into spectra", path);
  }
  if (!channels) {
    return make_error(ErrorCode::kBadFile, "{}: has no {}spectral channels (T.*nm, S0.*nm)", path,
                      !wanted                             ? ""
                      : *wanted == Quantity::kReflectance ? "reflective "
                                                          : "emissive ");
  }
  const auto bands = Bands::from_centres(channels->centres_nm);
  if (!bands) return make_error(ErrorCode::kBadFile, "{}: {}", path, bands.error().message);
  SPECTILE_ASSIGN(source->bands_, with_plan(source->input_->header(source->part_), *bands, path));
  source->channels_ = *std::move(channels);

  const Imf::ChannelList& list = source->header().channels();
  for (const std::string& name : source->channels_.names) {
    const Imf::Channel& channel = list[name.c_str()];
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      return make_error(ErrorCode::kBadFile,
                        "{}: channel \"{}\" is subsampled {} x {}, which is not supported", path, name,
                        channel.xSampling, channel.ySampling);
    }
    source->planes_.push_back({name, channel.type == Imf::HALF ? Imf::HALF : Imf::FLOAT});
  }
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string name = it.name();
    // The preview gives way to the colours made here; the rest of the spectrum is not a colour's business.
    if (name == "R" || name == "G" || name == "B" || parse_spectral_channel(name)) continue;
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      source->notes_.push_back(fmt::format("channel \"{}\" is left out: it is subsampled {} x {}", name,
                                           it.channel().xSampling, it.channel().ySampling));
      continue;
    }
    source->planes_.push_back({name, it.channel().type});
  }
  if (region) {
    SPECTILE_ASSIGN(source->region_,
                    RegionReader::create(*source->input_, source->part_, *region, source->notes_));
  }
  return source;
}

Result<std::shared_ptr<Strip>> SpectralSource::read(int first_line, int lines) {
  SPECTILE_ASSIGN(auto strip, make_strip(planes_, width(), first_line, lines));
  SPECTILE_TRY(region_ ? region_->fill(planes_, *strip) : fill_strip(*input_, part_, planes_, *strip));
  // The last lines: all of it is of one file.
  if (first_line + lines == height()) SPECTILE_TRY(input_->unchanged());
  return strip;
}

void SpectralSource::block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
                           float* block) const {
  const std::size_t count = std::min(kLanesPerBlock, static_cast<std::size_t>(strip.width) - x);
  for (std::size_t band = 0; band < bands_.count(); ++band, block += kLanesPerBlock) {
    const std::byte* row = strip.row(band, line);
    if (planes_[band].type == Imf::HALF) {
      kernels.half_to_float(block, reinterpret_cast<const std::uint16_t*>(row) + x, kLanesPerBlock);
    } else {
      std::memcpy(block, reinterpret_cast<const float*>(row) + x, count * sizeof(float));
    }
    std::fill(block + count, block + kLanesPerBlock, 0.0F);
  }
}

}  // namespace spectile::io
