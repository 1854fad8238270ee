// Smits mixtures, grids and sigmoids: one unit, compiled once per instruction set.
#include "kernels/upsampling/grid.inl"
#include "kernels/upsampling/sigmoid.inl"
#include "kernels/upsampling/sigmoid_continuation.inl"
#include "kernels/upsampling/sigmoid_search.inl"
#include "kernels/upsampling/smits.inl"

namespace spectile::kernels::SPECTILE_ISA {

extern const UpsamplingKernels upsampling;
constexpr UpsamplingKernels upsampling = {
    .smits_blocks = smits_blocks,
    .smits_rows_float = smits_rows_float,
    .smits_rows_half = smits_rows_half,
    .smits_fold = smits_fold,
    .grid_blocks = grid_blocks,
    .grid_rows_float = grid_rows_float,
    .grid_rows_half = grid_rows_half,
    .grid_fold = grid_fold,
    .sigmoid_solve = sigmoid_solve,
    .sigmoid_continuation = sigmoid_continuation,
    .sigmoid_blocks = sigmoid_blocks,
    .sigmoid_rows_float = sigmoid_rows_float,
    .sigmoid_rows_half = sigmoid_rows_half,
    .sigmoid_project = sigmoid_project,
};

}  // namespace spectile::kernels::SPECTILE_ISA
