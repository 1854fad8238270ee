// Fitting a plan: wavelengths, widths, sensor weights and emission values such that colour differences are
// minimal.
#include <algorithm>

#include "src/planner/equations.hpp"

namespace spectile::plan {
namespace {

/// Wavelengths stay within the visible, bands no narrower and no wider than this, and all at least so far
/// apart.
constexpr double kLowestNm = 385;
constexpr double kHighestNm = 725;
constexpr double kApartNm = 2;
constexpr double kNarrowestNm = 2;
constexpr double kWidestNm = 120;
/// Longest step of a wavelength or width.
constexpr double kLongestNm = 6;

/// Differences count to this power at last: between their mean (1), which leaves a few large ones, and their
/// squares, which spend precision on those few.
constexpr double kPower = 1.5;

/// Steps by squares and by the power itself before initial guesses are compared, of those that are left then,
/// and of each round of the best: lights are balanced before each, and the worst products added before the
/// first few.
constexpr int kSquareSteps = 8;
constexpr int kPowerSteps = 8;
constexpr int kLaterSteps = 15;
constexpr int kRounds = 6;
constexpr int kProductRounds = 4;

/// Where all colours are met there is still something to divide by.
constexpr double kMinUnit = 1e-6;

class Fit {
 public:
  Fit(const Problem& p, const InitialGuess& guess)
      : equations_(p, static_cast<Eigen::Index>(guess.wavelengths_nm.size()), guess.half_nm > 0),
        check_(&p.check),
        apart_(p.apart) {
    now_.lambda = Eigen::Map<const Vector>(guess.wavelengths_nm.data(), equations_.layout().k);
    now_.half = Vector::Constant(now_.lambda.size(), guess.half_nm);
    keep_apart(now_);
    equations_.initial_weights(now_);
  }

  double mean_difference() const { return equations_.mean_difference(now_); }
  void by_squares() { minimize(kSquareSteps); }
  /// Returns the loss, on the same scale for all fits of one `unit`.
  double by_power(double unit, int steps) {
    equations_.set_power(kPower, unit);
    return minimize(steps);
  }
  void add_worst(Problem& p) {
    add_worst_products(p, now_);
    equations_.set_power(2, 1);
  }
  Parameters finish(Problem& p, double unit) {
    for (int round = 0; round < kRounds; ++round) {
      if (round < kProductRounds) add_worst_products(p, now_);
      equations_.set_power(kPower, unit);
      equations_.balance_lights(now_);
      minimize(kLaterSteps);
    }
    make_white_exact();
    return now_;
  }

 private:
  /// Where bands are to be apart, those that overlap divide the distance between their centres.
  void keep_apart(Parameters& n) const {
    const bool bands = equations_.layout().bands;
    for (Eigen::Index k = 0; k < n.lambda.size(); ++k) {
      n.lambda[k] = std::clamp(n.lambda[k], kLowestNm, kHighestNm);
      const double apart = bands ? kNarrowestNm : kApartNm;
      if (k > 0) n.lambda[k] = std::max(n.lambda[k], n.lambda[k - 1] + apart);
    }
    if (!bands) return;
    for (Eigen::Index k = 0; k < n.half.size(); ++k) {
      // Within the observers' range, beyond which there is no table.
      const double widest = std::min({kWidestNm / 2, n.lambda[k] - kFirstNm, kLastNm - n.lambda[k]});
      n.half[k] = std::clamp(n.half[k], kNarrowestNm / 2, widest);
    }
    if (!apart_) return;
    for (Eigen::Index k = 1; k < n.half.size(); ++k) {
      const double room = n.lambda[k] - n.lambda[k - 1];
      const double taken = n.half[k] + n.half[k - 1];
      if (taken <= room) continue;
      n.half[k - 1] *= room / taken;
      n.half[k] *= room / taken;
    }
  }

  Parameters moved(const Vector& step) const {
    const Layout& at = equations_.layout();
    Parameters out = now_;
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
  double minimize(int steps) {
    const Layout& at = equations_.layout();
    double damping = 1e-3;
    double best = equations_.cost(now_);
    for (int step = 0; step < steps && damping < 1e8; ++step) {
      (*check_)();
      Matrix normal;
      Vector right;
      equations_.build(now_, normal, right);
      Matrix white;
      const Vector residual = equations_.white_residual(now_, &white);
      bool better = false;
      for (int attempt = 0; attempt < 8 && !better; ++attempt) {
        // [normal + damping, white^T; white, 0] [step; multipliers] = [-right; -residual]
        const Eigen::Index own = at.unknowns();
        const Eigen::Index all = own + residual.size();
        const double scale = normal.diagonal().mean();
        Matrix system = Matrix::Zero(all, all);
        system.topLeftCorner(own, own) = normal;
        system.diagonal().head(own) += damping * normal.diagonal() + Vector::Constant(own, 1e-12 * scale);
        system.bottomLeftCorner(residual.size(), own) = scale * white;
        system.topRightCorner(own, residual.size()) = scale * white.transpose();
        system.diagonal().tail(residual.size()).setConstant(-1e-9 * scale);
        Vector aim(all);
        aim << -right, -scale * residual;
        const Parameters next = moved(system.partialPivLu().solve(aim).head(own));
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
      const Vector residual = equations_.white_residual(now_, &slopes);
      if (residual.cwiseAbs().maxCoeff() < 1e-15) return;
      now_ = moved(-slopes.completeOrthogonalDecomposition().solve(residual));
    }
  }

  Equations equations_;
  const std::function<void()>* check_;  // the problem's
  bool apart_;                          // its bands
  Parameters now_;
};

}  // namespace

void add_worst_products(Problem& problem, const InitialGuess& guess) {
  Fit one(problem, guess);
  for (int round = 0; round < kProductRounds; ++round) {
    one.by_squares();
    one.add_worst(problem);
  }
}

Parameters fit(Problem& problem, const std::vector<InitialGuess>& guesses) {
  std::vector<Fit> fits;
  for (const InitialGuess& guess : guesses) {
    fits.emplace_back(problem, guess);
    fits.back().by_squares();
  }
  // One unit for all.
  double unit = fits.front().mean_difference();
  for (const Fit& one : fits) unit = std::min(unit, one.mean_difference());
  unit = std::max(unit, kMinUnit);
  // Successive halving: the most promising half goes on, then the best.
  const auto keep_best = [&](int steps, std::size_t left) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < fits.size(); ++i) order.emplace_back(fits[i].by_power(unit, steps), i);
    std::sort(order.begin(), order.end());
    std::vector<Fit> best;
    for (std::size_t i = 0; i < std::min(left, order.size()); ++i) {
      best.push_back(std::move(fits[order[i].second]));
    }
    fits = std::move(best);
  };
  keep_best(kPowerSteps, (fits.size() + 1) / 2);
  keep_best(kLaterSteps, 1);
  return fits.front().finish(problem, unit);
}

}  // namespace spectile::plan
