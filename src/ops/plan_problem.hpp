// What a plan is fitted to: reflectances and lights every nanometre, true colours, and the metric at each.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <spectile/plan.hpp>
#include <vector>

namespace spectile::plan {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Wavelengths of the integration: those of the observers.
inline constexpr int kFirstNm = 360;
inline constexpr int kLastNm = 830;
inline constexpr Eigen::Index kGrid = kLastNm - kFirstNm + 1;

/// Reflectances every nanometre, limited to [0, 1]. Shapes: [kGrid][reflectances].
Matrix tabulate(const std::vector<Spectrum>& reflectances);

/// Products of `bounces` columns: all of them for one, else `most` random ones. Deterministic. Shapes: any
/// number of rows.
Matrix products(const Matrix& reflectances, int bounces, std::size_t most);

/// Weights that turn a reflectance into XYZ under a light, Y = 1 for 1. Shapes: [kGrid][3].
/// Errors: kBadArgument for a light without luminance.
Result<Matrix> integrals(const PlannedLight& light, Observer observer);

/// The CIEDE2000 metric at colours: for small differences d in XYZ, |metric * d| is the colour difference.
/// Shapes: xyz [3][colours]; one 3 x 3 for each.
std::vector<Eigen::Matrix3d> metrics(const Matrix& xyz, const Eigen::Vector3d& white);

/// Colour differences between columns of XYZ. Shapes: [3][colours].
std::vector<double> differences(const Matrix& truth, const Matrix& got, const Eigen::Vector3d& white);

/// Mean, 95th percentile and maximum.
PlanError summary(std::vector<double> differences);

/// Samples of tabulated spectra at a wavelength between nanometres, and their slopes. Shapes: [spectra].
Vector samples_at(const Matrix& table, double lambda_nm);
Vector slopes_at(const Matrix& table, double lambda_nm);

/// All of a fit: samples and what they should come to.
struct Problem {
  Matrix samples;                                    ///< [kGrid][N], those of the prior last
  Eigen::Index measured = 0;                         ///< those that are reflectances
  std::vector<Matrix> weights;                       ///< a light: [kGrid][3]
  std::vector<Eigen::Vector3d> white;                ///< a light
  std::vector<Matrix> truth;                         ///< a light: [3][N]
  std::vector<std::vector<Eigen::Matrix3d>> metric;  ///< a light, a sample
  Vector share;                                      ///< [N]: how much a sample counts, squared
};

/// From reflectances (and their products) and integrals of lights.
Problem make_problem(const Matrix& reflectances, int bounces, const std::vector<Matrix>& integrals);

/// A plan's numbers while it is being fitted.
struct Numbers {
  Vector lambda;    ///< [K]
  Matrix sensor;    ///< [K][3]
  Matrix emission;  ///< [K][lights]
};

/// XYZ of samples by a plan's numbers. Shapes: [3][N].
Matrix predict(const Matrix& samples, const Numbers& numbers, Eigen::Index light);

/// Wavelengths by exchange, the best of several starts. Shapes: share [N].
std::vector<double> choose_wavelengths(const Problem& problem, std::size_t count, const Vector& share,
                                       int starts);

/// Moves wavelengths and solves for weights.
Numbers fit(const Problem& problem, const std::vector<double>& start);

}  // namespace spectile::plan
