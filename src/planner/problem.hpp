// The problem that a plan is fitted to: reflectances and lights every nanometre, true colours, and the metric
// at each.
#pragma once

#include <cstdint>
#include <functional>
#include <spectile/plan/plan.hpp>
#include <vector>

#include "src/base/eigen.hpp"

namespace spectile::plan {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Wavelengths of the integration: those of the observers.
inline constexpr int kFirstNm = static_cast<int>(kFirstVisibleNm);
inline constexpr int kLastNm = static_cast<int>(kLastVisibleNm);
inline constexpr Eigen::Index kGrid = kLastNm - kFirstNm + 1;

/// Spectra every nanometre, and products of them: each sample is the product of one or more of the spectra.
struct SampleSet {
  Matrix table;       ///< [kGrid][spectra]
  Matrix cumulative;  ///< [kGrid][spectra]: integrals from kFirstNm
  std::vector<std::vector<Eigen::Index>> factors;
  Eigen::Index count() const { return static_cast<Eigen::Index>(factors.size()); }
};

/// Every spectrum as a sample of its own.
SampleSet sample_set(Matrix table);
/// Adds products of `bounces` of the first `among` spectra, `most` random ones; deterministic.
void add_products(SampleSet& set, Eigen::Index among, int bounces, std::size_t most);

/// Parameters of a plan while it is being fitted.
struct Parameters {
  Vector lambda;    ///< [K]
  Vector half;      ///< [K]: half the widths of the bands; zeros for points
  Matrix sensor;    ///< [K][3]
  Matrix emission;  ///< [K][lights]
};

/// Values of the samples at wavelengths, or averages over bands around them; products are products of those.
/// Shapes: [samples][K].
Matrix sample_values(const SampleSet& set, const Vector& lambda, const Vector& half);
/// The same with its derivatives by the wavelengths and half widths.
struct Slopes {
  Matrix values;
  Matrix by_lambda;
  Matrix by_half;
};
Slopes sample_slopes(const SampleSet& set, const Vector& lambda, const Vector& half);

/// Reference XYZ of the samples under a light. Shapes: integrals [kGrid][3]; [3][samples].
Matrix reference_xyz(const SampleSet& set, const Matrix& integrals);
/// XYZ of samples by a plan's parameters. Shapes: [3][samples].
Matrix predict(const SampleSet& set, const Parameters& parameters, Eigen::Index light);

/// Reflectances every nanometre, as they are. Shapes: [kGrid][reflectances]. Errors: kBadArgument for
/// one that is no number somewhere.
Result<Matrix> tabulate(const std::vector<Spectrum>& reflectances);
/// Synthetic reflectances with steep edges anywhere from first_nm to last_nm, as saturated paints have, of
/// which a measured set has only a few. Deterministic. Shapes: [kGrid][count].
Matrix synthetic_reflectances(Eigen::Index count, double first_nm, double last_nm);
/// The leading directions of smooth deviations, each as large as it is likely. Shapes: [kGrid][..].
Matrix smooth_spectra();

/// Weights that turn a reflectance into XYZ under a light, Y = 1 for 1. Shapes: [kGrid][3].
/// Errors: kBadArgument for a light without luminance, or whose white has no X or Z.
Result<Matrix> integrals(const NamedLight& light, Observer observer);
/// XYZ of a reflectance that is 1.
Eigen::Vector3d white_xyz(const Matrix& integrals);

/// The CIEDE2000 metric at colours: for small differences d in XYZ, |metric * d| is the colour difference.
/// Shapes: xyz [3][colours]; one 3 x 3 for each.
std::vector<Eigen::Matrix3d> metrics(const Matrix& xyz, const Eigen::Vector3d& white);
/// Colour differences between columns of XYZ, each seen in its white. Shapes: [3][colours].
std::vector<double> differences(const Matrix& reference, const Matrix& got, const Eigen::Vector3d& white,
                                const Eigen::Vector3d& got_white);
inline std::vector<double> differences(const Matrix& reference, const Matrix& got,
                                       const Eigen::Vector3d& white) {
  return differences(reference, got, white, white);
}

/// Products that an error is evaluated over.
inline constexpr std::size_t kEvaluationProducts = 2000;
/// Samples that errors are evaluated over: reflectances for one bounce, random products of them for more.
SampleSet evaluation_samples(Matrix table, int bounces, std::size_t most);

/// Samples and their reference colours.
struct Problem {
  /// Reflectances and products of them, synthetic reflectances, smooth deviations, in this order.
  SampleSet samples;
  Eigen::Index scene = 0;              ///< samples that are reflectances or products
  Eigen::Index measured = 0;           ///< those and synthetic reflectances
  std::vector<Matrix> integrals;       ///< a light: [kGrid][3]
  std::vector<Eigen::Vector3d> white;  ///< a light
  std::vector<Matrix> reference;       ///< a light: [3][N]
  std::vector<Matrix> squared_metric;  ///< a light: [N][6]: xx, xy, xz, yy, yz, zz
  Vector sample_weights;               ///< [N], of squared differences
  SampleSet pool;                      ///< products that may be added; none for one bounce
  std::vector<Matrix> pool_reference;  ///< a light: [3][products]
  bool apart = true;                   ///< bands do not overlap
  /// Called some times a second. Throws: Stopped, where the work is not wanted any more.
  std::function<void()> check = [] {};
};

/// Ends a plan that is not wanted any more; caught where it was asked for.
struct Stopped {};

/// Pairs of XYZ's components in the order of `squared_metric`.
inline constexpr Eigen::Index kPairs = 6;
inline constexpr Eigen::Index kFirstOf[kPairs] = {0, 0, 0, 1, 1, 2};
inline constexpr Eigen::Index kSecondOf[kPairs] = {0, 1, 2, 1, 2, 2};

/// From reflectances (and their products) and integrals of lights.
Problem make_problem(const Matrix& reflectances, int bounces, const std::vector<Matrix>& integrals);
/// Adds to the samples those products of the pool that have the largest errors under each light.
void add_worst_products(Problem& problem, const Parameters& parameters);

/// Wavelengths by exchange, the best of several initial guesses; bands have half widths of `half_nm`, and
/// synthetic reflectances `synthetic_weight` times their weight in the problem.
std::vector<double> choose_wavelengths(const Problem& problem, std::size_t count, double half_nm,
                                       double synthetic_weight, int guesses);

/// Initial guess of a fit.
struct InitialGuess {
  std::vector<double> wavelengths_nm;
  double half_nm = 0;  ///< half the widths of bands; 0 for points
};

/// The same for a quick fit from an initial guess, in several rounds.
void add_worst_products(Problem& problem, const InitialGuess& guess);

/// Moves wavelengths (and the ends of bands) and solves for weights. The initial guesses, all of points
/// or all of bands, are compared by successive halving. The problem's samples grow by those products that
/// have the largest errors.
Parameters fit(Problem& problem, const std::vector<InitialGuess>& guesses);

}  // namespace spectile::plan
