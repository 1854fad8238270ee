// Declarations of the scalar twins; each has the type of its kernel, whose formula is in kernels/abi.
#pragma once

#include <type_traits>

#include "kernels/abi.hpp"

namespace spectile::reference {

#define SPECTILE_TWIN(Family, name) std::remove_pointer_t<decltype(kernels::Family::name)> name

SPECTILE_TWIN(ArithmeticKernels, add);
SPECTILE_TWIN(ArithmeticKernels, subtract);
SPECTILE_TWIN(ArithmeticKernels, multiply);
SPECTILE_TWIN(ArithmeticKernels, divide);
SPECTILE_TWIN(ArithmeticKernels, divide_or_zero);
SPECTILE_TWIN(ArithmeticKernels, negate);
SPECTILE_TWIN(ArithmeticKernels, complement);
SPECTILE_TWIN(ArithmeticKernels, scale);
SPECTILE_TWIN(ArithmeticKernels, multiply_add);
SPECTILE_TWIN(ArithmeticKernels, lerp);
SPECTILE_TWIN(ArithmeticKernels, sqrt);
SPECTILE_TWIN(ArithmeticKernels, exp);
SPECTILE_TWIN(ArithmeticKernels, pow);
SPECTILE_TWIN(ArithmeticKernels, clamp);
SPECTILE_TWIN(ArithmeticKernels, scale_lanes);
SPECTILE_TWIN(ArithmeticKernels, scale_bands);
SPECTILE_TWIN(ArithmeticKernels, multiply_add_lanes);
SPECTILE_TWIN(ArithmeticKernels, lerp_lanes);
SPECTILE_TWIN(ArithmeticKernels, transmittance);
SPECTILE_TWIN(ArithmeticKernels, update_throughput);
SPECTILE_TWIN(ArithmeticKernels, minimum);
SPECTILE_TWIN(ArithmeticKernels, maximum);
SPECTILE_TWIN(ArithmeticKernels, black_mask);
SPECTILE_TWIN(ArithmeticKernels, nan_mask);
SPECTILE_TWIN(ArithmeticKernels, equal_mask);
SPECTILE_TWIN(ArithmeticKernels, peak_load);
SPECTILE_TWIN(ArithmeticKernels, peak_store);
SPECTILE_TWIN(ArithmeticKernels, peak_copy);
SPECTILE_TWIN(ArithmeticKernels, peak_multiply_add);
SPECTILE_TWIN(ArithmeticKernels, peak_fused);
SPECTILE_TWIN(ArithmeticKernels, peak_divide);

SPECTILE_TWIN(ColorKernels, weighted_sum);
SPECTILE_TWIN(ColorKernels, project);
SPECTILE_TWIN(ColorKernels, transform3);
SPECTILE_TWIN(ColorKernels, gamut_clip);
SPECTILE_TWIN(ColorKernels, scan_rgb);
SPECTILE_TWIN(ColorKernels, half_to_float);
SPECTILE_TWIN(ColorKernels, float_to_half);
SPECTILE_TWIN(ColorKernels, rows_to_blocks);
SPECTILE_TWIN(ColorKernels, blocks_to_rows);

SPECTILE_TWIN(UpsamplingKernels, smits_blocks);
SPECTILE_TWIN(UpsamplingKernels, smits_rows_float);
SPECTILE_TWIN(UpsamplingKernels, smits_rows_half);
SPECTILE_TWIN(UpsamplingKernels, smits_fold);
SPECTILE_TWIN(UpsamplingKernels, grid_blocks);
SPECTILE_TWIN(UpsamplingKernels, grid_rows_float);
SPECTILE_TWIN(UpsamplingKernels, grid_rows_half);
SPECTILE_TWIN(UpsamplingKernels, grid_fold);
SPECTILE_TWIN(UpsamplingKernels, sigmoid_solve);
SPECTILE_TWIN(UpsamplingKernels, sigmoid_continuation);
SPECTILE_TWIN(UpsamplingKernels, sigmoid_blocks);
SPECTILE_TWIN(UpsamplingKernels, sigmoid_rows_float);
SPECTILE_TWIN(UpsamplingKernels, sigmoid_rows_half);
SPECTILE_TWIN(UpsamplingKernels, sigmoid_project);

SPECTILE_TWIN(WavelengthKernels, interpolate_even);
SPECTILE_TWIN(WavelengthKernels, interpolate_knots);
SPECTILE_TWIN(WavelengthKernels, planck);
SPECTILE_TWIN(WavelengthKernels, gaussians);
SPECTILE_TWIN(WavelengthKernels, sigmoid_at);
SPECTILE_TWIN(WavelengthKernels, centre_places);
SPECTILE_TWIN(WavelengthKernels, mixtures_at);
SPECTILE_TWIN(WavelengthKernels, bases_at);
SPECTILE_TWIN(WavelengthKernels, grid_at);
SPECTILE_TWIN(WavelengthKernels, sigmoids_at);
SPECTILE_TWIN(WavelengthKernels, even_wavelengths);
SPECTILE_TWIN(WavelengthKernels, visible_wavelengths);
SPECTILE_TWIN(WavelengthKernels, table_wavelengths);
SPECTILE_TWIN(WavelengthKernels, project_wavelengths);

SPECTILE_TWIN(FilmKernels, film_weigh_wavelengths);
SPECTILE_TWIN(FilmKernels, film_weigh_bands);
SPECTILE_TWIN(FilmKernels, film_band_quads);
SPECTILE_TWIN(FilmKernels, film_hits);
SPECTILE_TWIN(FilmKernels, film_place);
SPECTILE_TWIN(FilmKernels, film_add);
SPECTILE_TWIN(FilmKernels, film_add_hits);
SPECTILE_TWIN(FilmKernels, film_add_moments);
SPECTILE_TWIN(FilmKernels, film_count);

SPECTILE_TWIN(TextureKernels, texture_places);

#undef SPECTILE_TWIN

}  // namespace spectile::reference
