// Spectra of lamps, metal and glass, the bands of each representation, and their look-up in batches.
#include "spectral_scene.hpp"

#include <algorithm>
#include <cmath>

namespace tracer {
namespace {

/// A lamp scaled so that the observer's Y is its luminance.
Result<Spectrum> scaled_lamp(const Lamp& lamp) {
  SPECTILE_ASSIGN(const auto spectrum, named_spectrum(lamp.spectrum));
  SPECTILE_ASSIGN(const auto y, named_spectrum("cie1931-y"));
  SPECTILE_ASSIGN(const auto table, tabulated(spectrum));
  const double factor = lamp.luminance * y.integral() / inner_product(spectrum, y);
  return Spectrum(PiecewiseLinearSpectrum(table.scaled(factor), Ends::kZero));
}

/// A named index of refraction, which keeps its outer values beyond its table: SF10's begins at 380 nm.
Result<Spectrum> held(const std::string& name) {
  SPECTILE_ASSIGN(const auto spectrum, named_spectrum(name));
  if (const auto* table = std::get_if<PiecewiseLinearSpectrum>(&spectrum.kind())) {
    return Spectrum(PiecewiseLinearSpectrum(table->measured(), Ends::kHeld));
  }
  return spectrum;
}

/// The lamps' sum, to draw wavelengths in proportion to.
Result<Spectrum> sum_of(const Spectrum& a, const Spectrum& b) {
  constexpr int kFirst = static_cast<int>(kFirstVisibleNm);
  constexpr int kLast = static_cast<int>(kLastVisibleNm);
  std::vector<double> values;
  for (int nm = kFirst; nm <= kLast; ++nm) values.push_back(a(nm) + b(nm));
  SPECTILE_ASSIGN(auto sum, DenselySampledSpectrum::from_values(kFirst, std::move(values)));
  return Spectrum(std::move(sum));
}

/// Bands planned for the lamps, and for the measured colours that the library has. They are points: products
/// of values at a wavelength stay values, while products of averages are not averages.
Result<Bands> bands_for(const Scene& scene) {
  PlannerOptions options;
  // The upsampler makes spectra whose colours are those of the textures under D65.
  for (const std::string& name : {scene.lamps[0].spectrum, scene.lamps[1].spectrum, std::string("D65")}) {
    SPECTILE_ASSIGN(const auto light, named_spectrum(name));
    SPECTILE_ASSIGN(auto named, named_light(name, light));
    options.lights.push_back(std::move(named));
  }
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind != "reflectance") continue;
    SPECTILE_ASSIGN(auto patch, named_spectrum(info.name));
    options.reflectances.push_back(std::move(patch));
  }
  options.sampling = BandSampling::kPoints;
  options.bands = kPlannedBands;
  options.bounces = 2;
  options.folds = 0;
  SPECTILE_ASSIGN(const auto plan, make_plan(options));
  return planned_bands(plan);
}

Result<SpectralAxis> axis_of(const Scene& scene, Representation representation) {
  if (representation == Representation::kEven) return SpectralAxis(Bands());
  const bool planned = representation == Representation::kPlanned;
  if (planned || representation == Representation::kReference) {
    SPECTILE_ASSIGN(const auto bands,
                    planned ? bands_for(scene) : Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 1));
    return SpectralAxis(bands);
  }
  return SpectralAxis::own_wavelengths(kWavelengths);
}

std::vector<float> values_on(const Bands& bands, const Spectrum& spectrum) {
  if (!bands.are_points()) return spectrum.average_over(bands);
  std::vector<float> values;
  for (const Band& band : bands.list()) values.push_back(static_cast<float>(spectrum(band.centre_nm)));
  return values;
}

}  // namespace

Result<SpectralScene> SpectralScene::create(const Scene& scene, Representation representation) {
  SPECTILE_ASSIGN(const auto axis, axis_of(scene, representation));
  // Paths with wavelengths of their own have the reference's reflectances: those of bands of a nanometre.
  SPECTILE_ASSIGN(const auto fine, Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 1));
  SPECTILE_ASSIGN(auto atlas, Atlas::create(scene, axis.bands() != nullptr ? *axis.bands() : fine));
  SpectralScene out(axis, std::move(atlas));
  out.representation_ = representation;
  SPECTILE_ASSIGN(const auto first, scaled_lamp(scene.lamps[0]));
  SPECTILE_ASSIGN(const auto second, scaled_lamp(scene.lamps[1]));
  SPECTILE_ASSIGN(const auto eta, held(scene.metal_eta));
  SPECTILE_ASSIGN(const auto k, held(scene.metal_k));
  const std::array<Spectrum, kConstants> spectra = {first, second, eta, k};
  SPECTILE_ASSIGN(const auto glass, held(scene.glass_eta));
  SPECTILE_ASSIGN(out.glass_, SpectrumSampler::create(glass));
  if (const Bands* bands = out.axis_.bands()) {
    for (std::size_t i = 0; i < kConstants; ++i) out.bands_[i] = values_on(*bands, spectra[i]);
    for (std::size_t lamp = 0; bands->weights() != nullptr && lamp < 2; ++lamp) {
      // A plan has its own values for each light, which give it luminance 1.
      out.bands_[lamp].clear();
      for (const double e : bands->weights()->lights[lamp].emission) {
        out.bands_[lamp].push_back(static_cast<float>(e * scene.lamps[lamp].luminance));
      }
    }
    return out;
  }
  for (const Spectrum& spectrum : spectra) {
    SPECTILE_ASSIGN(auto sampler, SpectrumSampler::create(spectrum));
    out.samplers_.push_back(std::move(sampler));
  }
  if (representation != Representation::kLight) return out;
  SPECTILE_ASSIGN(const auto sum, sum_of(first, second));
  SPECTILE_ASSIGN(out.distribution_, WavelengthDistribution::of_light(sum));
  return out;
}

Result<PathSpectra> SpectralScene::make_paths(std::size_t lanes) const {
  PathSpectra out;
  if (!on_bands()) {
    SPECTILE_ASSIGN(out.wavelengths, SampledWavelengths::create(lanes, kWavelengths));
  }
  for (SampledSpectra* batch : {&out.throughput, &out.radiance, &out.scattering, &out.light, &out.product}) {
    SPECTILE_ASSIGN(*batch, SampledSpectra::create(axis_, lanes));
  }
  for (std::size_t lamp = 0; lamp < 2; ++lamp) {
    SPECTILE_ASSIGN(out.lamps[lamp], on_bands() ? SampledSpectra::broadcast(axis_, lanes, bands_[lamp])
                                                : SampledSpectra::create(axis_, lanes));
  }
  return out;
}

Result<OpticalConstants> SpectralScene::make_metals(std::size_t lanes) const {
  OpticalConstants out;
  if (on_bands()) {
    SPECTILE_ASSIGN(out.eta, SampledSpectra::broadcast(axis_, 1, bands_[kEta]));
    SPECTILE_ASSIGN(out.k, SampledSpectra::broadcast(axis_, 1, bands_[kAbsorption]));
    return out;
  }
  for (SampledSpectra* batch : {&out.lambda, &out.eta, &out.k}) {
    SPECTILE_ASSIGN(*batch, SampledSpectra::create(axis_, lanes));
  }
  return out;
}

Result<OpticalConstants> SpectralScene::make_glasses(std::size_t lanes) const {
  OpticalConstants out;
  SPECTILE_ASSIGN(const auto one, SpectralAxis::own_wavelengths(1));
  SPECTILE_ASSIGN(out.lambda, SampledSpectra::create(one, lanes));
  SPECTILE_ASSIGN(out.eta, SampledSpectra::create(one, lanes));
  return out;
}

Result<void> SpectralScene::start(LanesView u, PathSpectra& paths) const {
  const auto fill = [](SampledSpectraSpan batch, float value) {
    std::fill_n(batch.data, batch.floats(), value);
  };
  fill(paths.throughput, 1);
  fill(paths.radiance, 0);
  if (on_bands()) return {};
  SampledWavelengths& w = paths.wavelengths;
  if (distribution_) {
    SPECTILE_TRY(sample_wavelengths(*distribution_, u, w, kOneThread));
  } else {
    const auto sampling = representation_ == Representation::kVisible ? WavelengthSampling::kVisible
                                                                      : WavelengthSampling::kUniform;
    SPECTILE_TRY(sample_wavelengths(sampling, u, w, kFirstVisibleNm, kLastVisibleNm, kOneThread));
  }
  for (std::size_t lamp = 0; lamp < 2; ++lamp) {
    SPECTILE_TRY(samplers_[lamp].sample(w.lambda_nm, paths.lamps[lamp], kOneThread));
  }
  return {};
}

Result<void> SpectralScene::reflectances(const TexturePoints& at, const PathSpectra& paths,
                                         SampledSpectraSpan scattering) const {
  const SpectralTexture& texture = atlas_.texture();
  if (on_bands()) return texture.sample(at, scattering, {}, kOneThread);
  return texture.sample(at, paths.wavelengths.lambda_nm.view().range(0, scattering.lanes), scattering, {},
                        kOneThread);
}

Result<void> SpectralScene::look_up_metals(OpticalConstants& metals, std::size_t lanes) const {
  if (on_bands()) return {};
  const SampledSpectraView lambda = metals.lambda.view().range(0, lanes);
  SPECTILE_TRY(samplers_[kEta].sample(lambda, metals.eta.span().range(0, lanes), kOneThread));
  return samplers_[kAbsorption].sample(lambda, metals.k.span().range(0, lanes), kOneThread);
}

Result<void> SpectralScene::look_up_glasses(OpticalConstants& glasses, std::size_t lanes) const {
  return glass_->sample(glasses.lambda.view().range(0, lanes), glasses.eta.span().range(0, lanes),
                        kOneThread);
}

namespace {
constexpr std::string_view kNames[] = {"uniform", "visible", "light", "even", "planned", "reference"};
}  // namespace

std::optional<Representation> parse_representation(std::string_view name) {
  const auto* const found = std::ranges::find(kNames, name);
  if (found == std::end(kNames)) return std::nullopt;
  return static_cast<Representation>(found - kNames);
}

std::string_view to_string(Representation representation) {
  return kNames[static_cast<std::size_t>(representation)];
}

}  // namespace tracer
