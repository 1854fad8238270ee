// The normal equations of a plan's unknowns.
#include "src/planner/equations.hpp"

#include <cmath>

namespace spectile::plan {
namespace {

/// Steps hold white exactly but for what is not linear in it; so many samples' worth keeps that small.
constexpr double kWhiteWeight = 1e4;
/// A difference in XYZ of 0.01 is about one in CIEDE2000.
constexpr double kUnitsOfXyz = 1e4;

/// Ridge regularization of the weights, relative to the mean metric: noise must not grow.
constexpr double kRegularization = 1e-6;

/// Differences below this fraction of the unit count as squares, which have a slope of zero at none.
constexpr double kSmall = 0.1;

}  // namespace

Equations::Equations(const Problem& p, Eigen::Index k, bool bands)
    : p_(&p), layout_{k, static_cast<Eigen::Index>(p.white.size()), bands} {
  light_weights_ = Vector::Ones(layout_.lights);
  update_weights();
}

void Equations::update_weights() {
  sample_weights_ = p_->sample_weights.replicate(1, layout_.lights);
  sample_weights_.topRows(p_->measured) *= light_weights_.asDiagonal();
}

void Equations::set_power(double power, double unit) {
  power_ = power;
  unit_ = unit;
  update_weights();
}

Matrix Equations::color_weights(const Parameters& n, Eigen::Index l) const {
  return n.emission.col(l).asDiagonal() * n.sensor;
}

Matrix Equations::residuals(const Matrix& values, const Parameters& n, Eigen::Index l) const {
  return values * color_weights(n, l) - p_->reference[static_cast<std::size_t>(l)].transpose();
}

/// A sample whose squared difference is q = residual' S residual adds unit^2 (q / unit^2 + small^2)^(power /
/// 2). With f for half its derivative by q, and g for half the second, half its derivatives by the residual
/// are 2 f S residual and 2 f S + 4 g (S residual) (S residual)'. Smooth deviations, which are no colours,
/// count as squares.
Equations::RobustLoss Equations::robust_loss(const Matrix& residual, Eigen::Index l, bool derivatives) const {
  const Matrix& squared = p_->squared_metric[static_cast<std::size_t>(l)];
  const double unit = unit_ * unit_;
  RobustLoss out;
  if (derivatives) {
    out.gradient.resize(residual.rows(), 3);
    out.metric.resize(residual.rows(), kPairs);
  }
  for (Eigen::Index i = 0; i < residual.rows(); ++i) {
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (Eigen::Index s = 0; s < kPairs; ++s) {
      const Eigen::Index a = kFirstOf[s];
      const Eigen::Index b = kSecondOf[s];
      gradient[a] += squared(i, s) * residual(i, b);
      if (a != b) gradient[b] += squared(i, s) * residual(i, a);
    }
    const double q = gradient.dot(residual.row(i));
    double value = q;
    double first = 1;
    double second = 0;
    if (power_ != 2 && i < p_->measured) {
      const double u = q / unit + kSmall * kSmall;
      const double power = std::pow(u, power_ / 2);
      value = unit * power;
      first = power_ / 2 * power / u;
      second = (power_ - 2) * first / (u * unit);
    }
    out.sum += sample_weights_(i, l) * value;
    if (!derivatives) continue;
    out.gradient.row(i) = sample_weights_(i, l) * first * gradient.transpose();
    for (Eigen::Index s = 0; s < kPairs; ++s) {
      out.metric(i, s) = sample_weights_(i, l) *
                         (first * squared(i, s) + second * gradient[kFirstOf[s]] * gradient[kSecondOf[s]]);
    }
  }
  return out;
}

void Equations::initial_weights(Parameters& n) const {
  const Eigen::Index k = layout_.k;
  const Matrix values = sample_values(p_->samples, n.lambda, n.half);
  std::vector<Matrix> free;
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    const auto light = static_cast<std::size_t>(l);
    const Eigen::Matrix3d root = metrics(p_->white[light], p_->white[light])[0];
    const Eigen::Matrix3d white = kWhiteWeight * root.transpose() * root;
    Matrix normal(3 * k, 3 * k);
    for (Eigen::Index s = 0; s < kPairs; ++s) {
      const Eigen::Index a = kFirstOf[s];
      const Eigen::Index b = kSecondOf[s];
      const Vector weight = p_->squared_metric[light].col(s).cwiseProduct(sample_weights_.col(l));
      Matrix block = values.transpose() * weight.asDiagonal() * values;
      block.array() += white(a, b);
      for (Eigen::Index i = 0; i < k; ++i) {
        for (Eigen::Index j = 0; j < k; ++j) {
          normal(3 * i + a, 3 * j + b) = normal(3 * i + b, 3 * j + a) = block(i, j);
        }
      }
    }
    // Least squares: the gradient at a residual as large as the reference points to the reference.
    const Matrix aims = values.transpose() * robust_loss(p_->reference[light].transpose(), l, true).gradient;
    Vector right(3 * k);
    for (Eigen::Index i = 0; i < k; ++i) {
      right.segment<3>(3 * i) = aims.row(i).transpose() + white * p_->white[light];
    }
    // Neighbouring wavelengths divide one weight evenly.
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

double Equations::regularization() const {
  return kRegularization * sample_weights_.sum() / static_cast<double>(layout_.lights);
}

double Equations::cost(const Parameters& n) const {
  const Matrix values = sample_values(p_->samples, n.lambda, n.half);
  double sum = kWhiteWeight * kUnitsOfXyz * white_residual(n, nullptr).squaredNorm();
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    sum += robust_loss(residuals(values, n, l), l, false).sum +
           regularization() * color_weights(n, l).squaredNorm();
  }
  return sum;
}

void Equations::build(const Parameters& n, Matrix& normal, Vector& right) const {
  normal = Matrix::Zero(layout_.unknowns(), layout_.unknowns());
  right = Vector::Zero(layout_.unknowns());
  const Slopes slopes = sample_slopes(p_->samples, n.lambda, n.half);
  Matrix features(p_->samples.count(), (layout_.bands ? 3 : 2) * layout_.k);
  features.leftCols(2 * layout_.k) << slopes.values, slopes.by_lambda;
  if (layout_.bands) features.rightCols(layout_.k) = slopes.by_half;
  for (Eigen::Index l = 0; l < layout_.lights; ++l) add_light(n, l, features, normal, right);
  // The lower half follows from the upper.
  normal.triangularView<Eigen::StrictlyLower>() = normal.transpose();
  add_regularization(n, normal, right);
}

/// Adds a light's part, above the diagonal and on it. A sample's residual depends on an unknown of a
/// wavelength by one of the sample's features there (its value, or its slope in where or how wide the
/// wavelength is), times a colour: so all sums are those of products of two features, six times, for the six
/// pairs of XYZ in the squared metric.
void Equations::add_light(const Parameters& n, Eigen::Index l, const Matrix& features, Matrix& normal,
                          Vector& right) const {
  struct Unknown {
    Eigen::Index at;
    Eigen::Index feature;
    Eigen::Vector3d color;
  };
  const Layout& at = layout_;
  const Eigen::Index k = at.k;
  std::vector<Unknown> unknowns;
  // In the order of the unknowns.
  for (Eigen::Index i = 0; i < k; ++i) {
    unknowns.push_back({at.lambda(i), k + i, n.emission(i, l) * n.sensor.row(i).transpose()});
  }
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      unknowns.push_back({at.sensor(i, c), i, n.emission(i, l) * Eigen::Vector3d::Unit(c)});
    }
  }
  for (Eigen::Index i = 0; at.bands && i < k; ++i) {
    unknowns.push_back({at.half(i), 2 * k + i, n.emission(i, l) * n.sensor.row(i).transpose()});
  }
  for (Eigen::Index i = 0; at.lights > 1 && i < k; ++i) {
    unknowns.push_back({at.emission(l, i), i, n.sensor.row(i).transpose()});
  }

  const RobustLoss part = robust_loss(residuals(features.leftCols(k), n, l), l, true);
  for (Eigen::Index pair = 0; pair < kPairs; ++pair) {
    const Eigen::Index a = kFirstOf[pair];
    const Eigen::Index b = kSecondOf[pair];
    const Matrix weighed = part.metric.col(pair).asDiagonal() * features;
    Matrix sums(features.cols(), features.cols());
    sums.triangularView<Eigen::Lower>() = features.transpose() * weighed;
    sums.triangularView<Eigen::StrictlyUpper>() = sums.transpose();
    for (std::size_t v = 0; v < unknowns.size(); ++v) {
      const Unknown& other = unknowns[v];
      for (std::size_t u = 0; u <= v; ++u) {
        const Unknown& one = unknowns[u];
        double colors = one.color[a] * other.color[b];
        if (a != b) colors += one.color[b] * other.color[a];
        normal(one.at, other.at) += colors * sums(one.feature, other.feature);
      }
    }
  }
  const Matrix on_features = features.transpose() * part.gradient;
  for (const Unknown& u : unknowns) right[u.at] += on_features.row(u.feature).dot(u.color);
}

/// Adds the regularization of products of sensor weights and emission values.
void Equations::add_regularization(const Parameters& n, Matrix& normal, Vector& right) const {
  const Layout& at = layout_;
  const double by = regularization();
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

Vector Equations::white_residual(const Parameters& n, Matrix* slopes) const {
  const Layout& at = layout_;
  Vector out(3 * at.lights);
  if (slopes != nullptr) *slopes = Matrix::Zero(3 * at.lights, at.unknowns());
  for (Eigen::Index l = 0; l < at.lights; ++l) {
    const Eigen::Vector3d sum = color_weights(n, l).colwise().sum().transpose();
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

Vector Equations::light_means(const Parameters& n) const {
  Vector out(layout_.lights);
  for (Eigen::Index l = 0; l < layout_.lights; ++l) {
    const auto light = static_cast<std::size_t>(l);
    const auto all = differences(p_->reference[light].leftCols(p_->scene),
                                 predict(p_->samples, n, l).leftCols(p_->scene), p_->white[light]);
    out[l] = Eigen::Map<const Vector>(all.data(), p_->scene).mean();
  }
  return out;
}

double Equations::mean_difference(const Parameters& n) const {
  return light_means(n).mean();
}

void Equations::balance_lights(const Parameters& n) {
  const Vector means = light_means(n);
  if (!(means.mean() > 0)) return;
  // Squared: a light's mean moves by less than its weight does.
  light_weights_ = light_weights_.cwiseProduct((means / means.mean()).cwiseAbs2());
  update_weights();
}

}  // namespace spectile::plan
