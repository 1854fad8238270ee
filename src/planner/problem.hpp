// What a plan is fitted to: reflectances and lights every nanometre, true colours, and the metric at each.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <spectile/plan/plan.hpp>
#include <vector>

namespace spectile::plan {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Wavelengths of the integration: those of the observers.
inline constexpr int kFirstNm = 360;
inline constexpr int kLastNm = 830;
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

/// A plan's numbers while it is being fitted.
struct Numbers {
  Vector lambda;    ///< [K]
  Vector half;      ///< [K]: half the widths of the bands; zeros for points
  Matrix sensor;    ///< [K][3]
  Matrix emission;  ///< [K][lights]
};

/// What the samples are at wavelengths or over bands around them; products are products of those. Shapes:
/// [samples][K].
Matrix values_of(const SampleSet& set, const Vector& lambda, const Vector& half);
/// The same, and how it changes as the wavelengths, and the half widths, do.
struct Slopes {
  Matrix values;
  Matrix by_lambda;
  Matrix by_half;
};
Slopes slopes_of(const SampleSet& set, const Vector& lambda, const Vector& half);

/// True XYZ of the samples under a light. Shapes: integrals [kGrid][3]; [3][samples].
Matrix truth_of(const SampleSet& set, const Matrix& integrals);
/// XYZ of samples by a plan's numbers. Shapes: [3][samples].
Matrix predict(const SampleSet& set, const Numbers& numbers, Eigen::Index light);

/// Reflectances every nanometre, limited to [0, 1]. Shapes: [kGrid][reflectances]. Errors: kBadArgument for
/// one that is no number somewhere.
Result<Matrix> tabulate(const std::vector<Spectrum>& reflectances);
/// Reflectances with steep edges at any place from first_nm to last_nm, as strong dyes have, which a measured
/// set has only a few of. Deterministic. Shapes: [kGrid][count].
Matrix dye_spectra(Eigen::Index count, double first_nm, double last_nm);
/// The leading directions of smooth deviations, each as large as it is likely. Shapes: [kGrid][..].
Matrix smooth_spectra();

/// Weights that turn a reflectance into XYZ under a light, Y = 1 for 1. Shapes: [kGrid][3].
/// Errors: kBadArgument for a light without luminance, or whose white has no X or Z.
Result<Matrix> integrals(const PlannedLight& light, Observer observer);
/// XYZ of a reflectance that is 1.
Eigen::Vector3d white_of(const Matrix& integrals);

/// The CIEDE2000 metric at colours: for small differences d in XYZ, |metric * d| is the colour difference.
/// Shapes: xyz [3][colours]; one 3 x 3 for each.
std::vector<Eigen::Matrix3d> metrics(const Matrix& xyz, const Eigen::Vector3d& white);
/// Colour differences between columns of XYZ. Shapes: [3][colours].
std::vector<double> differences(const Matrix& truth, const Matrix& got, const Eigen::Vector3d& white);
/// Mean, 95th percentile and maximum.
PlanError summary(std::vector<double> differences);

/// Products that an error is taken over.
inline constexpr std::size_t kJudgedProducts = 2000;
/// What errors are taken over: reflectances for one bounce, random products of them for more.
SampleSet judged_samples(Matrix table, int bounces, std::size_t most);

/// All of a fit: samples and what they should come to.
struct Problem {
  /// Reflectances and products of them, dyes, smooth deviations, in this order.
  SampleSet samples;
  Eigen::Index scene = 0;              ///< samples that are reflectances or products
  Eigen::Index measured = 0;           ///< those and dyes
  std::vector<Matrix> integrals;       ///< a light: [kGrid][3]
  std::vector<Eigen::Vector3d> white;  ///< a light
  std::vector<Matrix> truth;           ///< a light: [3][N]
  std::vector<Matrix> squared_metric;  ///< a light: [N][6]: xx, xy, xz, yy, yz, zz
  Vector share;                        ///< [N]: how much a sample counts, squared
  SampleSet pool;                      ///< products that may yet be taken; none for one bounce
  std::vector<Matrix> pool_truth;      ///< a light: [3][products]
};

/// Pairs of XYZ's components in the order of `squared_metric`.
inline constexpr Eigen::Index kPairs = 6;
inline constexpr Eigen::Index kFirstOf[kPairs] = {0, 0, 0, 1, 1, 2};
inline constexpr Eigen::Index kSecondOf[kPairs] = {0, 1, 2, 1, 2, 2};

/// From reflectances (and their products) and integrals of lights.
Problem make_problem(const Matrix& reflectances, int bounces, const std::vector<Matrix>& integrals);
/// Takes those products of the pool into the samples that come out worst under each light.
void take_worst(Problem& problem, const Numbers& numbers);

/// Wavelengths by exchange, the best of several starts; bands have half widths of `half_nm`, and dyes count
/// `dyes` times what they do in the problem.
std::vector<double> choose_wavelengths(const Problem& problem, std::size_t count, double half_nm, double dyes,
                                       int starts);

/// Where a fit begins.
struct Start {
  std::vector<double> wavelengths_nm;
  double half_nm = 0;  ///< half the widths of bands; 0 for points
};

/// The same for a quick fit from a start, again and again.
void take_worst(Problem& problem, const Start& start);

/// Moves wavelengths (and the ends of bands) and solves for weights. Of several starts, the one that comes
/// nearest goes on; all are of points, or all of bands. The problem's samples grow by those products that
/// come out worst.
Numbers fit(Problem& problem, const std::vector<Start>& starts);

}  // namespace spectile::plan
