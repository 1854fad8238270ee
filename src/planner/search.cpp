// Wavelengths by exchange: greedily at first, then each in turn goes where the sum of squared colour
// differences, with the best weights for every light, becomes least.
#include <algorithm>
#include <random>

#include "src/planner/problem.hpp"

namespace spectile::plan {
namespace {

/// Candidate wavelengths: beyond them the eye sees next to nothing. Every second nanometre: the fit
/// moves them anyway, and half the candidates are a quarter of the sums.
constexpr int kFirstCandidateNm = 390;
constexpr int kStepNm = 2;
constexpr Eigen::Index kCandidates = (720 - kFirstCandidateNm) / kStepNm + 1;

double candidate_nm(Eigen::Index candidate) {
  return kFirstCandidateNm + kStepNm * static_cast<double>(candidate);
}

/// Weight of white, in samples.
constexpr double kWhiteSamples = 1e5;
/// Regularizes the weights of neighbouring wavelengths.
constexpr double kRidge = 1e-9;

/// The normal equations of the weights of every candidate, for one light. Each candidate has three unknowns.
class LightEquations {
 public:
  /// Shapes: samples [candidates][N].
  LightEquations(const Problem& p, std::size_t light, const Vector& sample_weights, const Matrix& samples) {
    normal_.resize(3 * kCandidates, 3 * kCandidates);
    const Eigen::Matrix3d root = metrics(p.white[light], p.white[light])[0];
    const Eigen::Matrix3d white = kWhiteSamples * root.transpose() * root;
    Matrix aims = Matrix::Zero(p.samples.count(), 3);
    for (Eigen::Index s = 0; s < kPairs; ++s) {
      const Eigen::Index a = kFirstOf[s];
      const Eigen::Index b = kSecondOf[s];
      const Vector weight = p.squared_metric[light].col(s).cwiseProduct(sample_weights);
      Matrix block = samples * weight.asDiagonal() * samples.transpose();
      block.array() += white(a, b);
      for (Eigen::Index k = 0; k < kCandidates; ++k) {
        for (Eigen::Index l = 0; l < kCandidates; ++l) {
          normal_(3 * k + a, 3 * l + b) = block(k, l);
          normal_(3 * k + b, 3 * l + a) = block(k, l);
        }
      }
      aims.col(a) += weight.cwiseProduct(p.reference[light].row(b).transpose());
      if (a != b) aims.col(b) += weight.cwiseProduct(p.reference[light].row(a).transpose());
    }
    const Matrix right = samples * aims;
    right_.resize(3 * kCandidates);
    const Eigen::Vector3d aim = white * p.white[light];
    for (Eigen::Index k = 0; k < kCandidates; ++k) {
      right_.segment<3>(3 * k) = right.row(k).transpose() + aim;
    }
    normal_.diagonal() *= 1 + kRidge;
  }

  /// Adds to each candidate's gain what it takes from the sum of squares beside those known; returns what
  /// those take.
  double add_gains(const std::vector<Eigen::Index>& known, Vector& gains) const {
    const auto k = static_cast<Eigen::Index>(known.size());
    Matrix inner(3 * k, 3 * k);
    Matrix cross(3 * k, 3 * kCandidates);
    Vector aim(3 * k);
    for (Eigen::Index a = 0; a < k; ++a) {
      const Eigen::Index at = 3 * known[static_cast<std::size_t>(a)];
      cross.middleRows<3>(3 * a) = normal_.middleRows<3>(at);
      aim.segment<3>(3 * a) = right_.segment<3>(at);
      for (Eigen::Index b = 0; b < k; ++b) {
        inner.block<3, 3>(3 * a, 3 * b) = normal_.block<3, 3>(at, 3 * known[static_cast<std::size_t>(b)]);
      }
    }
    const Eigen::LLT<Matrix> factor(inner);
    Vector seen = aim;
    if (k > 0) {
      factor.matrixL().solveInPlace(cross);
      factor.matrixL().solveInPlace(seen);
    }
    const Vector left = right_ - cross.transpose() * seen;
    for (Eigen::Index c = 0; c < kCandidates; ++c) {
      const Eigen::Matrix3d own = normal_.block<3, 3>(3 * c, 3 * c);
      const auto part = cross.middleCols<3>(3 * c);
      Eigen::Matrix3d rest = own - part.transpose() * part;
      rest.diagonal() += 1e-9 * own.diagonal();
      const Eigen::Vector3d d = left.segment<3>(3 * c);
      gains[c] += std::max(0.0, d.dot(rest.ldlt().solve(d)));
    }
    return seen.squaredNorm();
  }

 private:
  Matrix normal_;
  Vector right_;
};

/// The wavelength that helps most beside those known, and what all then take from the sum of squares.
std::pair<Eigen::Index, double> best_addition(const std::vector<LightEquations>& lights,
                                              const std::vector<Eigen::Index>& known) {
  Vector gains = Vector::Zero(kCandidates);
  double taken = 0;
  for (const LightEquations& light : lights) taken += light.add_gains(known, gains);
  for (const Eigen::Index g : known) gains[g] = -1;
  Eigen::Index best = 0;
  const double most = gains.maxCoeff(&best);
  return {best, taken + most};
}

/// Takes each in turn out and puts the best one in, until none moves. Returns what they take.
double exchange_all(const Problem& problem, const std::vector<LightEquations>& lights,
                    std::vector<Eigen::Index>& chosen) {
  constexpr int kSweeps = 30;
  double taken = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool moved = false;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      problem.check();
      const Eigen::Index before = chosen.front();
      chosen.erase(chosen.begin());
      const auto [best, sum] = best_addition(lights, chosen);
      chosen.push_back(best);
      moved = moved || best != before;
      taken = sum;
    }
    if (!moved) break;
  }
  return taken;
}

}  // namespace

std::vector<double> choose_wavelengths(const Problem& problem, std::size_t count, double half_nm,
                                       double synthetic_weight, int guesses) {
  Vector candidates(kCandidates);
  for (Eigen::Index c = 0; c < kCandidates; ++c) candidates[c] = candidate_nm(c);
  const Matrix samples =
      sample_values(problem.samples, candidates, Vector::Constant(kCandidates, half_nm)).transpose();
  Vector sample_weights = problem.sample_weights;
  sample_weights.segment(problem.scene, problem.measured - problem.scene) *= synthetic_weight;
  std::vector<LightEquations> lights;
  for (std::size_t l = 0; l < problem.white.size(); ++l) {
    lights.emplace_back(problem, l, sample_weights, samples);
  }
  std::vector<Eigen::Index> best;
  double most = -1;
  // Deterministic.
  std::mt19937_64 random(7);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  for (int guess = 0; guess < guesses; ++guess) {
    std::vector<Eigen::Index> chosen;
    if (guess == 0) {
      while (chosen.size() < count) chosen.push_back(best_addition(lights, chosen).first);
    } else {
      // Spread evenly, each anywhere within its interval.
      const auto interval = static_cast<std::uint64_t>(kCandidates) / count;
      for (std::uint64_t k = 0; k < count; ++k) {
        chosen.push_back(static_cast<Eigen::Index>(k * interval + random() % interval));
      }
    }
    const double taken = exchange_all(problem, lights, chosen);
    if (taken > most) {
      most = taken;
      best = chosen;
    }
  }
  std::vector<double> out;
  for (const Eigen::Index c : best) out.push_back(candidate_nm(c));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace spectile::plan
