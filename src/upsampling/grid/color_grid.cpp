// ColorGrid: a spectrum at each node of a grid over the cube of RGB, between which colours are interpolated.
#include "src/upsampling/grid/color_grid.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/upsampling/sigmoid_search.hpp"

namespace spectile {
namespace {

/// Offsets of a node at the centres of bands.
std::vector<double> offsets_at(const LearnedNodes& nodes, std::size_t node, const Bands& bands) {
  const std::vector<double>& nm = nodes.wavelengths_nm;
  const float* const own = nodes.offsets.data() + node * nm.size();
  std::vector<double> out;
  for (const Band& band : bands.list()) {
    const double at = std::clamp(band.centre_nm, nm.front(), nm.back());
    const auto after = std::upper_bound(nm.begin(), nm.end() - 1, at);
    const auto i = static_cast<std::size_t>(after - nm.begin());
    const std::size_t before = i == 0 ? 0 : i - 1;
    const double part = i == before ? 0 : (at - nm[before]) / (nm[i] - nm[before]);
    out.push_back((1 - part) * static_cast<double>(own[before]) + part * static_cast<double>(own[i]));
  }
  return out;
}

/// Samples of a node that is not grey; false where no sigmoid has its colour.
bool fill_node(SigmoidSums& sums, const Triple& rgb, const Triple& luminance, std::vector<double> offsets,
               double* samples, bool& weakened) {
  // The reflectance of 1 - colour is 1 - reflectance.
  const bool bright = std::max({rgb[0], rgb[1], rgb[2]}) + std::min({rgb[0], rgb[1], rgb[2]}) > 1;
  const Triple target = bright ? Triple{1 - rgb[0], 1 - rgb[1], 1 - rgb[2]} : rgb;
  sums.set_offsets(std::vector<double>(offsets.size(), 0.0));
  Triple c{};
  if (!sums.find(target, luminance, c)) return false;
  if (bright) {
    for (double& v : offsets) v = -v;
  }
  constexpr int kHalvings = 8;
  for (int i = 0; i < kHalvings; ++i) {
    Triple learned = c;
    sums.set_offsets(offsets);
    if (sums.solve(target, learned)) {
      c = learned;
      weakened = i > 0;
      break;
    }
    for (double& v : offsets) v = i + 2 < kHalvings ? v / 2 : 0.0;
  }
  if (bright) {
    c = {-c[0], -c[1], -c[2]};
    for (double& v : offsets) v = -v;
    sums.set_offsets(offsets);
  }
  sums.samples(c, samples);
  return true;
}

}  // namespace

Result<ColorGrid> sigmoid_grid(const Bands& bands, const WorkingSpace& space, Observer observer,
                               const LearnedNodes* nodes) {
  SigmoidSums sums(bands, space, SigmoidFunctions::of(observer));
  const Triple luminance = {space.rgb_to_xyz[3], space.rgb_to_xyz[4], space.rgb_to_xyz[5]};
  ColorGrid out;
  out.places = bands.count();
  out.nodes.resize(kNodes * out.places);
  for (std::size_t i = 0; i < kNodes; ++i) {
    double* const samples = out.nodes.data() + i * out.places;
    const Triple rgb = node_color(i);
    bool weakened = false;
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) {
      std::fill_n(samples, out.places, rgb[0]);
    } else if (!fill_node(
                   sums, rgb, luminance,
                   nodes == nullptr ? std::vector<double>(out.places, 0.0) : offsets_at(*nodes, i, bands),
                   samples, weakened)) {
      return make_error(
          ErrorCode::kBadArgument,
          "tetrahedral has no spectrum between 0 and 1 over the bands {}, under this white and for "
          "this observer, for RGB {}, {}, {} of its grid; sigmoid-observer makes every colour that is "
          "possible",
          bands.description(), rgb[0], rgb[1], rgb[2]);
    }
    out.weakened += weakened ? 1 : 0;
    for (std::size_t b = 0; b < out.places; ++b) samples[b] *= space.white[b];
  }
  return out;
}

ColorGrid grid_at(const ColorGrid& grid, std::span<const GridPlaceAt> places) {
  ColorGrid out;
  out.places = places.size();
  for (std::size_t i = 0; i < kNodes; ++i) {
    const std::span<const double> node = grid.node(i);
    for (const auto& [place, part] : places) {
      const double here = node[place];
      out.nodes.push_back(part == 0 ? here : (1 - part) * here + part * node[place + 1]);
    }
  }
  return out;
}

namespace {

Result<std::shared_ptr<GridModel>> model_of(ColorGrid grid, std::size_t stride) {
  const auto padded = [](std::size_t floats) { return (floats + 15) / 16 * 16; };
  const std::size_t levels = node_levels().size();
  auto model = std::make_shared<GridModel>();
  SPECTILE_ASSIGN(model->memory, FloatBuffer::create(padded(kNodes * stride) + 2 * padded(levels)));
  float* const nodes = model->memory.data();
  float* const level = nodes + padded(kNodes * stride);
  float* const per_width = level + padded(levels);
  std::fill_n(nodes, model->memory.size(), 0.0F);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const std::span<const double> node = grid.node(i);
    for (std::size_t b = 0; b < grid.places; ++b) nodes[i * stride + b] = static_cast<float>(node[b]);
  }
  for (std::size_t k = 0; k < levels; ++k) {
    level[k] = node_levels()[k];
    if (k + 1 < levels) per_width[k] = 1.0F / (node_levels()[k + 1] - node_levels()[k]);
  }
  model->table = {nodes, stride, grid.places, level, per_width, static_cast<std::int32_t>(levels),
                  0.0F,  false};
  model->grid = std::move(grid);
  return model;
}

}  // namespace

Result<std::shared_ptr<const GridModel>> grid_model(ColorGrid grid, float lowest, bool homogeneous) {
  const std::size_t stride = (grid.places + 15) / 16 * 16;
  SPECTILE_ASSIGN(const auto model, model_of(std::move(grid), stride));
  model->table.lowest = lowest;
  model->table.homogeneous = homogeneous;
  return std::shared_ptr<const GridModel>(model);
}

Result<std::shared_ptr<const GridModel>> folded_grid(const GridModel& model,
                                                     std::span<const std::array<double, 3>> weights) {
  ColorGrid colors;
  colors.places = 3;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const std::span<const double> node = model.grid.node(i);
    std::array<double, 3> sum{};
    for (std::size_t b = 0; b < weights.size(); ++b) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += weights[b][k] * node[b];
    }
    colors.nodes.insert(colors.nodes.end(), sum.begin(), sum.end());
  }
  SPECTILE_ASSIGN(const auto out, model_of(std::move(colors), kernels::kGridColor));
  out->table.homogeneous = model.table.homogeneous;
  return std::shared_ptr<const GridModel>(out);
}

}  // namespace spectile
