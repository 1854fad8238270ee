// The frame that every image job runs in: checks of its paths, the output's header, the conversion, the
// report.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <spectile/image/image.hpp>
#include <string>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/conversion.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/exr_writer.hpp"

namespace spectile::io {

/// Kernels and threads of a conversion.
struct JobSetup {
  const kernels::KernelTable& kernels;
  int threads;
};

/// Errors: kBadArgument where an input is the output; those of active_isa().
Result<JobSetup> set_up_job(std::span<const std::string> inputs, const std::string& output,
                            const ImageOptions& options);

/// The header of an image that is made of another: tiles and mip levels as the options say, and
/// the settings after the other texts.
ImageSpec conversion_spec(const PartHeader& source, std::vector<ChannelSpec> channels, TextAttributes texts,
                          const ImageOptions& options, const std::string& settings);

/// The error that the pixels found make of a conversion, where they forbid an output; else nothing.
using Refusal = std::function<std::optional<Error>(const LineStats&)>;

/// That of conversions of spectra: at numbers that are not finite, where the options say stop. `offset`: of
/// the converted pixels within the input's data window.
Refusal at_nonfinite(const std::string& input, const ImageOptions& options, std::array<int, 2> offset);

/// An image job in its frame.
struct ImageJob {
  LineJob& job;
  const std::string& output;
  ImageSpec spec;  // its compression is that of the options
  const ImageOptions& options;
  Refusal refusal;     // none where nothing forbids an output
  ImageReport report;  // what is known beforehand: bands, quantity, colour space, notes
  /// Appends notes on what was found; none where nothing can be.
  std::function<void(const LineStats&, std::vector<std::string>&)> remark = {};
};

/// Adds the size and the bytes of a complete file to a report, and the counts of the image itself.
void add_counts(ImageReport& report, const LineStats& stats, const ExrWriter& writer);

/// Creates the output, runs the conversion, writes mip levels where the file has some, completes the file,
/// and adds its size, counts and bytes to the report, counts being those of the image itself. Errors:
/// kBadArgument for samples that are written as integers; those of ExrWriter and run_conversion(); the
/// refusal.
Result<ImageReport> run_image_job(ImageJob image);

/// Runs `action`; whatever a library throws inside becomes an error that names `path`, for the library's
/// boundary.
template <class T>
Result<T> contained(const std::string& path, const std::function<Result<T>()>& action) {
  Result<T> result = Error{};
  SPECTILE_TRY(guarded(path, [&] { result = action(); }));
  return result;
}

/// The same for a conversion, with the time that it took.
Result<ImageReport> timed(const std::string& path, const std::function<Result<ImageReport>()>& action);

}  // namespace spectile::io
