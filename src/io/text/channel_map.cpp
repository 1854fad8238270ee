// load_channel_map: channels and their wavelengths, from a small table.
#include <algorithm>
#include <optional>
#include <set>
#include <spectile/image/channel_map.hpp>

#include "src/base/errors.hpp"
#include "src/io/text/text_file.hpp"

namespace spectile {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The fields of a line: apart by semicolons or tabs where there are any, else by commas.
std::vector<std::string_view> fields_of(std::string_view line) {
  const char* const separators = line.find_first_of(";\t") == std::string_view::npos ? "," : ";\t";
  std::vector<std::string_view> out;
  for (;;) {
    const std::size_t end = line.find_first_of(separators);
    out.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return out;
    line.remove_prefix(end + 1);
  }
}

/// A wavelength or an edge; nothing for other texts.
std::optional<double> wavelength(std::string_view text) {
  constexpr double kMaxNm = 1e9;
  const auto value = io::number_in(text);
  return value && *value > 0 && *value < kMaxNm ? value : std::nullopt;
}

/// A line of a map. Errors: kBadFile.
Result<MappedChannel> channel_of(const io::TextFile& file, std::size_t line,
                                 const std::vector<std::string_view>& fields) {
  if (fields.size() < 2 || fields.size() > 3 || fields[0].empty()) {
    return io::line_error(file, line, "is neither NAME,WAVELENGTH nor NAME,LOWER,UPPER (nm)");
  }
  for (std::size_t i = 1; i < fields.size(); ++i) {
    if (wavelength(fields[i])) continue;
    return io::place_error(file, line, fields[i].data(),
                           fmt::format("{} is not a wavelength in nm", io::quoted(fields[i])));
  }
  const double lower = *wavelength(fields[1]);
  const double upper = *wavelength(fields.back());
  if (fields.size() == 3 && !(lower < upper)) {
    return io::place_error(file, line, fields[2].data(), "the upper edge is not above the lower one");
  }
  return MappedChannel{std::string(fields[0]), {lower, (lower + upper) / 2, upper}};
}

}  // namespace

Result<std::vector<MappedChannel>> load_channel_map(const std::string& path) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  std::vector<MappedChannel> out;
  std::set<std::string, std::less<>> names;
  std::size_t edges = 0;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string_view text = trimmed(file.lines[i]);
    if (text.empty() || text.starts_with('#')) continue;
    const auto fields = fields_of(text);
    const bool numbers = std::any_of(fields.begin() + 1, fields.end(),
                                     [](std::string_view field) { return wavelength(field).has_value(); });
    if (out.empty() && fields.size() > 1 && !numbers) continue;  // headings
    SPECTILE_ASSIGN(auto channel, channel_of(file, i + 1, fields));
    if (!names.insert(channel.name).second) {
      return io::line_error(file, i + 1, fmt::format("channel {} again", io::quoted(channel.name)));
    }
    edges += fields.size() - 2;
    out.push_back(std::move(channel));
  }
  if (out.empty())
    return make_error(
        ErrorCode::kBadFile,
        "{}: names no channel; a channel map has lines NAME,WAVELENGTH or NAME,LOWER,UPPER (nm)", path);
  if (edges != 0 && edges != out.size()) {
    return make_error(ErrorCode::kBadFile, "{}: holds wavelengths and edges; give one or the other for all",
                      path);
  }
  std::ranges::stable_sort(out, {}, [](const MappedChannel& c) { return c.band.centre_nm; });
  std::vector<double> centres;
  std::vector<Band> list;
  for (const MappedChannel& c : out) {
    centres.push_back(c.band.centre_nm);
    list.push_back(c.band);
  }
  const auto bands = edges == 0 ? Bands::from_centres(centres) : Bands::from_list(list);
  if (!bands) return make_error(ErrorCode::kBadFile, "{}: {}", path, bands.error().message);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].band = (*bands)[i];
  return out;
}

}  // namespace spectile
