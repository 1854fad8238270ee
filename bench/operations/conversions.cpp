// Half and float, and looking rows of colours over.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/operations/operation.hpp"

namespace spectile::measure {
namespace {

using kernels::KernelTable;

/// The half nearest to a finite value, ties to even; beyond the largest and a half step an infinity.
double nearest_half(double v) {
  const double magnitude = std::abs(v);
  if (magnitude >= 65520) return std::copysign(std::numeric_limits<double>::infinity(), v);
  const double step = std::ldexp(1.0, std::max(-24, std::ilogb(std::max(magnitude, 0x1p-14)) - 10));
  return std::nearbyint(v / step) * step;
}

bool same(double a, double b) {
  return std::isnan(a) ? std::isnan(b) : a == b;
}

}  // namespace

void add_conversions(std::vector<Operation>& to) {
  Operation& widen = add_operation(to, "conversion", "half to float", "sample", {1, 1, Element::kHalf});
  widen.unit = "exact";
  widen.operations = 2;
  widen.fill = uniform_values(1, 0.0F, 1.0F);
  widen.run = [](const KernelTable& k, const Arrays& a) {
    k.half_to_float(a.out(), a.in<std::uint16_t>(), a.n());
  };
  widen.error = [](const double* in, const double* out, double) {
    return same(in[0], out[0]) ? 0.0 : kBeyond;
  };

  Operation& narrow = add_operation(to, "conversion", "float to half", "sample", {}, {1, 1, Element::kHalf});
  narrow.unit = "exact";  // the nearest half
  narrow.operations = 2;
  narrow.fill = uniform_values(1, 0.0F, 1.0F);
  narrow.run = [](const KernelTable& k, const Arrays& a) {
    k.float_to_half(a.out<std::uint16_t>(), a.in(), a.n());
  };
  narrow.error = [](const double* in, const double* out, double) {
    const double reference = std::isfinite(in[0]) ? nearest_half(in[0]) : in[0];
    return same(reference, out[0]) ? 0.0 : kBeyond;
  };
}

}  // namespace spectile::measure
