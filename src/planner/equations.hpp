// The normal equations of a plan's unknowns.
#pragma once

#include <vector>

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

/// Sums of colour differences to a power, and what they say of the unknowns. The problem must outlive it.
class Equations {
 public:
  Equations(const Problem& p, Eigen::Index k, bool bands);

  /// Differences count to this power, those of `unit` as much as squared; in a problem that has grown, too.
  void set_power(double power, double unit);
  /// Lets lights whose mean stays behind the others' count more.
  void balance_lights(const Numbers& n);
  /// Mean difference of reflectances and products.
  double mean_difference(const Numbers& n) const;

  const Layout& layout() const noexcept { return layout_; }
  /// Weights of each light for itself by least squares; of several lights their best common sensor.
  void start_weights(Numbers& n) const;
  /// The sum, with the sizes of the weights and the miss of white.
  double cost(const Numbers& n) const;
  /// Second and first derivatives, halved, without the miss of white. Shapes: [unknowns][unknowns],
  /// [unknowns].
  void build(const Numbers& n, Matrix& normal, Vector& right) const;
  /// By how much white is missed, a light after the other, and how that depends on the unknowns.
  Vector white_miss(const Numbers& n, Matrix* slopes) const;

 private:
  /// What a light's samples add to the sum, and, for each, half its first derivative by the miss, [N][3], and
  /// half its second, [N][6].
  struct Bent {
    double sum = 0;
    Matrix pull;
    Matrix metric;
  };
  Bent bent(const Matrix& miss, Eigen::Index l, bool derivatives) const;
  Matrix weights_of(const Numbers& n, Eigen::Index l) const;
  Matrix miss_of(const Matrix& values, const Numbers& n, Eigen::Index l) const;
  Vector light_means(const Numbers& n) const;
  void share_out();
  void add_light(const Numbers& n, Eigen::Index l, const Matrix& features, Matrix& normal,
                 Vector& right) const;
  void add_tame(const Numbers& n, Matrix& normal, Vector& right) const;
  double tame() const;

  const Problem* p_;
  Layout layout_;
  double power_ = 2;
  double unit_ = 1;
  Matrix share_;        // [N][lights]
  Vector light_share_;  // [lights]
};

}  // namespace spectile::plan
