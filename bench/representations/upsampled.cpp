// Spectra that are made of RGB alone, by the engine's methods and by others of the literature.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <spectile/color/colorimetry.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "bench/representations/linear_system.hpp"
#include "bench/representations/phases.hpp"
#include "bench/representations/representation.hpp"
#include "src/base/errors.hpp"
#include "src/upsampling/quadratic_program.hpp"

namespace spectile::measure {
namespace {

using Color = std::array<double, 3>;

/// How near sums must come to a colour.
constexpr double kTolerance = 1e-7;

Color sums_of(std::span<const Color> weights, const std::vector<double>& spectrum) {
  Color out{};
  for (std::size_t b = 0; b < weights.size(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) out[k] += weights[b][k] * spectrum[b];
  }
  return out;
}

double distance(const Color& a, const Color& b) {
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double apart = std::abs(a[k] - b[k]);
    if (!(apart <= out)) out = apart;  // NaN too
  }
  return out;
}

/// The engine's own spectra of the colours.
Result<std::vector<std::vector<double>>> engine_spectra(const PathScene& scene, Method method,
                                                        const Bands& bands) {
  SPECTILE_ASSIGN(auto upsampler, Upsampler::create(method, Quantity::kReflectance, bands));
  SPECTILE_ASSIGN(auto lanes, ColorLanes::create(scene.colors.size()));
  for (std::size_t i = 0; i < scene.colors.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      lanes.at(i, k) = static_cast<float>(std::clamp(scene.colors[i][k], 0.0, 1.0));
    }
  }
  SPECTILE_ASSIGN(auto spectra, SampledSpectra::create(bands, scene.colors.size()));
  SPECTILE_TRY(upsample_srgb(upsampler, lanes.view(), spectra.span()));
  std::vector<std::vector<double>> out(scene.colors.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t b = 0; b < bands.count(); ++b) {
      out[i].push_back(static_cast<double>(spectra.at(i, b)));
    }
  }
  return out;
}

}  // namespace

double moment_phase(double nm) {
  const double at = (nm - kFirstVisibleNm) / 5;
  const auto i = std::min(static_cast<std::size_t>(std::max(at, 0.0)), std::size(kMomentPhases) - 2);
  const double part = std::clamp(at - static_cast<double>(i), 0.0, 1.0);
  return (1 - part) * kMomentPhases[i] + part * kMomentPhases[i + 1];
}

std::vector<double> moment_spectrum(std::span<const double> phases, std::span<const Color> weights,
                                    const Color& color) {
  const std::size_t bands = weights.size();
  std::vector<double> out(bands);
  Color c{};
  // A maximum of entropy within 0 and 1 is 1/2 + arctan(c0 + c1 cos + c2 cos 2) / pi. Newton's method with
  // shorter steps where it gets worse.
  const auto evaluate = [&](const Color& at, std::vector<double>* jacobian) {
    for (std::size_t b = 0; b < bands; ++b) {
      const Color functions = {1, std::cos(phases[b]), std::cos(2 * phases[b])};
      const double x = at[0] + at[1] * functions[1] + at[2] * functions[2];
      out[b] = 0.5 + std::atan(x) / std::numbers::pi;
      if (jacobian == nullptr) continue;
      const double slope = 1 / (std::numbers::pi * (1 + x * x));
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t f = 0; f < 3; ++f) (*jacobian)[3 * k + f] += weights[b][k] * slope * functions[f];
      }
    }
    return sums_of(weights, out);
  };
  constexpr int kSteps = 200;
  Color sums = evaluate(c, nullptr);
  for (int step = 0; step < kSteps && distance(sums, color) > kTolerance; ++step) {
    std::vector<double> jacobian(9);
    evaluate(c, &jacobian);
    std::vector<double> move = {color[0] - sums[0], color[1] - sums[1], color[2] - sums[2]};
    if (!solve_linear(jacobian, move)) return {};
    double length = 1;
    bool nearer = false;
    while (!nearer && length > 1e-6) {
      const Color next = {c[0] + length * move[0], c[1] + length * move[1], c[2] + length * move[2]};
      const Color found = evaluate(next, nullptr);
      nearer = distance(found, color) < distance(sums, color);
      if (nearer) {
        c = next;
        sums = found;
      }
      length /= 2;
    }
    if (!nearer) return {};
  }
  evaluate(c, nullptr);
  if (distance(sums, color) > kTolerance) return {};
  return out;
}

std::vector<double> smoothest_spectrum(std::span<const Color> weights, const Color& color) {
  QuadraticProgram program;
  program.variables = weights.size();
  for (std::size_t b = 1; b < weights.size(); ++b) program.squares.push_back({{{b - 1, -1}, {b, 1}}, 0});
  for (std::size_t k = 0; k < 3; ++k) {
    LinearTerm& equality = program.equalities.emplace_back();
    for (std::size_t b = 0; b < weights.size(); ++b) equality.coefficients.emplace_back(b, weights[b][k]);
    equality.value = color[k];
  }
  return minimize(program).value_or(std::vector<double>{});
}

std::vector<double> least_slope_spectrum(std::span<const Color> weights, const Color& color) {
  const std::size_t n = weights.size();
  std::vector<double> z(n);
  Color multipliers{};
  std::vector<double> out(n, 0.5);
  constexpr int kSteps = 100;
  for (int step = 0; step < kSteps; ++step) {
    // Newton's method on the conditions of Lagrange: 2 D'D z + J' multipliers = 0, sums = colour.
    const std::size_t size = n + 3;
    std::vector<double> matrix(size * size);
    std::vector<double> right(size);
    for (std::size_t b = 0; b < n; ++b) {
      const double slope = 2 * out[b] * (1 - out[b]);         // of (tanh z + 1) / 2
      const double curvature = 2 * slope * (1 - 2 * out[b]);  // and of that
      double gradient = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        gradient += multipliers[k] * weights[b][k];
        matrix[b * size + n + k] = matrix[(n + k) * size + b] = weights[b][k] * slope;
      }
      right[b] = -gradient * slope;
      matrix[b * size + b] += gradient * curvature;
      if (b == 0) continue;
      matrix[b * size + b] += 2;
      matrix[(b - 1) * size + b - 1] += 2;
      matrix[b * size + b - 1] -= 2;
      matrix[(b - 1) * size + b] -= 2;
      right[b] -= 2 * (z[b] - z[b - 1]);
      right[b - 1] += 2 * (z[b] - z[b - 1]);
    }
    const Color sums = sums_of(weights, out);
    double residual = distance(sums, color);
    for (std::size_t k = 0; k < 3; ++k) right[n + k] = color[k] - sums[k];
    for (std::size_t b = 0; b < n; ++b) residual = std::max(residual, std::abs(right[b]));
    if (!std::isfinite(residual)) return {};
    if (residual < kTolerance) return out;
    if (!solve_linear(matrix, right)) return {};
    // No argument moves by more than 1 in a step.
    double longest = 1;
    for (std::size_t b = 0; b < n; ++b) longest = std::max(longest, std::abs(right[b]));
    for (std::size_t b = 0; b < n; ++b) {
      z[b] += right[b] / longest;
      out[b] = 0.5 * (std::tanh(z[b]) + 1);
    }
    for (std::size_t k = 0; k < 3; ++k) multipliers[k] += right[n + k] / longest;
  }
  return {};
}

Result<Products> upsampled_products(const PathScene& scene, Upsampling upsampling) {
  const Bands bands;
  SPECTILE_ASSIGN(const auto under, Projector::reflective(bands, scene.light().spectrum));
  Products out;
  out.weights.assign(under.weights().begin(), under.weights().end());
  if (upsampling == Upsampling::kSigmoid || upsampling == Upsampling::kTetrahedral) {
    const Method method = upsampling == Upsampling::kSigmoid ? Method::kSigmoid : Method::kTetrahedral;
    SPECTILE_ASSIGN(out.reflectances, engine_spectra(scene, method, bands));
    return out;
  }
  SPECTILE_ASSIGN(const auto d65, reference_light("D65"));
  SPECTILE_ASSIGN(const auto observer, Projector::reflective(bands, d65.spectrum));
  std::vector<Color> weights;
  std::vector<double> phases;
  for (std::size_t b = 0; b < bands.count(); ++b) {
    weights.push_back(times(observer.xyz_to_srgb(), observer.weights()[b]));
    phases.push_back(moment_phase(bands[b].centre_nm));
  }
  const auto made_of = [&](const Color& color) {
    return upsampling == Upsampling::kMoments ? moment_spectrum(phases, weights, color)
           : upsampling == Upsampling::kMeng  ? smoothest_spectrum(weights, color)
                                              : least_slope_spectrum(weights, color);
  };
  for (const Color& given : scene.colors) {
    const double grey = std::clamp((given[0] + given[1] + given[2]) / 3, 0.01, 0.99);
    const auto toward_grey = [&](double share) {
      Color color{};
      for (std::size_t k = 0; k < 3; ++k) {
        color[k] = (1 - share) * std::clamp(given[k], 0.0, 1.0) + share * grey;
      }
      return color;
    };
    std::vector<double> spectrum = made_of(toward_grey(1e-6));
    double share = 1e-6;
    double without = 0;
    while (spectrum.empty() && share < 0.25) {
      without = share;
      share *= 4;
      spectrum = made_of(toward_grey(share));
    }
    if (spectrum.empty()) spectrum.assign(bands.count(), grey);
    // The least share, to a tenth.
    while (without > 0 && share > 1.1 * without) {
      const double middle = std::sqrt(share * without);
      auto nearer = made_of(toward_grey(middle));
      (nearer.empty() ? without : share) = middle;
      if (!nearer.empty()) spectrum = std::move(nearer);
    }
    out.reflectances.push_back(std::move(spectrum));
  }
  return out;
}

}  // namespace spectile::measure
