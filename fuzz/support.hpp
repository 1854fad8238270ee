// Shared by the fuzz targets: invariants, whose breach ends the process, and a file and a folder for each
// case.
//
// A target is a file with its own LLVMFuzzerTestOneInput(): libFuzzer calls it, and in the ordinary build
// replay.cpp does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/result.hpp>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace spectile::fuzz {

using Bytes = std::span<const std::uint8_t>;

inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Says which law does not hold, and aborts.
[[noreturn]] void broken(const char* law, const std::string& detail);

inline void require(bool holds, const char* law, const std::string& detail = {}) {
  if (!holds) broken(law, detail);
}

/// An error is one sentence without its full stop, however long the text is that it is about.
void require_sentence(const Error& error);

/// True if a result is a value; where it is none, its error must be a sentence.
template <class T>
bool is_value(const Result<T>& result) {
  if (!result) require_sentence(result.error());
  return static_cast<bool>(result);
}

/// Choices that depend on nothing but a case's bytes.
class Choices {
 public:
  explicit Choices(Bytes bytes);
  /// 0 to n - 1.
  unsigned below(unsigned n);
  bool one_in(unsigned n) { return below(n) == 0; }

 private:
  std::uint64_t state_;
};

/// A folder of this process with a file of the case's bytes, and a place for one output.
class CaseFolder {
 public:
  explicit CaseFolder(Bytes bytes);
  const std::string& input() const noexcept { return input_; }
  const std::string& output() const noexcept { return output_; }
  /// The folder must hold the input as it was, the output if `written`, and nothing else. Removes the output.
  void require_tidy(bool written) const;

 private:
  Bytes bytes_;
  std::string input_;
  std::string output_;
};

}  // namespace spectile::fuzz
