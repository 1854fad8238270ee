// SpectralSource: an open spectral image, its bands in order, and what else passes through.
#include "src/io/convert/sources/spectral_source.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "src/base/errors.hpp"
#include "src/io/channels/color_channels.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/channels/spectral_layout.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"

namespace spectile::io {

Error no_spectra(const ExrInput& input) {
  for (int part = 0; part < input.parts(); ++part) {
    if (input.header(part).deep() || !claims_coefficients(input.header(part))) continue;
    return make_error(ErrorCode::kBadFile, "{}: holds coefficients; expanding turns them into spectra",
                      input.path());
  }
  const char* const colors = color_sets(input).empty() ? "" : "; upsample makes spectra of its colours";
  return make_error(
      ErrorCode::kBadFile,
      "{}: has no spectral channels (such as T.500,000000nm or S0.500,000000nm){}; a channel map "
      "(--channels) says which wavelengths other names stand for",
      input.path(), colors);
}

Result<std::unique_ptr<SpectralSource>> SpectralSource::open(const std::string& path,
                                                             const ChannelChoice& choice,
                                                             std::optional<Quantity> wanted, int threads,
                                                             const std::optional<PixelWindow>& region,
                                                             SpectralContent content) {
  std::unique_ptr<SpectralSource> source(new SpectralSource);
  SPECTILE_ASSIGN(source->input_, ExrInput::open(path, threads));
  SPECTILE_TRY(source->choose(choice, wanted, content));
  SPECTILE_TRY(source->add_passing());
  SPECTILE_TRY(source->choose_region(region));
  return source;
}

Result<void> SpectralSource::choose(const ChannelChoice& choice, std::optional<Quantity> wanted,
                                    SpectralContent content) {
  const std::string& path = input_->path();
  const bool both = content == SpectralContent::kBothQuantities;
  std::vector<SpectralSet> sets;
  if (both) {
    SPECTILE_ASSIGN(sets, choose_all_spectra(*input_, choice, std::nullopt, notes_));
  } else {
    SPECTILE_ASSIGN(auto set, choose_spectra(*input_, choice, wanted, notes_));
    if (set) sets.push_back(*std::move(set));
  }
  if (sets.empty()) return no_spectra(*input_);
  if (both && sets.size() != 2) {
    return make_error(ErrorCode::kBadFile, "{}: both quantities were asked for; it has {} alone", path,
                      sets.front().description());
  }
  set_ = std::move(sets.front());
  part_ = set_.part;
  SPECTILE_ASSIGN(bands_, set_.bands(header(), path));
  SPECTILE_ASSIGN(reradiation_, set_.reradiation(bands_, path));
  SPECTILE_ASSIGN(planes_, band_planes(header(), set_, path));
  const auto add = [&](const std::vector<PlaneSpec>& more) {
    planes_.insert(planes_.end(), more.begin(), more.end());
  };
  if (both) {
    SPECTILE_ASSIGN(emission_bands_, sets.back().bands(header(), path));
    SPECTILE_ASSIGN(const auto planes, band_planes(header(), sets.back(), path));
    add(planes);
  }
  for (const int component : {1, 2}) {
    if (content != SpectralContent::kLinearPolarisation) break;
    SpectralSet stokes;
    SPECTILE_ASSIGN(stokes.names, set_.stokes(component, path));
    SPECTILE_ASSIGN(const auto planes, band_planes(header(), stokes, path));
    add(planes);
  }
  samples_ = planes_.size();
  return {};
}

Result<void> SpectralSource::add_passing() {
  std::size_t polarised = 0;
  for (const StoredChannel& channel : header().channels()) {
    const std::string& name = channel.name;
    // The preview gives way to the colours made here; the rest of the spectrum is not a colour's business.
    if (name == "R" || name == "G" || name == "B") continue;
    const auto spectra = std::span(planes_).first(samples_);
    if (std::ranges::any_of(spectra, [&](const auto& p) { return p.name == name; })) continue;
    if (const auto spectral = parse_spectral_channel(name, header())) {
      polarised += spectral->kind == SpectralKind::kPolarised ? 1 : 0;
      continue;
    }
    if (passes(channel, notes_)) planes_.push_back({name, channel.type});
  }
  if (polarised > 0) {
    notes_.push_back(fmt::format("left out: {} channel{} of polarised light (S1, S2, S3)", polarised,
                                 polarised == 1 ? "" : "s"));
  }
  return {};
}

void load_block(const kernels::KernelTable& kernels, const std::vector<PlaneSpec>& planes,
                std::size_t samples, const Strip& strip, int line, std::size_t x, float* block) {
  const std::size_t count = std::min(kLanesPerBlock, static_cast<std::size_t>(strip.width) - x);
  for (std::size_t band = 0; band < samples; ++band, block += kLanesPerBlock) {
    const std::byte* row = strip.row(band, line);
    if (planes[band].type == SampleType::kHalf) {
      kernels.half_to_float(block, reinterpret_cast<const std::uint16_t*>(row) + x, kLanesPerBlock);
    } else {
      std::memcpy(block, reinterpret_cast<const float*>(row) + x, count * sizeof(float));
    }
    std::fill(block + count, block + kLanesPerBlock, 0.0F);
  }
}

}  // namespace spectile::io
