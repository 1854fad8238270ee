// Places in textures: one unit, compiled once per instruction set.
#include "kernels/texture.inl"

namespace spectile::kernels::SPECTILE_ISA {

extern const TextureKernels texture;
constexpr TextureKernels texture = {
    .texture_places = texture_places,
};

}  // namespace spectile::kernels::SPECTILE_ISA
