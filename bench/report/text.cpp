// Text of a report: escaped for HTML and SVG, and numbers as people read them.
#include "bench/report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace spectile::report {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr const char* kThinSpace = "\xE2\x80\xAF";    // U+202F, which does not break
constexpr const char* kSpace = "\xC2\xA0";            // U+00A0, which does not break either
constexpr int kDigits = 3;
constexpr int kSmallestPlain = -4;  // exponents written out
constexpr int kLargestPlain = 6;

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Bytes of the code point at i; 0 where there is none.
std::size_t code_point_size(std::string_view text, std::size_t i) {
  const unsigned lead = byte_at(text, i);
  if (lead < 0x80U) return 1;
  const std::size_t size = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U) return 0;
  for (std::size_t k = 1; k < size; ++k) {
    if ((byte_at(text, i + k) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned second = byte_at(text, i + 1);
  // Longer forms than needed, surrogates, and what lies beyond U+10FFFF.
  if ((lead == 0xE0U && second < 0xA0U) || (lead == 0xEDU && second > 0x9FU) ||
      (lead == 0xF0U && second < 0x90U) || (lead == 0xF4U && second > 0x8FU)) {
    return 0;
  }
  return size;
}

std::string escaped_byte(char c) {
  constexpr std::pair<char, const char*> kEntities[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  for (const auto& [character, entity] : kEntities) {
    if (c == character) return entity;
  }
  const bool control = (static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t') || c == 0x7F;
  return control ? std::string(kReplacement) : std::string(1, c);
}

/// Spaces between the thousands of plain digits.
std::string grouped(const std::string& digits) {
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += kThinSpace;
    out += digits[i];
  }
  return out;
}

std::string without_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

struct Rounded {
  double mantissa = 0;  ///< at least 1, under 10
  int exponent = 0;
};

/// A positive number to three significant digits; rounded before its size is looked at, as 999.9 is 1000.
Rounded rounded(double value) {
  const std::string text = fmt::format("{:.{}e}", value, kDigits - 1);
  const std::size_t e = text.find('e');
  return {std::strtod(text.substr(0, e).c_str(), nullptr),
          static_cast<int>(std::strtol(text.c_str() + e + 1, nullptr, 10))};
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = code_point_size(text, i);
    if (size == 0) {
      out += kReplacement;
    } else if (size == 1) {
      out += escaped_byte(text[i]);
    } else {
      out += text.substr(i, size);
    }
    i += std::max<std::size_t>(size, 1);
  }
  return out;
}

std::string power_of_ten(int exponent) {
  constexpr std::array<const char*, 10> kRaised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "10⁻" : "10";
  for (const char digit : fmt::format("{}", std::abs(exponent))) {
    out += kRaised[static_cast<std::size_t>(digit - '0')];
  }
  return out;
}

std::string number(double value, Zeros zeros) {
  if (!std::isfinite(value)) return kDash;
  if (value == 0) return "0";
  const std::string sign = value < 0 ? "−" : "";
  const Rounded r = rounded(std::abs(value));
  const auto trimmed = [&](std::string text) {
    return zeros == Zeros::kDrop ? without_zeros(std::move(text)) : text;
  };
  if (r.exponent < kSmallestPlain || r.exponent >= kLargestPlain) {
    const std::string mantissa = trimmed(fmt::format("{:.{}f}", r.mantissa, kDigits - 1));
    const std::string power = power_of_ten(r.exponent);
    return sign + (mantissa == "1" ? power : mantissa + "×" + power);
  }
  const double plain = r.mantissa * std::pow(10.0, r.exponent);
  const int decimals = std::max(0, kDigits - 1 - r.exponent);
  const std::string text = fmt::format("{:.{}f}", plain, decimals);
  return sign + (decimals > 0 ? trimmed(text) : grouped(text));
}

std::string quantity(double value, const std::string& unit) {
  const bool alone = unit.empty() || value == 0 || !std::isfinite(value);
  return number(value, Zeros::kDrop) + (alone ? "" : kSpace + unit);
}

std::string with_prefix(double value, const std::string& unit) {
  if (!std::isfinite(value)) return kDash;
  constexpr std::array<std::pair<int, const char*>, 5> kPrefixes = {
      {{15, "P"}, {12, "T"}, {9, "G"}, {6, "M"}, {3, "k"}}};
  const int exponent = value == 0 ? 0 : rounded(std::abs(value)).exponent;
  for (const auto& [power, prefix] : kPrefixes) {
    if (exponent >= power) return number(value / std::pow(10.0, power)) + kSpace + prefix + unit;
  }
  return number(value) + kSpace + unit;
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return kDash;
  const double value = 100 * fraction;
  const std::string text = std::abs(value) >= 9.95 || value == 0 ? number(std::round(value), Zeros::kDrop)
                                                                 : fmt::format("{:.2g}", value);
  return text + kSpace + "%";
}

std::string bytes_text(std::uint64_t bytes) {
  if (bytes == 0) return kDash;
  constexpr std::array<const char*, 5> kUnits = {"B", "KiB", "MiB", "GiB", "TiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < kUnits.size(); ++unit) value /= 1024;
  return number(value, Zeros::kDrop) + kSpace + kUnits[unit];
}

std::string count_text(std::uint64_t count) {
  return grouped(fmt::format("{}", count));
}

std::size_t display_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace spectile::report
