// average_images: renders of one frame become their weighted average, part by part, strip by strip.
#include <memory>
#include <spectile/image/average.hpp>

#include "src/base/errors.hpp"
#include "src/io/average/average_inputs.hpp"
#include "src/io/average/average_job.hpp"
#include "src/io/convert/frame/output.hpp"

namespace spectile {
namespace {

/// A part of the average: what it is made of, and how.
struct AveragedPart {
  std::unique_ptr<io::AverageInputs> inputs;
  std::unique_ptr<io::AverageJob> job;
};

io::ImageSpec spec_of(const AveragedPart& part, const std::string& made_of, const AverageOptions& options) {
  io::ImageSpec spec;
  spec.source = &part.inputs->header();
  spec.channels = part.job->channels();
  spec.compression = options.compression;
  spec.change = io::PixelChange::kAverage;
  spec.text_attributes.emplace_back("spectileAverage", made_of);
  return spec;
}

/// Writes a part; the counts go to the report.
Result<void> run_part(AveragedPart& part, io::ExrWriter& writer, std::size_t slots,
                      const AverageOptions& options, ImageReport& report) {
  io::AverageJob& job = *part.job;
  SPECTILE_TRY(job.prepare(writer, slots));
  ImageOptions run = options;
  run.progress = [&job](const Progress& progress) { return job.carry_on(progress); };
  const auto refused = [&job](const io::LineStats& found) { return job.refusal(found).has_value(); };
  SPECTILE_ASSIGN(
      const io::LineStats stats,
      io::run_conversion(job, writer, slots, job.strip_lines(writer.lines_per_chunk()), run, refused));
  if (auto error = job.refusal(stats)) return *std::move(error);
  report.nonfinite_pixels += stats.nonfinite.count;
  report.clamped_pixels += stats.clamped;
  const std::string name = part.inputs->parts() > 1 ? part.inputs->header().text("name").value_or("") : "";
  for (const std::string& note : job.notes()) {
    report.notes.push_back(name.empty() ? note : fmt::format("part \"{}\": {}", name, note));
  }
  return {};
}

Result<ImageReport> average_files(std::span<const std::string> paths, const std::string& output,
                                  const AverageOptions& options) {
  if (paths.empty()) return make_error(ErrorCode::kBadArgument, "no images to average");
  if (!options.weights.empty() && options.weights.size() != paths.size()) {
    return make_error(ErrorCode::kBadArgument, "{} weights for {} images", options.weights.size(),
                      paths.size());
  }
  SPECTILE_ASSIGN(const auto weights,
                  exact::whole_weights(options.weights.empty() ? std::vector<double>(paths.size(), 1.0)
                                                               : options.weights));
  if (options.stored == SampleType::kUint32) {
    return make_error(ErrorCode::kBadArgument, "{}: averages are written as half or float", output);
  }
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(paths, output, options));
  const std::string made_of =
      fmt::format("{} image{}, weights' sum {}", paths.size(), paths.size() == 1 ? "" : "s", weights.sum);

  std::vector<AveragedPart> parts;
  std::vector<io::ImageSpec> specs;
  ImageReport report;
  do {
    AveragedPart part;
    SPECTILE_ASSIGN(part.inputs,
                    io::AverageInputs::open(paths, setup.threads, static_cast<int>(parts.size())));
    part.job = std::make_unique<io::AverageJob>(*part.inputs, options, weights, setup.kernels);
    specs.push_back(spec_of(part, made_of, options));
    if (auto note = io::left_out_note(specs.back())) report.notes.push_back(*std::move(note));
    parts.push_back(std::move(part));
  } while (static_cast<int>(parts.size()) < parts[0].inputs->parts());

  std::size_t slots = 1;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    slots = std::max(slots, io::slot_count(specs[i], parts[i].inputs->header().width(), setup.threads));
  }
  SPECTILE_ASSIGN(const auto writer, io::ExrWriter::create(output, specs, slots));
  report.width = writer->size(0).width;
  report.height = writer->size(0).height;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    writer->begin_part(static_cast<int>(i));
    SPECTILE_TRY(run_part(parts[i], *writer, slots, options, report));
  }
  SPECTILE_TRY(writer->commit(options.durable));
  report.bytes_written = writer->bytes_written();
  return report;
}

}  // namespace

Result<ImageReport> average_images(std::span<const std::string> inputs, const std::string& output,
                                   const AverageOptions& options) {
  return io::timed(output, [&] { return average_files(inputs, output, options); });
}

}  // namespace spectile
