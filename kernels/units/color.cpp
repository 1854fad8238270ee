// Projection, colour transforms, gamut and conversions: one unit, compiled once per instruction set.
#include "kernels/colorimetry.inl"
#include "kernels/convert.inl"
#include "kernels/upsampling/gamut.inl"

namespace spectile::kernels::SPECTILE_ISA {

extern const ColorKernels color;
constexpr ColorKernels color = {
    .weighted_sum = weighted_sum,
    .project = project,
    .transform3 = transform3,
    .gamut_clip = gamut_clip,
    .scan_rgb = scan_rgb,
    .half_to_float = half_to_float,
    .float_to_half = float_to_half,
    .rows_to_blocks = rows_to_blocks,
    .blocks_to_rows = blocks_to_rows,
};

}  // namespace spectile::kernels::SPECTILE_ISA
