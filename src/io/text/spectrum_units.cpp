// Units of wavelengths by their numbers, and the choice of one spectrum among several.
#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {

std::string_view to_string(WavelengthUnit unit) noexcept {
  switch (unit) {
    case WavelengthUnit::kNm:
      return "nm";
    case WavelengthUnit::kUm:
      return "um";
    case WavelengthUnit::kM:
      return "m";
    case WavelengthUnit::kAngstrom:
      return "angstrom";
    case WavelengthUnit::kPerCm:
      return "cm^-1";
  }
  return "nm";
}

}  // namespace spectile

namespace spectile::io {
namespace {

/// Fewer samples are not taken for anything but nm: two reflectances ascend as easily as two wavelengths.
constexpr std::size_t kMinToGuess = 5;
/// A table in nm that begins below, in the range of X-rays, and goes on to visible light could be in um.
constexpr double kMinPlausibleNm = 10;

bool is_monotonic(const std::vector<double>& w) {
  return std::ranges::adjacent_find(w, std::greater_equal<>()) == w.end() ||
         std::ranges::adjacent_find(w, std::less_equal<>()) == w.end();
}

}  // namespace

double in_nm(double wavelength, WavelengthUnit unit) {
  double nm = wavelength;
  switch (unit) {
    case WavelengthUnit::kNm:
      return wavelength;
    case WavelengthUnit::kUm:
      nm = wavelength * 1e3;
      break;
    case WavelengthUnit::kM:
      nm = wavelength * 1e9;
      break;
    case WavelengthUnit::kAngstrom:
      nm = wavelength / 10;
      break;
    case WavelengthUnit::kPerCm:
      return 1e7 / wavelength;
  }
  const double rounded = std::round(nm * 1e6) / 1e6;
  return std::abs(rounded - nm) <= 1e-14 * std::abs(nm) * 4 ? rounded : nm;
}

bool covers_visible(const std::vector<double>& wavelengths, WavelengthUnit unit) {
  bool below = false;
  bool above = false;
  for (const double w : wavelengths) {
    const double nm = in_nm(w, unit);
    if (nm >= kFirstVisibleNm && nm <= kLastVisibleNm) return true;
    below = below || nm < kFirstVisibleNm;
    above = above || nm > kLastVisibleNm;
  }
  return below && above;
}

UnitGuess guess_unit(const std::vector<double>& wavelengths) {
  UnitGuess out;
  const bool telling = wavelengths.size() >= kMinToGuess && is_monotonic(wavelengths);
  if (covers_visible(wavelengths, WavelengthUnit::kNm)) {
    out.unit = WavelengthUnit::kNm;
    const bool x_rays = telling && std::ranges::min(wavelengths) < kMinPlausibleNm;
    if (x_rays && covers_visible(wavelengths, WavelengthUnit::kUm)) {
      out = {std::nullopt, WavelengthUnit::kUm};
    }
    return out;
  }
  if (!telling) return out;
  for (const auto unit :
       {WavelengthUnit::kUm, WavelengthUnit::kM, WavelengthUnit::kAngstrom, WavelengthUnit::kPerCm}) {
    if (!covers_visible(wavelengths, unit)) continue;
    if (out.unit) return {std::nullopt, unit};
    out.unit = unit;
  }
  return out;
}

std::string list_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kMax); ++i) {
    const std::string shown = io::quoted(names[i]);
    out += (i == 0 ? "" : ", ") + shown.substr(1, shown.size() - 2);
  }
  if (names.size() > kMax) out += fmt::format(" and {} more", names.size() - kMax);
  return out;
}

Result<std::size_t> chosen(const TextFile& file, const std::vector<std::string>& names,
                           const ColumnChoice& choice, const char* noun, std::vector<std::string>& notes) {
  const std::size_t count = names.size();
  const auto named = choice.name.empty() ? names.end() : std::ranges::find(names, choice.name);
  std::optional<double> number = number_in(choice.name);
  if (choice.name.empty()) number = static_cast<double>(choice.number.value_or(0));
  const bool counts = number && *number >= 0 && std::floor(*number) == *number;
  const bool in_range = counts && *number < static_cast<double>(count);
  if (named != names.end()) {
    const auto at = static_cast<std::size_t>(named - names.begin());
    if (in_range && static_cast<double>(at) != *number) {
      notes.push_back(fmt::format("column {} by its name; by number it is {}", choice.name, at));
    }
    return at;
  }
  if (in_range) return static_cast<std::size_t>(*number);
  if (!counts) {
    return make_error(ErrorCode::kBadArgument, "{}: has no column {}; there are {}, or numbers from 0 to {}",
                      file.path, io::quoted(choice.name), list_names(names), count - 1);
  }
  const std::string what = count == 1                             ? fmt::format("one {}", noun)
                           : noun == std::string_view("spectrum") ? fmt::format("{} spectra", count)
                                                                  : fmt::format("{} {}s", count, noun);
  return make_error(ErrorCode::kBadArgument, "{}: has {}, counted from 0; there is no {}", file.path, what,
                    *number);
}

}  // namespace spectile::io
