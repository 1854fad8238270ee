// State of a film: its options prepared for the kernels, and its tiles of exact sums.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <spectile/film/film.hpp>
#include <string>
#include <vector>

#include "kernels/abi.hpp"
#include "src/base/zeroed_pages.hpp"
#include "src/lanes/knot_index.hpp"

namespace spectile {

/// Bits of a coarse limb that one contribution may fill, and steps of a limb in one of the limb before.
inline constexpr int kFilmCoarseBits = 31;
inline constexpr int kFilmLimbBits = 44;

/// Carries what a limb holds beyond its share over into the limb before it. Limbs of damaged files wrap
/// round.
inline void film_carry(std::int64_t& before, std::int64_t& limb) {
  const std::int64_t whole = limb >> (kFilmLimbBits - 1);
  const std::int64_t over = (whole + 1) >> 1;  // the nearest number of steps, of halves the next
  const auto taken = static_cast<std::uint64_t>(over) << kFilmLimbBits;
  limb = static_cast<std::int64_t>(static_cast<std::uint64_t>(limb) - taken);
  before = static_cast<std::int64_t>(static_cast<std::uint64_t>(before) + static_cast<std::uint64_t>(over));
}

/// Three response curves as the film's kernels take them: of wavelengths the rows of FilmCurves, of bands the
/// weights [bands][4].
struct FilmResponse {
  std::string name;  ///< "cie1931", "cie1964", or the sensor's
  FloatBuffer table;
  float largest = 0;  ///< see kernels::FilmCurves
};

/// Where a tile's parts begin, in limbs of 64 bits; each part holds a fixed number of limbs a pixel.
struct FilmTileLayout {
  std::size_t quads = 1;     ///< of colours a pixel: XYZ or the first sensor with the weight
  std::size_t bands = 0;     ///< of the spectrum, 0 where none is kept
  bool own_weights = false;  ///< kFilmHitLimbs a band, value and weight; else quads of 4 bands
  bool moments = false;      ///< kFilmMomentLimbs a pixel
  bool counts = false;       ///< 1 limb a pixel
  std::size_t spectrum_at = 0;
  std::size_t moments_at = 0;
  std::size_t counts_at = 0;
  std::size_t limbs = 0;

  std::size_t band_quads() const noexcept { return (bands + 3) / 4; }
  /// Limbs of the spectrum a pixel.
  std::size_t spectrum_limbs() const noexcept {
    return own_weights ? kernels::kFilmHitLimbs * bands : kernels::kFilmQuadLimbs * band_quads();
  }
};

/// A profile of the pixel filter as a table over distances from 0 to its radius.
struct FilmProfile {
  FloatBuffer pairs;
  kernels::EvenTable table;
  float radius = 0.5F;
  int max_pixels = 1;  ///< that a sample reaches along the axis
};

/// Where a pixel of the film is in its tile.
inline std::size_t pixel_in_tile(int x, int y) noexcept {
  return static_cast<std::size_t>(y % kFilmTile) * kFilmTile + static_cast<std::size_t>(x % kFilmTile);
}

struct FilmScratch;

struct Film::State {
  FilmOptions options;
  PixelWindow window;
  kernels::FilmWindow kernel_window{};
  int tiles_x = 0;
  int tiles_y = 0;
  FilmTileLayout layout;
  kernels::FilmGrid grid{};       ///< of quads with the weight last
  kernels::FilmGrid band_grid{};  ///< of four bands, or value and weight twice
  kernels::FilmMomentGrid moment_grid{};
  kernels::FilmLimits limits{};
  std::vector<FilmResponse> responses;
  KnotIndex bucket_index;
  std::vector<std::int32_t> bucket_bands;
  kernels::BucketTable buckets;
  FilmProfile along_x, along_y;  ///< for splatting

  /// Guards a share of the tiles: their limbs, pointers and counters.
  struct alignas(64) Stripe {
    std::mutex mutex;
  };
  static constexpr std::size_t kStripes = 64;
  std::unique_ptr<Stripe[]> stripes;
  std::vector<std::int64_t*> tiles;       ///< null: untouched
  std::vector<std::uint64_t> additions;   ///< to a tile: also its version
  std::vector<std::uint64_t> normalized;  ///< additions when its carries were last normalized
  ZeroedPages pages;
  std::array<std::atomic<std::uint64_t>, kernels::kFilmReasons> counts{};
  std::atomic<bool> overflown = false;

  /// Held together while batches are added, and alone while a film is saved: files hold whole batches.
  std::shared_mutex whole;

  std::mutex scratch_mutex;
  std::vector<std::unique_ptr<FilmScratch>> scratch;

  State();
  ~State();

  std::mutex& tile_mutex(std::size_t tile) const noexcept { return stripes[tile % kStripes].mutex; }
  /// The tile of a pixel in the window.
  std::size_t tile_at(int x, int y) const noexcept {
    const auto column = static_cast<std::size_t>((x - kernel_window.origin_x) / kFilmTile);
    const auto row = static_cast<std::size_t>((y - kernel_window.origin_y) / kFilmTile);
    return row * static_cast<std::size_t>(tiles_x) + column;
  }
  /// The pixels of a tile that lie in the window.
  PixelWindow tile_window(std::size_t tile) const noexcept;
  /// Memory for a tile, where it has none; its mutex held. Null where there is no memory.
  std::int64_t* touch(std::size_t tile) noexcept;
  /// Normalizes the carries, so that equal sums have equal limbs; its mutex held.
  void normalize_carries(std::size_t tile) noexcept;
};

/// Access to a film's state for the operations on films.
struct FilmAccess {
  /// Developing and saving a film that does not change still normalize its carries.
  static Film::State& state(const Film& film) noexcept { return *film.state_; }
  static Film make(std::unique_ptr<Film::State> state) { return Film(std::move(state)); }
  using State = Film::State;
};

/// Checks the options and makes all of a film but its responses.
Result<std::unique_ptr<FilmAccess::State>> prepare_film(const FilmOptions& options);

/// The error of a film whose sums have overflown.
Error film_overflow(const FilmAccess::State& state);

/// Which option differs between two films, with both values; nothing where none does.
std::optional<std::string> film_difference(const FilmAccess::State& a, const FilmAccess::State& b);

}  // namespace spectile
