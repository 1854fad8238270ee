// Basis spectra whose colours are exactly the corners of the RGB cube, by quadratic programs.
#include "src/upsampling/exact_basis.hpp"

#include <algorithm>
#include <cmath>

#include "src/data/tables.hpp"
#include "src/spectra/band_weights.hpp"
#include "src/upsampling/quadratic_program.hpp"

namespace spectile {
namespace {

// White, cyan, magenta, yellow, red, green, blue.
constexpr std::array<std::array<double, 3>, 7> kCorners = {
    {{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// The rows whose squares sum to the integral of the squared second derivative, for variables that start at
/// `first`; less those of `reference` where there is one.
void add_roughness(const Bands& bands, std::size_t first, std::span<const double> reference,
                   std::vector<LinearTerm>& squares) {
  const std::size_t n = bands.count();
  if (n < 3) return;
  const double unit = (bands[n - 1].centre_nm - bands[0].centre_nm) / static_cast<double>(n - 1);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = (bands[i].centre_nm - bands[i - 1].centre_nm) / unit;
    const double after = (bands[i + 1].centre_nm - bands[i].centre_nm) / unit;
    const double scale = 1 / std::sqrt(0.5 * (before + after));
    const double c[3] = {scale / before, -scale / before - scale / after, scale / after};
    LinearTerm term;
    for (std::size_t k = 0; k < 3; ++k) {
      term.coefficients.emplace_back(first + i - 1 + k, c[k]);
      if (!reference.empty()) term.value += c[k] * reference[i - 1 + k];
    }
    squares.push_back(std::move(term));
  }
}

/// The rows that make the colour of the variables from `first` on a corner of the cube.
void add_color(const WorkingSpace& space, std::size_t first, const std::array<double, 3>& corner,
               std::vector<LinearTerm>& equalities) {
  for (std::size_t k = 0; k < 3; ++k) {
    LinearTerm term;
    for (std::size_t b = 0; b < space.weights.size(); ++b) {
      term.coefficients.emplace_back(first + b, space.weights[b][k] * space.white[b]);
    }
    term.value = corner[k];
    equalities.push_back(std::move(term));
  }
}

}  // namespace

std::optional<BasisTable> smoothest_basis(const Bands& bands, const WorkingSpace& space) {
  BasisTable out(bands.count());
  for (std::size_t k = 0; k < kCorners.size(); ++k) {
    std::vector<double> spectrum(bands.count(), 1.0);
    if (k > 0) {
      QuadraticProgram program;
      program.variables = bands.count();
      add_roughness(bands, 0, {}, program.squares);
      add_color(space, 0, kCorners[k], program.equalities);
      auto solved = minimize(program);
      if (!solved) return {};
      spectrum = *std::move(solved);
    }
    for (std::size_t b = 0; b < bands.count(); ++b) out[b][k] = spectrum[b] * space.white[b];
  }
  return out;
}

std::optional<BasisTable> primary_decomposition(const Bands& bands, const WorkingSpace& space) {
  // How much the change itself counts against its roughness: enough to keep it near the published spectra,
  // little enough to keep it smooth.
  constexpr double kCloseness = 1e-3;
  const std::size_t n = bands.count();
  std::vector<double> published[3];
  QuadraticProgram program;
  program.variables = 3 * n;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto spectrum = MeasuredSpectrum::from_samples(data::kMallettYuksel.wavelengths_nm,
                                                         data::kMallettYuksel.primaries[k]);
    if (!spectrum) return {};
    for (std::size_t b = 0; b < n; ++b) published[k].push_back(sample_in(*spectrum, bands, b));
    add_roughness(bands, k * n, published[k], program.squares);
    for (std::size_t b = 0; b < n; ++b) {
      program.squares.push_back({{{k * n + b, kCloseness}}, kCloseness * published[k][b]});
    }
    // Blue follows from the other two and the sum.
    if (k < 2) add_color(space, k * n, kCorners[4 + k], program.equalities);
  }
  for (std::size_t b = 0; b < n; ++b) {
    program.equalities.push_back({{{b, 1.0}, {n + b, 1.0}, {2 * n + b, 1.0}}, 1.0});
  }
  const auto solved = minimize(program);
  if (!solved) return {};
  BasisTable out(n);
  for (std::size_t b = 0; b < n; ++b) {
    const double red = (*solved)[b];
    const double green = (*solved)[n + b];
    // Not below 0 by a rounding.
    const double blue = std::max(0.0, 1 - red - green);
    const double white = space.white[b];
    out[b] = {white,       (green + blue) * white, (red + blue) * white, (red + green) * white,
              red * white, green * white,          blue * white};
  }
  return out;
}

double roughness(const Bands& bands, std::span<const double> spectrum) {
  std::vector<LinearTerm> squares;
  add_roughness(bands, 0, {}, squares);
  double sum = 0;
  for (const LinearTerm& term : squares) {
    double value = 0;
    for (const auto& [variable, coefficient] : term.coefficients) value += coefficient * spectrum[variable];
    sum += value * value;
  }
  return sum;
}

}  // namespace spectile
