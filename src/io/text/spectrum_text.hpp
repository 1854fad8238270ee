// Text files of spectra: their lines, numbers and errors; columns and CGATS are read to samples.
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
  std::unique_ptr<std::string> text;    ///< without a byte order mark; `lines` point into it
  std::vector<std::string_view> lines;  ///< end in \n, \r\n or \r, which they do not hold
};

/// Errors: kBadFile for what is no plain file, too large, or binary (a byte below 32 that is not white space;
/// with the line's number); kNoPermission.
Result<TextFile> read_text_file(const std::string& path);

/// "PATH: line N: ...", with what is wrong there.
Error line_error(const TextFile& file, std::size_t line, const std::string& what);

/// A line or word for use in an error, in quotation marks, not all of it where it is long.
std::string quoted(std::string_view text);

/// The number that a word is, infinite and NaN too; nothing where it is none or beyond the range of double.
std::optional<double> number_in(std::string_view word);

/// Samples as they are in a file, unsorted, each with the number of its line.
struct SampleLines {
  std::vector<double> wavelengths_nm;
  std::vector<double> values;
  std::vector<std::size_t> lines;
};

/// Columns "wavelength_nm value"; see load_spectrum.
Result<SampleLines> read_columns(const TextFile& file);

/// The samples of every spectrum in a text of columns: lines "wavelength_nm value value ...", or lines
/// "name,wavelength_nm,value" that are put together by name; see load_spectra.
Result<std::vector<SampleLines>> read_all_columns(const TextFile& file);

/// True if a text is CGATS: its first word is SPECT, CMF or CGATS and something, or a line begins with
/// SPECTRAL_BANDS or BEGIN_DATA.
bool is_cgats(const TextFile& file);

/// Row `column` of CGATS's data; see load_spectrum. Errors: kBadFile; kBadArgument for a row that there is
/// not.
Result<SampleLines> read_cgats(const TextFile& file, std::size_t column);

/// All rows of it. Errors: kBadFile.
Result<std::vector<SampleLines>> read_all_cgats(const TextFile& file);

}  // namespace spectile::io
