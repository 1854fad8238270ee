// Spectra from colours: Smits mixtures and sigmoids of quadratics.
#pragma once

#include <cstdint>

#include "kernels/abi/lanes.hpp"

namespace spectile::kernels {

/// Floats of a band's row in a Smits table: white, cyan, magenta, yellow, red, green, blue, 0.
inline constexpr std::size_t kSmitsRow = 8;

/// Smits basis spectra over bands.
struct SmitsTable {
  const float* rows = nullptr;  ///< [bands][kSmitsRow], 32-byte aligned
  std::size_t bands = 0;
  float lowest = 0;  ///< samples below become it; -infinity for none
};

/// Argument x of a sigmoid: of two functions p and q of the wavelength, and a constant.
enum class SigmoidForm : std::uint8_t {
  kQuadratic,  ///< (c0 q + c1) q + c2; q = (wavelength - 550 nm) / 150 nm
  kFunctions,  ///< c0 p + (c1 q + c2); p and q of an observer
};

/// Floats of a sigmoid's row: for each of red, green, blue four times its weight times p, q, 1; then q, the
/// white's sample and p.
inline constexpr std::size_t kSigmoidRow = 12;
inline constexpr std::size_t kSigmoidQ = 9;
inline constexpr std::size_t kSigmoidWhite = 10;
inline constexpr std::size_t kSigmoidP = 11;

/// Floats of a node of the start table: three coefficients; for each, its first derivatives along the three
/// axes, its pure second ones (halved) and its mixed ones (01, 02, 12); two zeros.
inline constexpr std::size_t kSigmoidNode = 32;

/// A coefficient at which the sigmoid is exactly 1, and its negative 0.
inline constexpr float kSigmoidFar = 0x1p40F;

/// Coefficients of colours outside the cube may sum to this, over the root of the largest component of the
/// colour that the search starts from: beyond it a spectrum is a step between two bands, and no colour of a
/// reflectance is much further out.
inline constexpr float kSigmoidSteep = 256.0F;

/// Tables for solving for sigmoid coefficients.
struct SigmoidTable {
  std::size_t bands = 0;
  const float* rows = nullptr;     ///< [bands][kSigmoidRow]
  const float* weights = nullptr;  ///< [bands][4]: RGB weight, 0
  const float* nodes = nullptr;    ///< [3][steps][steps][steps][kSigmoidNode]
  std::int32_t steps = 0;
  SigmoidForm form = SigmoidForm::kQuadratic;
};

/// The sigmoid spectra of lanes over bands.
struct SigmoidSpectra {
  const float* const* c = nullptr;  ///< three planes of coefficients
  const float* scale = nullptr;     ///< a factor a lane; null for 1
  const float* rows = nullptr;      ///< [bands][kSigmoidRow]
  std::size_t bands = 0;
  bool white = false;  ///< times the bands' white
  SigmoidForm form = SigmoidForm::kQuadratic;
};

/// Spectra at the nodes of a grid over the cube of RGB. A node's row: its samples, then zeros.
struct GridTable {
  const float* nodes = nullptr;  ///< [count][count][count][stride] of red, green, blue; 64-byte aligned
  std::size_t stride = 0;        ///< a multiple of 16; of colours kGridColor
  std::size_t bands = 0;
  const float* levels = nullptr;     ///< [count] components of the nodes, ascending from 0 to 1
  const float* per_width = nullptr;  ///< [count - 1]: 1 over the difference of two levels
  std::int32_t count = 0;            ///< at least 2
  float lowest = 0;                  ///< samples below become it; -infinity for none
  bool homogeneous = false;          ///< colours are looked up by their ratios alone
};

/// The spectra of lanes in a grid.
struct GridSpectra {
  const float* const* rgb = nullptr;  ///< three planes
  const float* scale = nullptr;       ///< a factor a lane; null for 1
  GridTable table;
};

/// Floats of a node that is a colour: three components and a 0.
inline constexpr std::size_t kGridColor = 4;

struct UpsamplingKernels {
  // Smits mixtures. low, middle, high: r, g, b in order; s: cyan, magenta, yellow of the component that is
  // lowest (red before green before blue); p: red, green, blue of the one that is highest (likewise).
  //   w0 = low, w1 = middle - low, w2 = high - middle
  //   sample = ((w0 * white) + (w1 * basis[s])) + (w2 * basis[p]); sample < lowest ? lowest : sample
  /// dst [blocks][bands][kLanes]
  void (*smits_blocks)(float* dst, const float* const rgb[3], const SmitsTable& table, std::size_t blocks,
                       bool non_temporal) noexcept;
  /// rows[band]: n floats, any address, any n; rgb readable up to n rounded up to kLanes
  void (*smits_rows_float)(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                           std::size_t n) noexcept;
  /// the same in halves: kHalfMax < sample ? kHalfMax : sample, nearest, ties to even
  void (*smits_rows_half)(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                          std::size_t n) noexcept;
  /// dst[k] = the sample of row k, not clamped; table [3][kSmitsRow], 32-byte aligned; dst may be rgb
  void (*smits_fold)(float* const dst[3], const float* const rgb[3], const float* table,
                     std::size_t n) noexcept;

  // Tetrahedral interpolation in a grid of spectra. Source: the partition of a cell into six tetrahedra is
  // that of Kuhn, Some Combinatorial Lemmas in Topology, IBM J. Research and Development 4(5), 1960.
  //   most = largest component, size = limit < most ? most : 1, limit = 1, homogeneous: 0; u = component /
  //   size cell: the last level but one at or below u, else the first; part = (u - level) * per_width N0 the
  //   cell's first node, N3 its last, N1 one step from N0 along the component of the greatest part (blue if
  //   above both; red if above green), N2 one step back from N3 along that of the least part (likewise) w0 =
  //   1 - greatest, w1 = greatest - middle, w2 = middle - least, w3 = least, each times size, then scale
  //   where there is one sample = ((w0 * N0 + w1 * N1) + w2 * N2) + w3 * N3; sample < lowest ? lowest :
  //   sample
  /// dst [blocks][bands][kLanes]
  void (*grid_blocks)(float* dst, const GridSpectra& spectra, std::size_t blocks, bool non_temporal) noexcept;
  /// rows[band]: n floats, any address, any n; rgb, scale readable up to n rounded up to kLanes
  void (*grid_rows_float)(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept;
  /// the same in halves: kHalfMax < sample ? kHalfMax : sample, nearest, ties to even
  void (*grid_rows_half)(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept;
  /// dst[k] = sample k of a grid of colours, not clamped; dst may be rgb
  void (*grid_fold)(float* const dst[3], const GridSpectra& spectra, std::size_t n) noexcept;

  // Sigmoids. fma rounds once, here, in planck and in peak_fused alone.
  //   x = fma(fma(c0, q, c1), q, c2) or fma(c0, p, fma(c1, q, c2)), by the form; t = fma(x, x, 1)
  //   r = 0.5 / sqrt(t) from bits and two steps: within 2.5 * 2^-24 up to x = 2^62, 3.1 * 2^-24 beyond
  //   sample = clamp(fma(x, r, 0.5), 0, 1) * white * scale, from left to right, each where there is one
  // Source: Jakob, Hanika, A Low-Dimensional Function Space for Efficient Spectral Upsampling, Computer
  // Graphics Forum 38(2), 2019.
  /// c: sum(bands) weights * sample = rgb
  /// unsolved[i / kLanes], bit i: none found within 1e-5 (dark colours: 1 % of the largest component or
  /// 2^-22) grey: c0 = c1 = 0; black, white: samples exactly 0, 1; a component NaN or infinite: c NaN
  void (*sigmoid_solve)(float* const c[3], const float* const rgb[3], const SigmoidTable& table,
                        std::uint64_t* unsolved, std::size_t n) noexcept;
  /// continuation toward the grey axis, for what sigmoid_solve leaves
  /// y = ((w0 * r) + (w1 * g)) + (w2 * b); step by step along the line from y, y, y to rgb
  /// part = 1: c of rgb; part < 1: c at that part of the line; y not inside (0, 1): 0, c of black or white
  /// a component NaN or infinite: c NaN, part 1
  void (*sigmoid_continuation)(float* const c[3], float* part, const float* const rgb[3],
                               const SigmoidTable& table, const float luminance[3], std::size_t n) noexcept;
  /// dst [blocks][bands][kLanes]
  void (*sigmoid_blocks)(float* dst, const SigmoidSpectra& spectra, std::size_t blocks,
                         bool non_temporal) noexcept;
  /// rows[band]: n floats, any address, any n; c, scale readable up to n rounded up to kLanes
  void (*sigmoid_rows_float)(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept;
  /// the same in halves: kHalfMax < sample ? kHalfMax : sample, nearest, ties to even
  void (*sigmoid_rows_half)(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept;
  /// dst[k] = sum(bands) weights[band][k] * sample; weights [bands][4]; dst may be c
  void (*sigmoid_project)(float* const dst[3], const SigmoidSpectra& spectra, const float* weights,
                          std::size_t n) noexcept;
};

}  // namespace spectile::kernels
