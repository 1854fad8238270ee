// The normal equations of a plan's unknowns.
#pragma once

#include <vector>

#include "src/ops/plan_problem.hpp"

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

/// Sums of squares of colour differences, and what they say of the unknowns. The problem must outlive it.
class Equations {
 public:
  Equations(const Problem& p, Eigen::Index k, bool bands);

  const Layout& layout() const noexcept { return layout_; }
  /// Weights of each light for itself by least squares; of several lights their best common sensor.
  void start_weights(Numbers& n) const;
  /// The sum of squares, with the sizes of the weights and the miss of white.
  double cost(const Numbers& n) const;
  /// Second and first derivatives, halved, without the miss of white. Shapes: [unknowns][unknowns],
  /// [unknowns].
  void build(const Numbers& n, Matrix& normal, Vector& right) const;
  /// By how much white is missed, a light after the other, and how that depends on the unknowns.
  Vector white_miss(const Numbers& n, Matrix* slopes) const;
  /// Makes samples count such that sums of squares become sums of differences to the power 1.5, and no
  /// light's mean stays behind.
  void weigh_by_difference(const Numbers& n);

 private:
  Matrix weights_of(const Numbers& n, Eigen::Index l) const;
  Matrix pulled(const Matrix& miss, Eigen::Index l) const;
  void add_light(const Numbers& n, Eigen::Index l, const Slopes& s, Matrix& normal, Vector& right) const;
  void add_tame(const Numbers& n, Matrix& normal, Vector& right) const;
  double tame() const;

  const Problem* p_;
  Layout layout_;
  Matrix share_;        // [N][lights]
  Vector light_share_;  // [lights]
};

}  // namespace spectile::plan
