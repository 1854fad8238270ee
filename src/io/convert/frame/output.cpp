// The frame that every image job runs in: checks of its paths, the output's header, the conversion, the
// report.
#include "src/io/convert/frame/output.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/fitted_job.hpp"
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

namespace {

std::string corners(const PixelWindow& w) {
  return fmt::format("{},{} to {},{}", w.x0, w.y0, std::int64_t{w.x1} - 1, std::int64_t{w.y1} - 1);
}

std::int64_t area(const PixelWindow& w) {
  return w.empty() ? 0 : (std::int64_t{w.x1} - w.x0) * (std::int64_t{w.y1} - w.y0);
}

/// The data window of an image with mip levels: the display window, which readers take every level for. Says
/// what that means where it is another than the source's.
Result<PixelWindow> window_of_levels(const PartHeader& source, const std::string& output,
                                     std::vector<std::string>& notes) {
  const PixelWindow& data = source.data_window();
  const PixelWindow& display = source.display_window();
  if (data == display) return data;
  const PixelWindow both = {std::max(data.x0, display.x0), std::max(data.y0, display.y0),
                            std::min(data.x1, display.x1), std::min(data.y1, display.y1)};
  const std::int64_t side =
      std::max(std::int64_t{display.x1} - display.x0, std::int64_t{display.y1} - display.y0);
  if (both.empty() || side > PartHeader::kMaxSide) {
    return make_error(ErrorCode::kBadFile,
                      "{}: mip levels are of the display window, {}, which does not go with the data window, "
                      "{}; write it without mip levels",
                      output, corners(display), corners(data));
  }
  std::string note = fmt::format("mip levels are of the display window, {}", corners(display));
  if (const auto more = area(display) - area(both); more > 0) {
    note += fmt::format("; {} pixel{} outside of the data window {} 0", more, more == 1 ? "" : "s",
                        more == 1 ? "is" : "are");
  }
  if (const auto less = area(data) - area(both); less > 0) {
    note += fmt::format("; {} pixel{} outside of it {} left out, which stay without mip levels", less,
                        less == 1 ? "" : "s", less == 1 ? "is" : "are");
  }
  notes.push_back(std::move(note));
  return display;
}

Result<ImageReport> run_fitted(ImageJob image);

}  // namespace

void add_counts(ImageReport& report, const LineStats& stats, const ExrWriter& writer) {
  report.width = writer.size(0).width;
  report.height = writer.size(0).height;
  report.nonfinite_pixels = stats.nonfinite.count;
  report.negative_pixels = stats.negative.count;
  report.over_one_pixels = stats.over_one;
  report.out_of_gamut_pixels = stats.outside.count;
  report.clamped_pixels = stats.clamped;
  report.bytes_written = writer.bytes_written();
}

Result<ImageReport> run_image_job(ImageJob image) {
  if (!image.options.mipmap || image.job.filtered() == nullptr) return run_fitted(std::move(image));
  const PartHeader& source = *image.spec.source;
  const PixelWindow from = source.data_window();
  if (image.options.region) {
    // The levels are of what was asked for.
    const PartHeader header = source.with_display_window(from);
    image.spec.source = &header;
    return run_fitted(std::move(image));
  }
  SPECTILE_ASSIGN(const PixelWindow to, window_of_levels(source, image.output, image.report.notes));
  if (to == from) return run_fitted(std::move(image));
  FittedJob job(*image.job.filtered(), from, to);
  const PartHeader header = source.with_data_window(to);
  image.spec.source = &header;
  const std::array<int, 2> moved = {to.x0 - from.x0, to.y0 - from.y0};
  Refusal refusal;
  if (image.refusal) {
    refusal = [own = std::move(image.refusal), moved](const LineStats& found) {
      return own(found.moved(moved[0], moved[1]));
    };
  }
  return run_fitted({job, image.output, std::move(image.spec), image.options, std::move(refusal),
                     std::move(image.report), std::move(image.remark)});
}

namespace {

Result<ImageReport> run_fitted(ImageJob image) {
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
    FilteredJob& job = *image.job.filtered();
    const std::vector<std::string> nearest = nearest_channels(job, *image.spec.source);
    SPECTILE_TRY(write_levels(job, writer, slots, lines, options, nearest));
    if (!nearest.empty()) {
      image.report.notes.push_back(
          fmt::format("{} {} objects: mip levels take the nearest pixel's, not an "
                      "average",
                      fmt::join(nearest, ", "), nearest.size() == 1 ? "names" : "name"));
    }
  }
  SPECTILE_TRY(writer.commit(options.durable));
  ImageReport report = std::move(image.report);
  if (image.remark) image.remark(stats, report.notes);
  add_counts(report, stats, writer);
  if (options.skip) report.skipped = skip_stats(stats);
  return report;
}

}  // namespace

Result<ImageReport> timed(const std::string& path, const std::function<Result<ImageReport>()>& action) {
  const auto start = std::chrono::steady_clock::now();
  auto report = contained<ImageReport>(path, action);
  if (report)
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace spectile::io
