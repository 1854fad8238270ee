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

void add_throughput(std::vector<Operation>& to) {
  // Throughput and scattering at four wavelengths, a density, and a random number.
  constexpr std::size_t kRows = 2 * kWavelengths + 2;
  Operation& op =
      add_operation(to, "wavelengths", "update throughput", "path", {1, kRows}, {1, kWavelengths});
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < 2 * kWavelengths; ++k) v[k] = uniform(random, 0.0F, 1.0F);
    v[kRows - 2] = uniform(random, 0.5F, 2.0F);
    v[kRows - 1] = uniform(random, 0.0F, 1.0F);
  };
  // A product and the largest a sample, who lives (4), the factor (2), a product and a selection a sample.
  op.operations = 4 * kWavelengths + 6;
  op.divisions = 1;
  op.bound = 4;
  op.run = [](const KernelTable& k, const Arrays& a) {
    for (std::size_t block = 0; block < a.blocks; ++block) {
      const float* const rows = a.in() + block * kRows * kernels::kLanes;
      const auto row = [&](std::size_t i) { return rows + i * kernels::kLanes; };
      std::uint64_t ended = 0;
      k.update_throughput(a.out() + block * kWavelengths * kernels::kLanes, &ended, row(0), row(kWavelengths),
                          row(2 * kWavelengths), row(2 * kWavelengths + 1), kWavelengths, 1);
    }
  };
  op.error = [](const double* v, const double* out, double /*tiny*/) {
    const double density = v[kRows - 2];
    const double u = v[kRows - 1];
    const auto normal = [](double x) { return x > 0x1p-120 && x < 0x1p120; };
    double most = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double product = v[k] * v[kWavelengths + k];
      if (!normal(product) && product != 0) return kOutOfDomain;
      most = std::max(most, product);
    }
    const double survival = std::min(1.0, most / density);
    if (!normal(density) || !normal(most) || !(u >= 0 && u <= 1)) return kOutOfDomain;
    // Rounding decides who lives where the number is as near.
    if (std::abs(u - survival) < 0x1p-21 * survival || (u > 0 && u * density < 0x1p-120)) return kOutOfDomain;
    double worst = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double want = u < survival ? v[k] * v[kWavelengths + k] / density / survival : 0;
      if (want == 0 && out[k] != 0) return kBeyond;
      if (normal(want)) worst = std::max(worst, std::abs(out[k] - want) / (0x1p-24 * want));
    }
    return worst;
  };
}

}  // namespace spectile::measure
