// The oracle: the same mathematics in double, straight from the definitions and independent of the library's
// own way.
#include "src/reference/oracle/oracle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/data/tables.hpp"

namespace spectile::oracle {
namespace {

/// Value of a function tabulated at even steps, linear in between; `beyond` decides what lies outside.
double at_even(double first_nm, double step_nm, std::span<const double> values, double lambda_nm,
               bool zero_beyond) {
  const double place = (lambda_nm - first_nm) / step_nm;
  const auto last = static_cast<double>(values.size() - 1);
  if (place < 0) return zero_beyond ? 0.0 : values.front();
  if (place > last) return zero_beyond ? 0.0 : values.back();
  const auto i = static_cast<std::size_t>(std::min(place, last - 1e-12));
  if (i + 1 >= values.size()) return values.back();
  const double t = place - static_cast<double>(i);
  return values[i] + t * (values[i + 1] - values[i]);
}

/// Integral from the first sample to lambda.
double antiderivative(std::span<const double> w, std::span<const double> v, double lambda_nm) {
  if (lambda_nm <= w.front()) return v.front() * (lambda_nm - w.front());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < w.size(); ++i) {
    if (lambda_nm >= w[i + 1]) {
      sum += 0.5 * (v[i] + v[i + 1]) * (w[i + 1] - w[i]);
      continue;
    }
    const double slope = (v[i + 1] - v[i]) / (w[i + 1] - w[i]);
    const double x = lambda_nm - w[i];
    return sum + x * v[i] + 0.5 * slope * x * x;
  }
  return sum + v.back() * (lambda_nm - w.back());
}

constexpr double kFineStep = 0.01;

/// Sum of f at the middles of steps of about 0.01 nm.
template <class F>
double fine_integral(double lower_nm, double upper_nm, F f) {
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil((upper_nm - lower_nm) / kFineStep)));
  const double h = (upper_nm - lower_nm) / static_cast<double>(steps);
  double sum = 0;
  for (std::size_t i = 0; i < steps; ++i) sum += f(lower_nm + (static_cast<double>(i) + 0.5) * h);
  return sum * h;
}

const data::NamedTable& table_of(std::string_view name) {
  for (const data::NamedTable& table : data::illuminants()) {
    if (name == table.name) return table;
  }
  return data::illuminants()[0];
}

// Columns are red, green, blue of IEC 61966-2-1 with Y adding up to the D65 white (0.3127, 0.3290).
std::array<std::array<double, 3>, 3> srgb_matrix() {
  const double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  const double white[3] = {0.3127 / 0.3290, 1.0, (1 - 0.3127 - 0.3290) / 0.3290};
  double m[3][4];
  for (int k = 0; k < 3; ++k) {
    m[0][k] = xy[k][0] / xy[k][1];
    m[1][k] = 1;
    m[2][k] = (1 - xy[k][0] - xy[k][1]) / xy[k][1];
  }
  double a[3][4];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) a[i][k] = m[i][k];
    a[i][3] = white[i];
  }
  // Gauss-Jordan elimination gives the luminances of the primaries.
  for (int p = 0; p < 3; ++p) {
    int pivot = p;
    for (int r = p + 1; r < 3; ++r) pivot = std::abs(a[r][p]) > std::abs(a[pivot][p]) ? r : pivot;
    std::swap(a[p], a[pivot]);
    for (int r = 0; r < 3; ++r) {
      if (r == p) continue;
      const double f = a[r][p] / a[p][p];
      for (int c = p; c < 4; ++c) a[r][c] -= f * a[p][c];
    }
  }
  std::array<std::array<double, 3>, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i][k] = m[i][k] * (a[k][3] / a[k][k]);
  }
  return out;
}

}  // namespace

double average(std::span<const double> wavelengths_nm, std::span<const double> values, double lower_nm,
               double upper_nm) {
  return (antiderivative(wavelengths_nm, values, upper_nm) -
          antiderivative(wavelengths_nm, values, lower_nm)) /
         (upper_nm - lower_nm);
}

std::vector<std::array<double, 7>> smits_basis(Method method, Quantity quantity, const Bands& bands) {
  const bool light = quantity == Quantity::kIlluminant;
  const data::SmitsData& data = method == Method::kSmits1999 ? data::kSmits1999
                                : light                      ? data::kSmitsIlluminant
                                                             : data::kSmitsReflectance;
  std::vector<std::array<double, 7>> out(bands.count());
  const data::NamedTable& d65 = table_of("D65");
  const auto d65_at = [&](double l) { return at_even(d65.first_nm, d65.step_nm, d65.values, l, true); };
  double unit = 1;
  if (light && method == Method::kSmits1999) {
    const auto& y = data::kCie1931;
    double with_light = 0;
    double without = 0;
    for (std::size_t i = 0; i < y.y_bar.size(); ++i) {
      with_light += y.y_bar[i] * d65_at(y.first_nm + static_cast<double>(i));
      without += y.y_bar[i];
    }
    unit = without / with_light;
  }
  for (std::size_t b = 0; b < bands.count(); ++b) {
    const Band& band = bands[b];
    for (std::size_t k = 0; k < 7; ++k) {
      if (light && method == Method::kSmits1999) {
        const auto product = [&](double l) {
          return average(data.wavelengths_nm, data.basis[k], l, l + 1e-6) * d65_at(l);
        };
        out[b][k] = unit * fine_integral(band.lower_nm, band.upper_nm, product) / band.width_nm();
      } else {
        out[b][k] = data.scale * average(data.wavelengths_nm, data.basis[k], band.lower_nm, band.upper_nm);
      }
    }
  }
  return out;
}

std::vector<double> smits_spectrum(const std::vector<std::array<double, 7>>& basis,
                                   const std::array<double, 3>& rgb, double lowest) {
  // From the definition: sort the components; what all share is white, what two share their secondary, the
  // rest a primary. Bases: white, cyan, magenta, yellow, red, green, blue; the secondary opposite to
  // component i is 1 + i.
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rgb[a] < rgb[b]; });
  const double low = rgb[order[0]];
  const double middle = rgb[order[1]];
  const double high = rgb[order[2]];
  std::vector<double> out(basis.size());
  for (std::size_t b = 0; b < basis.size(); ++b) {
    const double sample = low * basis[b][0] + (middle - low) * basis[b][1 + order[0]] +
                          (high - middle) * basis[b][4 + order[2]];
    out[b] = std::max(lowest, sample);
  }
  return out;
}

std::vector<std::array<double, 3>> projection_weights(
    const Bands& bands, Observer observer, const MeasuredSpectrum* light,
    std::span<const std::pair<std::size_t, std::size_t>> pairs) {
  const data::MatchingFunctions& f = observer == Observer::kCie1964 ? data::kCie1964 : data::kCie1931;
  const std::span<const double> bars[3] = {f.x_bar, f.y_bar, f.z_bar};
  std::vector<std::array<double, 3>> weights(bands.count());
  // Nothing is seen beyond, and the bands of a file may reach any number of nanometres further.
  const double first = f.first_nm - f.step_nm;
  const double last = f.first_nm + f.step_nm * static_cast<double>(f.x_bar.size());
  double luminance = 0;
  for (std::size_t b = 0; b < bands.count(); ++b) {
    const double lower = std::max(bands[b].lower_nm, first);
    const double upper = std::min(bands[b].upper_nm, last);
    for (std::size_t k = 0; k < 3 && lower < upper; ++k) {
      weights[b][k] = fine_integral(lower, upper, [&](double l) {
        return at_even(f.first_nm, f.step_nm, bars[k], l, true) * (light == nullptr ? 1.0 : light->at(l));
      });
    }
    luminance += weights[b][1];
  }
  for (const auto& [from, to] : pairs) {
    const double absorbed =
        fine_integral(bands[from].lower_nm, bands[from].upper_nm, [&](double l) { return light->at(l); }) /
        bands[from].width_nm();
    auto& w = weights.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = absorbed * fine_integral(bands[to].lower_nm, bands[to].upper_nm, [&](double l) {
               return at_even(f.first_nm, f.step_nm, bars[k], l, true);
             });
    }
  }
  for (auto& w : weights) {
    for (double& v : w) v /= luminance;
  }
  return weights;
}

std::array<double, 3> project(const std::vector<std::array<double, 3>>& weights,
                              std::span<const double> spectrum) {
  std::array<double, 3> xyz{};
  for (std::size_t b = 0; b < weights.size(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) xyz[k] += weights[b][k] * spectrum[b];
  }
  return xyz;
}

std::array<double, 3> srgb_to_xyz(const std::array<double, 3>& rgb) {
  static const auto m = srgb_matrix();
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) xyz[i] += m[i][k] * rgb[k];
  }
  return xyz;
}

std::array<double, 3> xyz_to_srgb(const std::array<double, 3>& xyz) {
  // Cramer's rule.
  static const auto m = srgb_matrix();
  const auto det = [](const std::array<std::array<double, 3>, 3>& a) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  };
  std::array<double, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k) {
    auto a = m;
    for (std::size_t i = 0; i < 3; ++i) a[i][k] = xyz[i];
    rgb[k] = det(a) / det(m);
  }
  return rgb;
}

namespace {

/// CIELAB in long double.
struct LongLab {
  long double l, a, b;
};

LongLab long_lab(const std::array<double, 3>& xyz, const std::array<double, 3>& white) {
  long double f[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const long double t = static_cast<long double>(xyz[k]) / static_cast<long double>(white[k]);
    f[k] = t > 216.0L / 24389.0L ? std::cbrt(t) : (24389.0L / 27.0L * t + 16.0L) / 116.0L;
  }
  return {116.0L * f[1] - 16.0L, 500.0L * (f[0] - f[1]), 200.0L * (f[1] - f[2])};
}

/// sqrt(c^7 / (c^7 + 25^7)).
long double vivid(long double c) {
  return c == 0 ? 0 : 1 / std::sqrt(1 + std::pow(25 / c, 7.0L));
}

}  // namespace

Difference ciede2000(const std::array<double, 3>& xyz_a, const std::array<double, 3>& xyz_b,
                     const std::array<double, 3>& white) {
  const LongLab x = long_lab(xyz_a, white);
  const LongLab y = long_lab(xyz_b, white);
  const long double g = 1.5L - 0.5L * vivid((std::hypot(x.a, x.b) + std::hypot(y.a, y.b)) / 2);
  const long double cx = std::hypot(g * x.a, x.b);
  const long double cy = std::hypot(g * y.a, y.b);
  const long double dot = g * x.a * g * y.a + x.b * y.b;
  const long double cross = g * x.a * y.b - g * y.a * x.b;
  Difference out;
  for (const LongLab& v : {x, y}) {
    out.size =
        std::max(out.size, static_cast<double>(std::max({std::abs(v.l), std::abs(v.a), std::abs(v.b)})));
  }
  // A grey but for a rounding has any hue; of opposite hues the mean is on either side.
  const long double least = std::min(cx, cy);
  const bool grey = least > 0 && least < 1e-5L * std::max<long double>(1, out.size);
  const bool opposite = dot < 0 && std::abs(cross) < 1e-9L * cx * cy;
  out.undecided = grey || opposite;
  // The angle between them halved: tan = |cross| / (product of chromas + dot), without cancellation.
  const long double half = least == 0 ? 0 : std::atan2(std::abs(cross), dot) / 2;
  const long double dh = std::copysign(2 * std::sqrt(cx * cy) * std::sin(half), cross);
  const long double degree = std::numbers::pi_v<long double> / 180;
  const auto part = [](long double v, long double c) { return c == 0 ? 0 : v / c; };
  const long double hue = std::atan2(part(x.b, cx) + part(y.b, cy), part(g * x.a, cx) + part(g * y.a, cy));
  const long double t = 1 - 0.17L * std::cos(hue - 30 * degree) + 0.24L * std::cos(2 * hue) +
                        0.32L * std::cos(3 * hue + 6 * degree) - 0.2L * std::cos(4 * hue - 63 * degree);
  const long double from_blue = (hue / degree + (hue < 0 ? 360 : 0) - 275) / 25;
  const long double turn = 60 * degree * std::exp(-from_blue * from_blue);
  const long double c = (cx + cy) / 2;
  const long double l2 = ((x.l + y.l) / 2 - 50) * ((x.l + y.l) / 2 - 50);
  const long double vl = (y.l - x.l) / (1 + 0.015L * l2 / std::sqrt(20 + l2));
  const long double vc = (cy - cx) / (1 + 0.045L * c);
  const long double vh = dh / (1 + 0.015L * c * t);
  out.value =
      static_cast<double>(std::sqrt(vl * vl + vc * vc + vh * vh - std::sin(turn) * 2 * vivid(c) * vc * vh));
  return out;
}

}  // namespace spectile::oracle
