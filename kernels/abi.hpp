// KernelTable: every hot operation as a noexcept function over raw pointers, each with its formula.
//
// Rules common to all:
//  - Float arrays are 64-byte aligned. A count `n` of floats is a multiple of kLanes. A batch of spectra is
//    [blocks][bands][kLanes].
//  - `dst` may be the same array as a source, never a shifted overlap of it.
//  - Formulas are evaluated as written: one rounding per operation, no contraction. Sums over bands are taken
//    in ascending order within runs of kSumRun bands, and the runs' sums are added in ascending order, each
//    sum starting from 0. Therefore every table gives the same bits.
//  - NaN goes through arithmetic as IEEE 754 says (its payload is not specified).
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectile::kernels {

/// Lanes of a block, the unit in which every kernel works.
inline constexpr std::size_t kLanes = 64;

/// Bands in a run of a sum: the error then grows with kSumRun + bands / kSumRun, not with the bands.
inline constexpr std::size_t kSumRun = 8;

/// Floats of one band's row in a Smits table: white, cyan, magenta, yellow, red, green, blue, 0.
inline constexpr std::size_t kSmitsRow = 8;

/// Numbers that a limit's chains come in: a multiple of 24 vectors, whatever their width.
inline constexpr std::size_t kPeakChains = 384;

/// Largest finite half; rows of halves are limited to it, so that a finite sample stays finite.
inline constexpr float kHalfMax = 65504.0F;

/// Counts over a row of RGB, as filled in by scan_rgb; counts are of pixels.
struct RgbScan {
  std::uint64_t nonfinite = 0;  ///< any component NaN or infinite
  std::uint64_t negative = 0;   ///< any component below 0
  std::uint64_t over_one = 0;   ///< any component above 1
  float maximum = 0;            ///< largest component above 0; NaN passed over
};

/// Floats of a sigmoid's row: for each of red, green, blue four times its weight times lambda^2, lambda, 1;
/// then lambda itself, the white's sample and a 0.
inline constexpr std::size_t kSigmoidRow = 12;
inline constexpr std::size_t kSigmoidLambda = 9;
inline constexpr std::size_t kSigmoidWhite = 10;

/// Floats of a node of the start table: three coefficients; for each, its first derivatives along the three
/// axes, its pure second ones (halved) and its mixed ones (01, 02, 12); two zeros.
inline constexpr std::size_t kSigmoidNode = 32;

/// A coefficient at which the sigmoid is exactly 1, and its negative 0.
inline constexpr float kSigmoidFar = 0x1p40F;

/// Coefficients of colours outside the cube may sum to this, over the root of the largest component of the
/// colour that the search starts from: beyond it a spectrum is a step between two bands, and no colour of a
/// reflectance is much further out.
inline constexpr float kSigmoidSteep = 256.0F;
/// What solving for sigmoid coefficients needs. Lambda is (wavelength - 550 nm) / 150 nm.
struct SigmoidTable {
  std::size_t bands = 0;
  const float* rows = nullptr;     ///< [bands][kSigmoidRow]
  const float* weights = nullptr;  ///< [bands][4]: RGB weight, 0
  const float* nodes = nullptr;    ///< [3][steps][steps][steps][kSigmoidNode]
  std::int32_t steps = 0;
};

/// A function tabulated at even wavelengths: pairs of a value and the difference to the next one.
struct EvenTable {
  const float* pairs = nullptr;  ///< [intervals][2]
  float first_nm = 0;
  float per_nm = 1;            ///< intervals a nanometre
  std::int32_t intervals = 0;  ///< at least 1
};

/// A function linear between irregular knots. The knot that is last at or below a wavelength is searched for
/// from the one that `start` names for the wavelength's bucket, in steps halved from 2^(halvings - 1) to 1.
struct KnotTable {
  const float* knots = nullptr;  ///< [count + 2^halvings], ascending; infinities from count on
  const float* pairs = nullptr;  ///< [count][2]: the value at a knot, the slope after it (0 after the last)
  std::int32_t count = 0;
  const std::int32_t* start = nullptr;  ///< [buckets]
  float buckets_per_nm = 0;
  std::int32_t buckets = 0;
  std::int32_t halvings = 0;
  bool held = false;  ///< beyond the ends: their values rather than 0
};

/// Planck's law with wavelengths in units of 1024 nm: factor * l^-5 / (2^(exponent / l) - 1).
struct PlanckTable {
  float factor = 0;
  float exponent = 0;  ///< rounded, and what that left
  float exponent_rest = 0;
};

/// One lobe of a sum of Gaussians: its amplitude, its mean, and 1 / sigma on both sides. Units: nm.
struct GaussianLobe {
  double amplitude, mean_nm, per_sigma_left, per_sigma_right;
};

/// A distribution of wavelengths over [first, first + range): even, or as the inverse of the eye's
/// sensitivity tanh(steepness * (lambda - centre)).
struct WavelengthDensity {
  float first_nm, range_nm;
  double centre_nm, per_steepness_nm;  ///< visible: 1 / steepness
  double from, by;                     ///< visible: tanh at u = 0, and what u = 1 takes from it
  double peak;                         ///< visible: density at the centre
};

// Film. A pixel's sum is a whole number of steps of a grid, in two or four limbs of 64 bits that each hold up
// to 2^43 steps of the next one a contribution: rounding to a multiple of a limb's step is adding and
// subtracting 1.5 * 2^52 steps, and the sum's bits less that number's are the count of steps.

/// log2 of pixels along a tile's side; a tile is square.
inline constexpr int kFilmTileLog2 = 4;
inline constexpr std::size_t kFilmTilePixels = std::size_t{1} << (2 * kFilmTileLog2);

/// Why a sample does not reach a pixel; of several the least counts.
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

/// What a contribution is held to.
struct FilmLimits {
  float maximum;       ///< a colour's largest component; infinite for no limit
  float range;         ///< of weight * colour
  float weight_range;  ///< of weights
};

/// 1.5 * 2^52 steps of the two limbs, for each component of a quad.
struct FilmGrid {
  double coarse[4];
  double rest[4];
};

/// The same for the four limbs of the sum of w y^2, and the three of that of w^2.
struct FilmMomentGrid {
  double luminance[4];
  double weight[3];
};

/// Where samples go: entry i adds sample[i] (i where that is null), times factor[i] (where there are any), to
/// the pixel address[i] = (tile << (2 * kFilmTileLog2)) | pixel; none where that is below 0.
struct FilmEntries {
  const std::uint32_t* sample = nullptr;
  const std::int32_t* address = nullptr;
  const float* factor = nullptr;
  std::size_t count = 0;
  std::int32_t tile = -1;  ///< the tile that all of them are in, or -1
};

/// The pixels of a film's crop window; `origin` is that of its first tile.
struct FilmWindow {
  float x0, y0, x1, y1;
  std::int32_t origin_x, origin_y;
  std::int32_t tiles_x;
  bool negative_weights;
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

/// One instruction set's kernels.
struct KernelTable {
  const char* name;
  int lanes;  ///< float lanes of a vector register; 1 for the reference

  // Element-wise arithmetic on n floats.
  void (*add)(float* dst, const float* a, const float* b, std::size_t n) noexcept;       ///< a + b
  void (*subtract)(float* dst, const float* a, const float* b, std::size_t n) noexcept;  ///< a - b
  void (*multiply)(float* dst, const float* a, const float* b, std::size_t n) noexcept;  ///< a * b
  void (*divide)(float* dst, const float* a, const float* b, std::size_t n) noexcept;    ///< a / b
  /// b == 0 ? 0 : a / b (a NaN divisor gives NaN)
  void (*divide_or_zero)(float* dst, const float* a, const float* b, std::size_t n) noexcept;
  void (*negate)(float* dst, const float* a, std::size_t n) noexcept;  ///< a with its sign bit flipped
  void (*scale)(float* dst, const float* a, float s, std::size_t n) noexcept;  ///< a * s
  /// (a * b) + c, two roundings
  void (*multiply_add)(float* dst, const float* a, const float* b, const float* c, std::size_t n) noexcept;
  /// ((1 - t) * a) + (t * b), with 1 - t rounded once
  void (*lerp)(float* dst, const float* a, const float* b, float t, std::size_t n) noexcept;
  void (*sqrt)(float* dst, const float* a, std::size_t n) noexcept;  ///< correctly rounded; below 0 gives NaN
  /// e to the a, computed in double and rounded once: error below 0.501 ULP on the whole range, denormals
  /// included
  void (*exp)(float* dst, const float* a, std::size_t n) noexcept;
  /// a to the power y as C's pow defines it, special values included: error below 0.501 ULP
  void (*pow)(float* dst, const float* a, float y, std::size_t n) noexcept;
  /// a < lo ? lo : (hi < a ? hi : a); NaN stays
  void (*clamp)(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept;

  // Per lane over the bands of a batch; dst [blocks][kLanes].
  /// least sample; NaN passed over, a lane of nothing but NaN gives +infinity
  void (*minimum)(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// greatest sample; NaN passed over, a lane of nothing but NaN gives -infinity
  void (*maximum)(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// bit i of mask[block]: every sample of lane i is +0 or -0
  void (*black_mask)(std::uint64_t* mask, const float* spectra, std::size_t bands,
                     std::size_t blocks) noexcept;
  /// bit i of mask[block]: some sample of lane i is NaN
  void (*nan_mask)(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// bit i of mask[block]: a == b in every band of lane i (NaN equals nothing, +0 equals -0)
  void (*equal_mask)(std::uint64_t* mask, const float* a, const float* b, std::size_t bands,
                     std::size_t blocks) noexcept;

  // Colorimetry.
  /// y = sum over bands of weights[band] * sample; weights [bands]; y [blocks][kLanes]
  void (*weighted_sum)(float* y, const float* spectra, const float* weights, std::size_t bands,
                       std::size_t blocks) noexcept;
  /// three such sums; weights [bands][4] (x, y, z, unused); x, y, z [blocks][kLanes]
  void (*project)(float* x, float* y, float* z, const float* spectra, const float* weights, std::size_t bands,
                  std::size_t blocks) noexcept;
  /// dst_i = ((m[3i] * a0) + (m[3i+1] * a1)) + (m[3i+2] * a2)
  void (*transform3)(float* const dst[3], const float* const src[3], const float m[9],
                     std::size_t n) noexcept;

  // Smits upsampling. With w0 = least of r, g, b, w1 = middle - least, w2 = greatest - middle, and the
  // secondary s (cyan where r is least, else magenta where g is, else yellow) and the primary p (red where r
  // is greatest, else green where g is, else blue): sample = ((w0 * white) + (w1 * basis_s)) + (w2 *
  // basis_p), then limited from below: sample < lowest ? lowest : sample. table [bands][kSmitsRow], 32-byte
  // aligned.
  /// dst [blocks][bands][kLanes]; with `stream`, stores that go round the caches
  void (*smits_blocks)(float* dst, const float* const rgb[3], const float* table, float lowest,
                       std::size_t bands, std::size_t blocks, bool stream) noexcept;
  /// rows[band] takes n floats, at any address, for any n; rgb readable up to n rounded up to kLanes
  void (*smits_rows_float)(void* const* rows, const float* const rgb[3], const float* table, float lowest,
                           std::size_t bands, std::size_t n) noexcept;
  /// the same in halves: limited to kHalfMax from above and rounded to nearest even
  void (*smits_rows_half)(void* const* rows, const float* const rgb[3], const float* table, float lowest,
                          std::size_t bands, std::size_t n) noexcept;

  /// A mixture of the table's three rows: dst_k = ((w0 * white_k) + (w1 * secondary_k)) + (w2 * primary_k);
  /// table [3][kSmitsRow], 32-byte aligned; dst may be rgb
  void (*smits_fold)(float* const dst[3], const float* const rgb[3], const float* table,
                     std::size_t n) noexcept;

  // Sigmoid spectra. These, and planck, alone use fused multiply-adds, written below as fma: one rounding,
  // the same bits everywhere. With x = fma(fma(c0, lambda, c1), lambda, c2) and r half the inverse square
  // root of fma(x, x, 1) (a guess from its bits and two steps, of third and second order, within 2.5 * 2^-24
  // up to x = 2^62, 3.1 * 2^-24 beyond): sample = fma(x, r, 0.5) limited to [0, 1], then times the band's
  // white, then times the lane's scale, each where there is one. Source: Jakob, Hanika, A Low-Dimensional
  // Function Space for Efficient Spectral Upsampling, Computer Graphics Forum 38(2), 2019.
  /// coefficients for which the weights' sums over the samples are rgb. Bit i of unsolved[i / kLanes]: none
  /// come within 1e-5 of it (1 % of the largest component, or 2^-22, for dark ones), or none were found.
  /// Greys give c0 = c1 = 0; 0, 0, 0 and 1, 1, 1 give exactly 0 and 1; a component that is not finite gives
  /// NaN. n a multiple of kLanes.
  void (*sigmoid_solve)(float* const c[3], const float* const rgb[3], const SigmoidTable& table,
                        std::uint64_t* unsolved, std::size_t n) noexcept;
  /// the same for what sigmoid_solve did not find, step by step along the line from the grey of luminance
  /// y = ((w0 * r) + (w1 * g)) + (w2 * b): reached = 1 with coefficients for rgb, or the part of the line
  /// that a sigmoid has, with the coefficients there; 0 with those of black or white where y is not inside
  /// (0, 1). A component that is not finite gives NaN and 1. n a multiple of kLanes.
  void (*sigmoid_continuation)(float* const c[3], float* reached, const float* const rgb[3],
                               const SigmoidTable& table, const float luminance[3], std::size_t n) noexcept;
  /// dst [blocks][bands][kLanes]; scale [n] or null for 1; rows [bands][kSigmoidRow]; `white`: times its
  /// white
  void (*sigmoid_blocks)(float* dst, const float* const c[3], const float* scale, const float* rows,
                         bool white, std::size_t bands, std::size_t blocks, bool stream) noexcept;
  /// out[band] takes n floats, at any address, for any n; c, scale readable up to n rounded up to kLanes
  void (*sigmoid_rows_float)(void* const* out, const float* const c[3], const float* scale, const float* rows,
                             bool white, std::size_t bands, std::size_t n) noexcept;
  /// the same in halves: limited to kHalfMax from above and rounded to nearest even
  void (*sigmoid_rows_half)(void* const* out, const float* const c[3], const float* scale, const float* rows,
                            bool white, std::size_t bands, std::size_t n) noexcept;
  /// dst_k = sum over bands of weights[band][k] * sample; weights [bands][4]
  void (*sigmoid_project)(float* const dst[3], const float* const c[3], const float* scale, const float* rows,
                          bool white, const float* weights, std::size_t bands, std::size_t n) noexcept;

  // Spectra at single wavelengths. A wavelength that is NaN gives NaN; n a multiple of kLanes.
  /// t = (lambda - first) * per_nm, i = min(int(t), intervals - 1): value[i] + ((t - i) * difference[i]); 0
  /// where t is outside [0, intervals]
  void (*look_up_even)(float* dst, const float* lambda_nm, const EvenTable& table, std::size_t n) noexcept;
  /// value[i] + ((lambda - knot[i]) * slope[i]) for the last knot i at or below lambda; outside the knots 0,
  /// or where the table is held, the value at the nearer end
  void (*look_up_knots)(float* dst, const float* lambda_nm, const KnotTable& table, std::size_t n) noexcept;
  /// l = lambda / 1024, 2^90 at most, i = 1 / l, x = exponent * i with its rounding error and the rest kept,
  /// n the integer nearest to x, q = 2^(x - n) - 1 by its series: ((factor * 2^-(n / 2)) / (l^5 * (q + (1 -
  /// 2^-n)))) * 2^-(n - n / 2), with fused multiply-adds for x and the series; within 6 u from 0.1 to 10^7
  /// nm. 0 where lambda is not above 0 and where x is 252 or more.
  void (*planck)(float* dst, const float* lambda_nm, const PlanckTable& table, std::size_t n) noexcept;
  /// sum of amplitude * exp(-z^2 / 2), z = (lambda - mean) / sigma, lobe by lobe, in double, rounded once
  void (*gaussians)(float* dst, const float* lambda_nm, const GaussianLobe* lobes, std::size_t count,
                    std::size_t n) noexcept;
  /// the sigmoid of one set of coefficients at lambda held in [lowest, highest] (see above), times scale
  void (*sigmoid_at)(float* dst, const float* lambda_nm, const float c[3], float lowest_nm, float highest_nm,
                     float scale, std::size_t n) noexcept;
  /// u_k = u + k / count, less 1 where it reaches 1; wavelength first + (u_k * range), density 1 / range. u
  /// limited to [0, 1 - 2^-24].
  void (*even_wavelengths)(float* const* lambda_nm, float* const* density, const float* u,
                           const WavelengthDensity& d, std::size_t count, std::size_t n) noexcept;
  /// the same u_k; y = from - (u_k * by), wavelength centre - atanh(y) * per_steepness, density peak * (1 - y
  /// * y), in double, rounded once. Source: Radziszewski, Boryczko, Alda, An Improved Technique for Full
  /// Spectral Rendering, Journal of WSCG 17, 2009.
  void (*visible_wavelengths)(float* const* lambda_nm, float* const* density, const float* u,
                              const WavelengthDensity& d, std::size_t count, std::size_t n) noexcept;
  /// dst_c = factor * sum over k of curve_c(lambda_k) * (values_k / density_k), curves looked up as in
  /// look_up_even; a density of 0 adds nothing, whatever the value. curves: three tables of the same
  /// wavelengths, [intervals][2] each.
  void (*project_wavelengths)(float* const dst[3], const float* const* values, const float* const* lambda_nm,
                              const float* const* density, const EvenTable curves[3], float factor,
                              std::size_t count, std::size_t n) noexcept;

  // Film. Samples n a multiple of kLanes, at any address; a quad is four floats of one sample, side by side.
  // What a sample's quads are is not specified where its reason is not 0.
  /// quads[4 i ..]: (w X, w Y, w Z, w) of sample i, with X, Y, Z = ((sum over k of value * ratio_k) + (sum
  /// over k of difference * (part * ratio_k))) * factor, of the row that holds the wavelength and its part of
  /// the way to the next one, or the row of zeros; ratio_k = radiance_k / density_k, 0 where the density is
  /// 0; where the largest magnitude m of the three is above limits.maximum, (X / m) * maximum and so on; then
  /// times w = weight (1 where that is null). reasons[i]: of the densities that are not 0 and what goes with
  /// them NaN, infinite or negative, else kFilmBeyondRange for a component, or with `luminance` Y before w,
  /// beyond limits.range, or w beyond limits.weight_range, else 0.
  void (*film_weigh_wavelengths)(float* quads, bool luminance, std::int32_t* reasons,
                                 const FilmCurves& curves, const FilmLimits& limits,
                                 const float* const* radiance, const float* const* lambda_nm,
                                 const float* const* density, const float* weight, float factor,
                                 std::size_t count, std::size_t n) noexcept;
  /// the same for X, Y, Z = sums over bands of weights[band] * radiance_band; weights [bands][4]
  void (*film_weigh_bands)(float* quads, bool luminance, std::int32_t* reasons, const float* weights,
                           const FilmLimits& limits, const float* const* radiance, const float* weight,
                           std::size_t bands, std::size_t n) noexcept;
  /// quads[i * stride + b] = radiance_b * w for b < bands, 0 up to a multiple of 4, with (radiance_b / m) *
  /// maximum in its place where the largest magnitude m of the radiances is above limits.maximum. reasons[i]
  /// becomes kFilmBeyondRange where it was 0 and a product is beyond limits.range.
  void (*film_band_quads)(float* quads, std::size_t stride, std::int32_t* reasons, const FilmLimits& limits,
                          const float* const* radiance, const float* weight, std::size_t bands,
                          std::size_t n) noexcept;
  /// band[k][i]: that which wavelength k falls into, or -1, also where its density is 0; hits[2 * (k * n +
  /// i)]: radiance_k * u and u = (w * (reference / density_k)), with (radiance_k / m) * maximum in its place
  /// where the largest magnitude m of those with a density is above limits.maximum. reasons[i] becomes
  /// kFilmBeyondRange where it was 0 and one of them that falls into a band is beyond its range.
  void (*film_hits)(std::int32_t* band, float* hits, std::int32_t* reasons, const BucketTable& table,
                    const FilmLimits& limits, const float* const* radiance, const float* const* lambda_nm,
                    const float* const* density, const float* weight, float reference, std::size_t count,
                    std::size_t n) noexcept;
  /// address[i] of the pixel that (x, y) lies in, or minus the reason: reasons[i], or for position and weight
  /// NaN, infinite, weight below 0 (unless allowed), outside the window; adds to counts[reason] for i < n
  /// alone, whatever n. tiles: the lowest and the highest tile reached, as far as they are beyond what is
  /// there. Arrays readable and writable up to n rounded up to kLanes; addresses there are not
  /// specified.
  void (*film_place)(std::int32_t* address, std::int32_t tiles[2], std::uint64_t counts[kFilmReasons],
                     const FilmWindow& window, const float* x, const float* y, const float* weight,
                     const std::int32_t* reasons, std::size_t n) noexcept;
  /// adds `count` quads from quads[4 * count * sample] on to the pixel's limbs, for each quad 4 coarse ones
  /// and 4 rests, at tiles[tile] + offset + pixel * limbs, 64-byte aligned
  void (*film_add)(std::int64_t* const* tiles, std::size_t offset, const FilmGrid& grid,
                   const FilmEntries& entries, const float* quads, std::size_t count,
                   std::size_t limbs) noexcept;
  /// adds the hits of each sample (see film_hits, n samples) to its pixel's bands: coarse value, coarse
  /// weight, rest, rest, at tiles[tile] + offset + (pixel * bands + band) * 4. The grid's first two
  /// components are those of values and weights.
  void (*film_add_hits)(std::int64_t* const* tiles, std::size_t offset, const FilmGrid& grid,
                        const FilmEntries& entries, const std::int32_t* band, const float* hits,
                        std::size_t count, std::size_t n, std::size_t bands) noexcept;
  /// at tiles[tile] + offset + pixel * 8 adds, in double, with w = quads[4 * sample + 3] * factor and y =
  /// quads[4 * sample + 1] * factor: four limbs of y * (y / w), 0 where w is 0; two of w * w; 1; the third of
  /// w * w
  void (*film_add_moments)(std::int64_t* const* tiles, std::size_t offset, const FilmMomentGrid& grid,
                           const FilmEntries& entries, const float* quads) noexcept;
  /// adds 1 at tiles[tile] + offset + pixel
  void (*film_count)(std::int64_t* const* tiles, std::size_t offset, const FilmEntries& entries) noexcept;

  // Gamut.
  /// moves colours with a component outside [lowest, highest] along the line to the grey of their luminance
  /// y = ((w0 * r) + (w1 * g)) + (w2 * b), y limited to [lowest, highest], to where all are inside; others
  /// and those with a component that is not finite stay as they are. Bit i of moved[i / kLanes]: it was
  /// outside.
  void (*gamut_clip)(float* const rgb[3], const float weights[3], float lowest, float highest,
                     std::uint64_t* moved, std::size_t n) noexcept;

  // Conversion. Sources and targets of any alignment, n a multiple of kLanes.
  void (*half_to_float)(float* dst, const std::uint16_t* src,
                        std::size_t n) noexcept;  ///< exact; NaN made quiet
  void (*float_to_half)(std::uint16_t* dst, const float* src,
                        std::size_t n) noexcept;  ///< nearest even; NaN quiet
  /// adds a row's counts to *scan
  void (*scan_rgb)(RgbScan* scan, const float* const rgb[3], std::size_t n) noexcept;

  // The machine's own limits. n a multiple of kLanes, for those with steps of kPeakChains.
  /// dst[i] = exclusive or of the bits of src[i], src[i + kLanes], ...; dst [kLanes]
  void (*peak_load)(std::uint32_t* dst, const float* src, std::size_t n) noexcept;
  /// dst[i] = value; `around`: with stores that go round the caches
  void (*peak_store)(float* dst, float value, std::size_t n, bool non_temporal) noexcept;
  void (*peak_copy)(float* dst, const float* src, std::size_t n) noexcept;  ///< dst[i] = src[i]
  /// dst[i] = x after `steps` times x = (x * m) + a, two roundings, from src[i] on
  void (*peak_multiply_add)(float* dst, const float* src, float m, float a, std::size_t steps,
                            std::size_t n) noexcept;
  /// the same with one rounding
  void (*peak_fused)(float* dst, const float* src, float m, float a, std::size_t steps,
                     std::size_t n) noexcept;
  /// dst[i] = x after `steps` times x = m / x
  void (*peak_divide)(float* dst, const float* src, float m, std::size_t steps, std::size_t n) noexcept;
};

}  // namespace spectile::kernels
