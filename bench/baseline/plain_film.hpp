// A film with plain sums: the engine's own kernels up to the contributions, then four doubles a pixel.
#pragma once

#include <cstdint>
#include <spectile/film/film.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <vector>

#include "kernels/abi.hpp"
#include "src/base/zeroed_pages.hpp"

namespace spectile::measure {

class PlainFilm {
 public:
  /// Of the window, tiles and curves of `like`, which must outlive it and be fed with wavelengths. Errors:
  /// kOutOfMemory.
  static Result<std::unique_ptr<PlainFilm>> create(const Film& like, const kernels::KernelTable& table);
  /// A multiple of 64 samples, all of them within the film and its range.
  void add(const WavelengthSamples& samples);
  /// Mean of a pixel's luminance; 0 where no sample reached it.
  double luminance(int x, int y) const;

 private:
  static constexpr std::size_t kChunk = 1024;  ///< samples that are weighed at once, as the film has it
  PlainFilm(const Film& like, const kernels::KernelTable& table) : like_(like), table_(table) {}
  const Film& like_;
  const kernels::KernelTable& table_;
  ZeroedPages pages_;
  double* pixels_ = nullptr;  ///< [tile][pixel][4]
  FloatBuffer quads_;
  std::vector<std::int32_t> reasons_, address_;
};

}  // namespace spectile::measure
