// Film: making, merging and comparing films.
#include <algorithm>
#include <mutex>
#include <shared_mutex>
#include <spectile/film/film.hpp>

#include "src/base/out_of_memory.hpp"
#include "src/film/responses.hpp"
#include "src/film/scratch.hpp"
#include "src/film/state.hpp"

namespace spectile {

Film::Film(std::shared_ptr<State> state) : state_(std::move(state)) {}
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

Result<Film> Film::create(const FilmOptions& options) {
  const auto make = [&]() -> Result<Film> {
    SPECTILE_ASSIGN(auto state, prepare_film(options));
    SPECTILE_TRY(make_film_responses(*state));
    return Film(std::move(state));
  };
  return guard_memory(make, "no memory for a film of {} x {} pixels", options.width, options.height);
}

const FilmOptions& Film::options() const noexcept {
  return state_->options;
}

PixelWindow Film::window() const noexcept {
  return state_->window;
}

FilmStats Film::stats() const {
  const State& s = *state_;
  FilmStats out;
  out.accepted = s.counts[kernels::kFilmAccepted];
  out.rejected = {.nan = s.counts[kernels::kFilmNan],
                  .infinite = s.counts[kernels::kFilmInfinite],
                  .negative = s.counts[kernels::kFilmNegative],
                  .outside = s.counts[kernels::kFilmOutside],
                  .beyond_range = s.counts[kernels::kFilmBeyondRange]};
  out.tiles = s.tiles.size();
  for (std::size_t t = 0; t < s.tiles.size(); ++t) {
    const std::scoped_lock lock(s.tile_mutex(t));
    if (s.tiles[t] != nullptr) ++out.touched_tiles;
  }
  const std::size_t tile_bytes = s.layout.limbs * sizeof(std::int64_t);
  out.bytes_per_pixel = tile_bytes / kernels::kFilmTilePixels;
  out.bytes = out.touched_tiles * tile_bytes;
  return out;
}

Result<void> Film::merge(const Film& other) {
  if (&other == this) return make_error(ErrorCode::kBadArgument, "a film cannot be merged with itself");
  State& to = *state_;
  State& from = *other.state_;
  if (const auto difference = film_difference(to, from)) {
    return make_error(ErrorCode::kBadArgument, "the films differ in {}", *difference);
  }
  // A file of either holds all of the other or none of it.
  std::shared_lock whole_to(to.whole, std::defer_lock);
  std::shared_lock whole_from(from.whole, std::defer_lock);
  std::lock(whole_to, whole_from);
  for (std::size_t t = 0; t < to.tiles.size(); ++t) {
    // Both films' mutexes: whichever is merged into the other at the same time.
    const std::scoped_lock lock(to.tile_mutex(t), from.tile_mutex(t));
    if (from.tiles[t] == nullptr) continue;
    if (to.touch(t) == nullptr) {
      return make_error(ErrorCode::kOutOfMemory, "no memory for another tile of the film");
    }
    to.normalize_carries(t);
    from.normalize_carries(t);
    for (std::size_t i = 0; i < to.layout.limbs; ++i) {
      // Sums beyond the range may wrap around; normalizing the carries finds them.
      to.tiles[t][i] = static_cast<std::int64_t>(static_cast<std::uint64_t>(to.tiles[t][i]) +
                                                 static_cast<std::uint64_t>(from.tiles[t][i]));
    }
    to.additions[t] += std::max<std::uint64_t>(1, from.additions[t]);
    to.normalize_carries(t);
  }
  for (std::size_t r = 0; r < to.counts.size(); ++r) to.counts[r] += from.counts[r];
  if (from.overflown) to.overflown = true;
  if (!to.overflown) return {};
  return film_overflow(to);
}

bool Film::same_contents(const Film& other) const {
  State& a = *state_;
  State& b = *other.state_;
  if (&a == &b) return true;
  if (film_difference(a, b)) return false;
  for (std::size_t r = 0; r < a.counts.size(); ++r) {
    if (a.counts[r] != b.counts[r]) return false;
  }
  const std::vector<std::int64_t> zeros(a.layout.limbs, 0);
  for (std::size_t t = 0; t < a.tiles.size(); ++t) {
    const std::scoped_lock lock(a.tile_mutex(t), b.tile_mutex(t));
    a.normalize_carries(t);
    b.normalize_carries(t);
    const std::int64_t* const limbs_a = a.tiles[t] == nullptr ? zeros.data() : a.tiles[t];
    const std::int64_t* const limbs_b = b.tiles[t] == nullptr ? zeros.data() : b.tiles[t];
    if (!std::equal(limbs_a, limbs_a + a.layout.limbs, limbs_b)) return false;
  }
  return true;
}

}  // namespace spectile
