// project_image: a spectral image becomes sRGB, XYZ or luminance, line by line.
#include <algorithm>
#include <cstring>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>

#include "src/base/errors.hpp"
#include "src/color/color_matrix.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/color_job.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/convert/stages/lines.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

class ProjectJob : public io::ColorJob {
 public:
  ProjectJob(io::SpectralSource& source, const Projector& projector, const ProjectImageOptions& options,
             const kernels::KernelTable& kernels)
      : ColorJob(source, source.samples(), options.target, options, kernels),
        source_(source),
        projector_(projector),
        options_(options) {
    matrix_ = color::to_float(io::color_matrix(projector, options.target, options.adaptation));
    // XYZ without an adaptation, and luminance, are the projector's own.
    convert_ = options.target == ColorTarget::kSrgb ||
               (options.target == ColorTarget::kXyz && options.adaptation != Adaptation::kNone);
  }

 private:
  std::size_t spectra_floats(std::size_t /*width*/) const override {
    return source_.samples() * kLanesPerBlock * tile_blocks();
  }

  void make_colors(std::size_t slot, const Strip& strip, int line, io::ColorLine& color, LineStats& stats,
                   bool /*checks_only*/) override {
    const auto width = static_cast<std::size_t>(strip.width);
    float* const* rows = color.rows;
    project_line(spectra(slot), strip, line, color);
    io::sanitize_nonfinite(kernels(), rows, width, line, options_.nonfinite, stats);
    if (convert_) {
      const float* const xyz[3] = {rows[0], rows[1], rows[2]};
      kernels().transform3(rows, xyz, matrix_.data(), color.padded);
    }
    io::sanitize_range(kernels(), rows, width, line, NegativeInput::kKeep, stats);
  }

  /// Blocks that are gathered and then projected together; they stay in the caches.
  std::size_t tile_blocks() const {
    const std::size_t line = blocks_for(static_cast<std::size_t>(source_.width()));
    return std::clamp<std::size_t>(options_.tile_lanes / kLanesPerBlock, 1, std::min<std::size_t>(line, 16));
  }

  void project_line(float* spectra, const Strip& strip, int line, io::ColorLine& color) const {
    const std::size_t blocks = blocks_for(static_cast<std::size_t>(strip.width));
    const std::size_t bands = source_.samples();
    float* const* rows = color.rows;
    for (std::size_t first = 0; first < blocks; first += tile_blocks()) {
      const std::size_t count = std::min(tile_blocks(), blocks - first);
      const std::size_t at = first * kLanesPerBlock;
      for (std::size_t b = 0; b < count; ++b) {
        source_.block(kernels(), strip, line, at + b * kLanesPerBlock, spectra + b * bands * kLanesPerBlock);
      }
      if (options_.target == ColorTarget::kLuminance) {
        kernels().weighted_sum(rows[0] + at, spectra, ProjectorAccess::luminance_weights(projector_), bands,
                               count);
      } else {
        float* const dst[3] = {rows[0] + at, rows[1] + at, rows[2] + at};
        kernels().project(dst, spectra, ProjectorAccess::weights(projector_), bands, count);
      }
    }
    if (options_.target == ColorTarget::kLuminance) {
      // The checks look at three components; luminance is all of them.
      for (std::size_t k : {1U, 2U}) std::memcpy(rows[k], rows[0], color.padded * sizeof(float));
    }
  }

  io::SpectralSource& source_;
  const Projector& projector_;
  const ProjectImageOptions& options_;
  std::array<float, 9> matrix_{};
  bool convert_ = false;
};

Result<Projector> projector_for(const io::SpectralSource& source, const std::string& input,
                                const ProjectImageOptions& options) {
  if (source.quantity() == Quantity::kIlluminant) {
    if (options.light) {
      return make_error(ErrorCode::kBadArgument, "{}: holds light, not reflectances; it takes no illuminant",
                        input);
    }
    return Projector::emissive(source.bands(), options.observer);
  }
  SPECTILE_ASSIGN(const auto d65, illuminant("D65"));
  std::vector<BandPair> pairs;
  for (const io::ReradiationChannel& channel : source.reradiation()) {
    pairs.push_back({channel.from_band, channel.to_band});
  }
  return Projector::reradiating(source.bands(), options.light.value_or(d65), pairs, options.observer);
}

Result<ImageReport> project_file(const std::string& input, const std::string& output,
                                 const ProjectImageOptions& options) {
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(std::array{input}, output, options));
  SPECTILE_ASSIGN(auto source, io::SpectralSource::open(input, options.channels, options.quantity,
                                                        setup.threads, options.region));
  if (options.adaptation != Adaptation::kNone && source->quantity() == Quantity::kIlluminant) {
    return make_error(ErrorCode::kBadArgument, "{}: holds light, whose white is not adapted", input);
  }
  if (options.adaptation != Adaptation::kNone && options.target == ColorTarget::kLuminance) {
    return make_error(ErrorCode::kBadArgument, "{}: luminance alone cannot be adapted", input);
  }
  SPECTILE_ASSIGN(const auto projector, projector_for(*source, input, options));

  ProjectJob job(*source, projector, options, setup.kernels);
  io::TextAttributes texts;
  io::add_color_tag(texts, options.target);
  io::ImageSpec spec = io::conversion_spec(source->header(), job.channels(), std::move(texts), options,
                                           settings_text(options));
  // The output is linear sRGB or CIE, whatever space the input's preview was in.
  spec.replaced = io::method_attribute_names();
  spec.change = io::PixelChange::kColor;
  ImageReport known;
  known.bands = source->bands().count();
  known.quantity = source->quantity();
  known.notes = source->notes();
  if (options.target == ColorTarget::kSrgb && projector.white_compensation() < 1) {
    known.notes.push_back(
        fmt::format("the bands miss much of the visible range: {:.0f} % of the tint that this gives to white "
                    "is taken out",
                    100 * projector.white_compensation()));
  }
  return io::run_image_job({job, output, std::move(spec), options,
                            io::at_nonfinite(input, options, source->offset()), std::move(known)});
}

}  // namespace

Result<ImageReport> project_image(const std::string& input, const std::string& output,
                                  const ProjectImageOptions& options) {
  return io::timed(input, [&] { return project_file(input, output, options); });
}

}  // namespace spectile
