// A film's samples a second by the order in which they arrive, beside the AoS baseline's film and plain sums.
#pragma once

#include <spectile/bench/benchmark.hpp>

#include "bench/limits/clock.hpp"
#include "kernels/abi.hpp"

namespace spectile::measure {

struct FilmOrderSettings {
  const kernels::KernelTable* table = nullptr;  ///< must be the one that runs
  bool quick = false;                           ///< a ninth of the pixels
  double copy = 0;                              ///< bytes a second of copying memory, 0 where unknown
  TimingBudget timing;
  std::uint64_t seed = 1;
  std::vector<std::string> only;  ///< rows whose name contains one of these; all where empty
};

/// On one thread, 4 wavelengths a sample, 1920 x 1080 pixels: by tile with 16, 4 and 1 samples a pixel and
/// visit, by scanline, at random; wavelengths drawn; 60 buckets on a ninth of the pixels. Errors: as
/// Film::create().
Result<std::vector<BaselineSpeed>> measure_film_orders(const FilmOrderSettings& settings);

}  // namespace spectile::measure
