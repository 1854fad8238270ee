// Sums over bands in the order that the kernels take.
#pragma once

#include "kernels/abi.hpp"

namespace spectile::reference {

/// Sum of term(band) over all bands: run by run, as kernels/abi.hpp says.
template <class Term>
float sum_in_runs(std::size_t bands, Term term) {
  float sum = 0;
  for (std::size_t first = 0; first < bands; first += kernels::kSumRun) {
    float run = 0;
    for (std::size_t band = first; band < bands && band < first + kernels::kSumRun; ++band) {
      run = run + term(band);
    }
    sum = sum + run;
  }
  return sum;
}

}  // namespace spectile::reference
