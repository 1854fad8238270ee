// Exit codes, error messages and texts of numbers.
#pragma once

#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>
#include <spectile/result.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace spectile::cli {

/// Exit codes of the tool.
enum Exit : int {
  kOk = 0,
  kBadInput = 1,       ///< an input that cannot be used
  kBadUsage = 2,       ///< wrong usage
  kNoRoom = 3,         ///< no space, no memory, no permission; a device that fails
  kSignalBase = 128,   ///< stopped by a signal: this and its number; see interrupted_exit()
  kInterrupted = 130,  ///< by SIGINT
};

/// The command that runs, such as "film merge": wrong usage names it, as its help explains what is right.
void set_running_command(std::string name);

/// Prints one line to stderr and returns the error's exit code.
int complain(const Error& error);
/// Prints one line to stderr, with the command whose help explains it, and returns kBadUsage.
int complain_usage(const std::string& message);
/// Prints one line to stderr for a file that cannot be written. `error` is an errno.
int complain_write(const std::string& path, int error);

/// The error of a plan that does not hold a light with the names of both, and a remedy: the library has only
/// the light's numbers. That of a plan for another observer likewise. Other errors stay as they are. `light`:
/// as it was given, D65 for an empty text.
Error with_light(Error error, const std::string& plan, const std::string& light);

/// Ends the command with an exit code; the error has been printed.
struct Stop : std::exception {
  explicit Stop(int code) : exit(code) {}
  int exit;
};

/// The value of a result. Prints the error of one that has none, and throws Stop.
template <class T>
T take(Result<T> result) {
  if (!result) throw Stop(complain(result.error()));
  if constexpr (!std::is_void_v<T>) return *std::move(result);
}
/// The same, where any error is wrong usage of the command.
template <class T>
T take_usage(Result<T> result) {
  if (!result) throw Stop(complain_usage(result.error().message));
  return *std::move(result);
}

/// One line of JSON without control characters. Bytes that are not UTF-8 are replaced.
std::string json_line(const nlohmann::json& json);
void print_json(const nlohmann::json& json);

/// Prints the notes of a run's reports, a guess that may be the same for all of its images once only.
class Notes {
 public:
  void print(const std::vector<std::string>& notes);

 private:
  bool space_assumed_ = false;
};

/// "1 pixel", "2 pixels".
std::string plural(std::uint64_t n, const char* noun);
/// "12.3 Mpixel/s".
std::string speed_text(std::uint64_t pixels, double seconds);
/// "1.2 GB".
std::string size_text(std::uint64_t bytes);
/// Prints how many values of what were clamped to the range of half; nothing for none.
void print_clamped(std::uint64_t count, const char* noun);

}  // namespace spectile::cli
