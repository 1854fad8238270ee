// project_image: a spectral image becomes sRGB, XYZ or luminance, line by line.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <spectile/image.hpp>
#include <spectile/settings.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/color_rows.hpp"
#include "src/io/conversion.hpp"
#include "src/io/lines.hpp"
#include "src/io/method_attributes.hpp"
#include "src/io/mip_levels.hpp"
#include "src/io/output.hpp"
#include "src/io/settings.hpp"
#include "src/io/spectral_source.hpp"
#include "src/ops/color_matrix.hpp"
#include "src/ops/tiles.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// Work space of one slot.
struct Work {
  io::ColorLine color;
  FloatBuffer spectra;
  FloatBuffer halves;
};

class ProjectJob : public io::FilteredJob {
 public:
  ProjectJob(io::SpectralSource& source, const Projector& projector, const ProjectImageOptions& options,
             const kernels::KernelTable& kernels)
      : source_(source), projector_(projector), options_(options), kernels_(kernels) {
    matrix_ = color::to_float(io::color_matrix(projector, options.target, options.adaptation));
    // XYZ without an adaptation, and luminance, are the projector's own.
    convert_ = options.target == ColorTarget::kSrgb ||
               (options.target == ColorTarget::kXyz && options.adaptation != Adaptation::kNone);
    color_names_ = io::color_channels(options.target);
  }

  /// Output channels: the colour, then those that pass through.
  std::vector<io::ChannelSpec> channels() const {
    const exr_pixel_type_t type = options_.pixel == PixelType::kHalf ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    std::vector<io::ChannelSpec> out;
    for (const char* name : color_names_) out.push_back({name, type});
    for (std::size_t i = source_.bands().count(); i < source_.planes().size(); ++i) {
      const io::PlaneSpec& plane = source_.planes()[i];
      const bool taken =
          std::any_of(out.begin(), out.end(), [&](const auto& c) { return c.name == plane.name; });
      if (taken) continue;
      out.push_back({plane.name, io::passing_type(plane)});
    }
    return out;
  }

  Result<void> prepare(const io::ExrWriter& writer, const std::vector<io::ChannelSpec>& channels,
                       std::size_t slots) {
    writer_ = &writer;
    for (std::size_t i = color_names_.size(); i < channels.size(); ++i) {
      const auto& planes = source_.planes();
      for (std::size_t p = source_.bands().count(); p < planes.size(); ++p) {
        if (planes[p].name == channels[i].name) passing_.emplace_back(i, p);
      }
    }
    for (std::size_t i = 0; i < slots; ++i) {
      Work work;
      auto color = io::ColorLine::create(source_.width());
      auto spectra = FloatBuffer::create(source_.bands().count() * kLanesPerBlock * tile_blocks());
      auto halves =
          FloatBuffer::create(blocks_for(static_cast<std::size_t>(source_.width())) * kLanesPerBlock / 2);
      if (!color) return color.error();
      if (!spectra) return spectra.error();
      if (!halves) return halves.error();
      work.color = *std::move(color);
      work.spectra = *std::move(spectra);
      work.halves = *std::move(halves);
      works_.push_back(std::move(work));
    }
    return {};
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    Work& work = works_[slot];
    colors(work, strip, line, stats);
    if (packed == nullptr) return;
    stats.limited += pack_colors(work, static_cast<std::size_t>(strip.width), packed);
    for (const auto& [channel, plane] : passing_) pass(strip, plane, line, channel, packed);
  }

  std::vector<std::pair<std::size_t, io::PlaneSpec>> passing() const override {
    std::vector<std::pair<std::size_t, io::PlaneSpec>> out;
    for (const auto& [channel, plane] : passing_) out.emplace_back(plane, source_.planes()[plane]);
    return out;
  }

  std::size_t filtered_rows() const override { return color_names_.size(); }

  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) override {
    Work& work = works_[slot];
    LineStats counted_before;
    colors(work, strip, line, counted_before);
    for (std::size_t k = 0; k < color_names_.size(); ++k) {
      std::memcpy(rows[k], work.color.rows[k], work.color.padded * sizeof(float));
    }
  }

  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) override {
    Work& work = works_[slot];
    io::load_colors(strip, line, passing_.size(), color_names_.size(), work.color);
    pack_colors(work, static_cast<std::size_t>(strip.width), packed);
    for (std::size_t i = 0; i < passing_.size(); ++i) pass(strip, i, line, passing_[i].first, packed);
  }

 private:
  /// A line's colours, in the slot's rows.
  void colors(Work& work, const Strip& strip, int line, LineStats& stats) const {
    const auto width = static_cast<std::size_t>(strip.width);
    work.color.set_width(width);
    float* const* rows = work.color.rows;
    project_line(work, strip, line);
    io::settle_nonfinite(kernels_, rows, width, line, options_.nonfinite, stats);
    if (convert_) {
      const float* const xyz[3] = {rows[0], rows[1], rows[2]};
      kernels_.transform3(rows, xyz, matrix_.data(), work.color.padded);
    }
    io::settle_range(kernels_, rows, width, line, Negative::kKeep, stats);
  }

  /// Packs the slot's rows, and returns how many pixels were limited to what a half holds.
  std::uint64_t pack_colors(Work& work, std::size_t width, std::byte* packed) const {
    const std::size_t colors = color_names_.size();
    const bool half = options_.pixel == PixelType::kHalf;
    const std::uint64_t limited = half ? io::limit_to_half(kernels_, work.color, colors, width) : 0;
    for (std::size_t k = 0; k < colors; ++k) {
      io::store_row(kernels_, work.color, k, width, options_.pixel, work.halves,
                    packed + writer_->channel_offset(k, width));
    }
    return limited;
  }

  void pass(const Strip& strip, std::size_t plane, int line, std::size_t channel, std::byte* packed) const {
    std::memcpy(packed + writer_->channel_offset(channel, static_cast<std::size_t>(strip.width)),
                strip.row(plane, line), strip.row_bytes[plane]);
  }

  /// Blocks that are gathered and then projected together; they stay in the caches.
  std::size_t tile_blocks() const {
    const std::size_t line = blocks_for(static_cast<std::size_t>(source_.width()));
    return std::clamp<std::size_t>(options_.tile_lanes / kLanesPerBlock, 1, std::min<std::size_t>(line, 16));
  }

  void project_line(Work& work, const Strip& strip, int line) const {
    const std::size_t blocks = blocks_for(static_cast<std::size_t>(strip.width));
    const std::size_t bands = source_.bands().count();
    for (std::size_t first = 0; first < blocks; first += tile_blocks()) {
      const std::size_t count = std::min(tile_blocks(), blocks - first);
      const std::size_t at = first * kLanesPerBlock;
      for (std::size_t b = 0; b < count; ++b) {
        source_.block(kernels_, strip, line, at + b * kLanesPerBlock,
                      work.spectra.data() + b * bands * kLanesPerBlock);
      }
      float* const* rows = work.color.rows;
      if (options_.target == ColorTarget::kLuminance) {
        kernels_.weighted_sum(rows[0] + at, work.spectra.data(), projector_.luminance_weights(), bands,
                              count);
      } else {
        kernels_.project(rows[0] + at, rows[1] + at, rows[2] + at, work.spectra.data(),
                         projector_.float_weights(), bands, count);
      }
    }
    if (options_.target == ColorTarget::kLuminance) {
      // The checks look at three components; luminance is all of them.
      for (std::size_t k : {1U, 2U}) {
        std::memcpy(work.color.rows[k], work.color.rows[0], work.color.padded * sizeof(float));
      }
    }
  }

  io::SpectralSource& source_;
  const Projector& projector_;
  const ProjectImageOptions& options_;
  const kernels::KernelTable& kernels_;
  const io::ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
  std::vector<std::pair<std::size_t, std::size_t>> passing_;  // output channel, source plane
  std::vector<const char*> color_names_;
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
  const auto d65 = illuminant("D65");
  if (!d65) return d65.error();
  return Projector::reflective(source.bands(), *d65, options.observer);
}

Result<ImageReport> project_file(const std::string& input, const std::string& output,
                                 const ProjectImageOptions& options) {
  SPECTILE_TRY(io::check_distinct(input, output));
  const auto kernels = dispatch::active();
  if (!kernels) return kernels.error();
  const int threads = tiles::thread_count(options.threads);
  auto source = io::SpectralSource::open(input, options.quantity, threads, options.region);
  if (!source) return source.error();
  if (options.adaptation != Adaptation::kNone && (*source)->quantity() == Quantity::kIlluminant) {
    return make_error(ErrorCode::kBadArgument, "{}: holds light, whose white is not adapted", input);
  }
  if (options.adaptation != Adaptation::kNone && options.target == ColorTarget::kLuminance) {
    return make_error(ErrorCode::kBadArgument, "{}: luminance alone cannot be adapted", input);
  }
  const auto projector = projector_for(**source, input, options);
  if (!projector) return projector.error();

  ProjectJob job(**source, *projector, options, **kernels);
  io::ImageSpec spec;
  spec.source = &(*source)->header();
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
  const std::size_t slots = io::slot_count(spec, (*source)->width(), threads);
  auto writer = io::ExrWriter::create(output, spec, slots);
  if (!writer) return writer.error();
  SPECTILE_TRY(job.prepare(**writer, spec.channels, slots + io::filter_slots(options)));

  const int lines = io::strip_lines(*spec.source, (*source)->planes(), (*writer)->lines_per_chunk());
  auto converted = io::convert(job, **writer, slots, lines, options,
                               io::at_nonfinite(input, options, (*source)->offset()));
  if (!converted) return converted.error();
  ImageReport report = *std::move(converted);
  report.bands = (*source)->bands().count();
  report.quantity = (*source)->quantity();
  report.notes = (*source)->notes();
  return report;
}

}  // namespace

Result<ImageReport> project_image(const std::string& input, const std::string& output,
                                  const ProjectImageOptions& options) {
  return io::timed(input, [&] { return project_file(input, output, options); });
}

}  // namespace spectile
