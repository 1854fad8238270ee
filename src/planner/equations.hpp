// The normal equations of a plan's unknowns.
#pragma once

#include "src/planner/problem.hpp"

namespace spectile::plan {

/// Where the unknowns lie: wavelengths, sensor weights (wavelength by wavelength), half widths of bands (none
/// for points), emission values (light by light; none with one light, whose values are 1).
struct Layout {
  Eigen::Index k = 0;
  Eigen::Index lights = 0;
  bool bands = false;
  Eigen::Index lambda(Eigen::Index i) const { return i; }
  Eigen::Index sensor(Eigen::Index i, Eigen::Index c) const { return k + 3 * i + c; }
  Eigen::Index half(Eigen::Index i) const { return 4 * k + i; }
  Eigen::Index emission(Eigen::Index l, Eigen::Index i) const { return (bands ? 5 : 4) * k + l * k + i; }
  Eigen::Index unknowns() const { return (bands ? 5 : 4) * k + (lights > 1 ? lights * k : 0); }
};

/// The loss, a sum of colour differences to a power, with its gradient and Hessian. The problem must outlive
/// it.
class Equations {
 public:
  Equations(const Problem& p, Eigen::Index k, bool bands);

  /// Differences count to this power, those of `unit` as much as squared; in a problem that has grown, too.
  void set_power(double power, double unit);
  /// Lets lights whose mean stays behind the others' count more.
  void balance_lights(const Parameters& n);
  /// Mean difference of reflectances and products.
  double mean_difference(const Parameters& n) const;

  const Layout& layout() const noexcept { return layout_; }
  /// Weights of each light for itself by least squares; of several lights their best common sensor.
  void initial_weights(Parameters& n) const;
  /// The loss, with the regularization and the residual of white.
  double cost(const Parameters& n) const;
  /// Second and first derivatives, halved, without the residual of white. Shapes: [unknowns][unknowns],
  /// [unknowns].
  void build(const Parameters& n, Matrix& normal, Vector& right) const;
  /// Residual of white, light by light, and its derivatives by the unknowns.
  Vector white_residual(const Parameters& n, Matrix* slopes) const;

 private:
  /// A light's part of the loss and, for each sample, half the gradient by the residual, [N][3], and half the
  /// Hessian, [N][6].
  struct RobustLoss {
    double sum = 0;
    Matrix gradient;
    Matrix metric;
  };
  RobustLoss robust_loss(const Matrix& residual, Eigen::Index l, bool derivatives) const;
  Matrix color_weights(const Parameters& n, Eigen::Index l) const;
  Matrix residuals(const Matrix& values, const Parameters& n, Eigen::Index l) const;
  Vector light_means(const Parameters& n) const;
  /// Weights of samples, from those of the problem and of the lights.
  void update_weights();
  void add_light(const Parameters& n, Eigen::Index l, const Matrix& features, Matrix& normal,
                 Vector& right) const;
  void add_regularization(const Parameters& n, Matrix& normal, Vector& right) const;
  double regularization() const;

  const Problem* p_;
  Layout layout_;
  double power_ = 2;
  double unit_ = 1;
  Matrix sample_weights_;  // [N][lights]
  Vector light_weights_;   // [lights]
};

}  // namespace spectile::plan
