// What every image job does at its edges: checks of its paths, and the report.
#pragma once

#include <functional>
#include <spectile/image.hpp>
#include <string>

#include "src/io/conversion.hpp"
#include "src/io/exr_input.hpp"
#include "src/io/exr_writer.hpp"

namespace spectile::io {

/// Errors: kBadArgument when both paths are one file.
Result<void> check_distinct(const std::string& input, const std::string& output);

/// Size, counts and bytes of a finished conversion.
ImageReport report_of(const ExrWriter& writer, const LineStats& stats);

/// Runs `action`; whatever a library throws inside becomes an error that names `path`, for the library's
/// boundary.
template <class T>
Result<T> contained(const std::string& path, const std::function<Result<T>()>& action) {
  Result<T> result = Error{};
  if (auto run = guarded(path, [&] { result = action(); }); !run) return run.error();
  return result;
}

}  // namespace spectile::io
