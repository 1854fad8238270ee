// What every image job does at its edges: checks of its paths, and the report.
#include "src/io/convert/frame/output.hpp"

#include <chrono>
#include <filesystem>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/mip_levels.hpp"

namespace spectile::io {

Result<void> check_distinct(const std::string& input, const std::string& output) {
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error) && !error) {
    return make_error(ErrorCode::kBadArgument, "{}: input and output are the same file", output);
  }
  return {};
}

Refusal at_nonfinite(const std::string& input, const ImageOptions& options, std::array<int, 2> offset) {
  return [&input, offset,
          stop = options.nonfinite == NonFinite::kStop](const LineStats& stats) -> std::optional<Error> {
    if (!stop || stats.nonfinite.count == 0) return {};
    return stopped_at(input, ErrorCode::kNonFinite, "non-finite", stats.nonfinite.moved(offset),
                      "--nonfinite zero makes them black");
  };
}

Result<ImageReport> convert(LineJob& job, ExrWriter& writer, std::size_t slots, int strip_lines,
                            const ImageOptions& options, const Refusal& refusal, LineStats* found) {
  const auto forbids = [&refusal](const LineStats& so_far) { return refusal(so_far).has_value(); };
  SPECTILE_ASSIGN(const auto run, run_conversion(job, writer, slots, strip_lines, options, forbids));
  const LineStats& stats = run;
  if (auto refused = refusal(stats)) return *std::move(refused);
  if (writer.levels() > 1) {
    SPECTILE_TRY(write_levels(*job.filtered(), writer, slots, strip_lines, options));
  }
  SPECTILE_TRY(writer.commit());
  if (found != nullptr) *found = stats;
  ImageReport report;
  report.width = writer.size(0).width;
  report.height = writer.size(0).height;
  report.nonfinite_pixels = stats.nonfinite.count;
  report.negative_pixels = stats.negative.count;
  report.over_one_pixels = stats.over_one;
  report.out_of_gamut_pixels = stats.outside.count;
  report.clamped_pixels = stats.limited;
  report.bytes_written = writer.bytes_written();
  if (options.skip) report.skipped = skip_stats(stats);
  return report;
}

Result<ImageReport> timed(const std::string& path, const std::function<Result<ImageReport>()>& action) {
  const auto start = std::chrono::steady_clock::now();
  auto report = contained<ImageReport>(path, action);
  if (report)
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace spectile::io
