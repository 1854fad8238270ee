// Scalar twins of the kernels for spectra at single wavelengths.
#pragma once

#include "kernels/abi.hpp"

namespace spectile::reference {

void look_up_even(float* dst, const float* lambda_nm, const kernels::EvenTable& table,
                  std::size_t n) noexcept;
void look_up_knots(float* dst, const float* lambda_nm, const kernels::KnotTable& table,
                   std::size_t n) noexcept;
void planck(float* dst, const float* lambda_nm, const kernels::PlanckTable& table, std::size_t n) noexcept;
void gaussians(float* dst, const float* lambda_nm, const kernels::GaussianLobe* lobes, std::size_t count,
               std::size_t n) noexcept;
void sigmoid_at(float* dst, const float* lambda_nm, const float c[3], float lowest_nm, float highest_nm,
                float scale, std::size_t n) noexcept;
void even_wavelengths(float* const* lambda_nm, float* const* density, const float* u,
                      const kernels::WavelengthDensity& d, std::size_t count, std::size_t n) noexcept;
void visible_wavelengths(float* const* lambda_nm, float* const* density, const float* u,
                         const kernels::WavelengthDensity& d, std::size_t count, std::size_t n) noexcept;
void project_wavelengths(float* const dst[3], const float* const* values, const float* const* lambda_nm,
                         const float* const* density, const kernels::EvenTable curves[3], float factor,
                         std::size_t count, std::size_t n) noexcept;

}  // namespace spectile::reference
