// Traits of OpenEXR's compression methods.
#include "src/io/exr/compression.hpp"

#include <iterator>

#include "src/base/errors.hpp"
#include "src/base/text.hpp"

namespace spectile {
namespace {

/// A method: its name, the highest level that it takes (0 for none; a quality for DWA, zlib's for the
/// others), and the lines of a scanline chunk.
struct Traits {
  std::string_view name;
  CompressionKind kind;
  int max_level;
  int chunk_lines;
};

// In the order of the enumeration.
constexpr Traits kMethods[] = {
    {"none", CompressionKind::kNone, 0, 1},    {"rle", CompressionKind::kRle, 0, 1},
    {"zips", CompressionKind::kZips, 9, 1},    {"zip", CompressionKind::kZip, 9, 16},
    {"piz", CompressionKind::kPiz, 0, 32},     {"pxr24", CompressionKind::kPxr24, 0, 16},
    {"b44", CompressionKind::kB44, 0, 32},     {"b44a", CompressionKind::kB44a, 0, 32},
    {"dwaa", CompressionKind::kDwaa, 500, 32}, {"dwab", CompressionKind::kDwab, 500, 256},
};

const Traits& traits(CompressionKind kind) {
  const auto i = static_cast<std::size_t>(kind);
  return kMethods[i < std::size(kMethods) ? i : 0];
}

}  // namespace

Result<Compression> Compression::parse(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  for (const auto& method : kMethods) {
    if (method.name != name) continue;
    Compression out;
    out.kind = method.kind;
    if (!io::is_zip(out.kind)) out.level = -1;
    if (colon == std::string_view::npos) return out;
    out.level = parse_number<int>(text.substr(colon + 1)).value_or(0);
    if (out.level < 1 || out.level > method.max_level) {
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
  const Traits& method = traits(kind);
  return method.max_level > 0 && level >= 0 ? fmt::format("{}:{}", method.name, level)
                                            : std::string(method.name);
}

int io::lines_per_chunk(CompressionKind kind) {
  return traits(kind).chunk_lines;
}

}  // namespace spectile
