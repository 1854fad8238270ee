// Tables of a WavelengthDistribution, as the kernels take them.
#pragma once

#include <spectile/lanes/wavelength_distribution.hpp>

#include "kernels/abi.hpp"
#include "src/lanes/knot_index.hpp"

namespace spectile {

struct WavelengthDistribution::Tables {
  int first_nm = 0;
  KnotIndex starts;       ///< share of the draws below each nanometre
  FloatBuffer bins;       ///< [nanometres][2]: nanometres a share, density
  FloatBuffer densities;  ///< [nanometres][2]: density, 0
  kernels::BinTable table;

  std::int32_t count() const { return table.count; }
};

struct WavelengthDistributionAccess {
  static const WavelengthDistribution::Tables& tables(const WavelengthDistribution& d) { return *d.tables_; }
  /// Of shares of all draws, one for each nanometre. Errors: kOutOfMemory.
  static Result<WavelengthDistribution> create(const std::vector<double>& shares, int first_nm);
};

}  // namespace spectile
