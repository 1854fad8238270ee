// Element-wise arithmetic, folds, exponentials and peak loops: one unit, compiled once per instruction set.
#include "kernels/arithmetic.inl"

#include "kernels/exponential.inl"
#include "kernels/peak.inl"

namespace spectile::kernels::SPECTILE_ISA {

extern const ArithmeticKernels arithmetic;
constexpr ArithmeticKernels arithmetic = {
    .add = add,
    .subtract = subtract,
    .multiply = multiply,
    .divide = divide,
    .divide_or_zero = divide_or_zero,
    .negate = negate,
    .complement = complement,
    .scale = scale,
    .multiply_add = multiply_add,
    .lerp = lerp,
    .sqrt = sqrt,
    .exp = exp,
    .pow = pow,
    .clamp = clamp,
    .scale_lanes = scale_lanes,
    .scale_bands = scale_bands,
    .multiply_add_lanes = multiply_add_lanes,
    .lerp_lanes = lerp_lanes,
    .transmittance = transmittance,
    .update_throughput = update_throughput,
    .minimum = minimum,
    .maximum = maximum,
    .black_mask = black_mask,
    .nan_mask = nan_mask,
    .equal_mask = equal_mask,
    .peak_load = peak_load,
    .peak_store = peak_store,
    .peak_copy = peak_copy,
    .peak_multiply_add = peak_multiply_add,
    .peak_fused = peak_fused,
    .peak_divide = peak_divide,
};

}  // namespace spectile::kernels::SPECTILE_ISA
