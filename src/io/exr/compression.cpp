// Names of OpenEXR's compression methods.
#include <charconv>
#include <spectile/image/image.hpp>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

/// A method by name and the highest level it takes; 0 for none. DWA's level is a quality, the others' zlib's.
constexpr struct {
  std::string_view name;
  CompressionKind kind;
  int highest_level;
} kMethods[] = {
    {"none", CompressionKind::kNone, 0},   {"rle", CompressionKind::kRle, 0},
    {"zips", CompressionKind::kZips, 9},   {"zip", CompressionKind::kZip, 9},
    {"piz", CompressionKind::kPiz, 0},     {"pxr24", CompressionKind::kPxr24, 0},
    {"b44", CompressionKind::kB44, 0},     {"b44a", CompressionKind::kB44a, 0},
    {"dwaa", CompressionKind::kDwaa, 500}, {"dwab", CompressionKind::kDwab, 500},
};

}  // namespace

Result<Compression> Compression::parse(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  for (const auto& method : kMethods) {
    if (method.name != name) continue;
    Compression out;
    out.kind = method.kind;
    if (out.kind != CompressionKind::kZip && out.kind != CompressionKind::kZips) out.level = -1;
    if (colon == std::string_view::npos) return out;
    const std::string_view level = text.substr(colon + 1);
    const auto [end, error] = std::from_chars(level.data(), level.data() + level.size(), out.level);
    const bool number = error == std::errc{} && end == level.data() + level.size();
    if (!number || out.level < 1 || out.level > method.highest_level) {
      return make_error(
          ErrorCode::kBadArgument,
          "compression \"{}\": zip and zips take a level of 1 to 9, dwaa and dwab one of 1 to 500, the "
          "others none",
          text);
    }
    return out;
  }
  return make_error(
      ErrorCode::kUnknownName,
      "compression \"{}\" is unknown; there are none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab",
      text);
}

std::string Compression::description() const {
  for (const auto& method : kMethods) {
    if (method.kind != kind) continue;
    return method.highest_level > 0 && level >= 0 ? fmt::format("{}:{}", method.name, level)
                                                  : std::string(method.name);
  }
  return "none";
}

}  // namespace spectile
