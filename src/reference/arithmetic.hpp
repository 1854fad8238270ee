// Scalar twins of the element-wise kernels and of the folds over bands.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectile::reference {

void add(float* dst, const float* a, const float* b, std::size_t n) noexcept;
void subtract(float* dst, const float* a, const float* b, std::size_t n) noexcept;
void multiply(float* dst, const float* a, const float* b, std::size_t n) noexcept;
void divide(float* dst, const float* a, const float* b, std::size_t n) noexcept;
void divide_or_zero(float* dst, const float* a, const float* b, std::size_t n) noexcept;
void negate(float* dst, const float* a, std::size_t n) noexcept;
void scale(float* dst, const float* a, float s, std::size_t n) noexcept;
void multiply_add(float* dst, const float* a, const float* b, const float* c, std::size_t n) noexcept;
void lerp(float* dst, const float* a, const float* b, float t, std::size_t n) noexcept;
void sqrt(float* dst, const float* a, std::size_t n) noexcept;
void exp(float* dst, const float* a, std::size_t n) noexcept;
void pow(float* dst, const float* a, float y, std::size_t n) noexcept;
void clamp(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept;
void minimum(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
void maximum(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
void black_mask(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
void nan_mask(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
void equal_mask(std::uint64_t* mask, const float* a, const float* b, std::size_t bands,
                std::size_t blocks) noexcept;

}  // namespace spectile::reference
