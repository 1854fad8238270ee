// Half and float; colour differences; rows of colours looked over.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <spectile/color/color_difference.hpp>

#include "bench/operations/operation.hpp"
#include "src/reference/oracle/oracle.hpp"

namespace spectile::measure {
namespace {

using kernels::RgbScan;

/// The half nearest to a finite value, ties to even; beyond the largest and a half step an infinity.
double nearest_half(double v) {
  const double magnitude = std::abs(v);
  if (magnitude >= 65520) return std::copysign(kBeyond, v);
  const double step = std::ldexp(1.0, std::max(-24, std::ilogb(std::max(magnitude, 0x1p-14)) - 10));
  return std::nearbyint(v / step) * step;
}

bool same(double a, double b) {
  return std::isnan(a) ? std::isnan(b) : a == b;
}

/// D65. Source: IEC 61966-2-1:1999, chromaticity (0.3127, 0.3290).
constexpr std::array<double, 3> kWhite = {0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290};

void add_ciede2000(std::vector<Operation>& to) {
  Operation& op = add_operation(to, "colorimetry", "CIEDE2000", "pair", {6, 1}, {1, 1});
  op.unit = "u of it and 1e-12 of the coordinates";
  op.bound = 1;
  // Six cube roots, eight square roots, two arc tangents, seven sines and cosines, three exponentials: in
  // double, some twenty operations each, and a hundred others.
  op.operations = 2 * (26 * 20 + 100);
  op.bottleneck = "the C library's cube roots, arc tangents, sines and cosines, one number at a time";
  op.fill = uniform_values(6, 0.0F, 1.0F);
  op.run = [](const KernelTable&, const Arrays& a) {
    const ColorView first = {{a.in(0), a.in(1), a.in(2)}, a.n()};
    const ColorView second = {{a.in(3), a.in(4), a.in(5)}, a.n()};
    // The shapes are right and one thread needs no memory: nothing can fail.
    static_cast<void>(ciede2000(first, second, kWhite, {a.out(), a.n()}, {1}));
  };
  op.error = [](const double* in, const double* out, double tiny) {
    for (std::size_t k = 0; k < 6; ++k) {
      // Of infinities nothing is said here.
      if (std::isinf(in[k])) return kOutOfDomain;
      if (std::isnan(in[k])) return std::isnan(out[0]) ? 0 : kBeyond;
    }
    const auto reference = oracle::ciede2000({in[0], in[1], in[2]}, {in[3], in[4], in[5]}, kWhite);
    if (reference.undecided) return kOutOfDomain;
    if (!(reference.value < static_cast<double>(std::numeric_limits<float>::max()))) return kOutOfDomain;
    const double allowed = 0x1p-24 * reference.value + 1e-12 * std::max(1.0, reference.size) + tiny;
    return std::abs(out[0] - reference.value) / allowed;
  };
}

void add_scan(std::vector<Operation>& to) {
  Operation& op =
      add_operation(to, "conversion", "count what is outside", "colour", {3, 1}, {1, 1, Element::kMask});
  // A row of an image is counted at once: 32 bytes, whatever its length.
  op.touched_bytes = 0;
  op.unit = "exact";
  // A component: compare with 0, with 1, find out whether it is finite (2), the maximum, join them (3).
  op.operations = 3 * 8 + 3;
  op.bottleneck = "counting the bits of three masks a vector, and adding them up in memory";
  op.fill = uniform_values(3, 0.0F, 1.0F);
  op.cache_only = true;
  op.run = [](const KernelTable& k, const Arrays& a) {
    RgbScan scan;
    k.scan_rgb(&scan, a.in3().data(), a.n());
    if (a.blocks * sizeof(std::uint64_t) >= sizeof(scan)) *reinterpret_cast<RgbScan*>(a.target) = scan;
  };
  op.run_error = [](const Arrays& a, bool flushed) {
    if (a.blocks * sizeof(std::uint64_t) < sizeof(RgbScan)) return kOutOfDomain;
    const RgbScan& found = *reinterpret_cast<const RgbScan*>(a.target);
    RgbScan reference;
    for (std::size_t i = 0; i < a.n(); ++i) {
      float v[3] = {a.in(0)[i], a.in(1)[i], a.in(2)[i]};
      for (float& x : v) x = flushed && std::abs(x) < std::numeric_limits<float>::min() ? 0.0F : x;
      const auto any = [&](auto is) { return is(v[0]) || is(v[1]) || is(v[2]) ? 1U : 0U; };
      reference.nonfinite += any([](float x) { return !std::isfinite(x); });
      reference.negative += any([](float x) { return x < 0; });
      reference.over_one += any([](float x) { return x > 1; });
      for (const float x : v) reference.maximum = x > reference.maximum ? x : reference.maximum;
    }
    const bool good = found.nonfinite == reference.nonfinite && found.negative == reference.negative &&
                      found.over_one == reference.over_one && found.maximum == reference.maximum;
    return good ? 0.0 : kBeyond;
  };
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

void add_differences(std::vector<Operation>& to) {
  add_ciede2000(to);
  add_scan(to);
}

}  // namespace spectile::measure
