// Parts of a procedural scene.
#pragma once

#include <spectile/scene/procedural_scene.hpp>
#include <vector>

#include "src/scene/layout.hpp"
#include "src/scene/reference_values.hpp"

namespace spectile {

struct ProceduralScene::Parts {
  explicit Parts(scene::Picture picture);
  static constexpr std::size_t kIntervals = static_cast<std::size_t>(kLastVisibleNm - kFirstVisibleNm);
  scene::Layout layout;
  /// Of each spectrum, every nanometre: a value and the difference to the next.
  /// Shapes: [spectrum][kIntervals][2].
  std::vector<float> tables;
  mutable scene::Responses responses;
};

}  // namespace spectile
