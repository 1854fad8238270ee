// Spectra at single wavelengths: one unit, compiled once per instruction set.
#include "kernels/wavelengths.inl"

#include "kernels/upsampling/own_wavelengths.inl"

namespace spectile::kernels::SPECTILE_ISA {

extern const WavelengthKernels wavelengths;
constexpr WavelengthKernels wavelengths = {
    .interpolate_even = interpolate_even,
    .interpolate_knots = interpolate_knots,
    .planck = planck,
    .gaussians = gaussians,
    .sigmoid_at = sigmoid_at,
    .centre_places = centre_places,
    .mixtures_at = mixtures_at,
    .bases_at = bases_at,
    .grid_at = grid_at,
    .sigmoids_at = sigmoids_at,
    .even_wavelengths = even_wavelengths,
    .visible_wavelengths = visible_wavelengths,
    .table_wavelengths = table_wavelengths,
    .project_wavelengths = project_wavelengths,
};

}  // namespace spectile::kernels::SPECTILE_ISA
