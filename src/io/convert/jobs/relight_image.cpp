// relight_image: a texture becomes its colour under another light, line by line, without its spectra.
#include <cstring>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>
#include <spectile/upsampling/relight.hpp>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/color_job.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/stages/color_stage.hpp"
#include "src/io/convert/stages/straight_color.hpp"
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
      : ColorJob(source, 3, io::color_channels(options.target), options, kernels),
        relighter_(relighter),
        options_(options),
        stage_(source, relighter.upsampler(), options, kernels),
        straight_(source, relighter.upsampler(), options, kernels),
        bands_(relighter.projector().bands().count()) {}

  const io::ColorStage& stage() const noexcept { return stage_; }

 private:
  /// One block, for the computation by spectra, and after it a line of scales.
  std::size_t spectra_floats(std::size_t width) const override {
    return (bands_ + (straight_.needed() ? blocks_for(width) : 0)) * kLanesPerBlock;
  }

  void make_colors(std::size_t slot, const Strip& strip, int line, io::ColorLine& color, LineStats& stats,
                   bool checks_only) override {
    const auto width = static_cast<std::size_t>(strip.width);
    float* const scale = straight_.needed() ? spectra(slot) + bands_ * kLanesPerBlock : nullptr;
    stage_.load(strip, line, color);
    const io::ColorStage::Sanitized sanitized = stage_.sanitize(line, color, width, stats);
    if (scale != nullptr) straight_.divide(strip, line, color.rows, scale, stats);
    if (sanitized.may_be_outside) stage_.clip_to_gamut(line, color, width, stats);
    if (checks_only) return;
    float* const* rows = color.rows;
    const float* const rgb[3] = {rows[0], rows[1], rows[2]};
    if (options_.mode == RelightMode::kDirect) {
      rows::relight(kernels(), relighter_, rgb, rows, color.padded, scale);
    } else {
      rows::relight_by_spectra(kernels(), relighter_, rgb, rows, spectra(slot), color.padded, scale);
    }
    // Luminance is the second of XYZ.
    if (options_.target == ColorTarget::kLuminance) {
      std::memcpy(rows[0], rows[1], color.padded * sizeof(float));
    }
  }

  const Relighter& relighter_;
  const RelightImageOptions& options_;
  io::ColorStage stage_;
  io::StraightColor straight_;
  std::size_t bands_;
};

Result<ImageReport> relight_file(const std::string& input, const std::string& output,
                                 const RelightImageOptions& options) {
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(std::array{input}, output, options));
  SPECTILE_ASSIGN(const auto upsampler, io::upsampler_for(options));
  SPECTILE_ASSIGN(const auto projector,
                  Projector::reflective(options.bands, options.under.spectrum, options.seen_by));
  const Matrix3 matrix = io::color_matrix(projector, options.target, options.adaptation);
  SPECTILE_ASSIGN(const auto relighter, Relighter::create(upsampler, projector, matrix));
  SPECTILE_ASSIGN(auto source, io::RgbSource::open(input, options.channels, setup.threads, options.region,
                                                   options.input_space));

  RelightJob job(*source, relighter, options, setup.kernels);
  auto texts = io::method_attributes(upsampler, options, false);
  texts.emplace_back("spectileSeenUnder", options.under.name);
  io::add_color_tag(texts, options.target);
  io::ImageSpec spec = io::conversion_spec(source->header(), job.channels(), std::move(texts), options,
                                           settings_text(options));
  spec.replaced = io::method_attribute_names();
  spec.replaced.emplace_back("spectileSeenUnder");
  spec.change = io::PixelChange::kColor;
  spec.view = source->view();
  ImageReport known;
  known.bands = options.bands.count();
  known.quantity = options.quantity;
  known.color_space = job.stage().space().description;
  known.notes = source->notes();
  io::note_nodes(upsampler, known.notes);
  const auto note_alpha = [&options](const io::LineStats& found, std::vector<std::string>& notes) {
    io::note_alpha(found, !options.alpha, notes);
  };
  const auto refusal = [&](const LineStats& found) { return job.stage().refusal(input, found); };
  return io::run_image_job({job, output, std::move(spec), options, refusal, std::move(known), note_alpha});
}

}  // namespace

Result<ImageReport> relight_image(const std::string& input, const std::string& output,
                                  const RelightImageOptions& options) {
  return io::timed(input, [&] { return relight_file(input, output, options); });
}

}  // namespace spectile
