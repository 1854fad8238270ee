// Element-wise operations on samples.
#include <cmath>

#include "bench/operations/operation.hpp"
#include "kernels/exponential_constants.hpp"

namespace spectile::measure {
namespace {

/// Which values are tried: one plane of samples for each operand.
Operation& sample_operation(std::vector<Operation>& to, std::string name, std::size_t operands) {
  Operation& out = add_operation(to, "arithmetic", std::move(name), "sample", {operands, 1}, {1, 1});
  out.fill = uniform_values(operands, 0.01F, 1.0F);
  return out;
}

/// An operation rounded once: u of the result.
template <class F>
void rounded_once(Operation& op, F f, double bound = 1) {
  op.bound = bound;
  op.error = error_against(1, 1, true, bound, [f](const double* in, double* reference, double* /*scale*/) {
    reference[0] = f(in);
  });
}

/// One without rounding: the very value, whatever the denormals.
template <class F>
void exact(Operation& op, F f) {
  rounded_once(op, f, 0);
  op.unit = "exact";
}

void add_basic(std::vector<Operation>& to) {
  using Binary = void (*KernelTable::*)(float*, const float*, const float*, std::size_t) noexcept;
  const auto binary = [&](const char* name, Binary kernel, auto f) -> Operation& {
    Operation& op = sample_operation(to, name, 2);
    op.operations = 1;
    op.run = [kernel](const KernelTable& k, const Arrays& a) {
      (k.*kernel)(a.out(), a.in(0), a.in(1), a.n());
    };
    rounded_once(op, f);
    return to.back();
  };
  binary("add", &KernelTable::add, [](const double* v) { return v[0] + v[1]; });
  binary("subtract", &KernelTable::subtract, [](const double* v) { return v[0] - v[1]; });
  binary("multiply", &KernelTable::multiply, [](const double* v) { return v[0] * v[1]; });
  Operation& divide = binary("divide", &KernelTable::divide, [](const double* v) { return v[0] / v[1]; });
  divide.operations = 0;
  divide.divisions = 1;
  Operation& or_zero = binary("divide_or_zero", &KernelTable::divide_or_zero,
                              [](const double* v) { return v[1] == 0 ? 0.0 : v[0] / v[1]; });
  or_zero.operations = 2;
  or_zero.divisions = 1;

  Operation& negate = sample_operation(to, "negate", 1);
  negate.operations = 1;
  negate.run = [](const KernelTable& k, const Arrays& a) { k.negate(a.out(), a.in(), a.n()); };
  negate.bitwise = true;
  exact(negate, [](const double* v) { return -v[0]; });

  Operation& complement = sample_operation(to, "complement", 1);
  complement.operations = 1;
  complement.run = [](const KernelTable& k, const Arrays& a) { k.complement(a.out(), a.in(), a.n()); };
  rounded_once(complement, [](const double* v) { return 1 - v[0]; });

  // One sample a lane: with more the lanes' own numbers are read from the first-level cache.
  Operation& lanes = sample_operation(to, "scale, each lane", 2);
  lanes.operations = 1;
  lanes.run = [](const KernelTable& k, const Arrays& a) {
    k.scale_lanes(a.out(), a.in(0), a.in(1), 1, a.blocks);
  };
  rounded_once(lanes, [](const double* v) { return v[0] * v[1]; });

  constexpr float kFactor = 0.7F;
  Operation& scale = sample_operation(to, "scale", 1);
  scale.operations = 1;
  scale.run = [](const KernelTable& k, const Arrays& a) { k.scale(a.out(), a.in(), kFactor, a.n()); };
  rounded_once(scale, [](const double* v) { return v[0] * static_cast<double>(kFactor); });

  Operation& clamp = sample_operation(to, "clamp", 1);
  clamp.operations = 4;
  clamp.run = [](const KernelTable& k, const Arrays& a) { k.clamp(a.out(), a.in(), 0.1F, 0.9F, a.n()); };
  exact(clamp, [](const double* v) {
    const double low = 0.1F;
    const double high = 0.9F;
    return v[0] < low ? low : high < v[0] ? high : v[0];
  });
}

void add_compound(std::vector<Operation>& to) {
  Operation& fused = sample_operation(to, "multiply_add", 3);
  fused.operations = 2;
  fused.bound = 2;  // the product, the sum
  fused.run = [](const KernelTable& k, const Arrays& a) {
    k.multiply_add(a.out(), a.in(0), a.in(1), a.in(2), a.n());
  };
  fused.error =
      error_against(1, 2, false, fused.bound, [](const double* v, double* reference, double* scale) {
        reference[0] = v[0] * v[1] + v[2];
        scale[0] = std::abs(v[0] * v[1]) + std::abs(v[2]);
      });

  constexpr float kPart = 0.3F;
  Operation& lerp = sample_operation(to, "lerp", 2);
  lerp.operations = 3;
  lerp.bound = 3;  // 1 - t, a product, the sum
  lerp.run = [](const KernelTable& k, const Arrays& a) { k.lerp(a.out(), a.in(0), a.in(1), kPart, a.n()); };
  lerp.error = error_against(1, 3, false, lerp.bound, [](const double* v, double* reference, double* scale) {
    const double t = kPart;
    reference[0] = (1 - t) * v[0] + t * v[1];
    scale[0] = (1 - t) * std::abs(v[0]) + t * std::abs(v[1]);
  });

  Operation& lanes = sample_operation(to, "lerp, each lane", 3);
  lanes.operations = 4;
  lanes.bound = 3;
  lanes.run = [](const KernelTable& k, const Arrays& a) {
    k.lerp_lanes(a.out(), a.in(0), a.in(1), a.in(2), 1, a.blocks);
  };
  lanes.error =
      error_against(1, 3, false, lanes.bound, [](const double* v, double* reference, double* scale) {
        reference[0] = (1 - v[2]) * v[0] + v[2] * v[1];
        scale[0] = std::abs((1 - v[2]) * v[0]) + std::abs(v[2] * v[1]);
      });

  Operation& root = sample_operation(to, "sqrt", 1);
  root.divisions = 1;
  root.bottleneck = "the divider, which takes longer for a root than for a division";
  root.run = [](const KernelTable& k, const Arrays& a) { k.sqrt(a.out(), a.in(), a.n()); };
  rounded_once(root, [](const double* v) { return std::sqrt(v[0]); });
}

/// The bound of exp and pow, half a unit in the last place and a bit, is at most 1.002 u of the result.
constexpr double kSeriesBound = 1.002;

void add_series(std::vector<Operation>& to) {
  constexpr const char* kChains =
      "two chains of dependent multiply-adds in double, and the conversions' shuffles";
  // On doubles: widen, times log2(e), hold (4), round (3), times ln 2, the series, the exponent (2), narrow.
  constexpr double kExp = 2 * (1 + 1 + 4 + 3 + 1 + 2 * kernels::kExpTerms - 1 + 2 + 1);
  Operation& exp = sample_operation(to, "exp", 1);
  exp.operations = kExp;
  exp.fill = uniform_values(1, -10.0F, 10.0F);
  exp.bottleneck = kChains;
  exp.run = [](const KernelTable& k, const Arrays& a) { k.exp(a.out(), a.in(), a.n()); };
  rounded_once(exp, [](const double* v) { return std::exp(v[0]); });
  exp.bound = kSeriesBound;

  Operation& transmittance = sample_operation(to, "transmittance", 2);
  // The product's scales and halves (6 + 2 + 2 + 5), its limits and choices (4 + 2), the reduction (3 + 5),
  // the series, the powers of two and the scaling (7 + 2).
  transmittance.operations = 6 + 2 + 2 + 5 + 4 + 2 + 3 + 5 + 2 * (kernels::kExpFloatTerms - 1) + 4 + 7 + 2;
  transmittance.fill = uniform_values(2, 0.0F, 3.0F);
  transmittance.run = [](const KernelTable& k, const Arrays& a) {
    k.transmittance(a.out(), a.in(0), a.in(1), 1, a.blocks);
  };
  transmittance.bound = 2 * 1.1;  // in u of the result, of which an ULP is two at most
  transmittance.error = error_against(
      1, 1, true, transmittance.bound,
      [](const double* v, double* reference, double* /*scale*/) { reference[0] = std::exp(-(v[0] * v[1])); });

  Operation& pow = sample_operation(to, "pow", 1);
  // On doubles, beside exp's: exponent and mantissa (5), to around 1 (5), the division's ends (2), its
  // square, the series, three more; on floats the special cases.
  pow.operations = kExp + 2 * (5 + 5 + 2 + 1 + 2 * kernels::kAtanhTerms - 1 + 3) + 12;
  pow.divisions = 4;  // one in double
  pow.bottleneck = "two series one after the other, chains of dependent multiply-adds in double";
  pow.run = [](const KernelTable& k, const Arrays& a) { k.pow(a.out(), a.in(), kPowExponent, a.n()); };
  rounded_once(pow, [](const double* v) { return std::pow(v[0], static_cast<double>(kPowExponent)); });
  pow.bound = kSeriesBound;
}

}  // namespace

void add_arithmetic(std::vector<Operation>& to) {
  add_basic(to);
  add_compound(to);
  add_series(to);
}

}  // namespace spectile::measure
