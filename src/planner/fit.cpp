// Fitting a plan: wavelengths, widths, sensor weights and emission values to the least colour differences.
#include <algorithm>
#include <cmath>

#include "src/planner/equations.hpp"

namespace spectile::plan {
namespace {

/// Wavelengths stay within the visible, bands no narrower than this, and all at least so far apart.
constexpr double kLowestNm = 385;
constexpr double kHighestNm = 725;
constexpr double kApartNm = 2;
constexpr double kNarrowestNm = 2;
/// Longest step of a wavelength or width.
constexpr double kLongestNm = 6;

/// Differences count to this power at last: between their mean (1), which leaves a few large ones, and their
/// squares, which spend precision on those few.
constexpr double kPower = 1.5;

/// Steps by squares and by the power itself before starts are compared, of those that are left then, and of
/// each round of the best: lights are balanced before each, and the worst products taken before the first
/// few.
constexpr int kSquareSteps = 8;
constexpr int kPowerSteps = 8;
constexpr int kLaterSteps = 15;
constexpr int kRounds = 6;
constexpr int kTakingRounds = 4;

/// Where all colours are met there is still something to divide by.
constexpr double kMinUnit = 1e-6;

class Fit {
 public:
  Fit(const Problem& p, const std::vector<double>& start, double half_nm)
      : equations_(p, static_cast<Eigen::Index>(start.size()), half_nm > 0) {
    now_.lambda = Eigen::Map<const Vector>(start.data(), equations_.layout().k);
    now_.half = Vector::Constant(now_.lambda.size(), half_nm);
    keep_apart(now_);
    equations_.start_weights(now_);
  }

  double mean_difference() const { return equations_.mean_difference(now_); }
  void by_squares() { descend(kSquareSteps); }
  /// Returns what is left: the same measure for all starts, if `unit` is.
  double by_power(double unit, int steps) {
    equations_.set_power(kPower, unit);
    return descend(steps);
  }
  void take(Problem& p) {
    take_worst(p, now_);
    equations_.set_power(2, 1);
  }
  Numbers finish(Problem& p, double unit) {
    for (int round = 0; round < kRounds; ++round) {
      if (round < kTakingRounds) take_worst(p, now_);
      equations_.set_power(kPower, unit);
      equations_.balance_lights(now_);
      descend(kLaterSteps);
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

  /// Levenberg and Marquardt's steps, with white as constraints. Returns the sum it comes to.
  double descend(int steps) {
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
          if (little) return best;
        } else {
          damping *= 5;
        }
      }
      if (!better) return best;
    }
    return best;
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

void take_worst(Problem& problem, const Start& start) {
  Fit one(problem, start.wavelengths_nm, start.half_nm);
  for (int round = 0; round < kTakingRounds; ++round) {
    one.by_squares();
    one.take(problem);
  }
}

Numbers fit(Problem& problem, const std::vector<Start>& starts) {
  std::vector<Fit> fits;
  for (const Start& start : starts) {
    fits.emplace_back(problem, start.wavelengths_nm, start.half_nm);
    fits.back().by_squares();
  }
  // What all are measured by.
  double unit = fits.front().mean_difference();
  for (const Fit& one : fits) unit = std::min(unit, one.mean_difference());
  unit = std::max(unit, kMinUnit);
  const auto race = [&](int steps, std::size_t left) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < fits.size(); ++i) order.emplace_back(fits[i].by_power(unit, steps), i);
    std::sort(order.begin(), order.end());
    std::vector<Fit> best;
    for (std::size_t i = 0; i < std::min(left, order.size()); ++i) {
      best.push_back(std::move(fits[order[i].second]));
    }
    fits = std::move(best);
  };
  // The most promising half goes on, then the best.
  race(kPowerSteps, (fits.size() + 1) / 2);
  race(kLaterSteps, 1);
  return fits.front().finish(problem, unit);
}

}  // namespace spectile::plan
