// ColorGrid: a spectrum at each node of a grid over the cube of RGB, between which colours are interpolated.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kernels/abi.hpp"
#include "src/color/working_space.hpp"
#include "src/upsampling/grid/nodes.hpp"

namespace spectile {

/// Spectra of the nodes. Each has exactly its node's colour, so that every mixture of nodes has the
/// mixture's.
struct ColorGrid {
  std::size_t places = 0;     ///< bands, or wavelengths
  std::vector<double> nodes;  ///< [red][green][blue][places]
  std::size_t weakened = 0;   ///< nodes that could not have all of what was learned of them

  std::span<const double> node(std::size_t i) const { return {nodes.data() + i * places, places}; }
};

/// A grid of the kernels, and the memory that it lies in.
struct GridModel {
  ColorGrid grid;
  FloatBuffer memory;
  kernels::GridTable table;
};

/// The grid of five levels, ((k / 4)^1.5), whose spectra are sigmoids of the observer's functions; times the
/// white of the space, where it is that of a light. `nodes`: what was learned of them; may be null. Errors:
/// kBadArgument where a node's colour has no such spectrum; kOutOfMemory.
Result<ColorGrid> sigmoid_grid(const Bands& bands, const WorkingSpace& space, Observer observer,
                               const LearnedNodes* nodes);

/// The same grid at other places: linear between two of its own, the next one's with the share `part`.
struct GridPlaceAt {
  std::size_t place = 0;
  double part = 0;
};
ColorGrid grid_at(const ColorGrid& grid, std::span<const GridPlaceAt> places);

/// Tables for the kernels. `lowest`: minimum of the samples. `homogeneous`: half the colour has half the
/// spectrum, as light has. Errors: kOutOfMemory.
Result<std::shared_ptr<const GridModel>> grid_model(ColorGrid grid, float lowest, bool homogeneous);

/// Colours of the nodes by weights [places] of each component, for UpsamplingKernels::grid_fold. Errors:
/// kOutOfMemory.
Result<std::shared_ptr<const GridModel>> folded_grid(const GridModel& model,
                                                     std::span<const std::array<double, 3>> weights);

}  // namespace spectile
