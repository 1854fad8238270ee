// Parsers of option values: regions, shards, pixels, weights.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <spectile/pixel_window.hpp>
#include <spectile/result.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spectile::cli {

/// One of `count` shards of the inputs.
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;
  std::string text() const;  ///< "0/4"
};

/// "I/N", with I from 0 to N - 1, of at most nine digits each; nothing for other texts.
std::optional<Shard> parse_shard(std::string_view text);

/// An integer of at most nine digits; nothing for other texts.
std::optional<std::size_t> parse_count(std::string_view text);

/// A text with its capital letters A to Z made small.
std::string lower_case(std::string text);

/// "X0,Y0,X1,Y1", the first and the last pixel, with X0 <= X1 and Y0 <= Y1; nothing for other texts.
std::optional<PixelWindow> parse_region(std::string_view text);

/// "X,Y"; nothing for other texts.
std::optional<std::array<int, 2>> parse_pixel(std::string_view text);

/// Numbers separated by commas. Errors: kBadArgument with the text quoted.
Result<std::vector<double>> parse_weights(std::string_view text);

/// Numbers separated by `separator`; nothing for other texts.
template <class T>
std::optional<std::vector<T>> parse_numbers(std::string_view text, char separator) {
  std::vector<T> out;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data();; ++at) {
    T value{};
    const auto [after, code] = std::from_chars(at, end, value);
    if (code != std::errc() || (after != end && *after != separator)) return {};
    out.push_back(value);
    if (after == end) return out;
    at = after;
  }
}

/// `count` integers separated by `separator`; nothing for other texts.
template <class T>
std::optional<std::vector<T>> parse_integers(std::string_view text, char separator, std::size_t count) {
  auto out = parse_numbers<T>(text, separator);
  return out && out->size() == count ? std::move(out) : std::nullopt;
}

}  // namespace spectile::cli
