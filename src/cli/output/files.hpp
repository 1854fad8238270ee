// The files that a command writes and reads: no written one is another of them.
#pragma once

#include <spectile/image/film_file.hpp>
#include <string>
#include <vector>

namespace spectile::cli {

/// A file that a command line names, such as {"x.exr", "the output (-o)"}. An empty path: none was given.
struct NamedFile {
  std::string path;
  std::string role;
};

// Roles that several commands share.
inline constexpr const char* kInputRole = "an input";
inline constexpr const char* kOutputRole = "the output (-o)";
inline constexpr const char* kIlluminantRole = "the illuminant (--illuminant)";
inline constexpr const char* kReflectancesRole = "the reflectances (--reflectances)";
inline constexpr const char* kBandsRole = "the bands (--bands)";

/// Files of one role.
std::vector<NamedFile> named_files(const std::vector<std::string>& paths, const std::string& role);

/// Those that are files among texts that may also be names of spectra.
std::vector<NamedFile> files_among(const std::vector<NamedFile>& names_or_files);

/// The file that a text of bands names, as find_bands() takes it; empty where it holds numbers.
std::string file_of_bands(const std::string& bands);

/// Refuses a written file that is also another written one, or one that is read: it would be lost. Files are
/// the same by device and inode, links followed, or, where there is none yet, by the place that their name
/// leads to. Throws: Stop.
void check_files(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

/// The same, and refuses a written file that cannot be written, before there is work to lose. Throws: Stop.
void check_outputs(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

/// A film from its file. Stops at signals. A note is added for one without a checksum. Throws: Stop.
LoadedFilm load_film_file(const std::string& path, int threads, std::vector<std::string>& notes);

/// True for a name that ends as image files do, OpenEXR's own endings among them.
bool is_image_name(const std::string& path);
/// Refuses the name of an image in another format, unless it is a folder. Throws: Stop.
void check_image_name(const std::string& output);

}  // namespace spectile::cli
