// Result<T>: a value, or an error with a code and one sentence that says what is wrong.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace spectile {

/// Classes of failure; the message carries the particulars.
enum class ErrorCode {
  kBadArgument,    ///< A parameter is outside what the operation accepts.
  kBandsMismatch,  ///< Two things that must share bands do not.
  kSizeMismatch,   ///< Two batches that must have the same number of lanes do not.
  kUnknownName,    ///< A name (ISA, illuminant, method, ...) is not one of those known.
  kUnavailable,    ///< A known thing that this machine or build cannot do.
  kBadFile,        ///< A file is missing, damaged, or not what was expected.
  kNonFinite,      ///< The data hold NaN or infinities and the caller asked to stop.
  kNoSpace,        ///< A device is full or fails, or too many files are open.
  kNoPermission,   ///< The target may not be written, or the source not be read.
  kCancelled,      ///< The caller's progress function asked to stop.
  kOutOfMemory,    ///< An allocation failed.
};

/// An error: its class and one sentence, without a final full stop, that names the values concerned.
struct Error {
  ErrorCode code = ErrorCode::kBadArgument;
  std::string message;
};

namespace detail {
/// Prints the error's message and aborts: a Result's value was taken without a look at its error.
[[noreturn]] void value_of_error(const Error& error) noexcept;
}  // namespace detail

/// A value of type T, or an Error. Test with `if (result)`, then `*result` or `result.error()`. Taking the
/// value of an error prints the error's message and aborts.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}

  explicit operator bool() const noexcept { return value_.has_value(); }
  bool has_value() const noexcept { return value_.has_value(); }
  /// The value, or another one in place of an error.
  T value_or(T other) const& { return value_ ? *value_ : std::move(other); }
  T value_or(T other) && { return value_ ? *std::move(value_) : std::move(other); }
  T& operator*() & { return checked(), *value_; }
  const T& operator*() const& { return checked(), *value_; }
  T&& operator*() && { return checked(), *std::move(value_); }
  T* operator->() { return checked(), &*value_; }
  const T* operator->() const { return checked(), &*value_; }
  /// Undefined where there is a value.
  const Error& error() const noexcept { return error_; }

 private:
  void checked() const noexcept {
    if (!value_.has_value()) detail::value_of_error(error_);
  }
  std::optional<T> value_;
  Error error_;
};

/// Success, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}

  explicit operator bool() const noexcept { return ok_; }
  bool has_value() const noexcept { return ok_; }
  const Error& error() const noexcept { return error_; }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace spectile

#define SPECTILE_JOIN_LINE_2(name, line) name##line
#define SPECTILE_JOIN_LINE(name, line) SPECTILE_JOIN_LINE_2(name, line)

/// Returns the error of a Result<void> from the enclosing function.
#define SPECTILE_TRY(...)                                     \
  do {                                                        \
    if (auto result_of_try = (__VA_ARGS__); !result_of_try) { \
      return result_of_try.error();                           \
    }                                                         \
  } while (false)

/// SPECTILE_ASSIGN(const auto value, function(...)): the value of a Result, or its error is returned from the
/// enclosing function. The target may also be a variable that exists.
#define SPECTILE_ASSIGN(target, ...)                                                                \
  auto SPECTILE_JOIN_LINE(result_, __LINE__) = (__VA_ARGS__);                                       \
  if (!SPECTILE_JOIN_LINE(result_, __LINE__)) return SPECTILE_JOIN_LINE(result_, __LINE__).error(); \
  target = *std::move(SPECTILE_JOIN_LINE(result_, __LINE__))
