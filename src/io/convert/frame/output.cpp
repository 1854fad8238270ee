// The frame that every image job runs in: checks of its paths, the output's header, the conversion, the
// report.
#include "src/io/convert/frame/output.hpp"

#include <chrono>
#include <filesystem>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/exr/attributes.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile::io {

Result<JobSetup> set_up_job(std::span<const std::string> inputs, const std::string& output,
                            const ImageOptions& options) {
  for (const std::string& input : inputs) {
    std::error_code error;
    if (std::filesystem::equivalent(input, output, error) && !error) {
      return make_error(ErrorCode::kBadArgument, "{}: input and output are the same file", output);
    }
  }
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  return JobSetup{*kernels, tiles::thread_count(options.threads)};
}

ImageSpec conversion_spec(const PartHeader& source, std::vector<ChannelSpec> channels, TextAttributes texts,
                          const ImageOptions& options, const std::string& settings) {
  ImageSpec spec;
  spec.source = &source;
  spec.channels = std::move(channels);
  spec.tile = tiles_of(options);
  spec.mipmap = options.mipmap;
  spec.text_attributes = std::move(texts);
  spec.text_attributes.emplace_back(kSettingsAttribute, settings);
  return spec;
}

Refusal at_nonfinite(const std::string& input, const ImageOptions& options, std::array<int, 2> offset) {
  return [&input, offset,
          stop = options.nonfinite == NonFinite::kStop](const LineStats& stats) -> std::optional<Error> {
    if (!stop || stats.nonfinite.count == 0) return {};
    return stopped_at(input, ErrorCode::kNonFinite, "non-finite", stats.nonfinite.moved(offset),
                      "--nonfinite zero makes them black");
  };
}

Result<ImageReport> run_image_job(ImageJob image) {
  const ImageOptions& options = image.options;
  if (options.pixel == SampleType::kUint32) {
    return make_error(ErrorCode::kBadArgument, "{}: samples are written as half or float", image.output);
  }
  image.spec.compression = options.compression;
  if (auto note = left_out_note(image.spec)) image.report.notes.push_back(*std::move(note));
  const std::size_t slots =
      slot_count(image.spec, image.spec.source->width(), tiles::thread_count(options.threads));
  SPECTILE_ASSIGN(const auto owner, ExrWriter::create(image.output, image.spec, slots));
  ExrWriter& writer = *owner;
  SPECTILE_TRY(image.job.prepare(writer, slots + filter_slots(options)));
  const int lines = image.job.strip_lines(writer.lines_per_chunk());
  const auto forbids = [&image](const LineStats& found) {
    return image.refusal ? image.refusal(found) : std::nullopt;
  };
  SPECTILE_ASSIGN(const LineStats stats,
                  run_conversion(image.job, writer, slots, lines, options,
                                 [&](const LineStats& found) { return forbids(found).has_value(); }));
  if (auto refused = forbids(stats)) return *std::move(refused);
  if (writer.levels() > 1) {
    SPECTILE_TRY(write_levels(*image.job.filtered(), writer, slots, lines, options));
  }
  SPECTILE_TRY(writer.commit());
  ImageReport report = std::move(image.report);
  if (image.remark) image.remark(stats, report.notes);
  report.width = writer.size(0).width;
  report.height = writer.size(0).height;
  report.nonfinite_pixels = stats.nonfinite.count;
  report.negative_pixels = stats.negative.count;
  report.over_one_pixels = stats.over_one;
  report.out_of_gamut_pixels = stats.outside.count;
  report.clamped_pixels = stats.clamped;
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
