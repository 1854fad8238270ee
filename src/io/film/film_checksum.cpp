// The checksum of a partial film: of its options, its counts and its sums.
#include "src/io/film/film_checksum.hpp"

#include <fmt/format.h>

#include <algorithm>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace spectile::io {
namespace {

/// A running XXH3 of 128 bits; its state is too large for some stacks.
class Hash {
 public:
  Hash() { XXH3_128bits_reset(state_.get()); }
  void add(const void* data, std::size_t bytes) { XXH3_128bits_update(state_.get(), data, bytes); }
  void add(std::uint64_t value) { add(&value, sizeof value); }
  void add(const std::string& text) {
    add(text.size());
    add(text.data(), text.size());
  }
  std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_ = make_state();
  static std::unique_ptr<XXH3_state_t, Free> make_state() {
    std::unique_ptr<XXH3_state_t, Free> state(XXH3_createState());
    if (!state) throw std::bad_alloc();
    return state;
  }
};

void add_contents(const TextAttributes& attributes, const FilmAccess::State& state, Hash& hash) {
  for (const auto& [name, text] : attributes) {
    hash.add(name);
    hash.add(text);
  }
  for (std::size_t t = 0; t < state.tiles.size(); ++t) {
    const std::int64_t* const limbs = state.tiles[t];
    const std::size_t count = state.layout.limbs;
    // A tile of zeros is not saved, and so is none.
    if (limbs == nullptr || std::all_of(limbs, limbs + count, [](std::int64_t v) { return v == 0; }))
      continue;
    hash.add(t);
    hash.add(limbs, count * sizeof(std::int64_t));
  }
}

}  // namespace

std::string film_checksum(const TextAttributes& attributes, const FilmAccess::State& state) {
  Hash hash;
  hash.add(static_cast<std::uint64_t>(state.options.width));
  hash.add(static_cast<std::uint64_t>(state.options.height));
  add_contents(attributes, state, hash);
  return "xxh3-128/2 " + hash.text();
}

bool has_checksum(const std::string& checksum, const TextAttributes& attributes,
                  const FilmAccess::State& state) {
  const std::string first = "xxh3-128 ";
  if (!checksum.starts_with(first)) return checksum == film_checksum(attributes, state);
  Hash hash;
  add_contents(attributes, state, hash);
  return checksum == first + hash.text();
}

}  // namespace spectile::io
