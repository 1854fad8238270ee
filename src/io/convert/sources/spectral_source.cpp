// SpectralSource: an open spectral image, its bands in order, and what else passes through.
#include "src/io/convert/sources/spectral_source.hpp"

#include <algorithm>
#include <cstring>
#include <map>

#include "src/base/errors.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/plan_attribute.hpp"
#include "src/io/convert/sources/spectral_layout.hpp"

namespace spectile::io {

std::optional<SpectralChannels> spectral_channels(const PartHeader& header, std::optional<Quantity> wanted) {
  std::map<Quantity, std::vector<std::pair<double, std::string>>> found;
  for (const StoredChannel& stored : header.channels()) {
    const auto channel = parse_spectral_channel(stored.name);
    if (!channel || channel->kind == SpectralKind::kPolarised) continue;
    const Quantity quantity =
        channel->kind == SpectralKind::kReflective ? Quantity::kReflectance : Quantity::kIlluminant;
    found[quantity].emplace_back(channel->wavelength_nm, stored.name);
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

Result<std::vector<PlaneSpec>> band_planes(const PartHeader& header, const SpectralChannels& channels,
                                           const std::string& path) {
  std::vector<PlaneSpec> out;
  for (const std::string& name : channels.names) {
    const StoredChannel& channel = *header.find(name);
    SPECTILE_TRY(check_sampling(channel, path));
    out.push_back({name, readable_type(channel.type)});
  }
  return out;
}

Result<std::unique_ptr<SpectralSource>> SpectralSource::open(const std::string& path,
                                                             std::optional<Quantity> wanted, int threads,
                                                             const std::optional<PixelWindow>& region) {
  std::unique_ptr<SpectralSource> source(new SpectralSource);
  SPECTILE_ASSIGN(source->input_, ExrInput::open(path, threads));
  std::optional<SpectralChannels> channels;
  for (int part = 0; part < source->input_->parts() && !channels; ++part) {
    if (source->input_->header(part).deep()) continue;
    channels = spectral_channels(source->input_->header(part), wanted);
    source->part_ = part;
  }
  for (int part = 0; part < source->input_->parts() && !channels; ++part) {
    if (source->input_->header(part).deep() || !claims_coefficients(source->input_->header(part))) continue;
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

  SPECTILE_ASSIGN(source->planes_, band_planes(source->header(), source->channels_, path));
  for (const StoredChannel& channel : source->header().channels()) {
    const std::string& name = channel.name;
    // The preview gives way to the colours made here; the rest of the spectrum is not a colour's business.
    if (name == "R" || name == "G" || name == "B" || parse_spectral_channel(name)) continue;
    if (passes(channel, source->notes_)) source->planes_.push_back({name, channel.type});
  }
  SPECTILE_TRY(source->choose_region(region));
  return source;
}

void SpectralSource::block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
                           float* block) const {
  const std::size_t count = std::min(kLanesPerBlock, static_cast<std::size_t>(strip.width) - x);
  for (std::size_t band = 0; band < bands_.count(); ++band, block += kLanesPerBlock) {
    const std::byte* row = strip.row(band, line);
    if (planes_[band].type == SampleType::kHalf) {
      kernels.half_to_float(block, reinterpret_cast<const std::uint16_t*>(row) + x, kLanesPerBlock);
    } else {
      std::memcpy(block, reinterpret_cast<const float*>(row) + x, count * sizeof(float));
    }
    std::fill(block + count, block + kLanesPerBlock, 0.0F);
  }
}

}  // namespace spectile::io
