// What every image job does at its edges: checks of its paths, and the report.
#include "src/io/output.hpp"

#include <filesystem>

#include "src/base/errors.hpp"

namespace spectile::io {

Result<void> check_distinct(const std::string& input, const std::string& output) {
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error) && !error) {
    return make_error(ErrorCode::kBadArgument, "{}: input and output are the same file", output);
  }
  return {};
}

ImageReport report_of(const ExrWriter& writer, const LineStats& stats) {
  ImageReport report;
  report.width = writer.width();
  report.height = writer.height();
  report.nonfinite_pixels = stats.nonfinite.count;
  report.negative_pixels = stats.negative.count;
  report.over_one_pixels = stats.over_one;
  report.out_of_gamut_pixels = stats.outside.count;
  report.limited_pixels = stats.limited;
  report.bytes_written = writer.bytes_written();
  return report;
}

}  // namespace spectile::io
