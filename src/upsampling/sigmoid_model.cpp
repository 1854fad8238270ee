// Tables for the sigmoid kernels: rows of weights, and second-order expansions around the nodes of a grid.
#include "src/upsampling/sigmoid_model.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/data/tables.hpp"
#include "src/upsampling/sigmoid_search.hpp"

namespace spectile {
namespace {

using kernels::kSigmoidNode;
using kernels::kSigmoidP;
using kernels::kSigmoidQ;
using kernels::kSigmoidRow;
using kernels::kSigmoidWhite;

// Nodes along each axis of the grid that the fast search starts from: fine enough that one step suffices for
// most colours, small enough for the second-level cache.
constexpr int kSteps = 12;
constexpr std::size_t kCells = std::size_t{kSteps} * kSteps * kSteps;

std::size_t node_index(std::size_t most, std::size_t i, std::size_t j, std::size_t k, std::size_t steps) {
  return ((most * steps + i) * steps + j) * steps + k;
}

double centre(std::size_t i, int steps) {
  return (static_cast<double>(i) + 0.5) / steps;
}

/// A function of the grid's three coordinates: value, first derivatives, second ones (00, 11, 22, 01, 02,
/// 12).
struct Expansion {
  double value = 0;
  Triple first{};
  std::array<double, 6> second{};
};

constexpr std::array<std::array<std::size_t, 2>, 6> kPairs = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

Expansion product(const Expansion& a, const Expansion& b) {
  Expansion out;
  out.value = a.value * b.value;
  for (std::size_t i = 0; i < 3; ++i) out.first[i] = a.first[i] * b.value + a.value * b.first[i];
  for (std::size_t p = 0; p < 6; ++p) {
    const auto [i, j] = kPairs[p];
    out.second[p] =
        a.second[p] * b.value + a.first[i] * b.first[j] + a.first[j] * b.first[i] + a.value * b.second[p];
  }
  return out;
}

/// f of a, given f's value and derivatives there.
Expansion composed(const Expansion& a, double f, double f1, double f2) {
  Expansion out;
  out.value = f;
  for (std::size_t i = 0; i < 3; ++i) out.first[i] = f1 * a.first[i];
  for (std::size_t p = 0; p < 6; ++p) {
    const auto [i, j] = kPairs[p];
    out.second[p] = f1 * a.second[p] + f2 * a.first[i] * a.first[j];
  }
  return out;
}

Expansion coordinate(std::size_t axis, double q) {
  Expansion out;
  out.value = q;
  out.first[axis] = 1;
  return out;
}

/// Coefficients, times the root of the largest component (which keeps them finite towards black), around a
/// node whose own coefficients are c.
std::array<Expansion, 3> expand(const SigmoidSums& sums, std::size_t most, const Triple& q, const Triple& c) {
  const Expansion z = composed(coordinate(0, q[0]), 1 - (1 - q[0]) * (1 - q[0]), 2 * (1 - q[0]), -2);
  const Expansion u = composed(coordinate(1, q[1]), q[1] * q[1], 2 * q[1], 2);
  const Expansion v = composed(coordinate(2, q[2]), q[2] * q[2], 2 * q[2], 2);
  std::array<Expansion, 3> rgb;
  rgb[most] = z;
  rgb[(most + 1) % 3] = product(z, u);
  rgb[(most + 2) % 3] = product(z, v);
  Matrix3 jacobian;
  sums.at(c, jacobian);
  const Matrix3 g = inverse(jacobian);  // derivatives of the coefficients by rgb
  const auto bend = sums.second(c);
  const double root = std::sqrt(z.value);
  const Expansion scale = composed(z, root, 0.5 / root, -0.25 / (root * z.value));
  std::array<Expansion, 3> out;
  for (std::size_t n = 0; n < 3; ++n) {
    Expansion e;
    e.value = c[n];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) e.first[i] += g[3 * n + k] * rgb[k].first[i];
    }
    out[n] = e;
  }
  for (std::size_t p = 0; p < 6; ++p) {
    const auto [i, j] = kPairs[p];
    // From rgb(c(q)) differentiated twice.
    Triple right{};
    for (std::size_t k = 0; k < 3; ++k) {
      right[k] = rgb[k].second[p];
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b)
          right[k] -= bend[k][3 * a + b] * out[a].first[i] * out[b].first[j];
      }
    }
    const Triple solved = times(g, right);
    for (std::size_t n = 0; n < 3; ++n) out[n].second[p] = solved[n];
  }
  for (Expansion& e : out) e = product(scale, e);
  return out;
}

void store_node(const std::array<Expansion, 3>& expansions, int steps, float* node) {
  const double unit = 1.0 / steps;  // derivatives are per cell
  for (std::size_t n = 0; n < 3; ++n) {
    node[n] = static_cast<float>(expansions[n].value);
    float* const e = node + 3 + 9 * n;
    for (std::size_t i = 0; i < 3; ++i) e[i] = static_cast<float>(expansions[n].first[i] * unit);
    for (std::size_t p = 0; p < 6; ++p) {
      e[3 + p] = static_cast<float>(expansions[n].second[p] * unit * unit * (p < 3 ? 0.5 : 1.0));
    }
  }
}

/// Coefficients near a point of the grid, from the published start table's nearest node.
Triple nearest_start(std::size_t most, const Triple& q) {
  const auto steps = static_cast<std::size_t>(data::kSigmoidStart.steps);
  const auto cell = [&](double v) {
    return std::min(static_cast<std::size_t>(v * static_cast<double>(steps)), steps - 1);
  };
  const std::size_t at = node_index(most, cell(q[0]), cell(q[1]), cell(q[2]), steps);
  Triple c;
  for (std::size_t n = 0; n < 3; ++n) c[n] = data::kSigmoidStart.nodes[3 * at + n];
  return c;
}

/// Coefficients of the grey of a component.
Triple grey_coefficients(double level) {
  return {0, 0, (level - 0.5) / std::sqrt(level * (1 - level))};
}

/// True if all nodes have coefficients.
bool fill_nodes(const SigmoidSums& sums, bool quadratic, const Triple& luminance, float* nodes) {
  bool all = true;
  std::vector<Triple> found(kCells);
  for (std::size_t most = 0; most < 3; ++most) {
    // From the greys outward, so that each node has a neighbour to start from.
    for (std::size_t at = kCells; at-- > 0;) {
      const std::size_t i = at / kSteps % kSteps;
      const std::size_t j = at % kSteps;
      const Triple q = {centre(at / kSteps / kSteps, kSteps), centre(i, kSteps), centre(j, kSteps)};
      float* const node = nodes + (most * kCells + at) * kSigmoidNode;
      const Triple rgb = sigmoid_node_rgb(most, q);
      Triple& c = found[at];
      if (quadratic) {
        c = nearest_start(most, q);
      } else if (j + 1 < kSteps) {
        c = found[at + 1];
      } else {
        c = i + 1 < kSteps ? found[at + kSteps] : grey_coefficients(rgb[most]);
      }
      const bool solved = sums.find(rgb, luminance, c);
      all = all && solved;
      if (solved) store_node(expand(sums, most, q, c), kSteps, node);
      // A node without a colour, or too steep to be expanded, is a plain start.
      const bool usable =
          solved && std::all_of(node, node + kSigmoidNode, [](float v) { return std::isfinite(v); });
      if (usable) continue;
      std::fill_n(node, kSigmoidNode, 0.0F);
      for (std::size_t n = 0; n < 3; ++n) node[n] = static_cast<float>(c[n] * std::sqrt(rgb[most]));
    }
  }
  return all;
}

/// True if the cube's corners have coefficients that the fast search can find.
bool has_corners(const SigmoidSums& sums, const Triple& luminance) {
  for (int corner = 1; corner < 7; ++corner) {
    const auto bit = [corner](int k) { return static_cast<double>(corner >> k & 1); };
    const Triple rgb = {bit(0), bit(1), bit(2)};
    Triple c{};
    if (!sums.find(rgb, luminance, c)) return false;
    if (std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]) > static_cast<double>(kernels::kSigmoidSteep)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::array<double, 3> sigmoid_node_rgb(std::size_t most, const std::array<double, 3>& q) {
  const double z = 1 - (1 - q[0]) * (1 - q[0]);
  std::array<double, 3> rgb{};
  rgb[most] = z;
  rgb[(most + 1) % 3] = z * q[1] * q[1];
  rgb[(most + 2) % 3] = z * q[2] * q[2];
  return rgb;
}

std::vector<double> sigmoid_start_nodes(const Bands& bands, const WorkingSpace& space, int steps) {
  const SigmoidSums sums(bands, space, SigmoidFunctions::of(std::nullopt));
  const auto n = static_cast<std::size_t>(steps);
  std::vector<double> out;
  for (std::size_t most = 0; most < 3; ++most) {
    for (std::size_t at = 0; at < n * n * n; ++at) {
      const Triple q = {centre(at / (n * n), steps), centre(at / n % n, steps), centre(at % n, steps)};
      Triple c{};
      if (!sums.solve_from_grey(sigmoid_node_rgb(most, q), c)) c = {};
      out.insert(out.end(), c.begin(), c.end());
    }
  }
  return out;
}

void set_functions(const SigmoidModel& model, double wavelength_nm, float* row) {
  const auto [p, q] = model.functions->at_float(std::clamp(wavelength_nm, model.first_nm, model.last_nm));
  row[kSigmoidP] = p;
  row[kSigmoidQ] = q;
}

Result<std::shared_ptr<const SigmoidModel>> sigmoid_model(const Bands& bands, const WorkingSpace& space,
                                                          const SigmoidFunctions& functions) {
  const std::size_t n = bands.count();
  const std::size_t nodes = 3 * kCells;
  const auto padded = [](std::size_t floats) { return (floats + 15) / 16 * 16; };
  const std::size_t sizes[3] = {padded(nodes * kSigmoidNode), padded(n * kSigmoidRow), padded(4 * n)};
  auto model = std::make_shared<SigmoidModel>();
  SPECTILE_ASSIGN(model->memory, FloatBuffer::create(sizes[0] + sizes[1] + sizes[2]));
  std::fill_n(model->memory.data(), model->memory.size(), 0.0F);
  float* const node = model->memory.data();
  float* const rows = node + sizes[0];
  float* const weights = rows + sizes[1];
  model->functions = &functions;
  model->first_nm = bands[0].centre_nm;
  model->last_nm = bands[n - 1].centre_nm;
  for (std::size_t b = 0; b < n; ++b) {
    const auto [p, q] = functions.at(bands[b].centre_nm);
    float* const row = rows + b * kSigmoidRow;
    const double power[3] = {p, q, 1};
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = space.weights[b][k] * space.white[b];
      weights[4 * b + k] = static_cast<float>(weight);
      for (std::size_t i = 0; i < 3; ++i) row[3 * k + i] = static_cast<float>(4 * weight * power[i]);
    }
    set_functions(*model, bands[b].centre_nm, row);
    row[kSigmoidWhite] = static_cast<float>(space.white[b]);
  }
  const SigmoidSums sums(bands, space, functions);
  const Triple luminance = {space.rgb_to_xyz[3], space.rgb_to_xyz[4], space.rgb_to_xyz[5]};
  model->covers_unit_cube =
      fill_nodes(sums, functions.are_quadratic(), luminance, node) && has_corners(sums, luminance);
  const auto form =
      functions.are_quadratic() ? kernels::SigmoidForm::kQuadratic : kernels::SigmoidForm::kFunctions;
  model->table = {n, rows, weights, node, kSteps, form};
  return std::shared_ptr<const SigmoidModel>(std::move(model));
}

}  // namespace spectile
