// Spectra at single wavelengths, sampled wavelengths, and their projection.
#pragma once

#include "kernels/abi/upsampling.hpp"

namespace spectile::kernels {

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

/// The sigmoid of one set of coefficients; wavelengths are clamped to its range.
struct SigmoidSpectrum {
  float c[3];
  float lowest_nm, highest_nm;
  float scale;
  SigmoidForm form = SigmoidForm::kQuadratic;
  EvenTable p = {};  ///< of kFunctions; these cover the range
  EvenTable q = {};
};

/// The centres of bands, between which spectra are linear; beyond the outer ones they keep the value there.
struct CentreTable {
  float first_nm = 0;
  float last_nm = 0;
  std::int32_t intervals = 1;  ///< at least 1, also of a single band
  float per_nm = 0;            ///< intervals a nanometre, where the centres are even
  // Where they are not: searched for as in KnotTable.
  const float* knots = nullptr;      ///< [intervals + 1 + 2^halvings]; null for even centres
  const float* per_width = nullptr;  ///< [intervals]: 1 over the interval, 0 where that is 0
  const std::int32_t* start = nullptr;
  float buckets_per_nm = 0;
  std::int32_t buckets = 0;
  std::int32_t halvings = 0;
};

/// Smits basis spectra at both ends of each interval.
struct MixtureTable {
  const float* ends = nullptr;  ///< [intervals][kSmitsRow][2]
  float lowest = 0;             ///< samples below become it; -infinity for none
};

/// Sigmoids of lanes at any wavelength, which is clamped to their range.
struct SigmoidLanes {
  const float* const* c = nullptr;  ///< three planes of coefficients
  const float* scale = nullptr;     ///< a factor a lane; null for 1
  float lowest_nm = 0;
  float highest_nm = 0;
  SigmoidForm form = SigmoidForm::kQuadratic;
  EvenTable p = {};  ///< of kFunctions; these cover the range
  EvenTable q = {};
};

/// A distribution of wavelengths over [first, first + range): even, or as the inverse of the eye's
/// sensitivity tanh(steepness * (lambda - centre)).
struct WavelengthDensity {
  float first_nm, range_nm;
  double centre_nm, per_steepness_nm;  ///< visible: 1 / steepness
  double from, by;                     ///< visible: tanh at u = 0, and what u = 1 takes from it
  double peak;                         ///< visible: density at the centre
};

/// A distribution of wavelengths by nanometres: the share of the draws below each is searched for as the
/// knots of KnotTable.
struct BinTable {
  const float* knots = nullptr;  ///< [count + 2^halvings], ascending from 0; infinities from count on
  const float* bins = nullptr;   ///< [count][2]: nanometres a share, density
  std::int32_t count = 0;
  float first_nm = 0;  ///< an integer
  const std::int32_t* start = nullptr;
  float buckets_per_nm = 0;  ///< a share
  std::int32_t buckets = 0;
  std::int32_t halvings = 0;
};

/// Lanes with `count` wavelengths of their own. Shapes: [block][count][64].
struct WavelengthBlocks {
  const float* values;
  const float* lambda_nm;
  const float* density;
  std::size_t count;
};

struct WavelengthKernels {
  // dst = f(lambda); lambda NaN: NaN.
  /// t = (lambda - first) * per_nm, i = min(int(t), intervals - 1): value[i] + ((t - i) * difference[i])
  /// t outside [0, intervals]: 0
  void (*interpolate_even)(float* dst, const float* lambda_nm, const EvenTable& table,
                           std::size_t n) noexcept;
  /// i = last knot at or below lambda: value[i] + ((lambda - knot[i]) * slope[i])
  /// lambda outside the knots: 0; held: the value at the nearer end
  void (*interpolate_knots)(float* dst, const float* lambda_nm, const KnotTable& table,
                            std::size_t n) noexcept;
  /// l = min(lambda / 1024, 2^90), i = 1 / l, x = exponent * i, n = nearest(x)
  /// rest = (fma(-x, l, exponent) + exponent_rest) * i, q = 2^((x - n) + rest) - 1 by its series in fma
  /// ((factor * 2^-(n / 2)) / (l^5 * (q + (1 - 2^-n)))) * 2^-(n - n / 2): within 6 u from 0.1 to 10^7 nm
  /// lambda <= 0 or infinite, x >= 252: 0
  void (*planck)(float* dst, const float* lambda_nm, const PlanckTable& table, std::size_t n) noexcept;
  /// sum(lobes) amplitude * exp(-z^2 / 2), z = (lambda - mean) / sigma, in double, rounded once
  void (*gaussians)(float* dst, const float* lambda_nm, const GaussianLobe* lobes, std::size_t count,
                    std::size_t n) noexcept;
  /// sigmoid(clamp(lambda, lowest, highest)) * scale, as in UpsamplingKernels; p and q as in interpolate_even
  void (*sigmoid_at)(float* dst, const float* lambda_nm, const SigmoidSpectrum& spectrum,
                     std::size_t n) noexcept;

  // Spectra of lanes' colours at their own wavelengths, dst and lambda_nm [block][count][64]; lambda NaN:
  // NaN.
  //   held = clamp(lambda, first, last), i: its interval
  //   part = min(1, (held - first) * per_nm - i), or min(1, (held - knot[i]) * per_width[i])
  //   sample = a + part * (b - a), a and b the samples at the interval's ends
  /// the interval i and the part; lambda NaN: interval 0, part NaN
  void (*centre_places)(std::int32_t* interval, float* part, const float* lambda_nm,
                        const CentreTable& centres, std::size_t n) noexcept;
  /// a, b: the sample of smits_blocks
  void (*mixtures_at)(float* dst, const float* const rgb[3], const MixtureTable& table,
                      const CentreTable& centres, const float* lambda_nm, std::size_t count,
                      std::size_t blocks) noexcept;
  /// a, b: ((w0 * white + w1 * cyan) + ...) + w6 * blue; sample < lowest ? lowest : sample, after the mixing
  /// of weights; weights [block][8][64], the last unused
  void (*bases_at)(float* dst, const float* weights, const MixtureTable& table, const CentreTable& centres,
                   const float* lambda_nm, std::size_t count, std::size_t blocks) noexcept;
  /// a, b: the sample of grid_blocks; the table's nodes lie over the bands whose centres these are
  void (*grid_at)(float* dst, const GridSpectra& spectra, const CentreTable& centres, const float* lambda_nm,
                  std::size_t count, std::size_t blocks) noexcept;
  /// sigmoid_at() with the lane's coefficients, then times its scale
  void (*sigmoids_at)(float* dst, const SigmoidLanes& sigmoids, const float* lambda_nm, std::size_t count,
                      std::size_t blocks) noexcept;

  // Sampled wavelengths [block][count][64]: v = clamp(u, 0, 1 - 2^-24), u[k] = v + k / count, less 1 from 1
  // on; u NaN: NaN.
  /// lambda[k] = first + (u[k] * range), density[k] = 1 / range
  void (*even_wavelengths)(float* lambda_nm, float* density, const float* u, const WavelengthDensity& d,
                           std::size_t count, std::size_t blocks) noexcept;
  /// y = from - (u[k] * by), lambda[k] = centre - atanh(y) * per_steepness, density[k] = peak * (1 - y * y),
  /// in double, rounded once. Source: Radziszewski, Boryczko, Alda, An Improved Technique for Full Spectral
  /// Rendering, Journal of WSCG 17, 2009.
  void (*visible_wavelengths)(float* lambda_nm, float* density, const float* u, const WavelengthDensity& d,
                              std::size_t count, std::size_t blocks) noexcept;
  /// i: last nanometre whose share is at or below u[k]; low = first + i
  /// lambda[k] = min(low + (u[k] - share[i]) * bins[i][0], (low + 1) * (1 - 2^-24)), density[k] = bins[i][1]
  void (*table_wavelengths)(float* lambda_nm, float* density, const float* u, const BinTable& table,
                            std::size_t count, std::size_t blocks) noexcept;
  /// dst[c] = factor * sum(k) curve[c](lambda[k]) * (values[k] / density[k]), curves as in interpolate_even
  /// density 0: adds nothing, whatever the value. curves: three tables of the same wavelengths
  void (*project_wavelengths)(float* const dst[3], const WavelengthBlocks& samples, const EvenTable curves[3],
                              float factor, std::size_t blocks) noexcept;
};

}  // namespace spectile::kernels
