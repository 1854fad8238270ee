// Partial films as OpenEXR files: saved, loaded and developed, bit for bit.
#pragma once

#include <cstdint>
#include <spectile/film/film.hpp>
#include <spectile/image/image.hpp>
#include <spectile/scene/procedural_scene.hpp>
#include <string>

namespace spectile {

/// Report of a film that was written.
struct FilmFileReport {
  std::uint64_t bytes_written = 0;
  double seconds = 0;
};

/// Saves a film's sums, weights and counts without loss, two 32-bit channels a limb of 64 bits, over the
/// tiles that samples have touched; a preview (R, G, B) where the film keeps XYZ. Equal films give equal
/// files, but for the compression. add() of other threads waits meanwhile, so the file holds whole batches
/// only; it appears at its path whole or not at all: a checkpoint is a save, and whatever ends the run, the
/// last one stands. `progress` is the caller's note of how far it is; load_film() gives it back. Errors:
/// kNoSpace, kNoPermission, kBadFile, kOutOfMemory; kUnavailable for sums beyond the film's range, and for
/// more than 32767 channels, as some 4090 bands fed with wavelengths take them.
Result<FilmFileReport> save_film(const Film& film, const std::string& path, const std::string& progress = {},
                                 const ImageOptions& options = {});

/// A film from its file, and the note saved with it. Sensors in its options are those that are known by their
/// names, or made from the curves in the file; the film itself goes on with the very curves of the one saved.
struct LoadedFilm {
  Film film;
  std::string progress;
  bool has_checksum = true;  ///< false for a file of a version that saved none: nothing proves it whole
};

/// Errors: kBadFile for what is no partial film, is damaged (also by its checksum), or of a version that is
/// not known; kNoPermission; kOutOfMemory; kCancelled where `progress` says so.
Result<LoadedFilm> load_film(const std::string& path, int threads = 0, const ProgressFunction& progress = {});

/// Writes a developed layer as an image, its data window the crop's: R, G, B, or X, Y, Z, or Y, or the
/// layout's spectral channels (radiance), or "weight", "count", "variance".
/// Errors: those of FilmDevelopment and of writing images.
Result<ImageReport> write_developed(const Film& film, FilmLayer layer, std::size_t sensor,
                                    const std::string& path, const ImageOptions& options = {});

/// Writes the exact XYZ of a scene's pixels (channels X, Y, Z) as a film of these options would come to.
/// Errors: those of writing images.
Result<ImageReport> write_scene(const ProceduralScene& scene, const FilmOptions& film,
                                const std::string& path, const ImageOptions& options = {});

}  // namespace spectile
