// Text of a report: escaped for HTML and SVG, and numbers as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace spectile::report {

/// A piece of HTML. A type of its own, so that text of others cannot get into a page without being escaped.
struct Html {
  std::string code;
};

/// Text that stands for itself in HTML and SVG, inside elements and quoted attributes. Bytes that are no
/// UTF-8 and control characters other than line ends and tabs become U+FFFD.
std::string escaped(std::string_view text);
inline Html html(std::string_view text) {
  return {escaped(text)};
}

/// Stands for a number that is not finite, or not known.
inline constexpr const char* kDash = "–";

enum class Zeros { kKeep, kDrop };

/// Three significant digits: 0.0123, 12.3, 12 300, 1.23×10⁻⁷. Zeros after the point tell of precision; those
/// of round numbers, as bounds and ticks are, are dropped.
std::string number(double value, Zeros zeros = Zeros::kKeep);
/// With its unit, but for 0: "0.53 u". Trailing zeros are dropped.
std::string quantity(double value, const std::string& unit);
/// With a prefix: "12.3 GB/s" for 1.23e10 and "B/s".
std::string with_prefix(double value, const std::string& unit);
/// "83 %", "0.42 %".
std::string percent(double fraction);
/// "2 MiB"; a dash for 0.
std::string bytes_text(std::uint64_t bytes);
/// "1 234 567".
std::string count_text(std::uint64_t count);
/// 10 to a power, in Unicode's raised digits.
std::string power_of_ten(int exponent);

/// Columns of a fixed-width font that text takes: its code points.
std::size_t display_width(std::string_view text);

}  // namespace spectile::report
