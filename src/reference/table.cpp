// The reference's KernelTable: the scalar twins.
#include "src/reference/table.hpp"

#include "src/reference/twins.hpp"

namespace spectile::reference {

const kernels::KernelTable kKernelTable = {
    {
        .add = add,
        .subtract = subtract,
        .multiply = multiply,
        .divide = divide,
        .divide_or_zero = divide_or_zero,
        .negate = negate,
        .scale = scale,
        .multiply_add = multiply_add,
        .lerp = lerp,
        .sqrt = sqrt,
        .exp = exp,
        .pow = pow,
        .clamp = clamp,
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
    },
    {
        .weighted_sum = weighted_sum,
        .project = project,
        .transform3 = transform3,
        .gamut_clip = gamut_clip,
        .scan_rgb = scan_rgb,
        .half_to_float = half_to_float,
        .float_to_half = float_to_half,
    },
    {
        .smits_blocks = smits_blocks,
        .smits_rows_float = smits_rows_float,
        .smits_rows_half = smits_rows_half,
        .smits_fold = smits_fold,
        .sigmoid_solve = sigmoid_solve,
        .sigmoid_continuation = sigmoid_continuation,
        .sigmoid_blocks = sigmoid_blocks,
        .sigmoid_rows_float = sigmoid_rows_float,
        .sigmoid_rows_half = sigmoid_rows_half,
        .sigmoid_project = sigmoid_project,
    },
    {
        .interpolate_even = interpolate_even,
        .interpolate_knots = interpolate_knots,
        .planck = planck,
        .gaussians = gaussians,
        .sigmoid_at = sigmoid_at,
        .even_wavelengths = even_wavelengths,
        .visible_wavelengths = visible_wavelengths,
        .project_wavelengths = project_wavelengths,
    },
    {
        .film_weigh_wavelengths = film_weigh_wavelengths,
        .film_weigh_bands = film_weigh_bands,
        .film_band_quads = film_band_quads,
        .film_hits = film_hits,
        .film_place = film_place,
        .film_add = film_add,
        .film_add_hits = film_add_hits,
        .film_add_moments = film_add_moments,
        .film_count = film_count,
    },
    "scalar",
    1,
};

}  // namespace spectile::reference
