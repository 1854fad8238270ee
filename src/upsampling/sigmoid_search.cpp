// Sigmoid coefficients of one colour in double, with derivatives.
#include "src/upsampling/sigmoid_search.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/abi.hpp"

namespace spectile {
namespace {

constexpr double kTolerance = 1e-12;

Triple difference(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double squared(const Triple& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}
double largest(const Triple& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

}  // namespace

SigmoidSums::SigmoidSums(const Bands& bands, const WorkingSpace& space, const SigmoidFunctions& functions)
    : quadratic_(functions.are_quadratic()) {
  for (std::size_t b = 0; b < bands.count(); ++b) {
    at_.push_back(functions.at(bands[b].centre_nm));
    weights_.push_back({space.weights[b][0] * space.white[b], space.weights[b][1] * space.white[b],
                        space.weights[b][2] * space.white[b]});
  }
}

namespace {

/// Half of 1 + x r, r = 1 / sqrt(1 + x^2), from the side where nothing cancels.
double sigmoid(double x, double r) {
  return x < 0 ? 0.5 * r * r / (1 - x * r) : 0.5 + 0.5 * x * r;
}

}  // namespace

void SigmoidSums::samples(const Triple& c, double* out) const {
  for (std::size_t b = 0; b < at_.size(); ++b) {
    const double x = argument(c, b);
    out[b] = sigmoid(x, 1 / std::sqrt(1 + x * x));
  }
}

Triple SigmoidSums::at(const Triple& c, Matrix3& jacobian) const {
  Triple sums{};
  jacobian = {};
  for (std::size_t b = 0; b < at_.size(); ++b) {
    const auto& [p, q] = at_[b];
    const double x = argument(c, b);
    const double r = 1 / std::sqrt(1 + x * x);
    const double sample = sigmoid(x, r);
    const double slope = 0.5 * r * r * r;
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = weights_[b][k];
      sums[k] += w * sample;
      const double by_q = w * slope * q;
      jacobian[3 * k] += quadratic_ ? by_q * q : w * slope * p;
      jacobian[3 * k + 1] += by_q;
      jacobian[3 * k + 2] += w * slope;
    }
  }
  return sums;
}

std::array<Matrix3, 3> SigmoidSums::second(const Triple& c) const {
  std::array<Matrix3, 3> out{};
  for (std::size_t b = 0; b < at_.size(); ++b) {
    const auto& [p, q] = at_[b];
    const double x = argument(c, b);
    const double r2 = 1 / (1 + x * x);
    const double bend = -1.5 * x * r2 * r2 * std::sqrt(r2);
    const double power[3] = {p, q, 1};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 9; ++i) {
        out[k][i] += weights_[b][k] * bend * power[i / 3] * power[i % 3];
      }
    }
  }
  return out;
}

bool SigmoidSums::solve(const Triple& rgb, Triple& c, int trials) const {
  Matrix3 j;
  Triple left = difference(rgb, at(c, j));
  double damping = 1e-6;
  for (int trial = 0; trial < trials && largest(left) > kTolerance; ++trial) {
    Matrix3 normal{};
    Triple gradient{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t b = 0; b < 3; ++b) normal[3 * a + b] += j[3 * k + a] * j[3 * k + b];
        gradient[a] += j[3 * k + a] * left[k];
      }
    }
    Matrix3 damped = normal;
    for (std::size_t a = 0; a < 3; ++a) damped[4 * a] += damping * normal[4 * a];
    const Triple move = times(inverse(damped), gradient);
    const Triple there = {c[0] + move[0], c[1] + move[1], c[2] + move[2]};
    Matrix3 j_there;
    const Triple left_there = difference(rgb, at(there, j_there));
    if (squared(left_there) < squared(left)) {
      c = there;
      left = left_there;
      j = j_there;
      damping = std::max(0.1 * damping, 1e-18);
    } else {
      damping = std::max(10 * damping, 1e-12);
      if (damping > 1e12) break;
    }
  }
  return largest(left) < 1e-9;
}

double SigmoidSums::continue_from_grey(const Triple& rgb, double grey, Triple& c) const {
  constexpr double kShortest = 0x1p-10;
  constexpr int kTrials = 20;
  c = {0, 0, (grey - 0.5) / std::sqrt(grey * (1 - grey))};
  const double steep = static_cast<double>(kernels::kSigmoidSteep) / std::sqrt(std::min(grey, 1 - grey));
  const auto goal = [&](double part) {
    Triple out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = grey + part * (rgb[k] - grey);
    return out;
  };
  double part = 0;
  for (double ahead = 0.25; part < 1 && ahead >= kShortest;) {
    const double next = std::min(1.0, part + ahead);
    Triple trial = c;
    const bool met = solve(goal(next), trial, kTrials);
    if (met && std::abs(trial[0]) + std::abs(trial[1]) + std::abs(trial[2]) <= steep) {
      c = trial;
      part = next;
      ahead *= 2;
    } else {
      ahead *= 0.25;
    }
  }
  return part;
}

bool SigmoidSums::find(const Triple& rgb, const Triple& luminance, Triple& c) const {
  constexpr int kTrials = 30;  // from near by
  if (solve(rgb, c, kTrials)) return true;
  const double grey = luminance[0] * rgb[0] + luminance[1] * rgb[1] + luminance[2] * rgb[2];
  return grey > 0 && grey < 1 && continue_from_grey(rgb, grey, c) == 1 && solve(rgb, c);
}

bool SigmoidSums::solve_from_grey(const Triple& rgb, Triple& c) const {
  c = {0, 0, 0};
  if (solve(rgb, c)) return true;
  c = {0, 0, 0};
  double done = 0;
  for (double step = 0.1; done < 1;) {
    const double next = std::min(1.0, done + step);
    Triple between;
    for (std::size_t k = 0; k < 3; ++k) between[k] = 0.5 + next * (rgb[k] - 0.5);
    Triple trial = c;
    if (solve(between, trial)) {
      c = trial;
      done = next;
      step *= 1.5;
    } else {
      step *= 0.5;
      if (step < 1e-4) return false;
    }
  }
  return true;
}

}  // namespace spectile
