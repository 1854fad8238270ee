// What a procedural scene is made of.
#pragma once

#include <spectile/procedural_scene.hpp>
#include <vector>

#include "src/ops/scene_layout.hpp"
#include "src/ops/scene_truth.hpp"

namespace spectile {

struct ProceduralScene::Parts {
  explicit Parts(scene::Picture picture);
  /// Pairs of a value and the difference to the next, every nanometre, of a spectrum.
  const float* table(std::size_t spectrum) const noexcept {
    return tables.data() + spectrum * 2 * kIntervals;
  }
  static constexpr std::size_t kIntervals = static_cast<std::size_t>(kLastVisibleNm - kFirstVisibleNm);
  scene::Layout layout;
  std::vector<float> tables;
  mutable scene::Responses responses;
};

}  // namespace spectile
