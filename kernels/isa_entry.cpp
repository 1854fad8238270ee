// The one translation unit of the kernels; the build compiles it once per instruction set.
#include "kernels/arithmetic.inl"
#include "kernels/colorimetry.inl"
#include "kernels/convert.inl"
#include "kernels/exponential.inl"
#include "kernels/film_add.inl"
#include "kernels/film_weigh.inl"
#include "kernels/gamut.inl"
#include "kernels/peak.inl"
#include "kernels/sigmoid.inl"
#include "kernels/sigmoid_continuation.inl"
#include "kernels/sigmoid_search.inl"
#include "kernels/upsample.inl"
#include "kernels/wavelengths.inl"

#if defined(SPECTILE_KERNEL_AVX512)
#define SPECTILE_KERNEL_NAME avx512
#define SPECTILE_KERNEL_TEXT "avx512"
#elif defined(SPECTILE_KERNEL_AVX2)
#define SPECTILE_KERNEL_NAME avx2
#define SPECTILE_KERNEL_TEXT "avx2"
#elif defined(SPECTILE_KERNEL_SSE42)
#define SPECTILE_KERNEL_NAME sse42
#define SPECTILE_KERNEL_TEXT "sse4.2"
#elif defined(SPECTILE_KERNEL_NEON)
#define SPECTILE_KERNEL_NAME neon
#define SPECTILE_KERNEL_TEXT "neon"
#endif

namespace spectile::kernels {

extern const KernelTable SPECTILE_KERNEL_NAME;

constexpr KernelTable SPECTILE_KERNEL_NAME = {
    .name = SPECTILE_KERNEL_TEXT,
    .lanes = static_cast<int>(kWidth),
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
    .weighted_sum = weighted_sum,
    .project = project,
    .transform3 = transform3,
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
    .look_up_even = look_up_even,
    .look_up_knots = look_up_knots,
    .planck = planck,
    .gaussians = gaussians,
    .sigmoid_at = sigmoid_at,
    .even_wavelengths = even_wavelengths,
    .visible_wavelengths = visible_wavelengths,
    .project_wavelengths = project_wavelengths,
    .film_weigh_wavelengths = film_weigh_wavelengths,
    .film_weigh_bands = film_weigh_bands,
    .film_band_quads = film_band_quads,
    .film_hits = film_hits,
    .film_place = film_place,
    .film_add = film_add,
    .film_add_hits = film_add_hits,
    .film_add_moments = film_add_moments,
    .film_count = film_count,
    .gamut_clip = gamut_clip,
    .half_to_float = half_to_float,
    .float_to_half = float_to_half,
    .scan_rgb = scan_rgb,
    .peak_load = peak_load,
    .peak_store = peak_store,
    .peak_copy = peak_copy,
    .peak_multiply_add = peak_multiply_add,
    .peak_fused = peak_fused,
    .peak_divide = peak_divide,
};

}  // namespace spectile::kernels
