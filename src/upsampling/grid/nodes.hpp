// The nodes of a grid over the cube of RGB, and mixtures of them.
#pragma once

#include <array>
#include <spectile/upsampling/learned_nodes.hpp>

namespace spectile {

/// RGB of a node.
std::array<double, 3> node_color(std::size_t node);

/// Nodes of which a colour is a mixture, and their weights, in double.
struct NodeMixture {
  std::array<std::size_t, 4> node{};
  std::array<double, 4> weight{};
};
/// `homogeneous`: half the colour has half the spectrum.
NodeMixture node_mixture(const std::array<double, 3>& rgb, bool homogeneous);

}  // namespace spectile
