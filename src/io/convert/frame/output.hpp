// What every image job does at its edges: checks of its paths, and the report.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <spectile/image/image.hpp>
#include <string>

#include "src/io/convert/frame/conversion.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/exr_writer.hpp"

namespace spectile::io {

/// Errors: kBadArgument when both paths are one file.
Result<void> check_distinct(const std::string& input, const std::string& output);

/// The error that what a conversion found makes of it, where it forbids an output; else nothing.
using Refusal = std::function<std::optional<Error>(const LineStats&)>;

/// That of conversions of spectra: at numbers that are not finite, where the options say stop. `offset`: of
/// what is converted within the input's data window.
Refusal at_nonfinite(const std::string& input, const ImageOptions& options, std::array<int, 2> offset);

/// Runs a conversion, writes its mip levels where the file has some, and reports its size, counts and bytes,
/// counts being those of the image itself; `found`, where asked for, gets all counts.
/// Errors: those of run_conversion(), and the refusal.
Result<ImageReport> convert(LineJob& job, ExrWriter& writer, std::size_t slots, int strip_lines,
                            const ImageOptions& options, const Refusal& refusal, LineStats* found = nullptr);

/// Runs `action`; whatever a library throws inside becomes an error that names `path`, for the library's
/// boundary.
template <class T>
Result<T> contained(const std::string& path, const std::function<Result<T>()>& action) {
  Result<T> result = Error{};
  if (auto run = guarded(path, [&] { result = action(); }); !run) return run.error();
  return result;
}

/// The same for a conversion, with the time that it took.
Result<ImageReport> timed(const std::string& path, const std::function<Result<ImageReport>()>& action);

}  // namespace spectile::io
