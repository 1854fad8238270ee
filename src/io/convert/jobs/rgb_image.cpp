// read_rgb_image and write_rgb_image: RGB in memory, for what is not worth streaming.
#include <algorithm>
#include <cstring>
#include <spectile/image/image.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

Result<RgbImage> read(const std::string& path, const std::string& layer, int threads) {
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  SPECTILE_ASSIGN(auto source,
                  io::RgbSource::open(path, ChannelChoice{layer, {}, {}, {}}, tiles::thread_count(threads)));
  RgbImage image;
  image.width = source->width();
  image.height = source->height();
  const auto width = static_cast<std::size_t>(image.width);
  SPECTILE_ASSIGN(image.rgb, ColorLanes::create(width * static_cast<std::size_t>(image.height)));
  SPECTILE_ASSIGN(auto line_memory, io::ColorLine::create(image.width));
  const int step = io::strip_lines(source->header(), source->planes(), 1);
  for (int first = 0; first < image.height; first += step) {
    SPECTILE_ASSIGN(const auto strip, source->read(first, std::min(step, image.height - first)));
    for (int line = first; line < first + strip->lines; ++line) {
      source->float_rows(*kernels, *strip, line, line_memory.rows);
      for (std::size_t k = 0; k < 3; ++k) {
        std::memcpy(image.rgb.span().c[k] + static_cast<std::size_t>(line) * width, line_memory.rows[k],
                    width * sizeof(float));
      }
    }
  }
  return image;
}

/// Lines of an image in memory, handed to the encoders.
class RgbJob : public io::MemoryJob {
 public:
  RgbJob(ColorView rgb, int width, SampleType pixel, const kernels::KernelTable& kernels)
      : MemoryJob(2 * padded(static_cast<std::size_t>(width))),
        rgb_(rgb),
        width_(static_cast<std::size_t>(width)),
        pixel_(pixel),
        kernels_(kernels) {}

  void line(std::size_t slot, const io::Strip& /*strip*/, int line, std::byte* packed,
            io::LineStats& /*stats*/) override {
    if (packed == nullptr) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const in = rgb_.c[k] + static_cast<std::size_t>(line) * width_;
      std::memcpy(row(slot), in, width_ * sizeof(float));
      io::store_row(kernels_, row(slot), width_, pixel_, row(slot) + padded(width_),
                    packed + writer().channel_offset(k));
    }
  }

 private:
  static std::size_t padded(std::size_t width) { return blocks_for(width) * kLanesPerBlock; }
  ColorView rgb_;
  std::size_t width_;
  SampleType pixel_;
  const kernels::KernelTable& kernels_;
};

Result<void> write(const std::string& path, const ColorView& rgb, int width, int height,
                   const ImageOptions& options) {
  if (width <= 0 || height <= 0 ||
      rgb.lanes != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    return make_error(ErrorCode::kSizeMismatch, "{} lanes are not an image of {} x {}", rgb.lanes, width,
                      height);
  }
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const PixelWindow window = {0, 0, width, height};
  const io::PartHeader header(window, window);
  RgbJob job(rgb, width, options.pixel, *kernels);
  io::ImageSpec spec;
  spec.source = &header;
  spec.channels = {{"R", options.pixel}, {"G", options.pixel}, {"B", options.pixel}};
  SPECTILE_TRY(io::run_image_job({job, path, std::move(spec), options, {}, {}}));
  return {};
}

}  // namespace

Result<RgbImage> read_rgb_image(const std::string& path, const std::string& layer, int threads) {
  return io::contained<RgbImage>(path, [&] { return read(path, layer, threads); });
}

Result<void> write_rgb_image(const std::string& path, ColorView rgb, int width, int height,
                             const ImageOptions& options) {
  return io::contained<void>(path, [&] { return write(path, rgb, width, height, options); });
}

}  // namespace spectile
