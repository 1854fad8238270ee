// Learns how measured reflectances differ from the smooth ones of their colours.
#include <algorithm>
#include <cmath>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/upsampling/learned_nodes.hpp>

#include "src/base/eigen.hpp"
#include "src/base/out_of_memory.hpp"
#include "src/upsampling/grid/measured_colors.hpp"
#include "src/upsampling/grid/nodes.hpp"
#include "src/upsampling/sigmoid_search.hpp"

namespace spectile {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFirstNm = 380;
constexpr double kStepNm = 5;
constexpr Index kPlaces = 81;
// Colours tell next to nothing of what lies outside: at its ends an observer sees a hundredth of its peak.
constexpr auto kFirstKept = static_cast<Index>((kFirstLearnedNm - kFirstNm) / kStepNm);
constexpr auto kKept = static_cast<Index>((kLastLearnedNm - kFirstLearnedNm) / kStepNm) + 1;
constexpr double kLeast = 0.006;
// Chosen by learning from each of three published sets, and two of them, and evaluating on the others: means
// of 1.12; from 0.3 to 0.8 and from a half to four times the noise they are up to 1.15.
constexpr double kLength = 0.8;
constexpr double kNoise = 4;  // of 50 reflectances
constexpr double kNoiseOf = 50;
constexpr double kSmoothing = 4;
constexpr std::size_t kMost = 4096;  // a matrix of 128 MiB

double place_nm(Index i) {
  return kFirstNm + kStepNm * static_cast<double>(i);
}

/// Turns arguments [kPlaces] of the sigmoid into offsets: less their best c0 p + c1 q + c2, and smoothed.
MatrixXd offset_filter(Observer observer) {
  const SigmoidFunctions& functions = SigmoidFunctions::of(observer);
  MatrixXd basis(kPlaces, 3);
  for (Index i = 0; i < kPlaces; ++i) {
    const auto [p, q] = functions.at(place_nm(i));
    basis.row(i) << p, q, 1;
  }
  const MatrixXd identity = MatrixXd::Identity(kPlaces, kPlaces);
  const MatrixXd orthonormal =
      Eigen::HouseholderQR<MatrixXd>(basis).householderQ() * MatrixXd::Identity(kPlaces, 3);
  MatrixXd bend = MatrixXd::Zero(kPlaces - 2, kPlaces);  // second differences
  for (Index i = 0; i + 2 < kPlaces; ++i) bend.row(i).segment(i, 3) << 1, -2, 1;
  const MatrixXd smooth = (identity + kSmoothing * bend.transpose() * bend).llt().solve(identity);
  return smooth * (identity - orthonormal * orthonormal.transpose());
}

/// Features of a colour.
Eigen::Vector3d features(const Lab& lab) {
  return {lab.l / 100, lab.a / 60, lab.b / 60};
}

double matern(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double d = std::sqrt(3.0) * (a - b).norm() / kLength;
  return (1 + d) * std::exp(-d);
}

/// Factors a positive definite matrix in place, of which the lower triangle counts, in parts between which it
/// asks `go_on`; false where that says no. Source: Golub, Van Loan, Matrix Computations, 4.2.6.
bool factor(MatrixXd& a, const std::function<bool()>& go_on) {
  constexpr Index kPanel = 256;
  for (Index at = 0; at < a.rows(); at += kPanel) {
    if (go_on && !go_on()) return false;
    const Index size = std::min(kPanel, a.rows() - at);
    const Index rest = a.rows() - at - size;
    const MatrixXd own = a.block(at, at, size, size).selfadjointView<Eigen::Lower>().llt().matrixL();
    a.block(at, at, size, size) = own;
    auto below = a.block(at + size, at, rest, size);
    own.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(below);
    a.block(at + size, at + size, rest, rest).selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
  }
  return true;
}

/// Errors: kBadArgument for a value that is not finite.
Result<VectorXd> arguments(const Spectrum& reflectance) {
  VectorXd out(kPlaces);
  for (Index i = 0; i < kPlaces; ++i) {
    const double value = reflectance(place_nm(i));
    if (!std::isfinite(value)) {
      return make_error(ErrorCode::kBadArgument, "a reflectance is {} at {} nm", value, place_nm(i));
    }
    const double y = 2 * std::clamp(value, kLeast, 1 - kLeast) - 1;
    out[i] = y / std::sqrt(1 - y * y);
  }
  return out;
}

}  // namespace

Result<void> check_sizes(std::span<const ReflectanceSet> sets) {
  std::size_t count = 0;
  for (const ReflectanceSet& set : sets) count += set.reflectances.size();
  if (count >= kMinReflectances && count <= kMost) return {};
  return make_error(ErrorCode::kBadArgument, "nodes are learned from {} to {} reflectances, not from {}",
                    kMinReflectances, kMost, count);
}

Result<LearnedNodes> learn_from(std::span<const ReflectanceSet> sets, const LearningOptions& options) {
  std::size_t count = 0;
  for (const ReflectanceSet& set : sets) count += set.reflectances.size();
  SPECTILE_ASSIGN(const auto colors, MeasuredColors::create(options));
  const auto n = static_cast<Index>(count);
  MatrixXd x(n, kPlaces);
  std::vector<Eigen::Vector3d> at;
  MatrixXd covariance(n, n);
  for (const ReflectanceSet& set : sets) {
    const double noise = kNoise * std::sqrt(static_cast<double>(set.reflectances.size()) / kNoiseOf);
    for (const Spectrum& reflectance : set.reflectances) {
      const auto row = static_cast<Index>(at.size());
      SPECTILE_ASSIGN(const auto argument, arguments(reflectance));
      x.row(row) = argument.transpose();
      at.push_back(features(colors.lab_of(colors.rgb_of(reflectance))));
      for (Index i = 0; i < row; ++i) covariance(row, i) = matern(at.back(), at[static_cast<std::size_t>(i)]);
      covariance(row, row) = 1 + noise;
    }
  }
  const MatrixXd filter = offset_filter(options.observer).middleRows(kFirstKept, kKept);
  const MatrixXd offsets = x * filter.transpose();
  if (!factor(covariance, options.go_on)) return make_error(ErrorCode::kCancelled, "stopped on request");
  const MatrixXd half = covariance.triangularView<Eigen::Lower>().solve(offsets);
  const MatrixXd weights = covariance.transpose().triangularView<Eigen::Upper>().solve(half);

  LearnedNodes out = {
      options.light.value_or(NamedLight{"D65", *illuminant("D65")}), options.observer, count, {}, {}};
  for (Index i = 0; i < kKept; ++i) out.wavelengths_nm.push_back(place_nm(kFirstKept + i));
  for (std::size_t node = 0; node < kNodes; ++node) {
    const std::array<double, 3> rgb = node_color(node);
    const Eigen::Vector3d here = features(colors.lab_of(rgb));
    VectorXd like(n);
    for (Index i = 0; i < n; ++i) like[i] = matern(here, at[static_cast<std::size_t>(i)]);
    const bool grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
    const VectorXd offset = weights.transpose() * like;
    for (Index i = 0; i < kKept; ++i) out.offsets.push_back(grey ? 0.0F : static_cast<float>(offset[i]));
  }
  return out;
}

Result<LearnedNodes> learn_nodes(std::span<const ReflectanceSet> sets, const LearningOptions& options) {
  SPECTILE_TRY(check_sizes(sets));
  return guard_memory([&] { return learn_from(sets, options); }, "no memory to learn from reflectances");
}

}  // namespace spectile
