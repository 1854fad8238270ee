// upsample_image: an RGB image becomes a spectral one, line by line.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <spectile/image.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/color_rows.hpp"
#include "src/io/color_stage.hpp"
#include "src/io/conversion.hpp"
#include "src/io/method_attributes.hpp"
#include "src/io/output.hpp"
#include "src/io/rgb_source.hpp"
#include "src/io/spectral_layout.hpp"
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
  std::vector<void*> rows;  // where each band of the present segment goes
  FloatBuffer block;        // spectra of 64 pixels, to count those that a half cannot hold
};

/// A line's coefficients, wherever they are kept.
struct LineCoefficients {
  const float* c[3];
  const float* scale;
};

class UpsampleJob : public io::LineJob {
 public:
  UpsampleJob(io::RgbSource& source, const Upsampler& upsampler, const UpsampleImageOptions& options,
              const kernels::KernelTable& kernels)
      : source_(source),
        upsampler_(upsampler),
        options_(options),
        kernels_(kernels),
        stage_(source, upsampler, options, kernels) {
    largest_basis_ = rows::largest_sample(upsampler);
    segment_ = std::max<std::size_t>(kLanesPerBlock, options.tile_lanes / kLanesPerBlock * kLanesPerBlock);
  }

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
    const auto kind = options_.quantity == Quantity::kIlluminant ? io::SpectralKind::kEmissive
                                                                 : io::SpectralKind::kReflective;
    const exr_pixel_type_t type = options_.pixel == PixelType::kHalf ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    for (const Band& band : upsampler_.bands().list()) {
      out.push_back({io::spectral_channel_name(kind, band.centre_nm), type});
    }
    return out;
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) {
    writer_ = &writer;
    const std::size_t bands = upsampler_.bands().count();
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
      work.rows.resize(bands);
      auto block = FloatBuffer::create((bands + 2) * kLanesPerBlock);
      if (!block) return block.error();
      work.block = *std::move(block);
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
    const float largest = stage_.line(strip, line, work.rgb, stats);
    if (packed == nullptr) return;
    pass_through(strip, line, packed);
    const LineCoefficients line_of = solve(work);
    if (options_.store == Store::kCoefficients) {
      coefficients(line_of, width, packed);
      return;
    }
    bands(work, line_of, width, packed);
    if (options_.pixel == PixelType::kHalf && 3 * largest * largest_basis_ > kernels::kHalfMax) {
      stats.limited += count_limited(work, line_of, width);
    }
  }

 private:
  void pass_through(const Strip& strip, int line, std::byte* packed) const {
    const auto& planes = source_.planes();
    for (std::size_t i = 0; i < planes.size(); ++i) {
      std::memcpy(packed + writer_->channel_offset(i), strip.row(i, line),
                  static_cast<std::size_t>(source_.width()) * planes[i].sample_bytes());
    }
  }

  LineCoefficients solve(Work& work) const {
    float* const* rgb = work.rgb.rows;
    if (rows::mixes_bases(upsampler_)) return {{rgb[0], rgb[1], rgb[2]}, nullptr};
    float* const* c = work.coefficients.rows;
    const float* const in[3] = {rgb[0], rgb[1], rgb[2]};
    float* const scale = rows::has_scale(upsampler_) ? work.scale.data() : nullptr;
    rows::solve(kernels_, upsampler_, in, {{c[0], c[1], c[2]}, scale}, work.unsolved.data(), work.rgb.padded);
    return {{c[0], c[1], c[2]}, scale};
  }

  void coefficients(const LineCoefficients& of, std::size_t width, std::byte* packed) const {
    const std::size_t first = source_.planes().size();
    for (std::size_t k = 0; k < (of.scale == nullptr ? 3U : 4U); ++k) {
      const float* const row = k < 3 ? of.c[k] : of.scale;
      std::memcpy(packed + writer_->channel_offset(first + k), row, width * sizeof(float));
    }
  }

  void bands(Work& work, const LineCoefficients& of, std::size_t width, std::byte* packed) const {
    const std::size_t count = upsampler_.bands().count();
    const std::size_t first = source_.planes().size();
    const bool half = options_.pixel == PixelType::kHalf;
    const std::size_t sample_bytes = half ? 2 : 4;
    for (std::size_t at = 0; at < width; at += segment_) {
      for (std::size_t b = 0; b < count; ++b) {
        work.rows[b] = packed + writer_->channel_offset(first + b) + at * sample_bytes;
      }
      const float* const segment[3] = {of.c[0] + at, of.c[1] + at, of.c[2] + at};
      rows::expand_rows(kernels_, upsampler_, segment, of.scale == nullptr ? nullptr : of.scale + at,
                        work.rows.data(), half, std::min(segment_, width - at));
    }
  }

  std::uint64_t count_limited(Work& work, const LineCoefficients& of, std::size_t width) const {
    const std::size_t count = upsampler_.bands().count();
    float* const greatest = work.block.data() + count * kLanesPerBlock;
    float* const least = greatest + kLanesPerBlock;
    std::uint64_t limited = 0;
    for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
      const float* const segment[3] = {of.c[0] + at, of.c[1] + at, of.c[2] + at};
      rows::expand_blocks(kernels_, upsampler_, segment, of.scale == nullptr ? nullptr : of.scale + at,
                          work.block.data(), 1, false);
      kernels_.maximum(greatest, work.block.data(), count, 1);
      kernels_.minimum(least, work.block.data(), count, 1);
      for (std::size_t i = 0; i < std::min(kLanesPerBlock, width - at); ++i) {
        limited += greatest[i] > kernels::kHalfMax || least[i] < -kernels::kHalfMax ? 1 : 0;
      }
    }
    return limited;
  }

  io::RgbSource& source_;
  const Upsampler& upsampler_;
  const UpsampleImageOptions& options_;
  const kernels::KernelTable& kernels_;
  const io::ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
  io::ColorStage stage_;
  float largest_basis_ = 0;
  std::size_t segment_ = 0;
};

Result<ImageReport> upsample(const std::string& input, const std::string& output,
                             const UpsampleImageOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  SPECTILE_TRY(io::check_distinct(input, output));
  const auto kernels = dispatch::active();
  if (!kernels) return kernels.error();
  const int threads = tiles::thread_count(options.threads);
  const auto upsampler = io::upsampler_for(options);
  if (!upsampler) return upsampler.error();
  auto source = io::RgbSource::open(input, options.layer, threads);
  if (!source) return source.error();

  UpsampleJob job(**source, *upsampler, options, **kernels);
  io::ImageSpec spec;
  spec.source = &(*source)->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  const bool coefficients = options.store == Store::kCoefficients;
  spec.replaced = io::method_attribute_names();
  spec.replaced.insert(spec.replaced.end(), {"spectralLayoutVersion", "emissiveUnits"});
  spec.text_attributes = io::method_attributes(*upsampler, options, coefficients);
  if (!coefficients) {
    spec.text_attributes.emplace_back("spectralLayoutVersion", "1.0");
    if (options.quantity == Quantity::kIlluminant) {
      spec.text_attributes.emplace_back("emissiveUnits", "W.m^-2.sr^-1");
    }
  }
  const std::size_t slots = io::slot_count(spec, (*source)->width(), threads);
  auto writer = io::ExrWriter::create(output, spec, slots);
  if (!writer) return writer.error();
  SPECTILE_TRY(job.prepare(**writer, slots));

  const auto forbidden = [&](const LineStats& stats) { return job.stage().forbidden(stats); };
  const int lines = io::strip_lines(*spec.source, (*source)->planes(), (*writer)->lines_per_chunk());
  const auto stats = io::run_conversion(job, **writer, slots, lines, options, forbidden);
  if (!stats) return stats.error();
  if (forbidden(*stats)) return job.stage().refusal(input, *stats);
  ImageReport report = io::report_of(**writer, *stats);
  report.bands = options.bands.count();
  report.quantity = options.quantity;
  report.color_space = job.stage().space().description;
  report.notes = (*source)->notes();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace

Result<ImageReport> upsample_image(const std::string& input, const std::string& output,
                                   const UpsampleImageOptions& options) {
  return io::contained<ImageReport>(input, [&] { return upsample(input, output, options); });
}

}  // namespace spectile
