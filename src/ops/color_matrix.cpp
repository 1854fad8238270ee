// Matrices between RGB spaces and XYZ, from chromaticities, in double.
#include "src/ops/color_matrix.hpp"

namespace spectile::color {

double determinant(const Matrix3& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

Matrix3 inverse(const Matrix3& m) {
  const double d = 1.0 / determinant(m);
  return {(m[4] * m[8] - m[5] * m[7]) * d, (m[2] * m[7] - m[1] * m[8]) * d, (m[1] * m[5] - m[2] * m[4]) * d,
          (m[5] * m[6] - m[3] * m[8]) * d, (m[0] * m[8] - m[2] * m[6]) * d, (m[2] * m[3] - m[0] * m[5]) * d,
          (m[3] * m[7] - m[4] * m[6]) * d, (m[1] * m[6] - m[0] * m[7]) * d, (m[0] * m[4] - m[1] * m[3]) * d};
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    }
  }
  return out;
}

std::array<double, 3> times(const Matrix3& m, const std::array<double, 3>& v) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i] += m[3 * i + k] * v[k];
  }
  return out;
}

std::array<float, 9> to_float(const Matrix3& m) {
  std::array<float, 9> out{};
  for (std::size_t i = 0; i < 9; ++i) out[i] = static_cast<float>(m[i]);
  return out;
}

std::array<double, 3> xyz_of(const std::array<double, 2>& xy) {
  return {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
}

Matrix3 rgb_to_xyz(const Chromaticities& space) {
  // Columns x, y, z of each primary, so that a primary on y = 0 (as in ACES or XYZ itself) is no exception.
  Matrix3 m{};
  const std::array<double, 2> primaries[3] = {space.red, space.green, space.blue};
  for (std::size_t k = 0; k < 3; ++k) {
    m[k] = primaries[k][0];
    m[3 + k] = primaries[k][1];
    m[6 + k] = 1.0 - primaries[k][0] - primaries[k][1];
  }
  const std::array<double, 3> scale = times(inverse(m), xyz_of(space.white));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) m[3 * i + k] *= scale[k];
  }
  return m;
}

Matrix3 bradford(const std::array<double, 2>& from_white, const std::array<double, 2>& to_white) {
  constexpr Matrix3 kCone = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
  const std::array<double, 3> from = times(kCone, xyz_of(from_white));
  const std::array<double, 3> to = times(kCone, xyz_of(to_white));
  const Matrix3 gain = {to[0] / from[0], 0, 0, 0, to[1] / from[1], 0, 0, 0, to[2] / from[2]};
  return product(inverse(kCone), product(gain, kCone));
}

}  // namespace spectile::color
