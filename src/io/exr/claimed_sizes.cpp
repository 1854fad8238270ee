// Sizes that a file's headers claim, checked before OpenEXR believes them.
// Source of the layout: OpenEXR, File Layout.
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "src/base/errors.hpp"
#include "src/io/exr/exr_input.hpp"

namespace spectile::io {
namespace {

constexpr std::uint32_t kManyParts = 0x1000;
// Names and types of attributes are shorter.
constexpr std::size_t kLongestName = 255;

/// A file's bytes one after the other, through a window.
class Bytes {
 public:
  explicit Bytes(int descriptor, std::int64_t at) : descriptor_(descriptor), at_(at) {}
  std::int64_t at() const { return at_; }
  void skip(std::int64_t bytes) { at_ += bytes; }

  std::optional<std::uint8_t> next() {
    if (at_ < start_ || at_ >= start_ + got_) {
      start_ = at_;
      got_ = ::pread(descriptor_, window_.data(), window_.size(), static_cast<off_t>(at_));
      if (got_ <= 0) return {};
    }
    return window_[static_cast<std::size_t>(at_++ - start_)];
  }
  std::optional<std::uint32_t> next_number() {
    std::uint32_t out = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) {
      const auto byte = next();
      if (!byte) return {};
      out |= std::uint32_t{*byte} << shift;
    }
    return out;
  }
  /// Up to a zero byte; nothing where there is none soon.
  std::optional<std::string> next_name() {
    std::string out;
    while (out.size() <= kLongestName) {
      const auto byte = next();
      if (!byte) return {};
      if (*byte == 0) return out;
      out.push_back(static_cast<char>(*byte));
    }
    return {};
  }

 private:
  int descriptor_;
  std::int64_t at_;
  std::int64_t start_ = 0;
  std::int64_t got_ = 0;
  std::array<std::uint8_t, 4096> window_{};
};

/// Types that take so many bytes, whatever they claim.
std::optional<std::int64_t> fixed_size(const std::string& type) {
  static const std::map<std::string, std::int64_t> kSizes = {{"box2f", 16},
                                                             {"box2i", 16},
                                                             {"chromaticities", 32},
                                                             {"compression", 1},
                                                             {"deepImageState", 1},
                                                             {"double", 8},
                                                             {"envmap", 1},
                                                             {"float", 4},
                                                             {"int", 4},
                                                             {"keycode", 28},
                                                             {"lineOrder", 1},
                                                             {"m33d", 72},
                                                             {"m33f", 36},
                                                             {"m44d", 128},
                                                             {"m44f", 64},
                                                             {"rational", 8},
                                                             {"tiledesc", 9},
                                                             {"timecode", 8},
                                                             {"v2d", 16},
                                                             {"v2f", 8},
                                                             {"v2i", 8},
                                                             {"v3d", 24},
                                                             {"v3f", 12},
                                                             {"v3i", 12}};
  const auto found = kSizes.find(type);
  return found == kSizes.end() ? std::nullopt : std::optional(found->second);
}

/// Passes over an attribute's value as OpenEXR does, which heeds the size claimed for some types only. How
/// many bytes it makes room for, where those are more than are left or fewer than none; false where the file
/// ends.
bool pass_value(Bytes& bytes, const std::string& type, std::int64_t claimed, std::int64_t end,
                std::optional<std::int64_t>& too_many) {
  const auto pass = [&](std::int64_t size) {
    if (size < 0 || size > end - bytes.at()) {
      too_many = size;
      return false;
    }
    bytes.skip(size);
    return true;
  };
  if (const auto size = fixed_size(type)) return pass(*size);
  if (type == "chlist") {
    // Name, pixel type, linearity, sampling in x and y; an empty name ends the list.
    constexpr std::int64_t kChannelBytes = 16;
    while (const auto name = bytes.next_name()) {
      if (name->empty()) return true;
      if (!pass(kChannelBytes)) return false;
    }
    return false;
  }
  if (type == "preview") {
    const auto width = bytes.next_number();
    const auto height = bytes.next_number();
    if (!height) return false;
    // Above this a side is negative for OpenEXR, or its product with the other beyond any file.
    constexpr std::uint32_t kMaxSide = 1U << 24U;
    if (*width > kMaxSide || *height > kMaxSide) return pass(-1);
    return pass(std::int64_t{*width} * std::int64_t{*height} * 4);
  }
  if (type == "stringvector") {
    for (const std::int64_t stop = bytes.at() + claimed; bytes.at() < stop;) {
      const auto size = bytes.next_number();
      if (!size || !pass(static_cast<std::int32_t>(*size))) return false;
    }
    return true;
  }
  return pass(claimed);
}

}  // namespace

Result<void> check_attribute_sizes(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {};
  constexpr std::int64_t kMagicBytes = 4;
  Bytes bytes(descriptor, kMagicBytes);
  const auto version = bytes.next_number();
  if (!version) return {};
  const bool many_parts = (*version & kManyParts) != 0;
  // A header ends with an empty name, and so do the headers.
  bool first_of_header = true;
  while (const auto name = bytes.next_name()) {
    if (name->empty()) {
      if (!many_parts || first_of_header) return {};
      first_of_header = true;
      continue;
    }
    first_of_header = false;
    const auto type = bytes.next_name();
    const auto size = type ? bytes.next_number() : std::nullopt;
    if (!size) return {};
    std::optional<std::int64_t> too_many;
    const std::int64_t end = status.st_size;
    if (!pass_value(bytes, *type, static_cast<std::int32_t>(*size), end, too_many)) {
      if (!too_many) return {};
      return make_error(ErrorCode::kBadFile, "{}: attribute {} claims {} bytes, and the file has {} more",
                        path, *name, *too_many, end - bytes.at());
    }
  }
  return {};
}

}  // namespace spectile::io
