// Fuzzes partial films: what can be loaded is saved as a file that holds the very same film.
#include <array>
#include <spectile/image/film_file.hpp>

#include "fuzz/exr_size.hpp"
#include "fuzz/support.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectile;
  const fuzz::Bytes bytes(data, size);
  if (!fuzz::is_small_image(bytes)) return 0;
  const fuzz::CaseFolder folder(bytes);
  const auto loaded = load_film(folder.input(), 1);
  folder.require_tidy(false);
  if (!fuzz::is_value(loaded)) return 0;
  ImageOptions options;
  options.threads = 1;
  const auto saved = save_film(loaded->film, folder.output(), loaded->progress, options);
  fuzz::require(static_cast<bool>(saved), "a film that was loaded can be saved",
                saved ? "" : saved.error().message);
  const auto again = load_film(folder.output(), 1);
  fuzz::require(static_cast<bool>(again), "a film that was saved can be loaded",
                again ? "" : again.error().message);
  fuzz::require(again->progress == loaded->progress, "the note comes back", loaded->progress);
  fuzz::require(again->film.same_contents(loaded->film), "a film comes back to the bit");
  folder.require_tidy(true);
  for (const FilmLayer layer : {FilmLayer::kSrgb, FilmLayer::kXyz, FilmLayer::kSpectrum}) {
    folder.require_tidy(fuzz::is_value(write_developed(loaded->film, layer, 0, folder.output(), options)));
  }
  return 0;
}
