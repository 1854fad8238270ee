// Tetrahedral interpolation: from three numbers to spectra and colours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <spectile/upsampling/relight.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "bench/operations/operation.hpp"
#include "src/upsampling/grid/nodes.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"

namespace spectile::measure {
namespace {

using kernels::GridTable;

/// A colour before its first band: the largest component; three cells, each by three levels; the order of
/// three parts, four places and four weights.
constexpr double kPlaces = 3 + 3 * 14 + 26;
/// And a band: four products, three sums, the limit from below, its share of a transposition.
constexpr double kGridBand = 10;
constexpr double kBound = 11;  // u
constexpr const char* kLoads =
    "loads: for each vector of samples four of nodes, one to be transposed, and weights and places a pixel";

std::array<double, 3> rgb3(const double* rgb) {
  return {rgb[0], rgb[1], rgb[2]};
}

/// `rows` samples of each node, limited from below: scaled by the sum of the weights' magnitudes times the
/// largest sample of the grid.
struct GridOracle {
  GridOracle(std::shared_ptr<const void> of, const GridTable& grid, std::size_t count, double least)
      : owner(std::move(of)), table(grid), rows(count), lowest(least) {
    for (std::size_t i = 0; i < kNodes * table.stride; ++i)
      largest = std::max(largest, std::abs(static_cast<double>(table.nodes[i])));
  }
  /// Three parts, each times up to 8; eight products.
  double roundings() const { return (3 * 8 + 8) * std::max(1.0, largest); }
  void operator()(const double* rgb, double* reference, double* scale) const {
    if (oracle_of_strange(rgb, rows, reference, scale)) return;
    const NodeMixture found = node_mixture(rgb3(rgb), table.homogeneous);
    double sum = 0;
    for (const double w : found.weight) sum += std::abs(w);
    for (std::size_t row = 0; row < rows; ++row) {
      double v = 0;
      for (std::size_t i = 0; i < 4; ++i)
        v += found.weight[i] * static_cast<double>(table.nodes[found.node[i] * table.stride + row]);
      reference[row] = std::max(v, lowest);
      scale[row] = sum * largest;
    }
  }
  std::shared_ptr<const void> owner;  ///< of the table
  GridTable table;
  std::size_t rows;
  double lowest;
  double largest = 0;
};

std::function<double(const double*, const double*, double)> grid_error(
    const std::shared_ptr<const void>& owner, const GridTable& table, std::size_t rows, double lowest,
    double bound) {
  const GridOracle oracle(owner, table, rows, lowest);
  return error_against(rows, oracle.roundings(), false, bound, oracle);
}

/// The colour at a few wavelengths of its own.
void add_at_wavelengths(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler) {
  Operation& op = add_own_wavelengths(
      to, "colour at 4 wavelengths, tetrahedral", "colour",
      [=](const KernelTable& k, const float* const rgb[3], const float* lambda_nm, float* samples) {
        k.grid_at(samples, rows::grid_spectra(*upsampler, rgb, nullptr),
                  UpsamplerAccess::at_wavelengths(*upsampler).centres, lambda_nm, kWavelengths, 1);
      });
  // A wavelength: held (4), its place (7), two samples (8 each) of four nodes (1 each), between them (3),
  // NaN (2).
  op.operations = kPlaces + kWavelengths * (4 + 7 + 2 * 8 + 4 + 3 + 2);
  op.divisions = 3;
  op.bottleneck = "gathers: eight loads a wavelength from the nodes";
  op.bound = kBound + 3;
  const GridOracle oracle(upsampler, rows::grid_spectra(*upsampler, nullptr, nullptr).table,
                          upsampler->bands().count(), 0);
  op.error = error_between_bands(upsampler->bands(), oracle.roundings() + 3, op.bound, oracle);
}

void add_spectra(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler) {
  const std::size_t bands = upsampler->bands().count();
  const GridTable table = rows::grid_spectra(*upsampler, nullptr, nullptr).table;
  Operation& op = add_operation(to, "upsampling", "upsample, tetrahedral", "colour", {3, 1}, {1, bands});
  op.operations = kPlaces + kGridBand * static_cast<double>(bands);
  op.divisions = 3;
  op.can_stream = true;
  // The part of a cell: the division's rounding over the narrowest width that it may lie in, 0.35 at 1, and
  // two roundings of its own, 2.5 u, times three components; then 3 u of weights, multiplying and adding.
  op.bound = kBound;
  op.bottleneck = kLoads;
  op.fill = uniform_values(3, 0.0F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.grid_blocks(a.out(), rows::grid_spectra(*upsampler, a.in3().data(), nullptr), a.blocks, a.non_temporal);
  };
  op.error = grid_error(upsampler, table, bands, 0, op.bound);

  Operation& line = to.emplace_back(Operation(to.back()));
  line.name = "upsample to a line of floats, tetrahedral";
  line.out = {bands, 1};
  line.can_stream = false;
  line.cache_only = true;
  line.run = [=](const KernelTable& k, const Arrays& a) {
    k.grid_rows_float(line_rows(a, bands), rows::grid_spectra(*upsampler, a.in3().data(), nullptr), a.n());
  };

  Operation& halves = to.emplace_back(Operation(to.back()));
  halves.name = "upsample to a line of halves, tetrahedral";
  halves.out = {bands, 1, Element::kHalf};
  halves.operations += 3 * static_cast<double>(bands);
  halves.unit = "half ULP of half";
  halves.bound = 1.001;  // rounding to half, and the float before it
  halves.run = [=](const KernelTable& k, const Arrays& a) {
    k.grid_rows_half(line_rows(a, bands), rows::grid_spectra(*upsampler, a.in3().data(), nullptr), a.n());
  };
  halves.error = [=](const double* rgb, const double* out, double /*tiny*/) {
    if (!finite3(rgb)) return kOutOfDomain;
    const NodeMixture found = node_mixture(rgb3(rgb), table.homogeneous);
    double magnitudes = 0;
    for (const double w : found.weight) magnitudes += std::abs(w);
    if (magnitudes > 1e37) return kOutOfDomain;
    double worst = 0;
    for (std::size_t row = 0; row < bands; ++row) {
      double v = 0;
      for (std::size_t i = 0; i < 4; ++i)
        v += found.weight[i] * static_cast<double>(table.nodes[found.node[i] * table.stride + row]);
      v = std::clamp(v, 0.0, static_cast<double>(kernels::kHalfMax));
      const double rounding = kBound * 0x1p-24 * magnitudes;
      if (!std::isfinite(out[row])) return kBeyond;
      worst = std::max(worst, std::max(0.0, std::abs(out[row] - v) - rounding) / half_of_half_step(v));
    }
    return worst;
  };
}

void add_fold(std::vector<Operation>& to, const std::shared_ptr<const Relighter>& relighter) {
  const GridTable table = rows::folded_spectra(*relighter, nullptr, nullptr).table;
  Operation& op = add_operation(to, "relighting", "relight, tetrahedral", "colour", {3, 1}, {3, 1});
  op.operations = kPlaces + 3 * (kGridBand - 1);
  op.divisions = 3;
  op.bound = 18;  // the same, but nodes' colours differ by up to twice the largest
  op.bottleneck = "twelve loads of four floats a colour, from 2 KB of nodes";
  op.fill = uniform_values(3, 0.0F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.grid_fold(a.out3().data(), rows::folded_spectra(*relighter, a.in3().data(), nullptr), a.n());
  };
  op.error = grid_error(relighter, table, 3, -kBeyond, op.bound);
}

}  // namespace

void add_grids(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler,
               const std::shared_ptr<const Relighter>& relighter) {
  add_spectra(to, upsampler);
  add_at_wavelengths(to, upsampler);
  add_fold(to, relighter);
}

}  // namespace spectile::measure
