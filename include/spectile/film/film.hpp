// Film: batches of spectral samples added up to pixels, the same bits in any order.
//
// Sums are integers of steps of a grid that the film's declared range fixes: a contribution is split,
// exactly, into a coarse part of at most 2^31 steps of 2^(range - 31) and a rest, rounded once to steps of
// 2^(range - 75). Integers add without error, so a pixel depends on the multiset of contributions and
// on nothing else: not on their order, batches, threads, instruction set, or which machine added them.
// A contribution is therefore exact down to 2^(range - 51) in magnitude and off by 2^(range - 76) at most
// below that; 2^31 contributions as large as the range fit into a pixel, and a sum beyond that is an error.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <spectile/color/colorimetry.hpp>
#include <spectile/color/sensor.hpp>
#include <spectile/film/pixel_filter.hpp>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/pixel_window.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Read-only rows of numbers, one a sample. Shapes: [count][n], `stride` floats from row to row; any
/// alignment.
struct RowsView {
  const float* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;
};

/// Samples with radiance at sampled wavelengths. Shapes: x, y [n] in pixels, pixel (i, j) reaching from i to
/// i + 1 and j to j + 1; weight [n], or empty for 1; the rows [k][n].
struct WavelengthSamples {
  std::span<const float> x = {}, y = {}, weight = {};
  RowsView radiance = {};
  RowsView lambda_nm = {};  ///< nm
  RowsView density = {};    ///< 1/nm; 0 for a wavelength that is terminated
};

/// Samples with radiance on the film's bands. Shapes: as above, radiance [band][n].
struct BandSamples {
  std::span<const float> x = {}, y = {}, weight = {};
  RowsView radiance = {};
};

/// Positions and weights of samples. Shapes: as above.
struct SamplePositions {
  std::span<const float> x = {}, y = {}, weight = {};
};

/// The kind of samples that a film takes.
enum class FilmInput { kWavelengths, kBands };

/// Placement of samples in pixels.
enum class SamplePlacement {
  kOnePixel,  ///< each to the pixel that it lies in, with its own weight: for filter-importance-sampled input
  kSplat,     ///< each to every pixel within the filter's radius, weighed by the filter
};

/// Statistics of a pixel's samples, kept beside the sums.
enum class PixelStatistics {
  kNone,
  kCounts,    ///< how many reached it
  kVariance,  ///< also the moments that the variance of its luminance needs
};

/// A sensor and how files and reports call it.
struct NamedSensor {
  std::string name;
  Sensor sensor;
};

/// Size, contents and ranges of a film.
struct FilmOptions {
  int width = 0;
  int height = 0;
  std::optional<PixelWindow> crop = {};  ///< the pixels kept; all where none
  PixelFilter filter = {};
  SamplePlacement placement = SamplePlacement::kOnePixel;
  FilmInput input = FilmInput::kWavelengths;
  /// Colours, at least one colour or the spectrum. XYZ for the observer, Y being 1 for radiance 1 throughout.
  std::optional<Observer> xyz = Observer::kCie1931;
  std::vector<NamedSensor> sensors = {};
  /// True to keep spectra, on the bands below. Fed with wavelengths, a band's value is the mean of the
  /// radiance of those that fell into it, each weighed by one over its density.
  bool spectral = false;
  Bands bands = {};  ///< also those of band input
  PixelStatistics statistics = PixelStatistics::kNone;
  /// Colours with a larger component, and for the spectrum samples with larger radiance, are scaled down to
  /// it before they are weighed.
  float maximum_component = std::numeric_limits<float>::infinity();
  /// Contributions (weight times colour) reach up to 2^range; -32 to 96.
  int range = 32;
  /// The same for weights; -16 to 32.
  int weight_range = 16;
  /// Weights below 0 count, as filters with lobes below 0 give them when they are importance-sampled.
  bool negative_weights = false;
};

/// Samples that reached no pixel, by the first reason in this order that applies.
struct FilmRejections {
  std::uint64_t nan = 0;           ///< position, weight, wavelength, density or radiance over density is NaN
  std::uint64_t infinite = 0;      ///< one of them is infinite
  std::uint64_t negative = 0;      ///< weight or a density below 0
  std::uint64_t outside = 0;       ///< no pixel of the crop window is reached
  std::uint64_t beyond_range = 0;  ///< weight or a contribution beyond the film's range, with variance also
                                   ///< the luminance itself
  std::uint64_t total() const noexcept { return nan + infinite + negative + outside + beyond_range; }
  friend bool operator==(const FilmRejections&, const FilmRejections&) = default;
};

/// Samples that a film has taken, and its memory.
struct FilmStats {
  std::uint64_t accepted = 0;
  FilmRejections rejected;
  std::size_t tiles = 0;            ///< of kFilmTile x kFilmTile pixels in the crop window
  std::size_t touched_tiles = 0;    ///< that hold memory
  std::size_t bytes_per_pixel = 0;  ///< of a touched tile
  std::size_t bytes = 0;            ///< of all touched tiles
};

/// Pixels along a side of a tile, the unit of memory and of development.
inline constexpr int kFilmTile = 16;

struct FilmAccess;

/// The film. add(), develop and stats may be called from any threads at once.
class Film {
 public:
  /// Errors: kBadArgument for a size that is not 1 to 2^18 a side and 2^31 pixels in all (those of whole
  /// tiles), an empty crop or one beyond the film, nothing to keep, a range or maximum outside what the
  /// options say, bands that no observer sees (for XYZ of band input); kOutOfMemory.
  static Result<Film> create(const FilmOptions& options);
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// Adds samples. Several threads are used where `execution` says so; by default the caller's alone.
  /// Numbers: colour = mean over k of curve(lambda_k) * radiance_k / density_k, in float; error below (K + 8)
  /// 2^-24 of the sum of magnitudes. A sample is taken whole or not at all, see FilmRejections.
  /// Errors: kBadArgument for the other kind of input, kSizeMismatch for rows or spans of other lengths,
  /// kBandsMismatch for other than the film's bands, kOutOfMemory (then part of the batch may be in),
  /// kUnavailable once a pixel's sum has gone beyond what it can hold.
  Result<void> add(const WavelengthSamples& samples, const Execution& execution = {1});
  Result<void> add(const BandSamples& samples, const Execution& execution = {1});
  /// The same for batches: radiance at sampled wavelengths, or on the film's bands. Shapes: a lane a
  /// position.
  Result<void> add(const SamplePositions& at, SampledSpectraView radiance,
                   const SampledWavelengthsView& wavelengths, const Execution& execution = {1});
  Result<void> add(const SamplePositions& at, SampledSpectraView radiance, const Execution& execution = {1});

  /// Adds another film's sums to this one's: the very bits of one film fed with both's samples.
  /// Errors: kBadArgument where an option differs, saying which, and when both are one film; kOutOfMemory.
  Result<void> merge(const Film& other);

  const FilmOptions& options() const noexcept;
  /// The pixels kept.
  PixelWindow window() const noexcept;
  FilmStats stats() const;
  /// True if both hold the same options and the same sums and counts, bit by bit.
  bool same_contents(const Film& other) const;

 private:
  friend struct FilmAccess;
  friend class FilmDevelopment;
  struct State;
  explicit Film(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

/// Layers that a film is developed into.
enum class FilmLayer {
  kXyz,        ///< 3 planes
  kSrgb,       ///< 3 planes, linear sRGB of the XYZ; white D65, no adaptation
  kLuminance,  ///< 1 plane: Y, for a third of the work
  kSensor,     ///< 3 planes of one sensor's RGB
  kSpectrum,   ///< a plane a band
  kWeight,     ///< 1 plane: the sum of the weights
  kCount,      ///< 1 plane: samples that reached the pixel
  kVariance,   ///< 1 plane: of the pixel's mean luminance, estimated from its samples; infinite where it
              ///< is undefined: below two samples, or where the sum of w^2 is not below the square of that of
              ///< w
};

/// Tiles of one update of a development.
struct DevelopStats {
  std::size_t developed = 0;  ///< tiles
  std::size_t unchanged = 0;  ///< tiles that nothing was added to since the last time
  std::size_t untouched = 0;  ///< tiles that no sample has reached: 0 everywhere, whatever is asked
};

/// A layer of a film, kept up to date tile by tile.
class FilmDevelopment {
 public:
  /// It shows the film that this one is now, wherever that is moved to, and keeps its sums alive: assigning
  /// another film to the variable does not change the picture's. `sensor` names one for FilmLayer::kSensor.
  /// Errors: kBadArgument when the film does not keep what the layer needs; kOutOfMemory.
  static Result<FilmDevelopment> create(const Film& film, FilmLayer layer, std::size_t sensor = 0);

  /// Develops the tiles that have changed since the last update. A pixel is its sums over the sum of its
  /// weights, in double, rounded once to float; 0 where the weights sum to 0.
  Result<DevelopStats> update(const Execution& execution = {});

  std::size_t planes() const noexcept { return planes_; }
  int width() const noexcept { return window_.width(); }
  int height() const noexcept { return window_.height(); }
  /// Shapes: [height][width], rows stride() floats apart.
  const float* plane(std::size_t p) const noexcept { return pixels_.data() + p * plane_floats_; }
  std::size_t stride() const noexcept { return stride_; }
  /// A pixel of the film, in its own coordinates.
  float at(std::size_t p, int x, int y) const noexcept {
    return plane(
        p)[static_cast<std::size_t>(y - window_.y0) * stride_ + static_cast<std::size_t>(x - window_.x0)];
  }

 private:
  FilmDevelopment() = default;
  std::shared_ptr<Film::State> film_;
  FilmLayer layer_ = FilmLayer::kXyz;
  std::size_t sensor_ = 0;
  PixelWindow window_;
  std::size_t planes_ = 0;
  std::size_t stride_ = 0;
  std::size_t plane_floats_ = 0;
  FloatBuffer pixels_;
  std::vector<std::uint64_t> seen_;  ///< a tile's additions when it was developed
};

}  // namespace spectile
