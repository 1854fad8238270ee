// Result<T>: a value, or an error with a code and one sentence that says what is wrong.
#pragma once

#include <string>
#include <utility>
#include <variant>

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
  kNoSpace,        ///< The target device is full.
  kNoPermission,   ///< The target may not be written, or the source not be read.
  kCancelled,      ///< The caller's progress function asked to stop.
  kOutOfMemory,    ///< An allocation failed.
};

/// An error: its class and one sentence, without a final full stop, that names the values concerned.
struct Error {
  ErrorCode code = ErrorCode::kBadArgument;
  std::string message;
};

/// A value of type T, or an Error. Test with `if (result)`, then `*result` or `result.error()`.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const noexcept { return state_.index() == 0; }
  T& operator*() & { return std::get<0>(state_); }
  const T& operator*() const& { return std::get<0>(state_); }
  T&& operator*() && { return std::get<0>(std::move(state_)); }
  T* operator->() { return &std::get<0>(state_); }
  const T* operator->() const { return &std::get<0>(state_); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
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
