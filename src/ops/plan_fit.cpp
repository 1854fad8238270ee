// Fitting a plan: wavelengths, sensor weights and emission values to the least squares of colour differences.
#include <algorithm>
#include <cmath>

#include "src/ops/plan_problem.hpp"

namespace spectile::plan {
namespace {

/// Steps hold white exactly but for what is not linear in it; so many samples' worth keeps that small.
constexpr double kWhiteShare = 1e4;

/// Sizes of weights are held down by this share of the mean metric: noise must not grow.
constexpr double kTame = 1e-4;

/// Wavelengths stay at least this far apart and within the visible.
constexpr double kApartNm = 2;
constexpr double kLowestNm = 385;
constexpr double kHighestNm = 725;

/// Unknowns in a row: wavelengths, sensor weights (wavelength by wavelength), emission values (light by
/// light; none with one light, whose values are 1).
class Fit {
 public:
  Fit(const Problem& p, const std::vector<double>& start)
      : p_(p),
        k_(static_cast<Eigen::Index>(start.size())),
        lights_(static_cast<Eigen::Index>(p.weights.size())) {
    now_.lambda = Eigen::Map<const Vector>(start.data(), k_);
    now_.emission = Matrix::Ones(k_, lights_);
    share_ = p.share;
    start_weights();
  }

  Numbers run() {
    // From squares of differences to the differences themselves, round by round: their mean is what counts.
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
      descend(round == 0 ? 40 : 15);
      if (round + 1 < kRounds) weigh_by_difference();
    }
    make_white_exact();
    return now_;
  }

 private:
  Eigen::Index unknowns() const { return 4 * k_ + (lights_ > 1 ? lights_ * k_ : 0); }
  Eigen::Index at_sensor(Eigen::Index k, Eigen::Index c) const { return k_ + 3 * k + c; }
  Eigen::Index at_emission(Eigen::Index l, Eigen::Index k) const { return 4 * k_ + l * k_ + k; }

  /// Weights of each light for itself by least squares; of several lights their best common sensor.
  void start_weights() {
    Matrix values(p_.samples.cols(), k_);
    for (Eigen::Index k = 0; k < k_; ++k) values.col(k) = samples_at(p_.samples, now_.lambda[k]);
    std::vector<Matrix> free;
    for (Eigen::Index l = 0; l < lights_; ++l) {
      const auto light = static_cast<std::size_t>(l);
      Matrix normal = Matrix::Zero(3 * k_, 3 * k_);
      Vector right = Vector::Zero(3 * k_);
      const auto add = [&](const Vector& v, const Eigen::Matrix3d& metric, const Eigen::Vector3d& target,
                           double share) {
        const Eigen::Matrix3d square = share * metric.transpose() * metric;
        const Eigen::Vector3d aim = square * target;
        for (Eigen::Index a = 0; a < k_; ++a) {
          right.segment<3>(3 * a) += v[a] * aim;
          for (Eigen::Index b = 0; b < k_; ++b) normal.block<3, 3>(3 * a, 3 * b) += v[a] * v[b] * square;
        }
      };
      for (Eigen::Index i = 0; i < p_.samples.cols(); ++i) {
        add(values.row(i), p_.metric[light][static_cast<std::size_t>(i)], p_.truth[light].col(i), share_[i]);
      }
      add(Vector::Ones(k_), metrics(p_.white[light], p_.white[light])[0], p_.white[light], kWhiteShare);
      normal.diagonal().array() += kTame * normal.diagonal().mean() * 1e-4;
      const Vector solved = normal.ldlt().solve(right);
      Matrix weights(k_, 3);
      for (Eigen::Index k = 0; k < k_; ++k) weights.row(k) = solved.segment<3>(3 * k).transpose();
      free.push_back(weights);
    }
    now_.sensor = free[0];
    if (lights_ == 1) return;
    for (Eigen::Index k = 0; k < k_; ++k) {
      Matrix all(3, lights_);
      for (Eigen::Index l = 0; l < lights_; ++l)
        all.col(l) = free[static_cast<std::size_t>(l)].row(k).transpose();
      const Eigen::JacobiSVD<Matrix> svd(all, Eigen::ComputeThinU | Eigen::ComputeThinV);
      Vector emission = svd.matrixV().col(0) * std::sqrt(svd.singularValues()[0]);
      Eigen::Vector3d sensor = svd.matrixU().col(0) * std::sqrt(svd.singularValues()[0]);
      if (emission.sum() < 0) {
        emission = -emission;
        sensor = -sensor;
      }
      now_.emission.row(k) = emission.transpose();
      now_.sensor.row(k) = sensor.transpose();
    }
  }

  /// Adds a light's residuals and derivatives to the normal equations; returns the sum of squares. Without
  /// equations it only adds up.
  double light_sums(const Numbers& n, Eigen::Index l, Matrix* normal, Vector* right) const {
    const auto light = static_cast<std::size_t>(l);
    const Eigen::Index count = p_.samples.cols();
    Matrix values(count, k_);
    Matrix slopes(count, k_);
    for (Eigen::Index k = 0; k < k_; ++k) {
      values.col(k) = samples_at(p_.samples, n.lambda[k]);
      if (normal != nullptr) slopes.col(k) = slopes_at(p_.samples, n.lambda[k]);
    }
    const Eigen::Index local = 5 * k_;
    Matrix rows = Matrix::Zero(3 * count, normal != nullptr ? local : 0);
    Vector residuals(3 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Matrix3d metric = std::sqrt(share_[i]) * p_.metric[light][static_cast<std::size_t>(i)];
      Eigen::Vector3d miss = -p_.truth[light].col(i);
      for (Eigen::Index k = 0; k < k_; ++k)
        miss += values(i, k) * n.emission(k, l) * n.sensor.row(k).transpose();
      residuals.segment<3>(3 * i) = metric * miss;
      if (normal == nullptr) continue;
      for (Eigen::Index k = 0; k < k_; ++k) {
        const Eigen::Vector3d seen = metric * n.sensor.row(k).transpose();
        rows.block<3, 1>(3 * i, k) = slopes(i, k) * n.emission(k, l) * seen;
        rows.block<3, 3>(3 * i, k_ + 3 * k) = values(i, k) * n.emission(k, l) * metric;
        rows.block<3, 1>(3 * i, 4 * k_ + k) = values(i, k) * seen;
      }
    }
    if (normal != nullptr) {
      Matrix square = Matrix::Zero(local, local);
      square.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
      square = Matrix(square.selfadjointView<Eigen::Lower>());
      const Vector slope = rows.transpose() * residuals;
      const Eigen::Index common = 4 * k_;
      normal->topLeftCorner(common, common) += square.topLeftCorner(common, common);
      right->head(common) += slope.head(common);
      if (lights_ > 1) {
        const Eigen::Index own = at_emission(l, 0);
        normal->block(own, 0, k_, common) += square.block(common, 0, k_, common);
        normal->block(0, own, common, k_) += square.block(0, common, common, k_);
        normal->block(own, own, k_, k_) += square.block(common, common, k_, k_);
        right->segment(own, k_) += slope.tail(k_);
      }
    }
    return residuals.squaredNorm();
  }

  /// By how much white is missed, a light after the other, and how that depends on the unknowns.
  Vector white_miss(const Numbers& n, Matrix* slopes) const {
    Vector out(3 * lights_);
    if (slopes != nullptr) *slopes = Matrix::Zero(3 * lights_, unknowns());
    for (Eigen::Index l = 0; l < lights_; ++l) {
      Eigen::Vector3d sum = -p_.white[static_cast<std::size_t>(l)];
      for (Eigen::Index k = 0; k < k_; ++k) {
        sum += n.emission(k, l) * n.sensor.row(k).transpose();
        for (Eigen::Index c = 0; slopes != nullptr && c < 3; ++c) {
          (*slopes)(3 * l + c, at_sensor(k, c)) = n.emission(k, l);
          if (lights_ > 1) (*slopes)(3 * l + c, at_emission(l, k)) = n.sensor(k, c);
        }
      }
      out.segment<3>(3 * l) = sum;
    }
    return out;
  }

  double tame_sum(const Numbers& n) const {
    double sum = 0;
    for (Eigen::Index l = 0; l < lights_; ++l) {
      for (Eigen::Index k = 0; k < k_; ++k) {
        sum += (n.sensor.row(k) * n.emission(k, l)).squaredNorm();
      }
    }
    return tame() * sum;
  }
  double tame() const { return kTame * share_.sum(); }

  double cost(const Numbers& n) const {
    // A difference in XYZ of 0.01 is about one in CIEDE2000.
    double sum = tame_sum(n) + kWhiteShare * 1e4 * white_miss(n, nullptr).squaredNorm();
    for (Eigen::Index l = 0; l < lights_; ++l) sum += light_sums(n, l, nullptr, nullptr);
    return sum;
  }

  Numbers moved(const Vector& step) const {
    Numbers out = now_;
    for (Eigen::Index k = 0; k < k_; ++k) {
      out.lambda[k] = std::clamp(out.lambda[k] + std::clamp(step[k], -6.0, 6.0), kLowestNm, kHighestNm);
      for (Eigen::Index c = 0; c < 3; ++c) out.sensor(k, c) += step[at_sensor(k, c)];
      for (Eigen::Index l = 0; lights_ > 1 && l < lights_; ++l) out.emission(k, l) += step[at_emission(l, k)];
    }
    for (Eigen::Index k = 1; k < k_; ++k)
      out.lambda[k] = std::max(out.lambda[k], out.lambda[k - 1] + kApartNm);
    return out;
  }

  /// Levenberg and Marquardt's steps.
  void descend(int steps) {
    double damping = 1e-3;
    double best = cost(now_);
    for (int step = 0; step < steps && damping < 1e8; ++step) {
      Matrix normal = Matrix::Zero(unknowns(), unknowns());
      Vector right = Vector::Zero(unknowns());
      for (Eigen::Index l = 0; l < lights_; ++l) light_sums(now_, l, &normal, &right);
      for (Eigen::Index k = 0; k < k_; ++k) {
        for (Eigen::Index l = 0; l < lights_; ++l) {
          const double e = now_.emission(k, l);
          for (Eigen::Index c = 0; c < 3; ++c) {
            const double s = now_.sensor(k, c);
            normal(at_sensor(k, c), at_sensor(k, c)) += tame() * e * e;
            right[at_sensor(k, c)] += tame() * e * e * s;
            if (lights_ == 1) continue;
            normal(at_emission(l, k), at_emission(l, k)) += tame() * s * s;
            right[at_emission(l, k)] += tame() * s * s * e;
          }
        }
      }
      Matrix slopes;
      const Vector miss = white_miss(now_, &slopes);
      bool better = false;
      for (int attempt = 0; attempt < 8 && !better; ++attempt) {
        // [normal + damping, slopes^T; slopes, 0] [step; multipliers] = [-right; -miss]
        const Eigen::Index all = unknowns() + 3 * lights_;
        Matrix system = Matrix::Zero(all, all);
        system.topLeftCorner(unknowns(), unknowns()) = normal;
        system.diagonal().head(unknowns()) +=
            damping * normal.diagonal() + Vector::Constant(unknowns(), 1e-12 * normal.diagonal().mean());
        const double scale = normal.diagonal().mean();
        system.bottomLeftCorner(3 * lights_, unknowns()) = scale * slopes;
        system.topRightCorner(unknowns(), 3 * lights_) = scale * slopes.transpose();
        system.diagonal().tail(3 * lights_).setConstant(-1e-9 * scale);
        Vector aim(all);
        aim << -right, -scale * miss;
        const Numbers next = moved(system.partialPivLu().solve(aim).head(unknowns()));
        const double sum = cost(next);
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

  /// Least squares with shares of one over the difference are least differences.
  void weigh_by_difference() {
    Vector worst = Vector::Zero(p_.measured);
    for (Eigen::Index l = 0; l < lights_; ++l) {
      const auto light = static_cast<std::size_t>(l);
      const Matrix got = predict(p_.samples.leftCols(p_.measured), now_, l);
      const auto d = differences(p_.truth[light].leftCols(p_.measured), got, p_.white[light]);
      for (Eigen::Index i = 0; i < p_.measured; ++i)
        worst[i] = std::max(worst[i], d[static_cast<std::size_t>(i)]);
    }
    const double mean = worst.mean();
    for (Eigen::Index i = 0; i < p_.measured; ++i) {
      share_[i] = std::clamp(mean / worst[i], 0.1, 10.0);
    }
  }

  /// Newton's steps of least length to the white of every light.
  void make_white_exact() {
    for (int step = 0; step < 20; ++step) {
      Matrix slopes;
      const Vector miss = white_miss(now_, &slopes);
      if (miss.cwiseAbs().maxCoeff() < 1e-15) return;
      now_ = moved(-slopes.completeOrthogonalDecomposition().solve(miss));
    }
  }

  const Problem& p_;
  Eigen::Index k_;
  Eigen::Index lights_;
  Numbers now_;
  Vector share_;
};

}  // namespace

Numbers fit(const Problem& problem, const std::vector<double>& start) {
  return Fit(problem, start).run();
}

}  // namespace spectile::plan
