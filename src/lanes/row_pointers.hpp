// Pointers to the rows of a batch of K numbers a lane, from one lane on, as the kernels take them.
#pragma once

#include <array>
#include <spectile/lanes/wavelengths.hpp>

namespace spectile::rows {

template <class Float>
class RowPointers {
 public:
  template <class View>
  RowPointers(const View& view, std::size_t lane) {
    for (std::size_t k = 0; k < view.count && k < rows_.size(); ++k) rows_[k] = view.row(k) + lane;
  }
  Float* const* data() const noexcept { return rows_.data(); }

 private:
  std::array<Float*, WavelengthLanes::kMaxWavelengths> rows_{};
};

}  // namespace spectile::rows
