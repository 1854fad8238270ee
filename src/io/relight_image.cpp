// relight_image: a texture becomes its colour under another light, line by line, without its spectra.
#include <algorithm>
#include <cstring>
#include <spectile/image.hpp>
#include <spectile/relight.hpp>
#include <spectile/settings.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/color_rows.hpp"
#include "src/io/color_stage.hpp"
#include "src/io/method_attributes.hpp"
#include "src/io/output.hpp"
#include "src/io/settings.hpp"
#include "src/ops/relight_rows.hpp"
#include "src/ops/tiles.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// Work space of one slot.
struct Work {
  io::ColorLine color;
  FloatBuffer halves;
  FloatBuffer spectra;  // one block, for the long way
};

class RelightJob : public io::LineJob {
 public:
  RelightJob(io::RgbSource& source, const Relighter& relighter, const RelightImageOptions& options,
             const kernels::KernelTable& kernels)
      : source_(source),
        relighter_(relighter),
        options_(options),
        kernels_(kernels),
        stage_(source, relighter.upsampler(), options, kernels),
        color_names_(io::color_channels(options.target)) {}

  const io::ColorStage& stage() const noexcept { return stage_; }

  /// Output channels: the colour, then those that pass through; the source's own colour does not.
  std::vector<io::ChannelSpec> channels() {
    const exr_pixel_type_t type = options_.pixel == PixelType::kHalf ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    std::vector<io::ChannelSpec> out;
    for (const char* name : color_names_) out.push_back({name, type});
    const auto& planes = source_.planes();
    for (std::size_t i = 3; i < planes.size(); ++i) {
      const bool taken =
          std::any_of(out.begin(), out.end(), [&](const auto& c) { return c.name == planes[i].name; });
      if (taken) continue;
      passing_.emplace_back(out.size(), i);
      out.push_back({planes[i].name, io::passing_type(planes[i])});
    }
    return out;
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) {
    writer_ = &writer;
    for (std::size_t i = 0; i < slots; ++i) {
      Work work;
      auto color = io::ColorLine::create(source_.width());
      if (!color) return color.error();
      work.color = *std::move(color);
      auto halves = FloatBuffer::create(work.color.padded / 2);
      auto spectra = FloatBuffer::create(relighter_.projector().bands().count() * kLanesPerBlock);
      if (!halves) return halves.error();
      if (!spectra) return spectra.error();
      work.halves = *std::move(halves);
      work.spectra = *std::move(spectra);
      works_.push_back(std::move(work));
    }
    return {};
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    Work& work = works_[slot];
    const auto width = static_cast<std::size_t>(strip.width);
    work.color.set_width(width);
    stage_.line(strip, line, work.color, stats);
    if (packed == nullptr) return;
    float* const* rows = work.color.rows;
    const float* const rgb[3] = {rows[0], rows[1], rows[2]};
    if (options_.way == Way::kDirect) {
      rows::relight(kernels_, relighter_, rgb, rows, work.color.padded);
    } else {
      rows::relight_by_spectra(kernels_, relighter_, rgb, rows, work.spectra.data(), work.color.padded);
    }
    // Luminance is the second of XYZ.
    if (options_.target == ColorTarget::kLuminance) {
      std::memcpy(rows[0], rows[1], work.color.padded * sizeof(float));
    }
    const std::size_t colors = color_names_.size();
    if (options_.pixel == PixelType::kHalf) {
      stats.limited += io::limit_to_half(kernels_, work.color, colors, width);
    }
    for (std::size_t k = 0; k < colors; ++k) {
      io::store_row(kernels_, work.color, k, width, options_.pixel, work.halves,
                    packed + writer_->channel_offset(k, width));
    }
    for (const auto& [channel, plane] : passing_) {
      std::memcpy(packed + writer_->channel_offset(channel, width), strip.row(plane, line),
                  strip.row_bytes[plane]);
    }
  }

 private:
  io::RgbSource& source_;
  const Relighter& relighter_;
  const RelightImageOptions& options_;
  const kernels::KernelTable& kernels_;
  io::ColorStage stage_;
  const io::ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
  std::vector<std::pair<std::size_t, std::size_t>> passing_;  // output channel, source plane
  std::vector<const char*> color_names_;
};

Result<ImageReport> relight_file(const std::string& input, const std::string& output,
                                 const RelightImageOptions& options) {
  SPECTILE_TRY(io::check_distinct(input, output));
  const auto kernels = dispatch::active();
  if (!kernels) return kernels.error();
  const int threads = tiles::thread_count(options.threads);
  const auto upsampler = io::upsampler_for(options);
  if (!upsampler) return upsampler.error();
  const auto projector = Projector::reflective(options.bands, options.under.spectrum, options.seen_by);
  if (!projector) return projector.error();
  const Matrix3 matrix = io::color_matrix(*projector, options.target, options.adaptation);
  const auto relighter = Relighter::create(*upsampler, *projector, matrix);
  if (!relighter) return relighter.error();
  auto source = io::RgbSource::open(input, options.layer, threads, options.region);
  if (!source) return source.error();

  RelightJob job(**source, *relighter, options, **kernels);
  io::ImageSpec spec;
  spec.source = &(*source)->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  spec.tile = options.tile;
  spec.replaced = io::method_attribute_names();
  spec.replaced.insert(spec.replaced.end(), {"chromaticities", "colorInteropID", "spectileSeenUnder"});
  spec.text_attributes = io::method_attributes(*upsampler, options, false);
  spec.text_attributes.emplace_back("spectileSeenUnder", options.under.name);
  if (options.target == ColorTarget::kSrgb) {
    spec.text_attributes.emplace_back("colorInteropID", "lin_rec709_scene");
  }
  spec.text_attributes.emplace_back(io::kSettingsAttribute, settings_text(options));
  const std::size_t slots = io::slot_count(spec, (*source)->width(), threads);
  auto writer = io::ExrWriter::create(output, spec, slots);
  if (!writer) return writer.error();
  SPECTILE_TRY(job.prepare(**writer, slots));
  const int lines = io::strip_lines(*spec.source, (*source)->planes(), (*writer)->lines_per_chunk());
  const auto refusal = [&](const LineStats& found) { return job.stage().refusal(input, found); };
  auto converted = io::convert(job, **writer, slots, lines, options, refusal);
  if (!converted) return converted.error();
  ImageReport report = *std::move(converted);
  report.bands = options.bands.count();
  report.quantity = options.quantity;
  report.color_space = job.stage().space().description;
  report.notes = (*source)->notes();
  return report;
}

}  // namespace

Result<ImageReport> relight_image(const std::string& input, const std::string& output,
                                  const RelightImageOptions& options) {
  return io::timed(input, [&] { return relight_file(input, output, options); });
}

}  // namespace spectile
