// Scalar twins of the film's kernels; their formulas are in kernels/abi.hpp.
#pragma once

#include "kernels/abi.hpp"

namespace spectile::reference {

void film_weigh_wavelengths(float* quads, bool luminance, std::int32_t* reasons,
                            const kernels::FilmCurves& curves, const kernels::FilmLimits& limits,
                            const float* const* radiance, const float* const* lambda_nm,
                            const float* const* density, const float* weight, float factor, std::size_t count,
                            std::size_t n) noexcept;
void film_weigh_bands(float* quads, bool luminance, std::int32_t* reasons, const float* weights,
                      const kernels::FilmLimits& limits, const float* const* radiance, const float* weight,
                      std::size_t bands, std::size_t n) noexcept;
void film_band_quads(float* quads, std::size_t stride, std::int32_t* reasons,
                     const kernels::FilmLimits& limits, const float* const* radiance, const float* weight,
                     std::size_t bands, std::size_t n) noexcept;
void film_hits(std::int32_t* band, float* hits, std::int32_t* reasons, const kernels::BucketTable& table,
               const kernels::FilmLimits& limits, const float* const* radiance, const float* const* lambda_nm,
               const float* const* density, const float* weight, float reference, std::size_t count,
               std::size_t n) noexcept;
void film_place(std::int32_t* address, std::int32_t tiles[2], std::uint64_t counts[kernels::kFilmReasons],
                const kernels::FilmWindow& window, const float* x, const float* y, const float* weight,
                const std::int32_t* reasons, std::size_t n) noexcept;
void film_add(std::int64_t* const* tiles, std::size_t offset, const kernels::FilmGrid& grid,
              const kernels::FilmEntries& entries, const float* quads, std::size_t count,
              std::size_t limbs) noexcept;
void film_add_hits(std::int64_t* const* tiles, std::size_t offset, const kernels::FilmGrid& grid,
                   const kernels::FilmEntries& entries, const std::int32_t* band, const float* hits,
                   std::size_t count, std::size_t n, std::size_t bands) noexcept;
void film_add_moments(std::int64_t* const* tiles, std::size_t offset, const kernels::FilmMomentGrid& grid,
                      const kernels::FilmEntries& entries, const float* quads) noexcept;
void film_count(std::int64_t* const* tiles, std::size_t offset, const kernels::FilmEntries& entries) noexcept;

}  // namespace spectile::reference
