// The tables of one instruction set's units, under its name.
#include "kernels/abi.hpp"
#include "kernels/simd/isa.hpp"

namespace spectile::kernels::SPECTILE_ISA {

extern const ArithmeticKernels arithmetic;
extern const ColorKernels color;
extern const UpsamplingKernels upsampling;
extern const WavelengthKernels wavelengths;
extern const FilmKernels film;
extern const TextureKernels texture;

extern const KernelFamilies families;
constexpr KernelFamilies families = {
    SPECTILE_ISA_NAME, static_cast<int>(kWidth), &arithmetic, &color, &upsampling, &wavelengths, &film,
    &texture};

}  // namespace spectile::kernels::SPECTILE_ISA
