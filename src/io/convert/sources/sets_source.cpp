// SetsSource: an open spectral image with all quantities of one layer and view, and what else passes through.
#include "src/io/convert/sources/sets_source.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"

namespace spectile::io {

Result<std::unique_ptr<SetsSource>> SetsSource::open(const std::string& path, const ChannelChoice& choice,
                                                     std::optional<Quantity> wanted, int threads,
                                                     const std::optional<PixelWindow>& region) {
  std::unique_ptr<SetsSource> source(new SetsSource);
  SPECTILE_ASSIGN(source->input_, ExrInput::open(path, threads));
  SPECTILE_ASSIGN(auto sets, choose_all_spectra(*source->input_, choice, wanted, source->notes_));
  if (sets.empty()) return no_spectra(*source->input_);
  source->part_ = sets.front().part;
  for (SpectralSet& set : sets) SPECTILE_TRY(source->add(std::move(set)));
  source->samples_ = source->planes_.size();
  source->add_passing();
  SPECTILE_TRY(source->choose_region(region));
  return source;
}

Result<void> SetsSource::add(SpectralSet set) {
  const std::string& path = input_->path();
  SourceSpectra out;
  out.set = std::move(set);
  SPECTILE_ASSIGN(out.bands, out.set.bands(header(), path));
  SPECTILE_TRY(out.set.reradiation(out.bands, path));
  SPECTILE_ASSIGN(const auto planes, band_planes(header(), out.set, path));
  out.first = planes_.size();
  out.first_reradiating = out.first + out.bands.count();
  planes_.insert(planes_.end(), planes.begin(), planes.end());
  for (const auto& [name, channel] : out.set.polarised) {
    SPECTILE_TRY(check_sampling(*header().find(name), path));
  }
  add_stokes(out);
  spectra_.push_back(std::move(out));
  return {};
}

void SetsSource::add_stokes(SourceSpectra& spectra) {
  for (int component = 1; component <= 3; ++component) {
    std::vector<PlaneSpec> planes;
    bool same = true;
    for (const auto& [name, channel] : spectra.set.polarised) {
      if (channel.stokes != component) continue;
      const std::size_t band = planes.size();
      // Names have six decimals.
      same = same && band < spectra.bands.count() &&
             std::abs(spectra.bands[band].centre_nm - channel.wavelength_nm) <= 1e-6;
      planes.push_back({name, readable_type(header().find(name)->type)});
    }
    if (planes.empty()) continue;
    if (!same || planes.size() != spectra.bands.count()) {
      notes_.push_back(fmt::format("left out: {} channels of S{}, whose wavelengths are not those of S0",
                                   planes.size(), component));
      continue;
    }
    spectra.stokes.push_back({component, planes_.size()});
    planes_.insert(planes_.end(), planes.begin(), planes.end());
  }
}

void SetsSource::add_passing() {
  const std::vector<PlaneSpec> taken = planes_;
  const auto belongs = [&](const std::string& name) {
    return std::any_of(spectra_.begin(), spectra_.end(), [&](const SourceSpectra& s) {
      return std::ranges::any_of(s.set.polarised, [&](const auto& p) { return p.first == name; });
    });
  };
  std::size_t polarised = 0;
  for (const StoredChannel& channel : header().channels()) {
    const std::string& name = channel.name;
    if (std::any_of(taken.begin(), taken.end(), [&](const auto& p) { return p.name == name; })) continue;
    if (const auto spectral = parse_spectral_channel(name, header())) {
      polarised += spectral->kind == SpectralKind::kPolarised && !belongs(name) ? 1 : 0;
      continue;
    }
    if (passes(channel, notes_)) planes_.push_back({name, channel.type});
  }
  if (polarised == 0) return;
  notes_.push_back(fmt::format("left out: {} channel{} of polarised light (S1, S2, S3)", polarised,
                               polarised == 1 ? "" : "s"));
}

}  // namespace spectile::io
