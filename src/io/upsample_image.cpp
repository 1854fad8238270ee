// upsample_image: an RGB image becomes a spectral one, line by line.
#include <cstring>
#include <spectile/image.hpp>
#include <spectile/settings.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/band_channels.hpp"
#include "src/io/color_rows.hpp"
#include "src/io/color_stage.hpp"
#include "src/io/conversion.hpp"
#include "src/io/method_attributes.hpp"
#include "src/io/output.hpp"
#include "src/io/rgb_source.hpp"
#include "src/io/settings.hpp"
#include "src/ops/method_rows.hpp"
#include "src/ops/tiles.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// Work space of one slot.
struct Work {
  io::ColorLine rgb;
  io::ColorLine coefficients;  // of no rows where they are the RGB
  FloatBuffer scale;
  std::vector<std::uint64_t> unsolved;
  io::BandPacker::Work bands;
};

class UpsampleJob : public io::LineJob {
 public:
  UpsampleJob(io::RgbSource& source, const Upsampler& upsampler, const rows::SampledRows& rows,
              const UpsampleImageOptions& options, const kernels::KernelTable& kernels)
      : source_(source),
        upsampler_(upsampler),
        options_(options),
        kernels_(kernels),
        stage_(source, upsampler, options, kernels),
        packer_(kernels, rows, options) {}

  const io::ColorStage& stage() const noexcept { return stage_; }

  /// Output channels: the preview and those that pass through first, as the source's planes, then the bands.
  std::vector<io::ChannelSpec> channels() const {
    std::vector<io::ChannelSpec> out;
    for (const io::PlaneSpec& plane : source_.planes()) {
      out.push_back({plane.name, io::passing_type(plane)});
    }
    if (options_.store == Store::kCoefficients) {
      for (const std::string& name : io::coefficient_channels(upsampler_))
        out.push_back({name, EXR_PIXEL_FLOAT});
      return out;
    }
    io::add_band_channels(out, upsampler_.bands(), options_.quantity, options_.pixel);
    return out;
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) {
    writer_ = &writer;
    for (std::size_t i = 0; i < slots; ++i) {
      Work work;
      auto rgb = io::ColorLine::create(source_.width());
      if (!rgb) return rgb.error();
      work.rgb = *std::move(rgb);
      if (!rows::mixes_bases(upsampler_)) {
        auto coefficients = io::ColorLine::create(source_.width());
        if (!coefficients) return coefficients.error();
        work.coefficients = *std::move(coefficients);
        auto scale = FloatBuffer::create(work.rgb.padded);
        if (!scale) return scale.error();
        work.scale = *std::move(scale);
        work.unsolved.resize(work.rgb.padded / kLanesPerBlock);
      }
      auto bands = packer_.work();
      if (!bands) return bands.error();
      work.bands = *std::move(bands);
      works_.push_back(std::move(work));
    }
    return {};
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    Work& work = works_[slot];
    const auto width = static_cast<std::size_t>(source_.width());
    stage_.line(strip, line, work.rgb, stats);
    if (packed == nullptr) return;
    pass_through(strip, line, packed);
    const io::LineCoefficients line_of = solve(work);
    if (options_.store == Store::kCoefficients) {
      coefficients(line_of, width, packed);
      return;
    }
    stats.limited += packer_.line(work.bands, line_of, width, *writer_, source_.planes().size(), packed);
  }

 private:
  void pass_through(const Strip& strip, int line, std::byte* packed) const {
    const auto& planes = source_.planes();
    for (std::size_t i = 0; i < planes.size(); ++i) {
      std::memcpy(packed + writer_->channel_offset(i), strip.row(i, line),
                  static_cast<std::size_t>(source_.width()) * planes[i].sample_bytes());
    }
  }

  io::LineCoefficients solve(Work& work) const {
    float* const* rgb = work.rgb.rows;
    if (rows::mixes_bases(upsampler_)) return {{rgb[0], rgb[1], rgb[2]}, nullptr};
    float* const* c = work.coefficients.rows;
    const float* const in[3] = {rgb[0], rgb[1], rgb[2]};
    float* const scale = rows::has_scale(upsampler_) ? work.scale.data() : nullptr;
    rows::solve(kernels_, upsampler_, in, {{c[0], c[1], c[2]}, scale}, work.unsolved.data(), work.rgb.padded);
    return {{c[0], c[1], c[2]}, scale};
  }

  void coefficients(const io::LineCoefficients& of, std::size_t width, std::byte* packed) const {
    const std::size_t first = source_.planes().size();
    for (std::size_t k = 0; k < (of.scale == nullptr ? 3U : 4U); ++k) {
      const float* const row = k < 3 ? of.c[k] : of.scale;
      std::memcpy(packed + writer_->channel_offset(first + k), row, width * sizeof(float));
    }
  }

  io::RgbSource& source_;
  const Upsampler& upsampler_;
  const UpsampleImageOptions& options_;
  const kernels::KernelTable& kernels_;
  const io::ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
  io::ColorStage stage_;
  io::BandPacker packer_;
};

Result<ImageReport> upsample(const std::string& input, const std::string& output,
                             const UpsampleImageOptions& options) {
  SPECTILE_TRY(io::check_distinct(input, output));
  const auto kernels = dispatch::active();
  if (!kernels) return kernels.error();
  const int threads = tiles::thread_count(options.threads);
  const auto upsampler = io::upsampler_for(options);
  if (!upsampler) return upsampler.error();
  auto source = io::RgbSource::open(input, options.layer, threads, options.region);
  if (!source) return source.error();

  const auto rows = rows::SampledRows::over(*upsampler, upsampler->bands());
  if (!rows) return rows.error();
  UpsampleJob job(**source, *upsampler, *rows, options, **kernels);
  io::ImageSpec spec;
  spec.source = &(*source)->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  const bool coefficients = options.store == Store::kCoefficients;
  spec.replaced = io::method_attribute_names();
  for (const std::string& name : io::layout_attribute_names()) spec.replaced.push_back(name);
  spec.text_attributes = io::method_attributes(*upsampler, options, coefficients);
  if (!coefficients) io::add_layout_attributes(spec.text_attributes, options.quantity);
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

Result<ImageReport> upsample_image(const std::string& input, const std::string& output,
                                   const UpsampleImageOptions& options) {
  return io::timed(input, [&] { return upsample(input, output, options); });
}

}  // namespace spectile
