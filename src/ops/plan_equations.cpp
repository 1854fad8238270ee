// The normal equations of a plan's unknowns.
#include "src/ops/plan_equations.hpp"

#include <algorithm>
#include <cmath>

namespace spectile::plan {
namespace {

/// Steps hold white exactly but for what is not linear in it; so many samples' worth keeps that small.
constexpr double kWhiteShare = 1e4;
/// A difference in XYZ of 0.01 is about one in CIEDE2000.
constexpr double kUnitsOfXyz = 1e4;

/// Sizes of weights are held down by this share of the mean metric: noise must not grow.
constexpr double kTame = 1e-6;

/// Differences count to this power: between their mean (1), which leaves a few large ones, and their squares,
/// which spend precision on those few.
constexpr double kPower = 1.5;
/// Largest and least factor of a sample's share.
constexpr double kMostShare = 10;

Matrix scaled(const Matrix& m, const Vector& rows, const Vector& columns) {
  return rows.asDiagonal() * m * columns.asDiagonal();
}

}  // namespace

Equations::Equations(const Problem& p, Eigen::Index k, bool bands)
    : p_(&p), layout_{k, static_cast<Eigen::Index>(p.white.size()), bands} {
  share_ = p.share.replicate(1, layout_.lights);
  light_share_ = Vector::Ones(layout_.lights);
}

Matrix Equations::weights_of(const Numbers& n, Eigen::Index l) const {
  return n.emission.col(l).asDiagonal() * n.sensor;
}

/// The squared metric, with shares, times each row. Shapes: [N][3].
Matrix Equations::pulled(const Matrix& miss, Eigen::Index l) const {
  const Matrix& squared = p_->squared_metric[static_cast<std::size_t>(l)];
  Matrix out = Matrix::Zero(miss.rows(), 3);
  for (Eigen::Index s = 0; s < kPairs; ++s) {
    const Eigen::Index a = kFirstOf[s];
    const Eigen::Index b = kSecondOf[s];
    out.col(a).array() += squared.col(s).array() * miss.col(b).array();
    if (a != b) out.col(b).array() += squared.col(s).array() * miss.col(a).array();
  }
  return share_.col(l).asDiagonal() * out;
}

void Equations::start_weights(Numbers& n) const {
  const Eigen::Index k = layout_.k;
  const Matrix values = values_of(p_->samples, n.lambda, n.half);
  std::vector<Matrix> free;
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    const auto light = static_cast<std::size_t>(l);
    const Eigen::Matrix3d root = metrics(p_->white[light], p_->white[light])[0];
    const Eigen::Matrix3d white = kWhiteShare * root.transpose() * root;
    Matrix normal(3 * k, 3 * k);
    for (Eigen::Index s = 0; s < kPairs; ++s) {
      const Eigen::Index a = kFirstOf[s];
      const Eigen::Index b = kSecondOf[s];
      const Vector weight = p_->squared_metric[light].col(s).cwiseProduct(share_.col(l));
      Matrix block = values.transpose() * weight.asDiagonal() * values;
      block.array() += white(a, b);
      for (Eigen::Index i = 0; i < k; ++i) {
        for (Eigen::Index j = 0; j < k; ++j) {
          normal(3 * i + a, 3 * j + b) = normal(3 * i + b, 3 * j + a) = block(i, j);
        }
      }
    }
    const Matrix aims = values.transpose() * pulled(p_->truth[light].transpose(), l);
    Vector right(3 * k);
    for (Eigen::Index i = 0; i < k; ++i) {
      right.segment<3>(3 * i) = aims.row(i).transpose() + white * p_->white[light];
    }
    // Wavelengths beside each other share one weight evenly.
    normal.diagonal().array() += 1e-8 * normal.diagonal().mean();
    const Vector solved = normal.ldlt().solve(right);
    Matrix weights(k, 3);
    for (Eigen::Index i = 0; i < k; ++i) weights.row(i) = solved.segment<3>(3 * i).transpose();
    free.push_back(std::move(weights));
  }
  n.sensor = free[0];
  n.emission = Matrix::Ones(k, layout_.lights);
  if (layout_.lights == 1) return;
  for (Eigen::Index i = 0; i < k; ++i) {
    Matrix all(3, layout_.lights);
    for (Eigen::Index l = 0; l < layout_.lights; ++l) {
      all.col(l) = free[static_cast<std::size_t>(l)].row(i).transpose();
    }
    const Eigen::JacobiSVD<Matrix> svd(all, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const double size = std::sqrt(svd.singularValues()[0]);
    const double sign = svd.matrixV().col(0).sum() < 0 ? -1 : 1;
    n.emission.row(i) = sign * size * svd.matrixV().col(0).transpose();
    n.sensor.row(i) = sign * size * svd.matrixU().col(0).transpose();
  }
}

double Equations::tame() const {
  return kTame * share_.sum() / static_cast<double>(layout_.lights);
}

double Equations::cost(const Numbers& n) const {
  const Matrix values = values_of(p_->samples, n.lambda, n.half);
  double sum = kWhiteShare * kUnitsOfXyz * white_miss(n, nullptr).squaredNorm();
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    const Matrix weights = weights_of(n, l);
    const Matrix miss = values * weights - p_->truth[static_cast<std::size_t>(l)].transpose();
    sum += miss.cwiseProduct(pulled(miss, l)).sum() + tame() * weights.squaredNorm();
  }
  return sum;
}

void Equations::build(const Numbers& n, Matrix& normal, Vector& right) const {
  normal = Matrix::Zero(layout_.unknowns(), layout_.unknowns());
  right = Vector::Zero(layout_.unknowns());
  const Slopes slopes = slopes_of(p_->samples, n.lambda, n.half);
  for (Eigen::Index l = 0; l < layout_.lights; ++l) add_light(n, l, slopes, normal, right);
  // The lower half follows from the upper.
  normal.triangularView<Eigen::StrictlyLower>() = normal.transpose();
  add_tame(n, normal, right);
}

/// Adds a light's part, above the diagonal and on it. A sample's miss depends on three kinds of unknowns of a
/// wavelength: on where and how wide it is, by slope times emission times the sensor's row; on the sensor's
/// weights, by value times emission; on emission, by value times the sensor's row. So all sums are those of
/// products of values and slopes, six times, for the six pairs of XYZ in the squared metric.
void Equations::add_light(const Numbers& n, Eigen::Index l, const Slopes& s, Matrix& normal,
                          Vector& right) const {
  const auto light = static_cast<std::size_t>(l);
  const Layout& at = layout_;
  const Eigen::Index k = at.k;
  const Vector e = n.emission.col(l);
  const Vector ones = Vector::Ones(k);
  // What multiplies the sensor's row, and where its unknowns begin.
  struct Part {
    const Matrix* slopes;
    Eigen::Index first;
    Vector factor;
  };
  std::vector<Part> parts = {{&s.by_lambda, at.lambda(0), e}};
  if (at.bands) parts.push_back({&s.by_half, at.half(0), e});
  if (at.lights > 1) parts.push_back({&s.values, at.emission(l, 0), ones});

  for (Eigen::Index pair = 0; pair < kPairs; ++pair) {
    const Vector weight = p_->squared_metric[light].col(pair).cwiseProduct(share_.col(l));
    const Eigen::Index a = kFirstOf[pair];
    const Eigen::Index b = kSecondOf[pair];
    const int orders = a == b ? 1 : 2;
    const Matrix weighed = weight.asDiagonal() * s.values;
    const Matrix values = scaled(s.values.transpose() * weighed, e, e);
    for (int order = 0; order < orders; ++order) {
      const Eigen::Index x = order == 0 ? a : b;
      const Eigen::Index y = order == 0 ? b : a;
      for (Eigen::Index i = 0; i < k; ++i) {
        for (Eigen::Index j = 0; j < k; ++j) {
          if (at.sensor(i, x) <= at.sensor(j, y)) normal(at.sensor(i, x), at.sensor(j, y)) += values(i, j);
        }
      }
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Part& part = parts[p];
      const Matrix cross = part.slopes->transpose() * weighed;
      for (int order = 0; order < orders; ++order) {
        const Eigen::Index x = order == 0 ? a : b;
        const Eigen::Index y = order == 0 ? b : a;
        const Matrix with_sensor = scaled(cross, part.factor.cwiseProduct(n.sensor.col(x)), e);
        for (Eigen::Index i = 0; i < k; ++i) {
          for (Eigen::Index j = 0; j < k; ++j) {
            const Eigen::Index row = std::min(part.first + i, at.sensor(j, y));
            normal(row, std::max(part.first + i, at.sensor(j, y))) += with_sensor(i, j);
          }
        }
      }
      for (std::size_t q = p; q < parts.size(); ++q) {
        const Part& other = parts[q];
        const Matrix both = part.slopes->transpose() * (weight.asDiagonal() * *other.slopes);
        for (int order = 0; order < orders; ++order) {
          const Eigen::Index x = order == 0 ? a : b;
          const Eigen::Index y = order == 0 ? b : a;
          normal.block(part.first, other.first, k, k) += scaled(
              both, part.factor.cwiseProduct(n.sensor.col(x)), other.factor.cwiseProduct(n.sensor.col(y)));
        }
      }
    }
  }
  const Matrix miss = s.values * weights_of(n, l) - p_->truth[light].transpose();
  const Matrix pull = pulled(miss, l);
  const Matrix on_values = s.values.transpose() * pull;
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) right[at.sensor(i, c)] += e[i] * on_values(i, c);
  }
  for (const Part& part : parts) {
    const Matrix on_slopes = part.slopes->transpose() * pull;
    right.segment(part.first, k) +=
        part.factor.cwiseProduct(on_slopes.cwiseProduct(n.sensor).rowwise().sum());
  }
}

/// Adds what holds down the sizes of products of sensor weights and emission values.
void Equations::add_tame(const Numbers& n, Matrix& normal, Vector& right) const {
  const Layout& at = layout_;
  const double by = tame();
  for (Eigen::Index i = 0; i < at.k; ++i) {
    for (Eigen::Index l = 0; l < at.lights; ++l) {
      const double e = n.emission(i, l);
      for (Eigen::Index c = 0; c < 3; ++c) {
        const double s = n.sensor(i, c);
        normal(at.sensor(i, c), at.sensor(i, c)) += by * e * e;
        right[at.sensor(i, c)] += by * e * e * s;
        if (at.lights == 1) continue;
        normal(at.emission(l, i), at.emission(l, i)) += by * s * s;
        right[at.emission(l, i)] += by * s * s * e;
      }
    }
  }
}

Vector Equations::white_miss(const Numbers& n, Matrix* slopes) const {
  const Layout& at = layout_;
  Vector out(3 * at.lights);
  if (slopes != nullptr) *slopes = Matrix::Zero(3 * at.lights, at.unknowns());
  for (Eigen::Index l = 0; l < at.lights; ++l) {
    const Eigen::Vector3d sum = weights_of(n, l).colwise().sum().transpose();
    out.segment<3>(3 * l) = sum - p_->white[static_cast<std::size_t>(l)];
    for (Eigen::Index i = 0; slopes != nullptr && i < at.k; ++i) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        (*slopes)(3 * l + c, at.sensor(i, c)) = n.emission(i, l);
        if (at.lights > 1) (*slopes)(3 * l + c, at.emission(l, i)) = n.sensor(i, c);
      }
    }
  }
  return out;
}

void Equations::weigh_by_difference(const Numbers& n) {
  Matrix all(p_->measured, layout_.lights);
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    const auto light = static_cast<std::size_t>(l);
    const auto one = differences(p_->truth[light].leftCols(p_->measured),
                                 predict(p_->samples, n, l).leftCols(p_->measured), p_->white[light]);
    all.col(l) = Eigen::Map<const Vector>(one.data(), p_->measured);
  }
  const double mean = all.mean();
  if (!(mean > 0)) return;
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    light_share_[l] *= all.col(l).mean() / mean;
    for (Eigen::Index i = 0; i < p_->measured; ++i) {
      const double factor = std::pow(all(i, l) / mean, kPower - 2);
      share_(i, l) = light_share_[l] * p_->share[i] * std::clamp(factor, 1 / kMostShare, kMostShare);
    }
  }
}

}  // namespace spectile::plan
