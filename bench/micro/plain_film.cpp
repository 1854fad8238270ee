// What the film would be with ordinary sums, compiled for this machine.
#include "bench/micro/plain_film.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <utility>

#include "bench/micro/report.hpp"

namespace bench {

using spectile::kernels::kFilmReasons;
using spectile::kernels::kFilmTilePixels;

namespace {

constexpr int kTileShift = 2 * spectile::kernels::kFilmTileLog2;
/// As in the film: changes of tile in a chunk up to which it is not sorted, and how far ahead pixels are
/// fetched where it is.
constexpr std::size_t kFewRuns = 128;
constexpr std::size_t kEntriesARun = 8;

// The compiler's own vectors: with -march=native one addition of four doubles.
using Double4 = double __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16), aligned(4)));

inline void add_quad(double* pixel, const float* quad) {
  auto& sums = *reinterpret_cast<Double4*>(pixel);
  sums += __builtin_convertvector(*reinterpret_cast<const Float4*>(quad), Double4);
}

}  // namespace

PlainFilm::PlainFilm(const spectile::Film& like, const spectile::kernels::KernelTable& table)
    : like_(spectile::FilmAccess::state(like)),
      table_(table),
      tiles_(like_.tiles.size()),
      additions_(like_.tiles.size()),
      quads_(report::need(spectile::FloatBuffer::create(4 * kChunk))),
      reasons_(kChunk),
      address_(kChunk),
      sorted_address_(kChunk),
      sorted_sample_(kChunk) {}

void PlainFilm::touch(std::size_t tile, std::size_t count) {
  if (tiles_[tile] == nullptr) {
    tiles_[tile] = static_cast<double*>(pages_.take(4 * kFilmTilePixels * sizeof(double)));
    if (tiles_[tile] == nullptr) std::abort();
  }
  additions_[tile] += count;
}

void PlainFilm::add(const spectile::WavelengthSamples& samples) {
  for (std::size_t i = 0; i < samples.x.size(); i += kChunk) {
    add_chunk(samples, i, std::min(kChunk, samples.x.size() - i));
  }
}

void PlainFilm::add_chunk(const spectile::WavelengthSamples& s, std::size_t first, std::size_t n) {
  std::array<const float*, 64> radiance{};
  std::array<const float*, 64> lambda{};
  std::array<const float*, 64> density{};
  for (std::size_t k = 0; k < s.radiance.count; ++k) {
    radiance[k] = s.radiance.data + k * s.radiance.stride + first;
    lambda[k] = s.lambda_nm.data + k * s.lambda_nm.stride + first;
    density[k] = s.density.data + k * s.density.stride + first;
  }
  const float* const weight = s.weight.empty() ? nullptr : s.weight.data() + first;
  const spectile::kernels::FilmCurves curves = {
      like_.responses[0].table.data(), static_cast<float>(spectile::kFirstVisibleNm),
      static_cast<std::int32_t>(spectile::kLastVisibleNm - spectile::kFirstVisibleNm),
      like_.responses[0].largest};
  table_.film_weigh_wavelengths(quads_.data(), false, reasons_.data(), curves, like_.limits, radiance.data(),
                                lambda.data(), density.data(), weight,
                                1.0F / static_cast<float>(s.radiance.count), s.radiance.count, n);
  std::array<std::uint64_t, kFilmReasons> counts{};
  std::int32_t tiles[2] = {std::numeric_limits<std::int32_t>::max(), -1};
  table_.film_place(address_.data(), tiles, counts.data(), like_.kernel_window, s.x.data() + first,
                    s.y.data() + first, weight, reasons_.data(), n);
  // What follows does not look for samples that are refused.
  if (counts[spectile::kernels::kFilmAccepted] != n) std::abort();
  if (tiles[0] == tiles[1]) {
    const auto tile = static_cast<std::size_t>(tiles[0]);
    const std::scoped_lock lock(like_.mutex_of(tile));
    touch(tile, n);
    double* const pixels = tiles_[tile];
    for (std::size_t i = 0; i < n; ++i) {
      add_quad(pixels + 4 * (static_cast<std::size_t>(address_[i]) % kFilmTilePixels), quads_.data() + 4 * i);
    }
    return;
  }
  add_entries(n);
}

void PlainFilm::add_entries(std::size_t n) {
  const std::size_t most = std::clamp<std::size_t>(n / kEntriesARun, 1, kFewRuns);
  std::array<std::size_t, kFewRuns + 1> ends{};
  std::size_t runs = 0;
  for (std::size_t i = 0; i < n && runs <= most; ++i) {
    if (i > 0 && address_[i] >> kTileShift == address_[i - 1] >> kTileShift) continue;
    if (runs > 0) ends[runs - 1] = i;
    ++runs;
  }
  if (runs <= most) {
    ends[runs - 1] = n;
    std::size_t i = 0;
    for (std::size_t r = 0; r < runs; ++r) {
      const auto tile = static_cast<std::size_t>(address_[i]) >> kTileShift;
      const std::scoped_lock lock(like_.mutex_of(tile));
      touch(tile, ends[r] - i);
      double* const pixels = tiles_[tile];
      for (; i < ends[r]; ++i) {
        add_quad(pixels + 4 * (static_cast<std::size_t>(address_[i]) % kFilmTilePixels),
                 quads_.data() + 4 * i);
      }
    }
    return;
  }
  std::array<std::size_t, kStripes> next{};
  const auto stripe_of = [](std::int32_t a) {
    return (static_cast<std::size_t>(a) >> kTileShift) % kStripes;
  };
  for (std::size_t i = 0; i < n; ++i) ++next[stripe_of(address_[i])];
  std::size_t sum = 0;
  for (std::size_t& v : next) sum += std::exchange(v, sum);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t to = next[stripe_of(address_[i])]++;
    sorted_address_[to] = address_[i];
    sorted_sample_[to] = static_cast<std::uint32_t>(i);
  }
  const auto pixel = [&](std::size_t i) {
    const auto at = static_cast<std::size_t>(sorted_address_[i]);
    return tiles_[at / kFilmTilePixels] + 4 * (at % kFilmTilePixels);
  };
  for (std::size_t stripe = 0, first = 0; stripe < kStripes; first = next[stripe++]) {
    if (first == next[stripe]) continue;
    const std::scoped_lock lock(like_.stripes[stripe].mutex);
    for (std::size_t i = first; i < next[stripe]; ++i) {
      touch(static_cast<std::size_t>(sorted_address_[i]) >> kTileShift, 1);
      __builtin_prefetch(pixel(i), 1);
    }
    for (std::size_t i = first; i < next[stripe]; ++i) {
      add_quad(pixel(i), quads_.data() + 4 * std::size_t{sorted_sample_[i]});
    }
  }
}

double PlainFilm::at(int x, int y, std::size_t component) const {
  const auto tile =
      static_cast<std::size_t>(y / spectile::kFilmTile * like_.tiles_x + x / spectile::kFilmTile);
  if (tiles_[tile] == nullptr) return 0;
  const auto in_tile =
      static_cast<std::size_t>(y % spectile::kFilmTile * spectile::kFilmTile + x % spectile::kFilmTile);
  const double* const sums = tiles_[tile] + 4 * in_tile;
  if (component == 3) return sums[3];
  return sums[3] == 0 ? 0.0 : sums[component] / sums[3];
}

}  // namespace bench
