// A small convex quadratic program over a box, by a primal-dual interior-point method.
#include "src/upsampling/quadratic_program.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/eigen.hpp"

namespace spectile {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kIterations = 100;
constexpr double kEqualityTolerance = 1e-12;

Matrix sparse_rows(const std::vector<LinearTerm>& terms, std::size_t variables, Vector& values) {
  Triplets entries;
  values.resize(static_cast<Eigen::Index>(terms.size()));
  for (std::size_t i = 0; i < terms.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = terms[i].value;
    for (const auto& [variable, coefficient] : terms[i].coefficients) {
      entries.emplace_back(static_cast<int>(i), static_cast<int>(variable), coefficient);
    }
  }
  Matrix out(static_cast<Eigen::Index>(terms.size()), static_cast<Eigen::Index>(variables));
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Solves [H + diag(d), A^T; A, 0] [x; y] = [f; g] with refinement.
class KktSystem {
 public:
  KktSystem(const Matrix& h, const Matrix& a) : h_(h), a_(a), n_(h.rows()), m_(a.rows()) {}

  bool factorize(const Vector& diagonal) {
    Triplets entries;
    for (Eigen::Index k = 0; k < n_; ++k) {
      for (Matrix::InnerIterator it(h_, k); it; ++it) entries.emplace_back(it.row(), it.col(), it.value());
      entries.emplace_back(k, k, diagonal[k]);
      for (Matrix::InnerIterator it(a_, k); it; ++it) {
        entries.emplace_back(n_ + it.row(), it.col(), it.value());
        entries.emplace_back(it.col(), n_ + it.row(), it.value());
      }
    }
    kkt_.resize(n_ + m_, n_ + m_);
    kkt_.setFromTriplets(entries.begin(), entries.end());
    kkt_.makeCompressed();
    lu_.compute(kkt_);
    return lu_.info() == Eigen::Success;
  }

  Vector solve(const Vector& right) const {
    Vector x = lu_.solve(right);
    for (int i = 0; i < 2; ++i) x += lu_.solve(right - kkt_ * x);
    return x;
  }

 private:
  const Matrix& h_;
  const Matrix& a_;
  Eigen::Index n_, m_;
  Matrix kkt_;
  Eigen::SparseLU<Matrix> lu_;
};

/// Longest step, at most 1, along `direction` that keeps `v` positive.
double longest_step(const Vector& v, const Vector& direction) {
  double step = 1;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (direction[i] < 0) step = std::min(step, -v[i] / direction[i]);
  }
  return step;
}

/// A point strictly inside the box, the multipliers of the equalities and of the two bounds.
struct State {
  Vector x, y, lower, upper;
  Vector room() const { return Vector::Ones(x.size()) - x; }  // to the upper bound
  double gap() const { return (lower.dot(x) + upper.dot(room())) / static_cast<double>(2 * x.size()); }
};

/// True if the multipliers prove that no point of the box meets the equalities (Farkas): their combination
/// asks for more than it has anywhere.
bool proves_infeasible(const Matrix& a, const Vector& b, const Vector& y) {
  const double size = y.lpNorm<1>();
  if (!(size > 0) || !std::isfinite(size)) return false;
  const Vector combined = a.transpose() * y;
  return b.dot(y) - combined.cwiseMax(0.0).sum() > 1e-9 * size;
}

/// How far a state is from the minimum: 1 is as near as doubles allow.
double residual_ratio(const Vector& primal, const Vector& dual, double gap) {
  return std::max({primal.lpNorm<Eigen::Infinity>() / kEqualityTolerance, gap / 1e-13,
                   dual.lpNorm<Eigen::Infinity>() / 1e-9});
}

// Residual ratio accepted where the steps break down before the minimum: the last of them mostly improve what
// polished() mends anyhow.
constexpr double kNearEnough = 1e5;

/// The state at the minimum, or nothing where the equalities cannot be met.
std::optional<State> interior_point(const Matrix& h, const Vector& g, const Matrix& a, const Vector& b) {
  const Eigen::Index n = h.rows();
  const Eigen::Index m = a.rows();
  State s{Vector::Constant(n, 0.5), Vector::Zero(m), Vector::Ones(n), Vector::Ones(n)};
  KktSystem kkt(h, a);
  std::optional<State> best;
  double best_distance = kNearEnough;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Vector room = s.room();
    const Vector dual = h * s.x - g - a.transpose() * s.y - s.lower + s.upper;
    const Vector primal = a * s.x - b;
    const double gap = s.gap();
    const double distance = residual_ratio(primal, dual, gap);
    if (distance < 1) return s;
    if (distance < best_distance) {
      best = s;
      best_distance = distance;
    }
    if (!best && proves_infeasible(a, b, s.y)) return {};
    if (!kkt.factorize((s.lower.array() / s.x.array() + s.upper.array() / room.array()).matrix())) break;
    // Complementarity products aimed at: those of the predictor, then of the corrector.
    const auto direction = [&](const Vector& at_lower, const Vector& at_upper, State& d) {
      Vector right(n + m);
      right.head(n) = -dual + (at_lower.array() / s.x.array()).matrix() - s.lower -
                      (at_upper.array() / room.array()).matrix() + s.upper;
      right.tail(m) = -primal;
      const Vector solved = kkt.solve(right);
      d.x = solved.head(n);
      d.y = -solved.tail(m);
      d.lower = ((at_lower.array() - s.lower.array() * d.x.array()) / s.x.array()).matrix() - s.lower;
      d.upper = ((at_upper.array() + s.upper.array() * d.x.array()) / room.array()).matrix() - s.upper;
    };
    const auto steps = [&](const State& d) {
      const double to_bounds = std::min(longest_step(s.x, d.x), longest_step(room, -d.x));
      const double to_zero = std::min(longest_step(s.lower, d.lower), longest_step(s.upper, d.upper));
      return std::pair{to_bounds, to_zero};
    };
    State d;
    direction(Vector::Zero(n), Vector::Zero(n), d);
    const auto [predicted_x, predicted_z] = steps(d);
    State predicted{s.x + predicted_x * d.x, s.y, s.lower + predicted_z * d.lower,
                    s.upper + predicted_z * d.upper};
    const double target = gap * std::pow(std::max(0.0, predicted.gap()) / gap, 3);
    const Vector at_lower = (target - d.x.array() * d.lower.array()).matrix();
    const Vector at_upper = (target + d.x.array() * d.upper.array()).matrix();
    direction(at_lower, at_upper, d);
    const auto [step_x, step_z] = steps(d);
    const double damping = 0.995;
    const double ax = std::min(1.0, damping * step_x);
    const double az = std::min(1.0, damping * step_z);
    s.x += ax * d.x;
    s.y += az * d.y;
    s.lower += az * d.lower;
    s.upper += az * d.upper;
    if (!s.x.allFinite() || !s.lower.allFinite() || !s.upper.allFinite()) break;
  }
  return best;
}

/// Puts the variables at a bound onto it and solves for the others, so that the equalities hold to rounding.
Vector polished(const Matrix& h, const Vector& g, const Matrix& a, const Vector& b, const State& s) {
  const Eigen::Index n = h.rows();
  Vector fixed = s.x;
  Vector pin = Vector::Zero(n);
  // A pinned variable gets a diagonal far beyond every other entry of its row.
  constexpr double kPin = 1e18;
  const Vector room = s.room();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (s.lower[i] > s.x[i]) fixed[i] = 0;
    if (s.upper[i] > room[i]) fixed[i] = 1;
    if (s.lower[i] > s.x[i] || s.upper[i] > room[i]) pin[i] = kPin;
  }
  KktSystem kkt(h, a);
  if (!kkt.factorize(pin)) return s.x;
  // Solve for the change from `fixed`, so that the pins need no large right side.
  Vector right(n + a.rows());
  right.head(n) = g - h * fixed;
  right.tail(a.rows()) = b - a * fixed;
  const Vector change = kkt.solve(right).head(n);
  const Vector x = (fixed + change).cwiseMax(0.0).cwiseMin(1.0);
  const bool better = (a * x - b).lpNorm<Eigen::Infinity>() <= kEqualityTolerance &&
                      (x - s.x).lpNorm<Eigen::Infinity>() < 1e-3;
  return better ? x : s.x;
}

}  // namespace

std::optional<std::vector<double>> minimize(const QuadraticProgram& program) {
  Vector values, b;
  const Matrix squares = sparse_rows(program.squares, program.variables, values);
  const Matrix a = sparse_rows(program.equalities, program.variables, b);
  const Matrix h = squares.transpose() * squares;
  const Vector g = squares.transpose() * values;
  const auto state = interior_point(h, g, a, b);
  if (!state) return {};
  const Vector x = polished(h, g, a, b, *state);
  return std::vector<double>(x.data(), x.data() + x.size());
}

}  // namespace spectile
