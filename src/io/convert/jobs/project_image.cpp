// project_image: a spectral image becomes sRGB, XYZ or luminance, line by line.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>

#include "src/base/errors.hpp"
#include "src/color/color_matrix.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/color_job.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/convert/stages/lines.hpp"
#include "src/io/exr/attributes.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

class ProjectJob : public io::ColorJob {
 public:
  ProjectJob(io::SpectralSource& source, const Projector& projector, const ProjectImageOptions& options,
             const kernels::KernelTable& kernels)
      : ColorJob(source.planes(), source.bands().count(), options.target, options, kernels),
        source_(source),
        projector_(projector),
        options_(options) {
    matrix_ = color::to_float(io::color_matrix(projector, options.target, options.adaptation));
    // XYZ without an adaptation, and luminance, are the projector's own.
    convert_ = options.target == ColorTarget::kSrgb ||
               (options.target == ColorTarget::kXyz && options.adaptation != Adaptation::kNone);
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) {
    for (std::size_t i = 0; i < slots; ++i) {
      SPECTILE_ASSIGN(auto spectra,
                      FloatBuffer::create(source_.bands().count() * kLanesPerBlock * tile_blocks()));
      spectra_.push_back(std::move(spectra));
    }
    return prepare_colors(writer, source_.width(), slots);
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }

 private:
  void make_colors(std::size_t slot, const Strip& strip, int line, io::ColorLine& color, LineStats& stats,
                   bool /*checks_only*/) override {
    const auto width = static_cast<std::size_t>(strip.width);
    float* const* rows = color.rows;
    project_line(spectra_[slot].data(), strip, line, color);
    io::settle_nonfinite(kernels(), rows, width, line, options_.nonfinite, stats);
    if (convert_) {
      const float* const xyz[3] = {rows[0], rows[1], rows[2]};
      kernels().transform3(rows, xyz, matrix_.data(), color.padded);
    }
    io::settle_range(kernels(), rows, width, line, NegativeInput::kKeep, stats);
  }

  /// Blocks that are gathered and then projected together; they stay in the caches.
  std::size_t tile_blocks() const {
    const std::size_t line = blocks_for(static_cast<std::size_t>(source_.width()));
    return std::clamp<std::size_t>(options_.tile_lanes / kLanesPerBlock, 1, std::min<std::size_t>(line, 16));
  }

  void project_line(float* spectra, const Strip& strip, int line, io::ColorLine& color) const {
    const std::size_t blocks = blocks_for(static_cast<std::size_t>(strip.width));
    const std::size_t bands = source_.bands().count();
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
        kernels().project(rows[0] + at, rows[1] + at, rows[2] + at, spectra,
                          ProjectorAccess::weights(projector_), bands, count);
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
  std::vector<FloatBuffer> spectra_;  // of each slot
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
  if (options.light) return Projector::reflective(source.bands(), *options.light, options.observer);
  SPECTILE_ASSIGN(const auto d65, illuminant("D65"));
  return Projector::reflective(source.bands(), d65, options.observer);
}

Result<ImageReport> project_file(const std::string& input, const std::string& output,
                                 const ProjectImageOptions& options) {
  SPECTILE_TRY(io::check_distinct(input, output));
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const int threads = tiles::thread_count(options.threads);
  SPECTILE_ASSIGN(auto source, io::SpectralSource::open(input, options.quantity, threads, options.region));
  if (options.adaptation != Adaptation::kNone && source->quantity() == Quantity::kIlluminant) {
    return make_error(ErrorCode::kBadArgument, "{}: holds light, whose white is not adapted", input);
  }
  if (options.adaptation != Adaptation::kNone && options.target == ColorTarget::kLuminance) {
    return make_error(ErrorCode::kBadArgument, "{}: luminance alone cannot be adapted", input);
  }
  SPECTILE_ASSIGN(const auto projector, projector_for(*source, input, options));

  ProjectJob job(*source, projector, options, *kernels);
  io::ImageSpec spec;
  spec.source = &source->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  spec.tile = io::tiles_of(options);
  spec.mipmap = options.mipmap;
  // The output is linear sRGB or CIE, whatever space the input's preview was in.
  spec.replaced = io::method_attribute_names();
  spec.replaced.insert(spec.replaced.end(),
                       {"spectralLayoutVersion", "emissiveUnits", "chromaticities", "colorInteropID"});
  if (options.target == ColorTarget::kSrgb) spec.text_attributes = {{"colorInteropID", "lin_rec709_scene"}};
  spec.text_attributes.emplace_back(io::kSettingsAttribute, settings_text(options));
  const std::size_t slots = io::slot_count(spec, source->width(), threads);
  SPECTILE_ASSIGN(auto writer, io::ExrWriter::create(output, spec, slots));
  SPECTILE_TRY(job.prepare(*writer, slots + io::filter_slots(options)));

  const int lines = io::strip_lines(*spec.source, source->planes(), writer->lines_per_chunk());
  SPECTILE_ASSIGN(auto converted, io::convert(job, *writer, slots, lines, options,
                                              io::at_nonfinite(input, options, source->offset())));
  ImageReport report = std::move(converted);
  report.bands = source->bands().count();
  report.quantity = source->quantity();
  report.notes = source->notes();
  return report;
}

}  // namespace

Result<ImageReport> project_image(const std::string& input, const std::string& output,
                                  const ProjectImageOptions& options) {
  return io::timed(input, [&] { return project_file(input, output, options); });
}

}  // namespace spectile
