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
#include "src/io/mip_levels.hpp"
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

class RelightJob : public io::FilteredJob {
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
    work.color.set_width(static_cast<std::size_t>(strip.width));
    stage_.line(strip, line, work.color, stats);
    if (packed == nullptr) return;
    relight(work);
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
    work.color.set_width(static_cast<std::size_t>(strip.width));
    stage_.line(strip, line, work.color, counted_before);
    relight(work);
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
  /// A line's colours under the light, in place of those of the texture.
  void relight(Work& work) const {
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
  spec.tile = io::tiles_of(options);
  spec.mipmap = options.mipmap;
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
  SPECTILE_TRY(job.prepare(**writer, slots + io::filter_slots(options)));
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
