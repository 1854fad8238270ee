// Scalar twins of the loops that find a machine's limits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectile::reference {

void peak_load(std::uint32_t* dst, const float* src, std::size_t n) noexcept;
void peak_store(float* dst, float value, std::size_t n, bool non_temporal) noexcept;
void peak_copy(float* dst, const float* src, std::size_t n) noexcept;
void peak_multiply_add(float* dst, const float* src, float m, float a, std::size_t steps,
                       std::size_t n) noexcept;
void peak_fused(float* dst, const float* src, float m, float a, std::size_t steps, std::size_t n) noexcept;
void peak_divide(float* dst, const float* src, float m, std::size_t steps, std::size_t n) noexcept;

}  // namespace spectile::reference
