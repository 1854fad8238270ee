// Operation: one thing that the kernels do to lanes, with what it costs at least and how its error is
// evaluated.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/relight.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "bench/limits/limits.hpp"
#include "kernels/abi.hpp"

namespace spectile::measure {

using Random = std::mt19937_64;
using kernels::KernelTable;

enum class Element {
  kFloat,
  kHalf,
  kMask,  ///< a bit a lane
  kInt,   ///< integers of 32 bits
  kQuad,  ///< floats, a lane's rows side by side: [kLanes][rows]
  kLimb,  ///< integers of 64 bits, a lane's rows side by side
};

/// A lane's layout in memory: planes of blocks [rows][kLanes].
struct Shape {
  std::size_t planes = 1;
  std::size_t rows = 1;
  Element element = Element::kFloat;
  std::size_t values() const noexcept { return planes * rows; }
  /// Of a block in a plane.
  std::size_t block_bytes() const noexcept {
    if (element == Element::kMask) return rows * sizeof(std::uint64_t);
    const std::size_t bytes = element == Element::kHalf   ? sizeof(std::uint16_t)
                              : element == Element::kLimb ? sizeof(std::int64_t)
                                                          : sizeof(float);
    return rows * kernels::kLanes * bytes;
  }
  double lane_bytes() const noexcept {
    return static_cast<double>(planes * block_bytes()) / static_cast<double>(kernels::kLanes);
  }
};

/// A run of blocks in memory.
struct Arrays {
  const std::byte* source = nullptr;
  std::byte* target = nullptr;
  std::size_t source_plane = 0;  ///< bytes from plane to plane
  std::size_t target_plane = 0;
  std::size_t blocks = 0;
  bool non_temporal = false;  ///< non-temporal stores, where the kernel has them

  std::size_t n() const noexcept { return blocks * kernels::kLanes; }
  template <class T = float>
  const T* in(std::size_t plane = 0) const noexcept {
    return reinterpret_cast<const T*>(source + plane * source_plane);
  }
  /// The first three planes, as kernels take colours.
  std::array<const float*, 3> in3() const noexcept { return {in(0), in(1), in(2)}; }
  std::array<float*, 3> out3() const noexcept { return {out(0), out(1), out(2)}; }
  template <class T = float>
  T* out(std::size_t plane = 0) const noexcept {
    return reinterpret_cast<T*>(target + plane * target_plane);
  }
};

/// No error: the case lies outside of the domain of the operation's bound.
inline constexpr double kOutOfDomain = -1;
/// Beyond any bound.
inline constexpr double kBeyond = std::numeric_limits<double>::infinity();

struct Operation {
  std::string group, name;
  std::string item = "lane";
  Shape in, out;
  /// A lane's arithmetic: vector instructions that are neither load nor store, one on doubles counting twice.
  double operations = 0;
  double divisions = 0;
  bool can_stream = false;  ///< the kernel stores with non-temporal stores where it is told
  bool bitwise = false;     ///< looks at bits: denormals are not 0 in any mode of the processor
  bool cache_only = false;  ///< works on a line of an image, never on more
  bool adds = false;        ///< to what is there: the target is read too
  /// A lane's bytes of the target that are touched; below 0: all.
  double touched_bytes = -1;
  /// So many times fewer lanes are tried: for what takes microseconds a lane.
  std::size_t expense = 1;
  std::string bottleneck;  ///< bottleneck beside the limit, in words
  std::string unit = "u";  ///< of error and bound
  double bound = 0;
  std::function<void(const KernelTable&, const Arrays&)> run;
  /// Makes a target ready to be added to; empty where none is. Called before results are evaluated.
  std::function<void(const Arrays&)> clear;
  /// Typical values of one lane, [planes][rows].
  std::function<void(Random&, float* values)> fill;
  /// Makes of any numbers what the operation may be given; empty where that is all.
  std::function<void(float* values)> admit;
  /// Error of a lane, [planes][rows] each: at most `bound`, or kOutOfDomain. `tiny`: what a result or an
  /// operand may be off by where it is below the smallest normal number.
  std::function<double(const double* in, const double* out, double tiny)> error;
  /// In its place, where it matters which lane it is.
  std::function<double(std::size_t lane, const double* in, const double* out, double tiny)> error_at;
  /// In its place, for what tells of all lanes together: the largest error of a run.
  std::function<double(const Arrays&, bool flushed)> run_error;
  /// Reads a lane's results out of a block of the target, where they do not lie as the shape says.
  std::function<void(const std::byte* block, std::size_t lane, double* values)> read_block;
  Cost cost() const {
    const double written = touched_bytes >= 0 ? touched_bytes : out.lane_bytes();
    return {in.lane_bytes() + (adds ? written : 0), written, operations, divisions};
  }
};

/// Reference of a lane: values and, for each, the magnitude that the bound is a multiple of u of.
using Oracle = std::function<void(const double* in, double* reference, double* scale)>;

/// Evaluates against the oracle. Errors in units of u = 2^-24 of `scale`; `roundings`: of results that may be
/// below the smallest normal number. Where a sum of magnitudes leaves float's range there is no bound but for
/// operations that are `single`: rounded once, whose overflow is the infinity that rounding gives, and whose
/// scale is the result's own magnitude.
std::function<double(const double*, const double*, double)> error_against(std::size_t outputs,
                                                                          double roundings, bool single,
                                                                          double bound, Oracle oracle);

/// Adds an operation, to be completed; the reference holds until the next one is added.
Operation& add_operation(std::vector<Operation>& to, const char* group, std::string name, const char* item,
                         Shape in, Shape out = {});

// Constants of some operations.
inline constexpr float kPowExponent = 2.4F;  ///< of sRGB's encoding
inline constexpr kernels::SigmoidSpectrum kSigmoidAtWavelengths = {{-3.0F, 1.0F, 0.5F}, 400, 700, 1};
inline constexpr double kPlanckTemperature = 6504;  ///< K
/// h c / k, exact since the redefinition of 2019. Source: CODATA 2018.
inline constexpr double kSecondRadiationNmK = 6.62607015e-34 * 299792458.0 / 1.380649e-23 * 1e9;
/// Wavelengths as instruments give them: some nanometres apart, never evenly. Units: nm.
std::vector<float> irregular_knots();

/// Wavelengths of a path, as renderers draw them.
inline constexpr std::size_t kWavelengths = 4;
/// Rows of such samples: planes of values, then of wavelengths, then of densities, from a block on.
struct PathRows {
  const float* values[kWavelengths];
  const float* lambda[kWavelengths];
  const float* density[kWavelengths];
  explicit PathRows(const Arrays& a, std::size_t block = 0);
};
/// Fills one with typical values.
void fill_path(Random& random, float* values);

/// Three numbers a lane and as many wavelengths of its own, [block][3 + kWavelengths][64], to a sample at
/// each. `kernel`: of one block, with its three rows, its wavelengths and where its samples go.
using OwnWavelengthsKernel = std::function<void(const KernelTable&, const float* const rows[3],
                                                const float* lambda_nm, float* samples)>;
Operation& add_own_wavelengths(std::vector<Operation>& to, std::string name, const char* item,
                               OwnWavelengthsKernel kernel);
/// Error of such an operation whose samples are linear between the centres of even bands: `bound` u of what
/// the oracle gives for the bands, and the rounding of the place between them.
std::function<double(const double*, const double*, double)> error_between_bands(const Bands& bands,
                                                                                double roundings,
                                                                                double bound,
                                                                                Oracle on_bands);

/// A bounce and Russian roulette at a path's own wavelengths.
void add_throughput(std::vector<Operation>& to);

/// Rows of a line of an image in the target: a plane a band.
void* const* line_rows(const Arrays& arrays, std::size_t bands);

/// Uniform in [low, high).
float uniform(Random& random, float low, float high);

/// True if a name contains one of these, or there are none.
bool is_chosen(const std::string& name, const std::vector<std::string>& only);

/// True if three numbers are finite.
bool finite3(const double* v);
/// An oracle's results for three numbers that are not: NaN stays NaN, and infinities go through by the
/// kernel's own order, which the reference's bits tell. False, and nothing done, for three finite ones.
bool oracle_of_strange(const double* v, std::size_t results, double* reference, double* scale);

/// Half a step of half at a value.
double half_of_half_step(double value);

/// Fills a lane's values uniformly.
std::function<void(Random&, float*)> uniform_values(std::size_t count, float low, float high);

/// Everything that the kernels do, for spectra on these bands. Errors: as Upsampler::create() and Projector.
Result<std::vector<Operation>> lane_operations(const Bands& bands);

// Its parts.
void add_arithmetic(std::vector<Operation>& to);
Result<void> add_reductions(std::vector<Operation>& to, const Bands& bands);
Result<void> add_upsampling(std::vector<Operation>& to, const Bands& bands);
Result<void> add_sigmoids(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler);
/// Of sigmoids at single wavelengths.
Result<void> add_sigmoids_at_wavelengths(std::vector<Operation>& to,
                                         const std::shared_ptr<const Upsampler>& upsampler);
void add_grids(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler,
               const std::shared_ptr<const Relighter>& relighter);
Result<void> add_wavelengths(std::vector<Operation>& to);
Result<void> add_film(std::vector<Operation>& to, const Bands& bands);
Result<void> add_film_sums(std::vector<Operation>& to, const Bands& bands);
void add_differences(std::vector<Operation>& to);
void add_conversions(std::vector<Operation>& to);

}  // namespace spectile::measure
