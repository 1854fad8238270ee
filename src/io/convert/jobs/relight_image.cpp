// relight_image: a texture becomes its colour under another light, line by line, without its spectra.
#include <cstring>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>
#include <spectile/upsampling/relight.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/color_job.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/stages/color_stage.hpp"
#include "src/io/exr/attributes.hpp"
#include "src/lanes/tiles.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

class RelightJob : public io::ColorJob {
 public:
  /// The source's own colour, its first three planes, does not pass through.
  RelightJob(io::RgbSource& source, const Relighter& relighter, const RelightImageOptions& options,
             const kernels::KernelTable& kernels)
      : ColorJob(source.planes(), 3, options.target, options, kernels),
        source_(source),
        relighter_(relighter),
        options_(options),
        stage_(source, relighter.upsampler(), options, kernels) {}

  const io::ColorStage& stage() const noexcept { return stage_; }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) {
    for (std::size_t i = 0; i < slots; ++i) {
      SPECTILE_ASSIGN(auto spectra,
                      FloatBuffer::create(relighter_.projector().bands().count() * kLanesPerBlock));
      spectra_.push_back(std::move(spectra));
    }
    return prepare_colors(writer, source_.width(), slots);
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }

 private:
  void make_colors(std::size_t slot, const Strip& strip, int line, io::ColorLine& color, LineStats& stats,
                   bool checks_only) override {
    stage_.line(strip, line, color, stats);
    if (checks_only) return;
    float* const* rows = color.rows;
    const float* const rgb[3] = {rows[0], rows[1], rows[2]};
    if (options_.way == Way::kDirect) {
      rows::relight(kernels(), relighter_, rgb, rows, color.padded);
    } else {
      rows::relight_by_spectra(kernels(), relighter_, rgb, rows, spectra_[slot].data(), color.padded);
    }
    // Luminance is the second of XYZ.
    if (options_.target == ColorTarget::kLuminance) {
      std::memcpy(rows[0], rows[1], color.padded * sizeof(float));
    }
  }

  io::RgbSource& source_;
  const Relighter& relighter_;
  const RelightImageOptions& options_;
  io::ColorStage stage_;
  std::vector<FloatBuffer> spectra_;  // of each slot: one block, for the long way
};

Result<ImageReport> relight_file(const std::string& input, const std::string& output,
                                 const RelightImageOptions& options) {
  SPECTILE_TRY(io::check_distinct(input, output));
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const int threads = tiles::thread_count(options.threads);
  SPECTILE_ASSIGN(const auto upsampler, io::upsampler_for(options));
  SPECTILE_ASSIGN(const auto projector,
                  Projector::reflective(options.bands, options.under.spectrum, options.seen_by));
  const Matrix3 matrix = io::color_matrix(projector, options.target, options.adaptation);
  SPECTILE_ASSIGN(const auto relighter, Relighter::create(upsampler, projector, matrix));
  SPECTILE_ASSIGN(auto source, io::RgbSource::open(input, options.layer, threads, options.region));

  RelightJob job(*source, relighter, options, *kernels);
  io::ImageSpec spec;
  spec.source = &source->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  spec.tile = io::tiles_of(options);
  spec.mipmap = options.mipmap;
  spec.replaced = io::method_attribute_names();
  spec.replaced.insert(spec.replaced.end(), {"chromaticities", "colorInteropID", "spectileSeenUnder"});
  spec.text_attributes = io::method_attributes(upsampler, options, false);
  spec.text_attributes.emplace_back("spectileSeenUnder", options.under.name);
  if (options.target == ColorTarget::kSrgb) {
    spec.text_attributes.emplace_back("colorInteropID", "lin_rec709_scene");
  }
  spec.text_attributes.emplace_back(io::kSettingsAttribute, settings_text(options));
  const std::size_t slots = io::slot_count(spec, source->width(), threads);
  SPECTILE_ASSIGN(auto writer, io::ExrWriter::create(output, spec, slots));
  SPECTILE_TRY(job.prepare(*writer, slots + io::filter_slots(options)));
  const int lines = io::strip_lines(*spec.source, source->planes(), writer->lines_per_chunk());
  const auto refusal = [&](const LineStats& found) { return job.stage().refusal(input, found); };
  SPECTILE_ASSIGN(auto converted, io::convert(job, *writer, slots, lines, options, refusal));
  ImageReport report = std::move(converted);
  report.bands = options.bands.count();
  report.quantity = options.quantity;
  report.color_space = job.stage().space().description;
  report.notes = source->notes();
  return report;
}

}  // namespace

Result<ImageReport> relight_image(const std::string& input, const std::string& output,
                                  const RelightImageOptions& options) {
  return io::timed(input, [&] { return relight_file(input, output, options); });
}

}  // namespace spectile
