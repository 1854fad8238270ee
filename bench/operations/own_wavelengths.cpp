// Operations on lanes with wavelengths of their own: what they share.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

Operation& add_own_wavelengths(std::vector<Operation>& to, std::string name, const char* item,
                               OwnWavelengthsKernel kernel) {
  constexpr std::size_t kRows = 3 + kWavelengths;
  Operation& op = add_operation(to, "wavelengths", std::move(name), item, {1, kRows}, {1, kWavelengths});
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < 3; ++k) v[k] = uniform(random, 0.0F, 1.0F);
    for (std::size_t k = 3; k < kRows; ++k) v[k] = uniform(random, 360.0F, 830.0F);
  };
  op.run = [kernel = std::move(kernel)](const KernelTable& k, const Arrays& a) {
    for (std::size_t block = 0; block < a.blocks; ++block) {
      const float* const rows = a.in() + block * kRows * kernels::kLanes;
      const float* const three[3] = {rows, rows + kernels::kLanes, rows + 2 * kernels::kLanes};
      kernel(k, three, rows + 3 * kernels::kLanes, a.out() + block * kWavelengths * kernels::kLanes);
    }
  };
  return op;
}

std::function<double(const double*, const double*, double)> error_between_bands(const Bands& bands,
                                                                                double roundings,
                                                                                double bound,
                                                                                Oracle on_bands) {
  const std::size_t count = bands.count();
  const double first = bands[0].centre_nm;
  const double last = bands[count - 1].centre_nm;
  return error_against(
      kWavelengths, roundings, false, bound,
      [=, on_bands = std::move(on_bands)](const double* v, double* reference, double* scale) {
        thread_local std::vector<double> samples;
        thread_local std::vector<double> scales;
        samples.assign(count, 0.0);
        scales.assign(count, 0.0);
        on_bands(v, samples.data(), scales.data());
        for (std::size_t k = 0; k < kWavelengths; ++k) {
          const double lambda = v[3 + k];
          reference[k] = lambda;
          scale[k] = 0;
          if (std::isnan(lambda)) continue;
          const auto intervals = static_cast<double>(count - 1);
          const double t =
              count == 1 ? 0 : (std::clamp(lambda, first, last) - first) / (last - first) * intervals;
          const auto i = static_cast<std::size_t>(std::max(0.0, std::min(t, intervals - 1)));
          const std::size_t next = std::min(i + 1, count - 1);
          const double rise = samples[next] - samples[i];
          reference[k] = samples[i] + (t - static_cast<double>(i)) * rise;
          // The intervals a nanometre are rounded, and the place once more, after a difference that is exact
          // from half to twice the first centre.
          scale[k] = std::max(scales[i], scales[next]) + 2 * t * std::abs(rise) / bound;
          if (!std::isfinite(scale[k])) scale[k] = std::numeric_limits<double>::max();
        }
      });
}

}  // namespace spectile::measure
