// The instruction set that a unit is compiled for: its namespace, its name and its width.
#pragma once

#include <cstddef>

#if defined(SPECTILE_KERNEL_AVX512)
#define SPECTILE_ISA avx512
#define SPECTILE_ISA_NAME "avx512"
#elif defined(SPECTILE_KERNEL_AVX2)
#define SPECTILE_ISA avx2
#define SPECTILE_ISA_NAME "avx2"
#elif defined(SPECTILE_KERNEL_SSE42)
#define SPECTILE_ISA sse42
#define SPECTILE_ISA_NAME "sse4.2"
#elif defined(SPECTILE_KERNEL_NEON)
#define SPECTILE_ISA neon
#define SPECTILE_ISA_NAME "neon"
#else
#error "compile with one of SPECTILE_KERNEL_AVX512, _AVX2, _SSE42, _NEON"
#endif

namespace spectile::kernels {
namespace {

/// Floats of a vector register.
#if defined(SPECTILE_KERNEL_AVX512)
inline constexpr std::size_t kWidth = 16;
#elif defined(SPECTILE_KERNEL_AVX2)
inline constexpr std::size_t kWidth = 8;
#else
inline constexpr std::size_t kWidth = 4;
#endif

}  // namespace
}  // namespace spectile::kernels
