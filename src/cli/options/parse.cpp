// Parsers of option values: regions, shards, pixels, weights.
#include "src/cli/options/parse.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace spectile::cli {
namespace {

template <class T, std::size_t kCount>
std::optional<std::array<T, kCount>> parse_list(std::string_view text) {
  const auto numbers = parse_integers<T>(text, ',', kCount);
  if (!numbers) return {};
  std::array<T, kCount> out{};
  std::copy(numbers->begin(), numbers->end(), out.begin());
  return out;
}

}  // namespace

std::string Shard::text() const {
  return fmt::format("{}/{}", index, count);
}

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::optional<std::size_t> parse_count(std::string_view text) {
  const auto value = parse_integers<std::size_t>(text, ',', 1);
  if (!value || value->front() > 999'999'999) return {};
  return value->front();
}

std::optional<Shard> parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return {};
  const auto index = parse_count(text.substr(0, slash));
  const auto count = parse_count(text.substr(slash + 1));
  if (!index || !count || *index >= *count) return {};
  return Shard{*index, *count};
}

std::optional<PixelWindow> parse_region(std::string_view text) {
  const auto region = parse_list<int, 4>(text);
  if (!region || (*region)[0] > (*region)[2] || (*region)[1] > (*region)[3]) return {};
  return PixelWindow::inclusive((*region)[0], (*region)[1], (*region)[2], (*region)[3]);
}

std::optional<std::array<int, 2>> parse_pixel(std::string_view text) {
  return parse_list<int, 2>(text);
}

Result<std::vector<double>> parse_weights(std::string_view text) {
  if (auto numbers = parse_numbers<double>(text, ',')) return *std::move(numbers);
  return Error{ErrorCode::kBadArgument, fmt::format("--weights \"{}\" are not numbers between commas", text)};
}

}  // namespace spectile::cli
