// Loops over lanes for representations whose products the engine has no kernel for.
#pragma once

#include <cstddef>
#include <string_view>

namespace spectile::measure {

inline constexpr std::size_t kLoopLanes = 64;  ///< of a block
/// Functions of the bases that there are loops for.
inline constexpr std::size_t kBasisSizes[] = {4, 8};
/// Terms of a polynomial: of degree 3.
inline constexpr std::size_t kTerms = 4;

/// Plain C for a compiler's vectors, compiled once for each level of the processor. Operands do not overlap.
struct LaneLoops {
  const char* flags;
  /// out = matrix * in on each lane, for the matrices of kBasisSizes[i]. Shapes: in, out [block][n][64],
  /// matrix [block][n (n + 1) / 2][64]: rows of the lower triangle of a symmetric one.
  void (*apply[2])(float* out, const float* in, const float* matrix, std::size_t blocks);
  /// out = a * b without terms above the third, in Chebyshev's basis. Shapes: [polynomial][kTerms][64].
  void (*multiply_chebyshev)(float* out, const float* a, const float* b, std::size_t polynomials);
  /// Sums over wavelengths of product times weight. Shapes: product [block][n][64], weights
  /// [block][n][3][64], xyz [3][block][64].
  void (*weigh)(float* xyz, const float* product, const float* weights, std::size_t n, std::size_t blocks);
};

/// Those compiled for the level of the architecture that has the vectors of an instruction set's kernels.
const LaneLoops& lane_loops(std::string_view isa);

}  // namespace spectile::measure
