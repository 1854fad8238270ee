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
  const Error& error() const { return error_; }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace spectile
