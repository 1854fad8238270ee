// upsample_image: an RGB image becomes a spectral one, line by line.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <spectile/image.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/conversion.hpp"
#include "src/io/lines.hpp"
#include "src/io/output.hpp"
#include "src/io/rgb_source.hpp"
#include "src/io/spectral_layout.hpp"
#include "src/ops/color_matrix.hpp"
#include "src/ops/tiles.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// Work space of one slot.
struct Work {
  io::ColorLine rgb;
  std::vector<void*> rows;  // where each band of the present segment goes
  FloatBuffer block;        // spectra of 64 pixels, to count those that a half cannot hold
};

class UpsampleJob : public io::LineJob {
 public:
  UpsampleJob(io::RgbSource& source, const Upsampler& upsampler, const UpsampleImageOptions& options,
              const kernels::KernelTable& kernels)
      : source_(source), upsampler_(upsampler), options_(options), kernels_(kernels) {
    convert_ = !io::is_srgb(source.color_space());
    matrix_ = color::to_float(io::to_srgb(source.color_space(), options.quantity));
    for (const auto& band : upsampler.basis()) {
      for (const double v : band) largest_basis_ = std::max(largest_basis_, std::abs(static_cast<float>(v)));
    }
    segment_ = std::max<std::size_t>(kLanesPerBlock, options.tile_lanes / kLanesPerBlock * kLanesPerBlock);
  }

  /// Output channels: the preview and those that pass through first, as the source's planes, then the bands.
  std::vector<io::ChannelSpec> channels() const {
    std::vector<io::ChannelSpec> out;
    for (const io::PlaneSpec& plane : source_.planes()) {
      const exr_pixel_type_t type = plane.type == Imf::HALF    ? EXR_PIXEL_HALF
                                    : plane.type == Imf::FLOAT ? EXR_PIXEL_FLOAT
                                                               : EXR_PIXEL_UINT;
      out.push_back({plane.name, type});
    }
    const auto kind = options_.quantity == Quantity::kReflectance ? io::SpectralKind::kReflective
                                                                  : io::SpectralKind::kEmissive;
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
    float* const* rows = work.rgb.rows;
    const float* const rgb[3] = {rows[0], rows[1], rows[2]};
    source_.float_rows(kernels_, strip, line, rows);
    // What is not finite stays so in at least one component.
    if (convert_) kernels_.transform3(rows, rgb, matrix_.data(), work.rgb.padded);
    io::settle_nonfinite(kernels_, rows, width, line, options_.nonfinite, stats);
    const float largest = io::settle_range(kernels_, rows, width, line, options_.negative, stats);
    if (packed == nullptr) return;
    pass_through(strip, line, packed);
    bands(work, rgb, width, packed);
    if (options_.pixel == PixelType::kHalf && 3 * largest * largest_basis_ > kernels::kHalfMax) {
      stats.limited += count_limited(work, rgb, width);
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

  void bands(Work& work, const float* const rgb[3], std::size_t width, std::byte* packed) const {
    const std::size_t count = upsampler_.bands().count();
    const std::size_t first = source_.planes().size();
    const bool half = options_.pixel == PixelType::kHalf;
    const std::size_t sample_bytes = half ? 2 : 4;
    for (std::size_t at = 0; at < width; at += segment_) {
      for (std::size_t b = 0; b < count; ++b) {
        work.rows[b] = packed + writer_->channel_offset(first + b) + at * sample_bytes;
      }
      const float* const segment[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
      const auto kernel = half ? kernels_.smits_rows_half : kernels_.smits_rows_float;
      const float lowest = half ? std::max(upsampler_.lowest(), -kernels::kHalfMax) : upsampler_.lowest();
      kernel(work.rows.data(), segment, upsampler_.table(), lowest, count, std::min(segment_, width - at));
    }
  }

  std::uint64_t count_limited(Work& work, const float* const rgb[3], std::size_t width) const {
    const std::size_t count = upsampler_.bands().count();
    float* const greatest = work.block.data() + count * kLanesPerBlock;
    float* const least = greatest + kLanesPerBlock;
    std::uint64_t limited = 0;
    for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
      const float* const segment[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
      kernels_.smits_blocks(work.block.data(), segment, upsampler_.table(), upsampler_.lowest(), count, 1,
                            false);
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
  std::array<float, 9> matrix_{};
  bool convert_ = false;
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
  const auto negative =
      options.negative == Negative::kKeep ? NegativeSamples::kKeep : NegativeSamples::kClampToZero;
  const auto upsampler = Upsampler::create(options.method, options.quantity, options.bands, negative);
  if (!upsampler) return upsampler.error();
  auto source = io::RgbSource::open(input, options.layer, threads);
  if (!source) return source.error();

  UpsampleJob job(**source, *upsampler, options, **kernels);
  io::ImageSpec spec;
  spec.source = &(*source)->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  spec.text_attributes = {{"spectralLayoutVersion", "1.0"}};
  spec.replaced = {"spectralLayoutVersion", "emissiveUnits", "spectileMethod"};
  if (options.quantity == Quantity::kIlluminant) {
    spec.text_attributes.emplace_back("emissiveUnits", "W.m^-2.sr^-1");
  }
  spec.text_attributes.emplace_back("spectileMethod", std::string(to_string(options.method)));
  const std::size_t slots = io::slot_count(spec, (*source)->width(), threads);
  auto writer = io::ExrWriter::create(output, spec, slots);
  if (!writer) return writer.error();
  SPECTILE_TRY(job.prepare(**writer, slots));

  const auto forbidden = [&](const LineStats& stats) {
    return (options.nonfinite == NonFinite::kStop && stats.nonfinite.count > 0) ||
           (options.negative == Negative::kStop && stats.negative.count > 0);
  };
  const int lines = io::strip_lines(*spec.source, (*source)->planes(), (*writer)->lines_per_chunk());
  const auto stats = io::run_conversion(job, **writer, slots, lines, options, forbidden);
  if (!stats) return stats.error();
  if (options.nonfinite == NonFinite::kStop && stats->nonfinite.count > 0) {
    return io::stopped_at(input, ErrorCode::kNonFinite, "non-finite", stats->nonfinite,
                          "--nonfinite zero makes them black");
  }
  if (options.negative == Negative::kStop && stats->negative.count > 0) {
    return io::stopped_at(input, ErrorCode::kBadFile, "negative", stats->negative,
                          "--negative clip or keep converts them");
  }
  ImageReport report = io::report_of(**writer, *stats);
  report.bands = options.bands.count();
  report.quantity = options.quantity;
  report.color_space = (*source)->color_space().description;
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
