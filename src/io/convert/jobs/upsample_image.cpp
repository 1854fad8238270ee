// upsample_image: an RGB image becomes a spectral one, line by line.
#include <chrono>
#include <cstring>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/conversion.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/sources/pixel_mask.hpp"
#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/band_filter.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/io/convert/stages/color_stage.hpp"
#include "src/io/convert/stages/line_solver.hpp"
#include "src/io/convert/stages/straight_color.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

using Clock = std::chrono::steady_clock;

/// UpsampleWork space of one slot.
struct UpsampleWork {
  io::ColorLine rgb;
  std::vector<std::uint8_t> masked;
  io::LineSolver::Work solving;
  io::BandPacker::Work bands;
  io::BandFilter::Work filtered;
};

class UpsampleJob : public io::FilteredJob {
 public:
  UpsampleJob(io::RgbSource& source, io::PixelMask& mask, const Upsampler& upsampler,
              const rows::SampledRows& rows, const UpsampleImageOptions& options,
              const kernels::KernelTable& kernels)
      : source_(source),
        mask_(mask),
        upsampler_(upsampler),
        options_(options),
        stage_(source, upsampler, options, kernels),
        straight_(source, upsampler, options, kernels),
        solver_(stage_, upsampler, kernels, options.skip, pixels_of(source), straight_.needed()),
        packer_(kernels, rows, options),
        filter_(kernels, upsampler, rows, packer_, options, options.store == Store::kCoefficients) {}

  const io::ColorStage& stage() const noexcept { return stage_; }

  /// Output channels: the preview and those that pass through first, as the source's planes, then the bands.
  std::vector<io::ChannelSpec> channels() const {
    std::vector<io::ChannelSpec> out;
    for (const io::PlaneSpec& plane : source_.planes()) {
      out.push_back({plane.name, plane.type});
    }
    if (options_.store == Store::kCoefficients) {
      for (const std::string& name : io::coefficient_channels(upsampler_, straight_.needed()))
        out.push_back({name, SampleType::kFloat});
      return out;
    }
    io::add_band_channels(out, upsampler_.bands(), options_.quantity, options_.pixel);
    return out;
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) override {
    writer_ = &writer;
    for (std::size_t i = 0; i < slots; ++i) {
      UpsampleWork work;
      SPECTILE_ASSIGN(work.rgb, io::ColorLine::create(writer.width()));
      work.masked.resize(static_cast<std::size_t>(writer.width()));
      SPECTILE_ASSIGN(work.solving, solver_.work(writer.width()));
      SPECTILE_ASSIGN(work.bands, packer_.work());
      SPECTILE_ASSIGN(work.filtered, filter_.work(writer.width()));
      works_.push_back(std::move(work));
    }
    return {};
  }

  int strip_lines(int chunk_lines) const override { return source_.strip_lines(chunk_lines); }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    SPECTILE_ASSIGN(auto strip, source_.read(first_line, lines));
    SPECTILE_ASSIGN(const auto colored, mask_.apply(*strip));
    // Mip levels read the lines again.
    if (first_line >= counted_lines_) {
      masked_colored_ += colored;
      counted_lines_ = first_line + lines;
    }
    return strip;
  }

  bool repeats() const override { return true; }

  /// Masked pixels that were not black.
  std::uint64_t masked_colored() const noexcept { return masked_colored_; }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    UpsampleWork& work = works_[slot];
    const auto width = static_cast<std::size_t>(strip.width);
    const io::ColorStage::Sanitized sanitized = sanitize(work, strip, line, stats);
    if (packed == nullptr) {
      if (sanitized.may_be_outside) stage_.clip_to_gamut(line, work.rgb, width, stats);
      return;
    }
    pass_through(strip, line, packed);
    const io::LineCoefficients of =
        solver_.line(work.solving, work.rgb, width, line, sanitized.may_be_outside, stats);
    if (options_.mipmap) filter_.scan(of, width);
    if (options_.store == Store::kCoefficients) {
      coefficients(of, width, packed);
    } else {
      spectra(work, of, width, packed, stats);
    }
  }

  std::vector<io::PlaneSpec> strip_planes() const override {
    std::vector<io::PlaneSpec> out = source_.planes();
    if (mask_.adds_plane()) out.push_back({"", SampleType::kFloat});
    return out;
  }

  std::vector<std::pair<std::size_t, io::PlaneSpec>> passing() const override {
    std::vector<std::pair<std::size_t, io::PlaneSpec>> out;
    for (const io::PlaneSpec& plane : source_.planes()) out.emplace_back(out.size(), plane);
    return out;
  }

  std::size_t filtered_rows() const override { return filter_.rows(); }

  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) override {
    UpsampleWork& work = works_[slot];
    LineStats counted_before;
    const io::ColorStage::Sanitized sanitized = sanitize(work, strip, line, counted_before);
    const auto width = static_cast<std::size_t>(strip.width);
    filter_.filter(
        solver_.line(work.solving, work.rgb, width, line, sanitized.may_be_outside, counted_before), width,
        rows);
  }

  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) override {
    UpsampleWork& work = works_[slot];
    pass_through(strip, line, packed);
    const std::size_t first = source_.planes().size();
    if (options_.store == Store::kCoefficients) {
      coefficients(io::coefficients_in(strip, line, first), static_cast<std::size_t>(strip.width), packed);
    } else {
      filter_.pack(work.filtered, work.bands, {strip, line, first}, *writer_, first, packed);
    }
  }

 private:
  /// A line's RGB as the method takes it, straight where it has to be.
  io::ColorStage::Sanitized sanitize(UpsampleWork& work, const Strip& strip, int line,
                                     LineStats& stats) const {
    const auto width = static_cast<std::size_t>(strip.width);
    work.rgb.set_width(width);
    stage_.load(strip, line, work.rgb);
    stats.masked += mask_.line(strip, line, work.masked.data());
    const io::ColorStage::Sanitized out = stage_.sanitize(line, work.rgb, width, stats);
    if (straight_.needed()) {
      straight_.divide(strip, line, work.rgb.rows, work.solving.scale.data(), stats);
    }
    return out;
  }

  static std::uint64_t pixels_of(const io::RgbSource& source) {
    return static_cast<std::uint64_t>(source.width()) * static_cast<std::uint64_t>(source.height());
  }

  void spectra(UpsampleWork& work, const io::LineCoefficients& of, std::size_t width, std::byte* packed,
               LineStats& stats) const {
    const std::size_t first = source_.planes().size();
    auto start = Clock::now();
    for (const io::ColorRun& run : work.solving.runs) {
      const bool computed = run.kind == io::ColorRun::Kind::kComputed;
      if (computed) {
        packer_.run(work.bands, of, {run.first, run.pixels, width}, *writer_, first, packed);
      } else {
        packer_.fill(work.bands, of, {run.first, run.pixels, width}, *writer_, first, packed);
      }
      const auto end = Clock::now();
      const double took = std::chrono::duration<double>(end - start).count();
      start = end;
      (computed ? stats.costs.computed_pixels : stats.costs.filled_pixels) += run.pixels;
      (computed ? stats.costs.computing_seconds : stats.costs.filling_seconds) += took;
    }
    stats.clamped += packer_.clamped(work.bands, of, width);
  }

  void pass_through(const Strip& strip, int line, std::byte* packed) const {
    const auto width = static_cast<std::size_t>(strip.width);
    for (std::size_t i = 0; i < source_.planes().size(); ++i) {
      std::memcpy(packed + writer_->channel_offset(i, width), strip.row(i, line), strip.row_bytes[i]);
    }
  }

  void coefficients(const io::LineCoefficients& of, std::size_t width, std::byte* packed) const {
    const std::size_t first = source_.planes().size();
    for (std::size_t k = 0; k < (of.scale == nullptr ? 3U : 4U); ++k) {
      const float* const row = k < 3 ? of.c[k] : of.scale;
      std::memcpy(packed + writer_->channel_offset(first + k, width), row, width * sizeof(float));
    }
  }

  io::RgbSource& source_;
  io::PixelMask& mask_;
  const Upsampler& upsampler_;
  const UpsampleImageOptions& options_;
  const io::ExrWriter* writer_ = nullptr;
  std::vector<UpsampleWork> works_;
  std::uint64_t masked_colored_ = 0;
  int counted_lines_ = 0;
  io::ColorStage stage_;
  io::StraightColor straight_;
  io::LineSolver solver_;
  io::BandPacker packer_;
  io::BandFilter filter_;
};

Result<ImageReport> upsample(const std::string& input, const std::string& output,
                             const UpsampleImageOptions& options) {
  std::vector<std::string> inputs = {input};
  if (options.masking == Masking::kFile) inputs.push_back(options.mask);
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(inputs, output, options));
  SPECTILE_ASSIGN(const auto upsampler, io::upsampler_for(options));
  if (options.mipmap && options.store == Store::kCoefficients && !io::linear_in_coefficients(upsampler)) {
    return make_error(
        ErrorCode::kBadArgument,
        "coefficients of {} have no mip levels: the spectrum of their average is not the average of "
        "the spectra, as it is for {}; store spectra instead",
        to_string(options.method), to_string(Method::kMallett));
  }
  SPECTILE_ASSIGN(auto source, io::RgbSource::open(input, options.channels, setup.threads, options.region,
                                                   options.input_space));

  SPECTILE_ASSIGN(auto mask, io::PixelMask::open(options, *source, setup.threads));
  SPECTILE_ASSIGN(const auto rows, rows::SampledRows::over(upsampler, upsampler.bands()));
  UpsampleJob job(*source, mask, upsampler, rows, options, setup.kernels);
  const bool coefficients = options.store == Store::kCoefficients;
  auto texts = io::method_attributes(upsampler, options, coefficients);
  if (source->alpha()) io::add_alpha_attribute(texts, options.alpha_meaning());
  if (!coefficients) io::add_layout_attributes(texts, options.quantity, options.bands);
  io::ImageSpec spec = io::conversion_spec(source->header(), job.channels(), std::move(texts), options,
                                           settings_text(options));
  spec.replaced = io::spectral_attribute_names();
  spec.view = source->view();
  ImageReport known;
  known.bands = options.bands.count();
  known.quantity = options.quantity;
  known.color_space = job.stage().space().description;
  known.notes = source->notes();
  io::note_nodes(upsampler, known.notes);
  if (const std::string chosen = mask.chosen(); !chosen.empty())
    known.notes.push_back(fmt::format("{} is taken for the mask", chosen));
  const auto note_alpha = [&options](const io::LineStats& found, std::vector<std::string>& notes) {
    io::note_alpha(found, !options.alpha, notes);
  };
  const auto refusal = [&](const LineStats& found) { return job.stage().refusal(input, found); };
  SPECTILE_ASSIGN(auto report, io::run_image_job({job, output, std::move(spec), options, refusal,
                                                  std::move(known), note_alpha}));
  if (options.masking == Masking::kAlpha && !source->alpha()) {
    report.notes.emplace_back("there is no alpha, so that --mask alpha masks nothing");
  }
  if (options.masking == Masking::kAlpha && job.masked_colored() > 0) {
    report.notes.push_back(fmt::format(
        "{} pixel{} of alpha 0 with a colour: they become black; without --mask alpha they keep it",
        job.masked_colored(), job.masked_colored() == 1 ? "" : "s"));
  }
  return report;
}

}  // namespace

Result<ImageReport> upsample_image(const std::string& input, const std::string& output,
                                   const UpsampleImageOptions& options) {
  return io::timed(input, [&] { return upsample(input, output, options); });
}

}  // namespace spectile
