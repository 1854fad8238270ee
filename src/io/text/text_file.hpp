// Text files: their lines, and errors that name a place in them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <spectile/result.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile::io {

/// A whole text file, of at most 64 MiB: a spectrum at every picometre is 20 MB.
struct TextFile {
  std::string path;
  std::unique_ptr<std::string> text;    ///< UTF-8 without a byte order mark; `lines` point into it
  std::vector<std::string_view> lines;  ///< end in \n, \r\n or \r, which they do not hold
};

/// Reads a file; UTF-16 becomes UTF-8. Errors: kBadFile for what is no plain file, too large, or binary (a
/// byte below 32 that is not white space; with the line's number); kNoPermission.
Result<TextFile> read_text_file(const std::string& path);

/// "PATH: line N: ...", with what is wrong there.
Error line_error(const TextFile& file, std::size_t line, const std::string& what);

/// "PATH: line N, column M: ...", with what is wrong at `place`, which points into the line. Columns count
/// bytes from 1.
Error place_error(const TextFile& file, std::size_t line, const char* place, const std::string& what);

/// A line or word for use in an error, in quotation marks, not all of it where it is long.
std::string quoted(std::string_view text);

/// The number that a word is, infinite and NaN too; nothing where it is none or beyond the range of double.
std::optional<double> number_in(std::string_view word);

}  // namespace spectile::io
