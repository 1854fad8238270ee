// What the film would be with ordinary sums: its own kernels up to the contributions, its tiles, locks and
// order, but four doubles a pixel that are added to.
#pragma once

#include <array>
#include <spectile/film/film.hpp>
#include <vector>

#include "kernels/abi.hpp"
#include "src/film/state.hpp"

namespace bench {

class PlainFilm {
 public:
  /// Of the same window, tiles and curves as `like`, which must outlive it and be fed with wavelengths.
  PlainFilm(const spectile::Film& like, const spectile::kernels::KernelTable& table);
  /// A multiple of 64 samples; the program ends where one of them is refused.
  void add(const spectile::WavelengthSamples& samples);
  /// A component of a pixel's mean; 3 for the sum of its weights.
  double at(int x, int y, std::size_t component) const;

 private:
  /// Samples that are weighed at once, as the film has it.
  static constexpr std::size_t kChunk = 1024;
  static constexpr std::size_t kStripes = spectile::FilmAccess::State::kStripes;
  void add_chunk(const spectile::WavelengthSamples& samples, std::size_t first, std::size_t n);
  void add_entries(std::size_t n);
  void touch(std::size_t tile, std::size_t count);

  spectile::FilmAccess::State& like_;
  const spectile::kernels::KernelTable& table_;
  spectile::ZeroedPages pages_;
  std::vector<double*> tiles_;  ///< [pixel][4]
  std::vector<std::uint64_t> additions_;
  spectile::FloatBuffer quads_;
  std::vector<std::int32_t> reasons_, address_, sorted_address_;
  std::vector<std::uint32_t> sorted_sample_;
};

}  // namespace bench
