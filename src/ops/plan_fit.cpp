// Fitting a plan: wavelengths, widths, sensor weights and emission values to the least colour differences.
#include <algorithm>
#include <cmath>
#include <optional>

#include "src/ops/plan_equations.hpp"

namespace spectile::plan {
namespace {

/// Wavelengths stay within the visible, bands no narrower than this, and all at least so far apart.
constexpr double kLowestNm = 385;
constexpr double kHighestNm = 725;
constexpr double kApartNm = 2;
constexpr double kNarrowestNm = 2;
/// Longest step of a wavelength or width.
constexpr double kLongestNm = 6;

/// Rounds of weighing anew, and steps in the first and in each further.
constexpr int kRounds = 8;
constexpr int kFirstSteps = 40;
constexpr int kSteps = 20;

class Fit {
 public:
  Fit(const Problem& p, const std::vector<double>& start, double half_nm)
      : equations_(p, static_cast<Eigen::Index>(start.size()), half_nm > 0) {
    now_.lambda = Eigen::Map<const Vector>(start.data(), equations_.layout().k);
    now_.half = Vector::Constant(now_.lambda.size(), half_nm);
    keep_apart(now_);
    equations_.start_weights(now_);
  }

  /// The first round; returns the sum of squares.
  double begin() {
    descend(kFirstSteps);
    return equations_.cost(now_);
  }

  /// The others: from squares of differences to the differences themselves, whose means and maxima count.
  Numbers finish() {
    for (int round = 1; round < kRounds; ++round) {
      equations_.weigh_by_difference(now_);
      descend(kSteps);
    }
    make_white_exact();
    return now_;
  }

 private:
  /// Neighbours that come too near share what is between them.
  void keep_apart(Numbers& n) const {
    const bool bands = equations_.layout().bands;
    for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
      n.lambda[k] = std::clamp(n.lambda[k], kLowestNm, kHighestNm);
      const double apart = bands ? kNarrowestNm : kApartNm;
      if (k > 0) n.lambda[k] = std::max(n.lambda[k], n.lambda[k - 1] + apart);
    }
    if (!bands) return;
    for (Eigen::Index k = 0; k < n.half.size(); ++k) {
      n.half[k] = std::clamp(n.half[k], kNarrowestNm / 2, 60.0);
    }
    for (Eigen::Index k = 1; k < n.half.size(); ++k) {
      const double room = n.lambda[k] - n.lambda[k - 1];
      const double taken = n.half[k] + n.half[k - 1];
      if (taken <= room) continue;
      n.half[k - 1] *= room / taken;
      n.half[k] *= room / taken;
    }
  }

  Numbers moved(const Vector& step) const {
    const Layout& at = equations_.layout();
    Numbers out = now_;
    for (Eigen::Index k = 0; k < at.k; ++k) {
      out.lambda[k] += std::clamp(step[at.lambda(k)], -kLongestNm, kLongestNm);
      if (at.bands) out.half[k] += std::clamp(step[at.half(k)], -kLongestNm, kLongestNm);
      for (Eigen::Index c = 0; c < 3; ++c) out.sensor(k, c) += step[at.sensor(k, c)];
      for (Eigen::Index l = 0; at.lights > 1 && l < at.lights; ++l) {
        out.emission(k, l) += step[at.emission(l, k)];
      }
    }
    keep_apart(out);
    return out;
  }

  /// Levenberg and Marquardt's steps, with white as constraints.
  void descend(int steps) {
    const Layout& at = equations_.layout();
    double damping = 1e-3;
    double best = equations_.cost(now_);
    for (int step = 0; step < steps && damping < 1e8; ++step) {
      Matrix normal;
      Vector right;
      equations_.build(now_, normal, right);
      Matrix white;
      const Vector miss = equations_.white_miss(now_, &white);
      bool better = false;
      for (int attempt = 0; attempt < 8 && !better; ++attempt) {
        // [normal + damping, white^T; white, 0] [step; multipliers] = [-right; -miss]
        const Eigen::Index own = at.unknowns();
        const Eigen::Index all = own + miss.size();
        const double scale = normal.diagonal().mean();
        Matrix system = Matrix::Zero(all, all);
        system.topLeftCorner(own, own) = normal;
        system.diagonal().head(own) += damping * normal.diagonal() + Vector::Constant(own, 1e-12 * scale);
        system.bottomLeftCorner(miss.size(), own) = scale * white;
        system.topRightCorner(own, miss.size()) = scale * white.transpose();
        system.diagonal().tail(miss.size()).setConstant(-1e-9 * scale);
        Vector aim(all);
        aim << -right, -scale * miss;
        const Numbers next = moved(system.partialPivLu().solve(aim).head(own));
        const double sum = equations_.cost(next);
        if (sum < best) {
          better = true;
          const bool little = sum > best * (1 - 1e-5);
          best = sum;
          now_ = next;
          damping = std::max(1e-9, damping * 0.3);
          if (little) return;
        } else {
          damping *= 5;
        }
      }
      if (!better) return;
    }
  }

  /// Newton's steps of least length to the white of every light, by weights alone.
  void make_white_exact() {
    for (int step = 0; step < 20; ++step) {
      Matrix slopes;
      const Vector miss = equations_.white_miss(now_, &slopes);
      if (miss.cwiseAbs().maxCoeff() < 1e-15) return;
      now_ = moved(-slopes.completeOrthogonalDecomposition().solve(miss));
    }
  }

  Equations equations_;
  Numbers now_;
};

}  // namespace

Numbers fit(const Problem& problem, const std::vector<Start>& starts) {
  std::optional<Fit> best;
  double least = 0;
  for (const Start& start : starts) {
    Fit one(problem, start.wavelengths_nm, start.half_nm);
    const double sum = one.begin();
    if (best && !(sum < least)) continue;
    best.emplace(std::move(one));
    least = sum;
  }
  return best->finish();
}

}  // namespace spectile::plan
