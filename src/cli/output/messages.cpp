// Exit codes, error messages and texts of numbers.
#include "src/cli/output/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>

namespace spectile::cli {

int complain(const Error& error) {
  fmt::print(stderr, "spectile: {}\n", error.message);
  switch (error.code) {
    case ErrorCode::kNoSpace:
    case ErrorCode::kNoPermission:
      return kNoRoom;
    case ErrorCode::kBadArgument:
    case ErrorCode::kUnknownName:
    case ErrorCode::kUnavailable:
      return kBadUsage;
    case ErrorCode::kCancelled:
      return kInterrupted;
    default:
      return kBadInput;
  }
}

int complain_usage(const std::string& message, const std::string& command) {
  fmt::print(stderr, "spectile: {}{}\n", message,
             command.empty() ? "" : fmt::format(" (see spectile {} --help)", command));
  return kBadUsage;
}

int complain_write(const std::string& path, int error) {
  fmt::print(stderr, "spectile: {}: cannot write: {}\n", path, std::generic_category().message(error));
  return error == EACCES || error == EPERM || error == EROFS || error == ENOSPC ? kNoRoom : kBadUsage;
}

std::string json_line(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_json(const nlohmann::json& json) {
  fmt::print("{}\n", json_line(json));
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
  fmt::print("  {} beyond the range of half, clamped to 65504; --pixel float keeps them\n",
             plural(count, noun));
}

}  // namespace spectile::cli
