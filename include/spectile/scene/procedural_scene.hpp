// ProceduralScene: pictures whose every pixel has a known exact value, as batches of samples for films.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <spectile/film/film.hpp>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// How samples are drawn of a scene.
struct SceneSampling {
  std::uint64_t seed = 1;
  std::uint64_t samples_per_pixel = 16;
  /// Of each pixel's samples this shard draws those whose number modulo `shards` is `shard`: the shards
  /// together are the very samples of one run.
  std::uint64_t shard = 0;
  std::uint64_t shards = 1;
  std::size_t wavelengths = 4;  ///< a sample, for films fed with wavelengths
  WavelengthSampling density = WavelengthSampling::kVisible;
};

/// A batch of samples in memory of its own, as a film takes it.
class SceneBatch {
 public:
  /// `rows`: wavelengths a sample, or bands. Errors: kOutOfMemory.
  static Result<SceneBatch> create(std::size_t most_samples, std::size_t rows, bool wavelengths);
  std::size_t size() const noexcept { return size_; }
  /// Without weights where all are 1; none of the kind that the batch is not for.
  WavelengthSamples wavelength_samples() const noexcept;
  BandSamples band_samples() const noexcept;

 private:
  friend class ProceduralScene;
  SceneBatch() = default;
  FloatBuffer x_, y_, weight_;
  FloatBuffer radiance_, lambda_, density_;
  std::size_t capacity_ = 0, size_ = 0, rows_ = 0, stride_ = 0;
  bool wavelengths_ = false;
  bool weighted_ = false;  ///< else all weights are 1 and none are handed out
};

/// A scene: axis-aligned rectangles of the unit square over one another, each of a spectrum times a product
/// of a linear function of x and one of y; black between them. Such a scene has a closed form under every
/// separable filter.
class ProceduralScene {
 public:
  /// "gradients", "edges", "spikes", "decades" or "mixed", the four of them side by side.
  /// Errors: kUnknownName, listing the names.
  static Result<ProceduralScene> named(std::string_view name);
  static std::vector<std::string> names();

  /// Radiance at a point of a film of width x height pixels. Units: pixels, nm, W/(m^2 sr nm).
  double radiance(double x, double y, double lambda_nm, int width, int height) const;

  /// Draws the samples of a run of pixels: of `count` pixels from the `first` on, in tiles of kFilmTile
  /// (left to right, top to bottom, and so within a tile), of the film's window, positions spread over each
  /// pixel's area (or, where the film places samples in one pixel, as its filter is importance-sampled).
  /// The same pixel gets the same samples whatever the run. Replaces what the batch held.
  /// All are independent; float positions are the nearest within the pixel to those that radiance is of.
  /// Errors: kSizeMismatch where they do not fit into the batch, or it is for other rows; kBadArgument for a
  /// shard that there is not, a window beyond the film, pixels beyond the window; kOutOfMemory.
  Result<void> draw(const FilmOptions& film, const SceneSampling& sampling, std::uint64_t first,
                    std::uint64_t count, SceneBatch& batch) const;

  /// Exact values of a pixel, by closed forms in double: what a film of these options comes to with more and
  /// more samples, but for its maximum_component, which they know nothing of. Colours of a film fed with
  /// bands are projections of the bands' averages. Splatted samples exist in the film's window only, so a
  /// filter is cut off there; the others see beyond it, up to the scene's end. Of no observer: CIE 1931; of a
  /// sensor that there is not: 0.
  std::array<double, 3> xyz(const FilmOptions& film, int x, int y) const;
  std::array<double, 3> sensor(const FilmOptions& film, std::size_t sensor, int x, int y) const;
  /// One value a band: averages; of a film fed with wavelengths over that part of a band that they are drawn
  /// from, 360 to 830 nm.
  std::vector<double> spectrum(const FilmOptions& film, int x, int y) const;

 private:
  struct Parts;
  explicit ProceduralScene(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
  std::shared_ptr<const Parts> parts_;
};

/// Steps that drawing a scene into a film takes: some ten thousand samples each, in a fixed order, so that a
/// run can stop between them and go on later.
std::uint64_t simulation_steps(const FilmOptions& film, const SceneSampling& sampling);

/// Draws `count` steps from the `first` on and adds them to the film, on several threads: whatever their
/// number, the film is the same. Errors: those of draw() and Film::add(); kBadArgument for steps that there
/// are not.
Result<void> simulate(const ProceduralScene& scene, const SceneSampling& sampling, Film& film,
                      std::uint64_t first, std::uint64_t count, const Execution& execution = {});

/// How far a film's developed XYZ is from the exact values, over the pixels of its window.
struct SceneError {
  double mean_luminance = 0;       ///< of the exact values
  double rms_luminance = 0;        ///< root of the mean square of the differences in Y
  double rms_xyz = 0;              ///< the same over all three
  double mean_radiance = 0;        ///< of the exact spectra on the film's bands, 0 where it keeps none
  double rms_spectrum = 0;         ///< root of the mean square of the differences on the bands
  double largest_relative = 0;     ///< of Y, where the exact value is not 0
  std::uint64_t black_pixels = 0;  ///< exactly 0 as they should be
  std::uint64_t wrong_black = 0;   ///< that are not 0 and should be, or the other way round
};

/// `go_on` is asked some times a second, by one thread at a time; false stops with kCancelled. Errors: those
/// of FilmDevelopment::create() and update(); kCancelled.
Result<SceneError> simulation_error(const ProceduralScene& scene, const Film& film,
                                    const Execution& execution = {}, const std::function<bool()>& go_on = {});

}  // namespace spectile
