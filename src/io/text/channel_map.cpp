// load_channel_map: channels and their wavelengths, from a small table.
#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <spectile/image/channel_map.hpp>

#include "src/base/errors.hpp"
#include "src/io/text/text_file.hpp"

namespace spectile {
namespace {

// More is no table of an image's channels: OpenEXR writes 32767 at most.
constexpr std::size_t kMaxMapBytes = std::size_t{4} << 20;

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> out;
  for (;;) {
    const std::size_t comma = line.find(',');
    out.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return out;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> wavelength(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && value > 0 && value < 1e9 ? std::optional(value) : std::nullopt;
}

}  // namespace

Result<std::vector<MappedChannel>> load_channel_map(const std::string& path) {
  SPECTILE_ASSIGN(const io::TextFile file, io::read_text_file(path));
  if (file.text->size() > kMaxMapBytes)
    return make_error(ErrorCode::kBadFile, "{}: is too large for a channel map", path);
  std::vector<MappedChannel> out;
  std::set<std::string, std::less<>> names;
  std::size_t number = 0;
  std::size_t edges = 0;
  for (const std::string_view line : file.lines) {
    ++number;
    const std::string_view text = trimmed(line);
    if (text.empty() || text.starts_with('#')) continue;
    const auto fields = fields_of(text);
    std::vector<double> values;
    for (std::size_t i = 1; i < fields.size(); ++i) {
      if (const auto value = wavelength(fields[i])) values.push_back(*value);
    }
    if (out.empty() && values.empty() && fields.size() > 1) continue;  // headings
    const bool right = values.size() + 1 == fields.size() && (values.size() == 1 || values.size() == 2) &&
                       (values.size() == 1 || values[0] < values[1]);
    if (!right || fields[0].empty()) {
      return make_error(ErrorCode::kBadFile, "{}:{}: is neither NAME,WAVELENGTH nor NAME,LOWER,UPPER (nm)",
                        path, number);
    }
    if (!names.insert(std::string(fields[0])).second) {
      return make_error(ErrorCode::kBadFile, "{}:{}: channel \"{}\" again", path, number, fields[0]);
    }
    edges += values.size() - 1;
    const double centre = (values.front() + values.back()) / 2;
    out.push_back({std::string(fields[0]), {values.front(), centre, values.back()}});
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
