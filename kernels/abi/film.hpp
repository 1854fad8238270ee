// The film: samples weighed, placed in pixels, and added up in exact sums.
//
// A pixel's sum is an integer multiple of a grid's step, in limbs of 64 bits: the coarse one, then rests, of
// at most 2^43 of their steps a contribution. With magic = 1.5 * 2^52 steps of a limb, (v + magic) - magic
// rounds to a step, and bits(v + magic) - bits(magic) is the number of steps.
#pragma once

#include "kernels/abi/lanes.hpp"

namespace spectile::kernels {

/// log2 of pixels along a tile's side; a tile is square.
inline constexpr int kFilmTileLog2 = 4;
inline constexpr std::size_t kFilmTilePixels = std::size_t{1} << (2 * kFilmTileLog2);

// --- limbs of a pixel

/// A quad (four components, the fourth of a colour its weight): coarse limbs of the four, then their rests.
inline constexpr std::size_t kFilmQuadLimbs = 8;
inline constexpr std::size_t kFilmQuadRest = 4;    ///< from a coarse limb to its rest
inline constexpr std::size_t kFilmQuadWeight = 3;  ///< component of the weight

/// A band with its own weight: coarse value, coarse weight, then their rests.
inline constexpr std::size_t kFilmHitLimbs = 4;
inline constexpr std::size_t kFilmHitWeight = 1;
inline constexpr std::size_t kFilmHitRest = 2;  ///< from a coarse limb to its rest

/// Moments: four limbs of sum(w y^2) from the first on, three of sum(w^2), the number of samples.
inline constexpr std::size_t kFilmMomentLimbs = 8;
inline constexpr std::size_t kFilmSquareLimbs = 4;
inline constexpr std::size_t kFilmWeightSquareLimbs = 3;
constexpr std::size_t kFilmWeightSquare[kFilmWeightSquareLimbs] = {4, 5, 7};
inline constexpr std::size_t kFilmMomentCount = 6;

// --- arguments

/// Why a sample does not reach a pixel; of several the lowest counts.
enum FilmReason : std::int32_t {
  kFilmAccepted = 0,
  kFilmNan = 1,
  kFilmInfinite = 2,
  kFilmNegative = 3,
  kFilmOutside = 4,
  kFilmBeyondRange = 5,
  kFilmReasons = 6,
};

/// Three curves at every nanometre, side by side: rows [intervals + 2][8], 32-byte aligned, of the values of
/// the three and a 0, then the differences to the next ones and a 0; those of the last value are 0, and so is
/// all of the row behind it.
struct FilmCurves {
  const float* rows = nullptr;
  float first_nm = 0;
  std::int32_t intervals = 0;
  float largest = 0;  ///< no value and its difference are larger in sum, by magnitude
};

/// Bounds of a contribution.
struct FilmLimits {
  float maximum;       ///< a colour's largest component; infinite for no limit
  float range;         ///< of weight * colour
  float weight_range;  ///< of weights
};

/// Radiance of n samples at `count` wavelengths of their own, or on `count` bands (lambda_nm, density null).
/// Rows at any address, in pieces of kLanes.
struct FilmSamples {
  const float* const* radiance = nullptr;   ///< [count]
  const float* const* lambda_nm = nullptr;  ///< [count]
  const float* const* density = nullptr;    ///< [count]
  const float* weight = nullptr;            ///< [n]; null for 1
  std::size_t count = 0;
  std::size_t n = 0;                  ///< a multiple of kLanes
  std::size_t piece_stride = kLanes;  ///< floats from a row's piece to its next one
  /// Of sample i in its row.
  std::size_t place(std::size_t i) const noexcept { return (i / kLanes) * piece_stride + i % kLanes; }
};

/// Colours of samples; undefined where the reason is not 0.
struct FilmQuads {
  float* quads = nullptr;  ///< [n][4]: w X, w Y, w Z, w
  std::int32_t* reasons = nullptr;
  bool luminance = false;  ///< Y before w is held to the range, too
};

/// Bands that wavelengths fall into: edges in ascending order, searched for as in KnotTable; from edge i on
/// lies band[i], -1 for none.
struct BucketTable {
  const float* edges = nullptr;  ///< [count + 2^halvings], infinities from count on
  const std::int32_t* band = nullptr;
  std::int32_t count = 0;
  const std::int32_t* start = nullptr;
  float buckets_per_nm = 0;
  std::int32_t buckets = 0;
  std::int32_t halvings = 0;
};

/// Hits of samples' wavelengths in bands, as they are made.
struct FilmHits {
  std::int32_t* band = nullptr;     ///< [count][n], -1 for none
  float* values = nullptr;          ///< [count][n][2]: value, weight
  std::int32_t* reasons = nullptr;  ///< [n], raised
};

/// The same, as they are added.
struct FilmHitRows {
  const std::int32_t* band = nullptr;
  const float* values = nullptr;
  std::size_t count = 0;
  std::size_t n = 0;
};

/// The pixels of a film's crop window; `origin` is that of its first tile.
struct FilmWindow {
  float x0, y0, x1, y1;
  std::int32_t origin_x, origin_y;
  std::int32_t tiles_x;
  bool negative_weights;
};

/// Positions of n samples, any n. Rows readable up to n rounded up to kLanes.
struct FilmPositions {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* weight = nullptr;          ///< null for 1
  const std::int32_t* reasons = nullptr;  ///< as weighing left them
  std::size_t n = 0;
};

/// Pixels of samples.
struct FilmPlaces {
  std::int32_t* address = nullptr;  ///< (tile << (2 * kFilmTileLog2)) | pixel; rows as in FilmPositions
  std::int32_t* tiles = nullptr;    ///< [2]: lowest and highest tile, widened
  std::uint64_t* counts = nullptr;  ///< [kFilmReasons], added to
};

/// Additions: entry i adds sample[i] (null: i), times factor[i] (null: 1), to the pixel of address[i]; none
/// where that is below 0.
struct FilmEntries {
  const std::uint32_t* sample = nullptr;
  const std::int32_t* address = nullptr;
  const float* factor = nullptr;
  std::size_t count = 0;
  std::int32_t tile = -1;  ///< the tile that all of them are in, or -1
};

/// One kind of sums: of a pixel from tiles[tile] + offset + pixel * limbs on; quads and moments 64-byte
/// aligned.
struct FilmSums {
  std::int64_t* const* tiles = nullptr;
  std::size_t offset = 0;
  std::size_t limbs = 0;  ///< a pixel
};

/// Magic numbers of the two limbs, for each component of a quad.
struct FilmGrid {
  double coarse[4];
  double rest[4];
};

/// The same for the limbs of the moments.
struct FilmMomentGrid {
  double luminance[kFilmSquareLimbs];
  double weight[kFilmWeightSquareLimbs];
};

struct FilmKernels {
  // Weighing. clamped(v): m = largest magnitude of all v; m > maximum ? (v / m) * maximum : v.
  /// ratio[k] = density[k] == 0 ? 0 : radiance[k] / density[k]
  /// part = lambda[k] less its row's wavelength; outside the curves: the row of zeros
  /// X = (sum(k) value * ratio[k] + sum(k) difference * (part * ratio[k])) * factor, likewise Y, Z
  /// quad = clamped(X, Y, Z) * w, w
  /// reason: NaN, infinite, negative density, where the density is not 0; then beyond the ranges; else 0
  void (*film_weigh_wavelengths)(const FilmQuads& out, const FilmSamples& samples, const FilmCurves& curves,
                                 const FilmLimits& limits, float factor) noexcept;
  /// the same for X, Y, Z = sum(bands) weights[band] * radiance[band]; weights [bands][4]
  void (*film_weigh_bands)(const FilmQuads& out, const FilmSamples& samples, const float* weights,
                           const FilmLimits& limits) noexcept;
  /// quads[i * stride + b] = clamped(radiance[b]) * w for b < bands; 0 up to a multiple of 4
  /// reasons[i]: beyond the range where it was 0
  void (*film_band_quads)(float* quads, std::size_t stride, std::int32_t* reasons, const FilmSamples& samples,
                          const FilmLimits& limits) noexcept;
  /// band[k]: of lambda[k]; density 0: -1
  /// u = w * (reference / density[k]), value = clamped(radiance[k], of those with a density) * u
  /// reason: beyond the range where it was 0 and a hit in a band is
  void (*film_hits)(const FilmHits& out, const FilmSamples& samples, const BucketTable& table,
                    const FilmLimits& limits, float reference) noexcept;

  // Placing.
  /// address[i]: of the pixel that holds (x, y), or -reason; counts[reason] += 1 for i < n
  /// reason: the lower of reasons[i] and NaN, infinite, weight < 0 (unless allowed), outside the window
  /// addresses from n on: undefined
  void (*film_place)(const FilmPlaces& out, const FilmWindow& window, const FilmPositions& samples) noexcept;

  // Adding.
  /// pixel[8 q + c], pixel[8 q + 4 + c] += quads[sample][q][c] * factor, for q < count
  void (*film_add)(const FilmSums& to, const FilmGrid& grid, const FilmEntries& entries, const float* quads,
                   std::size_t count) noexcept;
  /// pixel[4 band + c], pixel[4 band + 2 + c] += hits[k][sample][c] * factor, with the grid's components 0, 1
  void (*film_add_hits)(const FilmSums& to, const FilmGrid& grid, const FilmEntries& entries,
                        const FilmHitRows& hits) noexcept;
  /// w = quads[sample][3] * factor, y = quads[sample][1] * factor; limbs: kFilmMomentLimbs
  /// sum(w y^2) += w == 0 ? 0 : y * (y / w), sum(w^2) += w * w, in double; count += 1
  void (*film_add_moments)(const FilmSums& to, const FilmMomentGrid& grid, const FilmEntries& entries,
                           const float* quads) noexcept;
  /// pixel += 1; limbs: 1
  void (*film_count)(const FilmSums& to, const FilmEntries& entries) noexcept;
};

}  // namespace spectile::kernels
