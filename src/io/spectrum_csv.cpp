// load_spectrum_csv: a spectrum from a two-column text file.
#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <spectile/measured_spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/io/atomic_file.hpp"

namespace spectile {
namespace {

constexpr std::string_view kSeparators = ",; \t\r";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The next number of a line, after separators; nothing where there is none.
std::optional<double> next_number(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kSeparators), line.size()));
  double value = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  const auto length = static_cast<std::size_t>(end - line.data());
  const bool whole = length == line.size() || kSeparators.find(line[length]) != std::string_view::npos;
  if (error != std::errc{} || !whole) return std::nullopt;
  line.remove_prefix(length);
  return value;
}

}  // namespace

Result<MeasuredSpectrum> load_spectrum_csv(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return io::system_error(path, "read", errno);
  if (!S_ISREG(status.st_mode))
    return make_error(ErrorCode::kBadFile, "{}: cannot read: not a plain file", path);
  std::ifstream file(path);
  if (!file) return io::system_error(path, "read", errno);
  std::vector<double> wavelengths;
  std::vector<double> values;
  std::string text;
  bool heading_seen = false;
  for (int number = 1; std::getline(file, text); ++number) {
    std::string_view line(text);
    if (number == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    line.remove_prefix(std::min(line.find_first_not_of(kSeparators), line.size()));
    if (line.empty() || line.front() == '#') continue;
    const auto wavelength = next_number(line);
    std::optional<double> value;
    if (wavelength) value = next_number(line);
    line.remove_prefix(std::min(line.find_first_not_of(kSeparators), line.size()));
    if (!value || !line.empty()) {
      if (wavelengths.empty() && !wavelength && !heading_seen) {
        heading_seen = true;
        continue;
      }
      return make_error(ErrorCode::kBadFile, "{}: line {}: \"{}\" is not a wavelength in nm and a value",
                        path, number, text);
    }
    if (!std::isfinite(*wavelength) || !std::isfinite(*value)) {
      return make_error(ErrorCode::kBadFile, "{}: line {}: \"{}\" is not finite", path, number, text);
    }
    wavelengths.push_back(*wavelength);
    values.push_back(*value);
  }
  auto spectrum = MeasuredSpectrum::from_samples(wavelengths, values);
  if (!spectrum) return make_error(ErrorCode::kBadFile, "{}: {}", path, spectrum.error().message);
  return spectrum;
}

}  // namespace spectile
