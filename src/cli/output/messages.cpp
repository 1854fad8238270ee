// Exit codes, error messages and texts of numbers.
#include "src/cli/output/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <spectile/image/image.hpp>
#include <system_error>
#include <utility>

#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

std::string running_command;

}  // namespace

void set_running_command(std::string name) {
  running_command = std::move(name);
}

int complain(const Error& error) {
  switch (error.code) {
    case ErrorCode::kBadArgument:
    case ErrorCode::kUnknownName:
      return complain_usage(error.message);
    default:
      break;
  }
  print_error("spectile: {}\n", error.message);
  switch (error.code) {
    case ErrorCode::kNoSpace:
    case ErrorCode::kNoPermission:
    case ErrorCode::kOutOfMemory:
      return kNoRoom;
    case ErrorCode::kUnavailable:
      return kBadUsage;
    case ErrorCode::kCancelled:
      return interrupted_exit();
    default:
      return kBadInput;
  }
}

int complain_usage(const std::string& message) {
  print_error("spectile: {} (see spectile {}--help)\n", message,
              running_command.empty() ? "" : running_command + " ");
  return kBadUsage;
}

int complain_write(const std::string& path, int error) {
  print_error("spectile: {}: cannot write: {}\n", path, std::generic_category().message(error));
  constexpr std::array kNamesAtFault = {ENOENT, EISDIR, ENOTDIR, ENAMETOOLONG, ELOOP, EINVAL, ENXIO};
  return std::ranges::find(kNamesAtFault, error) == kNamesAtFault.end() ? kNoRoom : kBadUsage;
}

Error with_light(Error error, const std::string& plan, const std::string& light) {
  const std::string observed = "the plan of these bands is for the ";
  if (error.message.starts_with(observed)) {
    error.message = fmt::format(
        "{}: its plan is for the {}; choose the plan's observer, or another with spectile "
        "plan --observer",
        plan, error.message.substr(observed.size()));
    return error;
  }
  const std::string unnamed = "the plan of these bands holds no emission values for this light";
  if (!error.message.starts_with(unnamed)) return error;
  const std::string name = light.empty() ? "D65" : light;
  error.message = fmt::format(
      "{}: its plan holds no emission values for the light {}{}; add --illuminant {} to spectile plan", plan,
      name, error.message.substr(unnamed.size()), name);
  return error;
}

std::string json_line(const nlohmann::json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  // Its library leaves U+007F to U+009F, which terminals obey. They are in texts only.
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const unsigned next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    if (byte == 0x7F) {
      out += "\\u007f";
    } else if (byte == 0xC2 && next < 0xA0) {
      out += fmt::format("\\u{:04x}", next);
      ++i;
    } else {
      out += text[i];
    }
  }
  return out;
}

void print_json(const nlohmann::json& json) {
  print_verbatim(json_line(json) + "\n");
}

void Notes::print(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    const bool assumed = note == kAssumedSpaceNote;
    if (!assumed || !space_assumed_) cli::print("  {}\n", note);
    space_assumed_ = space_assumed_ || assumed;
  }
}

std::string plural(std::uint64_t n, const char* noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

std::string speed_text(std::uint64_t pixels, double seconds) {
  return fmt::format("{:.3g} Mpixel/s", static_cast<double>(pixels) / std::max(seconds, 1e-9) * 1e-6);
}

std::string size_text(std::uint64_t bytes) {
  constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < std::size(kUnits); ++unit) value /= 1000;
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

void print_clamped(std::uint64_t count, const char* noun) {
  if (count == 0) return;
  print("  {} beyond the range of half, clamped to 65504; --depth float keeps them\n", plural(count, noun));
}

}  // namespace spectile::cli
