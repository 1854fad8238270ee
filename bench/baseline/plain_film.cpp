// A film with plain sums: the engine's own kernels up to the contributions, then four doubles a pixel.
#include "bench/baseline/plain_film.hpp"

#include <algorithm>
#include <array>

#include "src/base/errors.hpp"
#include "src/film/state.hpp"

namespace spectile::measure {

Result<std::unique_ptr<PlainFilm>> PlainFilm::create(const Film& like, const kernels::KernelTable& table) {
  std::unique_ptr<PlainFilm> out(new PlainFilm(like, table));
  const auto& state = FilmAccess::state(like);
  const auto tiles = static_cast<std::size_t>(state.tiles_x) * static_cast<std::size_t>(state.tiles_y);
  out->pixels_ =
      static_cast<double*>(out->pages_.take(4 * sizeof(double) * kernels::kFilmTilePixels * tiles));
  if (out->pixels_ == nullptr) return make_error(ErrorCode::kOutOfMemory, "no memory for a film of doubles");
  SPECTILE_ASSIGN(out->quads_, FloatBuffer::create(4 * kChunk));
  out->reasons_.resize(kChunk);
  out->address_.resize(kChunk);
  return out;
}

void PlainFilm::add(const WavelengthSamples& s) {
  const auto& like = FilmAccess::state(like_);
  const FilmResponse& response = like.responses[0];
  const kernels::FilmCurves curves = {response.table.data(), static_cast<float>(kFirstVisibleNm),
                                      static_cast<std::int32_t>(kLastVisibleNm - kFirstVisibleNm),
                                      response.largest};
  const std::size_t count = s.radiance.count;
  std::array<const float*, 64> rows[3];
  for (std::size_t first = 0; first < s.x.size(); first += kChunk) {
    const std::size_t n = std::min(kChunk, s.x.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      rows[0][k] = s.radiance.data + k * s.radiance.stride + first;
      rows[1][k] = s.lambda_nm.data + k * s.lambda_nm.stride + first;
      rows[2][k] = s.density.data + k * s.density.stride + first;
    }
    table_.film_weigh_wavelengths({quads_.data(), reasons_.data()},
                                  {rows[0].data(), rows[1].data(), rows[2].data(), nullptr, count, n}, curves,
                                  like.limits, 1.0F / static_cast<float>(count));
    std::int32_t tiles[2] = {INT32_MAX, -1};
    std::array<std::uint64_t, kernels::kFilmReasons> counts{};
    table_.film_place({address_.data(), tiles, counts.data()}, like.kernel_window,
                      {s.x.data() + first, s.y.data() + first, nullptr, reasons_.data(), n});
    const auto pixel = [&](std::size_t i) { return pixels_ + 4 * static_cast<std::size_t>(address_[i]); };
    for (std::size_t i = 0; i < n; ++i) __builtin_prefetch(pixel(i), 1);
    for (std::size_t i = 0; i < n; ++i) {
      double* const sums = pixel(i);
      for (std::size_t c = 0; c < 4; ++c) sums[c] += static_cast<double>(quads_.data()[4 * i + c]);
    }
  }
}

double PlainFilm::luminance(int x, int y) const {
  const auto tile =
      static_cast<std::size_t>(y / kFilmTile * FilmAccess::state(like_).tiles_x + x / kFilmTile);
  const double* const sums = pixels_ + 4 * (tile * kernels::kFilmTilePixels + pixel_in_tile(x, y));
  return sums[3] == 0 ? 0 : sums[1] / sums[3];
}

}  // namespace spectile::measure
