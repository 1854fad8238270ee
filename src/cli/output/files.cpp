// The files that a command writes and reads: no written one is another of them.
#include "src/cli/output/files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <spectile/output_file.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/spectra/spectrum_table.hpp>
#include <string_view>
#include <system_error>

#include "src/cli/options/parse.hpp"
#include "src/cli/output/messages.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

/// Where a name leads that has no file yet, links followed.
std::string resolved(const std::string& path) {
  std::error_code error;
  std::filesystem::path at = std::filesystem::absolute(path, error);
  constexpr int kMaxLinks = 40;  // as Linux follows
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(at, error); ++i) {
    // A relative target replaces the link's own name; an absolute one replaces all of it.
    at = at.parent_path() / std::filesystem::read_symlink(at, error);
  }
  const std::filesystem::path whole = std::filesystem::weakly_canonical(at, error);
  return (error ? at.lexically_normal() : whole).string();
}

/// The same text for the same file. Empty for folders, devices and pipes, which hold nothing that could be
/// lost.
std::string identity(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return resolved(path);
  return S_ISREG(status.st_mode) ? fmt::format("{}:{}", status.st_dev, status.st_ino) : std::string();
}

/// The error of a written file that is another one.
std::string sentence(const NamedFile& written, const NamedFile& other) {
  if (written.role == kOutputRole && other.role == kOutputRole) {
    return fmt::format("{}: two inputs would be written there", written.path);
  }
  if (written.role == kOutputRole && other.role == kInputRole) {
    return fmt::format("{}: input and output are the same file", written.path);
  }
  return fmt::format("{}: {} and {} are the same file", written.path, written.role, other.role);
}

// Endings of images in other formats.
constexpr std::string_view kOtherFormats[] = {
    ".avif", ".bmp",  ".cin",  ".dds", ".dng", ".dpx", ".fits", ".gif",  ".hdr", ".heic",
    ".heif", ".ico",  ".iff",  ".j2k", ".jp2", ".jpe", ".jpg",  ".jpeg", ".jxl", ".ktx",
    ".pam",  ".pbm",  ".pcx",  ".pfm", ".pgm", ".pic", ".png",  ".pnm",  ".ppm", ".psd",
    ".rgb",  ".rgba", ".rgbe", ".sgi", ".svg", ".tga", ".tif",  ".tiff", ".webp"};

bool is_other_format(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  return std::find(std::begin(kOtherFormats), std::end(kOtherFormats), ending) != std::end(kOtherFormats);
}

}  // namespace

std::vector<NamedFile> named_files(const std::vector<std::string>& paths, const std::string& role) {
  std::vector<NamedFile> out;
  out.reserve(paths.size());
  for (const std::string& path : paths) out.push_back({path, role});
  return out;
}

std::vector<NamedFile> files_among(const std::vector<NamedFile>& names_or_files) {
  std::vector<NamedFile> out;
  for (const NamedFile& file : names_or_files) {
    if (!file.path.empty() && !named_spectrum(file.path)) {
      out.push_back({parse_spectrum_path(file.path).file, file.role});
    }
  }
  return out;
}

std::string file_of_bands(const std::string& bands) {
  return Bands::parse(bands) ? std::string() : bands;
}

void check_files(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  std::map<std::string, const NamedFile*> known;
  for (const NamedFile& file : read) {
    if (!file.path.empty()) known.emplace(identity(file.path), &file);
  }
  known.erase("");
  std::map<std::string, const NamedFile*> taken;
  for (const NamedFile& file : written) {
    if (file.path.empty()) continue;
    const std::string id = identity(file.path);
    if (id.empty()) continue;
    if (const auto it = known.find(id); it != known.end()) {
      const NamedFile& other = *it->second;
      const bool output = file.role == kOutputRole && other.role != kInputRole;
      throw Stop(complain_usage(output ? fmt::format("{}: the output is {}, which it is made from: {}",
                                                     file.path, other.path, other.role)
                                       : sentence(file, other)));
    }
    if (const auto [it, added] = taken.emplace(id, &file); !added) {
      throw Stop(complain_usage(sentence(file, *it->second)));
    }
  }
}

void check_outputs(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  check_files(written, read);
  for (const NamedFile& file : written) {
    if (!file.path.empty()) take(check_writable(file.path));
  }
}

LoadedFilm load_film_file(const std::string& path, int threads, std::vector<std::string>& notes) {
  LoadedFilm film = take(load_film(path, threads, [](const Progress&) { return !interrupted(); }));
  if (!film.has_checksum) {
    notes.push_back(path + ": has no checksum, as films of earlier versions; damage may go unseen");
  }
  return film;
}

bool is_image_name(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  return ending == ".exr" || ending == ".sxr" || is_other_format(path);
}

void check_image_name(const std::string& output) {
  std::error_code ignored;
  if (!is_other_format(output) || std::filesystem::is_directory(output, ignored)) return;
  const std::filesystem::path path(output);
  throw Stop(complain_usage(fmt::format("{}: images are written as OpenEXR only, not as {}; name it {}",
                                        output, path.extension().string().substr(1),
                                        std::filesystem::path(path).replace_extension(".exr").string())));
}

}  // namespace spectile::cli
