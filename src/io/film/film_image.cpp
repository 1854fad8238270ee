// write_developed, write_scene: a layer of a film, or the exact values of a scene, as an image.
#include <cmath>
#include <spectile/image/film_file.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

/// Planes of one picture.
struct Picture {
  const float* data = nullptr;
  std::size_t planes = 0;
  std::size_t width = 0;
  std::size_t plane_floats = 0;
};

/// Lines of a picture, floats or halves.
class PictureJob : public io::MemoryJob {
 public:
  PictureJob(const Picture& picture, SampleType pixel, const kernels::KernelTable& kernels)
      : MemoryJob(2 * blocks_for(picture.width) * kLanesPerBlock),
        picture_(picture),
        pixel_(pixel),
        kernels_(kernels) {}

  void line(std::size_t slot, const io::Strip& /*strip*/, int line, std::byte* packed,
            io::LineStats& stats) override {
    const std::size_t width = picture_.width;
    const bool half = pixel_ != SampleType::kFloat;
    float* const work = row(slot);
    for (std::size_t p = 0; p < picture_.planes; ++p) {
      const float* const from =
          picture_.data + p * picture_.plane_floats + static_cast<std::size_t>(line) * width;
      for (std::size_t x = 0; half && x < width; ++x) {
        // Beyond the largest half: written as that, and counted. Infinite variance stays what it is.
        const bool beyond = std::abs(from[x]) > kernels::kHalfMax && std::abs(from[x]) < INFINITY;
        work[x] = beyond ? std::copysign(kernels::kHalfMax, from[x]) : from[x];
        stats.clamped += beyond ? 1 : 0;
      }
      if (packed == nullptr) continue;
      io::store_row(kernels_, half ? work : from, width, pixel_, work + blocks_for(width) * kLanesPerBlock,
                    packed + writer().channel_offset(p));
    }
  }

 private:
  Picture picture_;
  SampleType pixel_;
  const kernels::KernelTable& kernels_;
};

std::vector<io::ChannelSpec> channels_of(const Film& film, FilmLayer layer, SampleType pixel) {
  std::vector<io::ChannelSpec> out;
  const auto named = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) out.push_back({name, pixel});
    return out;
  };
  switch (layer) {
    case FilmLayer::kXyz:
      return named({"X", "Y", "Z"});
    case FilmLayer::kSrgb:
    case FilmLayer::kSensor:
      return named({"R", "G", "B"});
    case FilmLayer::kLuminance:
      return named({"Y"});
    case FilmLayer::kWeight:
      return named({"weight"});
    case FilmLayer::kCount:
      return named({"count"});
    case FilmLayer::kVariance:
      return named({"variance"});
    case FilmLayer::kSpectrum:
      break;
  }
  io::add_band_channels(out, film.options().bands, Quantity::kIlluminant, pixel);
  return out;
}

Result<ImageReport> write(const Picture& picture, const FilmOptions& film,
                          const std::vector<io::ChannelSpec>& channels, const io::TextAttributes& texts,
                          const std::string& path, const ImageOptions& options) {
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const PixelWindow w = film.crop.value_or(PixelWindow{0, 0, film.width, film.height});
  const io::PartHeader header({0, 0, film.width, film.height}, w);
  PictureJob job(picture, options.pixel, *kernels);
  io::ImageSpec spec;
  spec.source = &header;
  spec.channels = channels;
  spec.text_attributes = texts;
  return io::run_image_job({job, path, std::move(spec), options, {}, {}});
}

Result<ImageReport> write_layer(const Film& film, FilmLayer layer, std::size_t sensor,
                                const std::string& path, const ImageOptions& options) {
  SPECTILE_ASSIGN(auto development, FilmDevelopment::create(film, layer, sensor));
  SPECTILE_TRY(development.update({options.threads}));
  io::TextAttributes texts;
  if (layer == FilmLayer::kSrgb) io::add_color_tag(texts, ColorTarget::kSrgb);
  if (layer == FilmLayer::kXyz) io::add_color_tag(texts, ColorTarget::kXyz);
  if (layer == FilmLayer::kSensor) texts = {{"spectileSensor", film.options().sensors[sensor].name}};
  if (layer == FilmLayer::kSpectrum) {
    io::add_layout_attributes(texts, Quantity::kIlluminant, film.options().bands);
  }
  const Picture picture = {development.plane(0), development.planes(), development.stride(),
                           development.stride() * static_cast<std::size_t>(development.height())};
  auto report = write(picture, film.options(), channels_of(film, layer, options.pixel), texts, path, options);
  if (report && layer == FilmLayer::kSpectrum) report->bands = film.options().bands.count();
  return report;
}

Result<ImageReport> write_exact(const ProceduralScene& scene, const FilmOptions& film,
                                const std::string& path, const ImageOptions& options) {
  const PixelWindow w = film.crop.value_or(PixelWindow{0, 0, film.width, film.height});
  const auto width = static_cast<std::size_t>(w.width());
  const std::size_t plane = width * static_cast<std::size_t>(w.height());
  SPECTILE_ASSIGN(auto pixels, FloatBuffer::create(3 * plane));
  tiles::for_blocks(
      static_cast<std::size_t>(w.height()), {options.threads, 1}, [&](std::size_t first, std::size_t n) {
        for (std::size_t i = first * width; i < (first + n) * width; ++i) {
          const auto xyz =
              scene.xyz(film, w.x0 + static_cast<int>(i % width), w.y0 + static_cast<int>(i / width));
          for (std::size_t c = 0; c < 3; ++c) {
            pixels.data()[c * plane + i] = static_cast<float>(xyz[c]);
          }
        }
      });
  const SampleType type = options.pixel;
  io::TextAttributes texts;
  io::add_color_tag(texts, ColorTarget::kXyz);
  return write({pixels.data(), 3, width, plane}, film, {{"X", type}, {"Y", type}, {"Z", type}}, texts, path,
               options);
}

}  // namespace

Result<ImageReport> write_developed(const Film& film, FilmLayer layer, std::size_t sensor,
                                    const std::string& path, const ImageOptions& options) {
  return io::timed(path, [&] { return write_layer(film, layer, sensor, path, options); });
}

Result<ImageReport> write_scene(const ProceduralScene& scene, const FilmOptions& film,
                                const std::string& path, const ImageOptions& options) {
  return io::timed(path, [&] { return write_exact(scene, film, path, options); });
}

}  // namespace spectile
