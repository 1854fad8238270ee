// Spectral side of a scene in one representation: wavelengths of each path's own, or bands of all.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "atlas.hpp"

namespace tracer {

/// Ways to carry spectra along paths.
enum class Representation {
  kUniform,    ///< four wavelengths a path, drawn evenly
  kVisible,    ///< ... as the eye is sensitive
  kLight,      ///< ... as the lamps' sum is seen
  kEven,       ///< 60 bands, 400 to 700 nm
  kPlanned,    ///< bands planned for the lamps and materials
  kReference,  ///< every nanometre that the observer sees
};

inline constexpr std::size_t kWavelengths = 4;
inline constexpr std::size_t kPlannedBands = 12;
/// A worker calls the library for its own batch, so each call runs on the worker's thread.
inline constexpr Execution kOneThread = {1};

/// Spectral batches of one worker's paths.
struct PathSpectra {
  SampledWavelengths wavelengths;  ///< of no lanes on bands
  SampledSpectra throughput, radiance, scattering;
  std::array<SampledSpectra, 2> lamps;
  SampledSpectra light, product;  ///< intermediate results
};

/// Optical constants of a few lanes. Metal: a lane each at wavelengths of their own, one for all on bands.
/// Glass: at one wavelength a lane, without k.
struct OpticalConstants {
  SampledSpectra lambda, eta, k;
};

/// Spectra of a scene, ready for batches. Shared by all threads.
class SpectralScene {
 public:
  static Result<SpectralScene> create(const Scene& scene, Representation representation);

  bool on_bands() const noexcept { return axis_.bands() != nullptr; }
  const SpectralAxis& axis() const noexcept { return axis_; }

  Result<PathSpectra> make_paths(std::size_t lanes) const;
  Result<OpticalConstants> make_metals(std::size_t lanes) const;
  Result<OpticalConstants> make_glasses(std::size_t lanes) const;

  /// Draws wavelengths and looks the lamps up there; throughput 1, radiance 0.
  Result<void> start(LanesView u, PathSpectra& paths) const;
  /// Reflectances at points of the atlas, for the lanes of `scattering`.
  Result<void> reflectances(const TexturePoints& at, const PathSpectra& paths,
                            SampledSpectraSpan scattering) const;
  const Atlas& atlas() const noexcept { return atlas_; }
  /// Fills eta and k of the first lanes, whose wavelengths are in `lambda`.
  Result<void> look_up_metals(OpticalConstants& metals, std::size_t lanes) const;
  Result<void> look_up_glasses(OpticalConstants& glasses, std::size_t lanes) const;
  /// Centre of a band. Units: nm.
  float band_nm(std::size_t k) const { return static_cast<float>((*axis_.bands())[k].centre_nm); }

 private:
  enum Constant : std::size_t { kFirstLamp, kSecondLamp, kEta, kAbsorption, kConstants };
  SpectralScene(SpectralAxis axis, Atlas atlas) : axis_(std::move(axis)), atlas_(std::move(atlas)) {}

  SpectralAxis axis_;
  Atlas atlas_;
  Representation representation_ = Representation::kUniform;
  std::optional<WavelengthDistribution> distribution_;
  std::vector<SpectrumSampler> samplers_;             ///< [kConstants], for wavelengths
  std::array<std::vector<float>, kConstants> bands_;  ///< the same on bands
  std::optional<SpectrumSampler> glass_;
};

std::optional<Representation> parse_representation(std::string_view name);
std::string_view to_string(Representation representation);

}  // namespace tracer
