// project_image: a spectral image becomes sRGB, XYZ or luminance, line by line.
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

class ProjectJob : public io::LineJob {
 public:
  ProjectJob(io::SpectralSource& source, const Projector& projector, const ProjectImageOptions& options,
             const kernels::KernelTable& kernels)
      : source_(source), projector_(projector), options_(options), kernels_(kernels) {
    matrix_ = color::to_float(projector.xyz_to_srgb());
    color_names_ = names_of(options.target);
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
      const exr_pixel_type_t passing = plane.type == Imf::HALF    ? EXR_PIXEL_HALF
                                       : plane.type == Imf::FLOAT ? EXR_PIXEL_FLOAT
                                                                  : EXR_PIXEL_UINT;
      out.push_back({plane.name, passing});
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
    const auto width = static_cast<std::size_t>(source_.width());
    float* const* rows = work.color.rows;
    project_line(work, strip, line);
    io::settle_nonfinite(kernels_, rows, width, line, options_.nonfinite, stats);
    if (options_.target == ColorTarget::kSrgb) {
      const float* const xyz[3] = {rows[0], rows[1], rows[2]};
      kernels_.transform3(rows, xyz, matrix_.data(), work.color.padded);
    }
    io::settle_range(kernels_, rows, width, line, Negative::kKeep, stats);
    if (packed == nullptr) return;
    if (options_.pixel == PixelType::kHalf) stats.limited += limit_to_half(rows, width);
    for (std::size_t k = 0; k < color_names_.size(); ++k) store_row(work, rows[k], width, k, packed);
    for (const auto& [channel, plane] : passing_) {
      std::memcpy(packed + writer_->channel_offset(channel), strip.row(plane, line),
                  width * source_.planes()[plane].sample_bytes());
    }
  }

 private:
  static std::vector<const char*> names_of(ColorTarget target) {
    switch (target) {
      case ColorTarget::kXyz:
        return {"X", "Y", "Z"};
      case ColorTarget::kLuminance:
        return {"Y"};
      case ColorTarget::kSrgb:
        break;
    }
    return {"R", "G", "B"};
  }

  /// Blocks that are gathered and then projected together; they stay in the caches.
  std::size_t tile_blocks() const {
    const std::size_t line = blocks_for(static_cast<std::size_t>(source_.width()));
    return std::clamp<std::size_t>(options_.tile_lanes / kLanesPerBlock, 1, std::min<std::size_t>(line, 16));
  }

  void project_line(Work& work, const Strip& strip, int line) const {
    const std::size_t blocks = blocks_for(static_cast<std::size_t>(source_.width()));
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

  /// Limits what a half cannot hold, and counts its pixels.
  std::uint64_t limit_to_half(float* const rows[3], std::size_t width) const {
    std::uint64_t limited = 0;
    for (std::size_t x = 0; x < width; ++x) {
      bool beyond = false;
      for (std::size_t k = 0; k < color_names_.size(); ++k)
        beyond = beyond || std::fabs(rows[k][x]) > kernels::kHalfMax;
      limited += beyond ? 1 : 0;
    }
    if (limited > 0) {
      const std::size_t padded = blocks_for(width) * kLanesPerBlock;
      for (std::size_t k = 0; k < 3; ++k) {
        kernels_.clamp(rows[k], rows[k], -kernels::kHalfMax, kernels::kHalfMax, padded);
      }
    }
    return limited;
  }

  void store_row(Work& work, const float* row, std::size_t width, std::size_t channel,
                 std::byte* packed) const {
    std::byte* const out = packed + writer_->channel_offset(channel);
    if (options_.pixel == PixelType::kFloat) {
      std::memcpy(out, row, width * sizeof(float));
      return;
    }
    auto* const halves = reinterpret_cast<std::uint16_t*>(work.halves.data());
    kernels_.float_to_half(halves, row, work.color.padded);
    std::memcpy(out, halves, width * sizeof(std::uint16_t));
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
  const auto start = std::chrono::steady_clock::now();
  SPECTILE_TRY(io::check_distinct(input, output));
  const auto kernels = dispatch::active();
  if (!kernels) return kernels.error();
  const int threads = tiles::thread_count(options.threads);
  auto source = io::SpectralSource::open(input, options.quantity, threads);
  if (!source) return source.error();
  const auto projector = projector_for(**source, input, options);
  if (!projector) return projector.error();

  ProjectJob job(**source, *projector, options, **kernels);
  io::ImageSpec spec;
  spec.source = &(*source)->header();
  spec.channels = job.channels();
  spec.compression = options.compression;
  // The output is linear sRGB or CIE, whatever space the input's preview was in.
  spec.replaced = {"spectralLayoutVersion", "emissiveUnits", "spectileMethod", "chromaticities",
                   "colorInteropID"};
  if (options.target == ColorTarget::kSrgb) spec.text_attributes = {{"colorInteropID", "lin_rec709_scene"}};
  const std::size_t slots = io::slot_count(spec, (*source)->width(), threads);
  auto writer = io::ExrWriter::create(output, spec, slots);
  if (!writer) return writer.error();
  SPECTILE_TRY(job.prepare(**writer, spec.channels, slots));

  const auto forbidden = [&](const LineStats& stats) {
    return options.nonfinite == NonFinite::kStop && stats.nonfinite.count > 0;
  };
  const int lines = io::strip_lines(*spec.source, (*source)->planes(), (*writer)->lines_per_chunk());
  const auto stats = io::run_conversion(job, **writer, slots, lines, options, forbidden);
  if (!stats) return stats.error();
  if (forbidden(*stats)) {
    return io::stopped_at(input, ErrorCode::kNonFinite, "non-finite", stats->nonfinite,
                          "--nonfinite zero makes them black");
  }
  ImageReport report = io::report_of(**writer, *stats);
  report.bands = (*source)->bands().count();
  report.quantity = (*source)->quantity();
  report.notes = (*source)->notes();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace

Result<ImageReport> project_image(const std::string& input, const std::string& output,
                                  const ProjectImageOptions& options) {
  return io::contained<ImageReport>(input, [&] { return project_file(input, output, options); });
}

}  // namespace spectile
