// SpectralSource: an open spectral image, its bands in order, and what else passes through.
#include "src/io/convert/sources/spectral_source.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/io/channels/color_channels.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/channels/spectral_layout.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"

namespace spectile::io {

Result<std::unique_ptr<SpectralSource>> SpectralSource::open(const std::string& path,
                                                             const ChannelChoice& choice,
                                                             std::optional<Quantity> wanted, int threads,
                                                             const std::optional<PixelWindow>& region) {
  std::unique_ptr<SpectralSource> source(new SpectralSource);
  SPECTILE_ASSIGN(source->input_, ExrInput::open(path, threads));
  const ExrInput& input = *source->input_;
  SPECTILE_ASSIGN(auto set, choose_spectra(input, choice, wanted, source->notes_));
  if (!set) {
    for (int part = 0; part < input.parts(); ++part) {
      if (input.header(part).deep() || !claims_coefficients(input.header(part))) continue;
      return make_error(ErrorCode::kBadFile, "{}: holds coefficients; expanding turns them into spectra",
                        path);
    }
    const std::string colors = color_sets(input).empty() ? "" : "; upsample makes spectra of its colours";
    return make_error(ErrorCode::kBadFile,
                      "{}: has no spectral channels (such as T.500,000000nm or S0.500,000000nm){}; a channel "
                      "map (--channels) says which wavelengths other names stand for",
                      path, colors);
  }
  source->part_ = set->part;
  source->set_ = *std::move(set);
  SPECTILE_ASSIGN(source->bands_, source->set_.bands(source->header(), path));
  SPECTILE_ASSIGN(source->reradiation_, source->set_.reradiation(source->bands_, path));
  SPECTILE_ASSIGN(source->planes_, band_planes(source->header(), source->set_, path));
  const std::vector<PlaneSpec> taken = source->planes_;
  std::size_t polarised = 0;
  for (const StoredChannel& channel : source->header().channels()) {
    const std::string& name = channel.name;
    // The preview gives way to the colours made here; the rest of the spectrum is not a colour's business.
    if (name == "R" || name == "G" || name == "B") continue;
    if (std::any_of(taken.begin(), taken.end(), [&](const auto& p) { return p.name == name; })) continue;
    if (const auto spectral = parse_spectral_channel(name, source->header())) {
      polarised += spectral->kind == SpectralKind::kPolarised ? 1 : 0;
      continue;
    }
    if (passes(channel, source->notes_)) source->planes_.push_back({name, channel.type});
  }
  if (polarised > 0) {
    source->notes_.push_back(fmt::format("left out: {} channel{} of polarised light (S1, S2, S3)", polarised,
                                         polarised == 1 ? "" : "s"));
  }
  SPECTILE_TRY(source->choose_region(region));
  return source;
}

void SpectralSource::block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
                           float* block) const {
  const std::size_t count = std::min(kLanesPerBlock, static_cast<std::size_t>(strip.width) - x);
  for (std::size_t band = 0; band < samples(); ++band, block += kLanesPerBlock) {
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
