// Writes the images of the fuzz corpus: small files of every kind that the readers know.
// usage: spectile_fuzz_corpus CORPUS_FOLDER
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfMultiView.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <spectile/image/film_file.hpp>
#include <string>
#include <vector>

#include "fuzz/support.hpp"

namespace {

using namespace spectile;
using fuzz::require;

constexpr int kWidth = 9;
constexpr int kHeight = 6;

/// Samples of channels in floats, which OpenEXR turns into what a header asks for.
class Picture {
 public:
  explicit Picture(const std::vector<std::string>& names, float scale = 1) {
    for (const std::string& name : names) {
      std::vector<float> samples;
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const float wave = std::sin(static_cast<float>(i) * 0.7F + static_cast<float>(planes_.size()));
        // Runs of one colour and black ones are read in ways of their own.
        samples.push_back(i < kWidth ? 0 : i < 2 * kWidth ? 0.25F : scale * (0.5F + 0.5F * wave));
      }
      planes_.emplace_back(name, std::move(samples));
    }
  }
  std::vector<std::pair<std::string, std::vector<float>>>& planes() { return planes_; }
  Imf::FrameBuffer frame(Imath::V2i origin = {0, 0}) {
    Imf::FrameBuffer out;
    for (auto& [name, samples] : planes_) {
      out.insert(name, Imf::Slice::Make(Imf::FLOAT, samples.data(), origin, kWidth, kHeight));
    }
    return out;
  }

 private:
  std::vector<std::pair<std::string, std::vector<float>>> planes_;
};

Imf::Header header_of(Picture& picture, Imf::PixelType type, Imf::Compression compression) {
  Imf::Header header(kWidth, kHeight);
  header.compression() = compression;
  for (const auto& [name, samples] : picture.planes()) header.channels().insert(name, Imf::Channel(type));
  return header;
}

void scanlines(const std::string& path, Picture picture, const Imf::Header& header) {
  Picture as_written = std::move(picture);
  // Integer channels are written from integers.
  std::vector<std::vector<std::uint32_t>> whole;
  Imf::FrameBuffer frame = as_written.frame(header.dataWindow().min);
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const std::size_t bytes = it.channel().type == Imf::HALF ? 2 : 4;
    whole.emplace_back(kWidth * kHeight, it.channel().type == Imf::FLOAT ? 0x3E800000U : 0x34003400U);
    if (it.channel().type == Imf::FLOAT) continue;
    frame.insert(it.name(), Imf::Slice::Make(it.channel().type, whole.back().data(), header.dataWindow().min,
                                             kWidth, kHeight, bytes, bytes * kWidth));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(kHeight);
}

void tiles(const std::string& path, Imf::LevelMode mode, Imf::Compression compression) {
  Picture picture({"R", "G", "B"});
  Imf::Header header = header_of(picture, Imf::FLOAT, compression);
  header.setTileDescription(Imf::TileDescription(4, 4, mode));
  Imf::TiledOutputFile file(path.c_str(), header);
  file.setFrameBuffer(picture.frame());
  for (int ly = 0; ly < file.numYLevels(); ++ly) {
    for (int lx = 0; lx < file.numXLevels(); ++lx) {
      if (mode != Imf::RIPMAP_LEVELS && lx != ly) continue;
      file.writeTiles(0, file.numXTiles(lx) - 1, 0, file.numYTiles(ly) - 1, lx, ly);
    }
  }
}

void parts(const std::string& path) {
  Picture spectra({"T.400,000000nm", "T.500,000000nm", "T.600,000000nm", "T.700,000000nm"});
  Picture left({"R", "G", "B", "A"});
  Imf::Header headers[] = {header_of(spectra, Imf::FLOAT, Imf::ZIPS_COMPRESSION),
                           header_of(left, Imf::FLOAT, Imf::RLE_COMPRESSION)};
  headers[0].setName("spectrum");
  headers[1].setName("left");
  for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
  Imf::MultiPartOutputFile file(path.c_str(), headers, 2);
  Picture* const pictures[] = {&spectra, &left};
  for (int i = 0; i < 2; ++i) {
    Imf::OutputPart part(file, i);
    part.setFrameBuffer(pictures[i]->frame());
    part.writePixels(kHeight);
  }
}

void deep(const std::string& path) {
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  std::vector<unsigned> counts(kWidth * kHeight, 1);
  std::vector<float> samples(counts.size(), 2);
  std::vector<float*> pointers;
  for (float& sample : samples) pointers.push_back(&sample);
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned),
                                          sizeof(unsigned) * kWidth));
  frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                   sizeof(float*) * kWidth, sizeof(float)));
  Imf::DeepScanLineOutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(kHeight);
}

void chroma(const std::string& path) {
  std::vector<Imf::Rgba> pixels(8 * 6, Imf::Rgba(0.5F, 0.25F, 0.125F, 1.0F));
  Imf::RgbaOutputFile file(path.c_str(), 8, 6, Imf::WRITE_YC);
  file.setFrameBuffer(pixels.data(), 1, 8);
  file.writePixels(6);
}

void subsampled(const std::string& path) {
  Imf::Header header(8, 6);
  std::vector<float> samples(48, 0.5F);
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B", "T.500nm"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT, 2, 2));
    frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), 4, 16, 2, 2));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(6);
}

void plain_images(const std::string& folder) {
  constexpr std::array<std::pair<const char*, Imf::Compression>, 10> kCompressions = {
      {{"none", Imf::NO_COMPRESSION},
       {"rle", Imf::RLE_COMPRESSION},
       {"zips", Imf::ZIPS_COMPRESSION},
       {"zip", Imf::ZIP_COMPRESSION},
       {"piz", Imf::PIZ_COMPRESSION},
       {"pxr24", Imf::PXR24_COMPRESSION},
       {"b44", Imf::B44_COMPRESSION},
       {"b44a", Imf::B44A_COMPRESSION},
       {"dwaa", Imf::DWAA_COMPRESSION},
       {"dwab", Imf::DWAB_COMPRESSION}}};
  int i = 0;
  for (const auto& [name, compression] : kCompressions) {
    const Imf::PixelType type = i++ % 2 == 0 ? Imf::HALF : Imf::FLOAT;
    Picture picture({"R", "G", "B"});
    scanlines(folder + "rgb_" + name + ".exr", picture, header_of(picture, type, compression));
  }
  tiles(folder + "tiles.exr", Imf::ONE_LEVEL, Imf::NO_COMPRESSION);
  tiles(folder + "tiles_mipmap.exr", Imf::MIPMAP_LEVELS, Imf::ZIP_COMPRESSION);
  tiles(folder + "tiles_ripmap.exr", Imf::RIPMAP_LEVELS, Imf::PIZ_COMPRESSION);
  parts(folder + "parts.exr");
  deep(folder + "deep.exr");
  chroma(folder + "chroma.exr");
  subsampled(folder + "subsampled.exr");
  Picture odd({"R", "G", "B", "A", "id", "diffuse.R", "diffuse.G", "diffuse.B"}, 3);
  odd.planes()[0].second[20] = std::nanf("");
  odd.planes()[1].second[21] = -1;
  Imf::Header header = header_of(odd, Imf::FLOAT, Imf::ZIP_COMPRESSION);
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  header.dataWindow() = Imath::Box2i({-3, 2}, {-3 + kWidth - 1, 2 + kHeight - 1});
  header.lineOrder() = Imf::DECREASING_Y;
  Imf::addChromaticities(header, Imf::Chromaticities({0.708F, 0.292F}, {0.17F, 0.797F}, {0.131F, 0.046F}));
  Imf::addOwner(header, "spectile");
  Imf::addKeyCode(header, Imf::KeyCode(1, 2, 3, 4, 5, 6, 20));
  Imf::addTimeCode(header, Imf::TimeCode(1, 2, 3, 4));
  Imf::addFramesPerSecond(header, Imf::Rational(24, 1));
  Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  Imf::addWorldToCamera(header, Imath::M44f());
  Imf::addMultiView(header, {"left", "right"});
  const std::vector<Imf::PreviewRgba> small(4);
  header.setPreviewImage(Imf::PreviewImage(2, 2, small.data()));
  scanlines(folder + "attributes.exr", odd, header);
  Picture light({"S0.400,000000nm", "S0.5e-7m", "S0.500THz", "S1.500,000000nm", "T.555.5nm", "Y"});
  scanlines(folder + "light.exr", light, header_of(light, Imf::HALF, Imf::ZIP_COMPRESSION));
}

void upsampled_images(const std::string& folder) {
  const std::string from = folder + "attributes.exr";
  UpsampleImageOptions options;
  options.threads = 1;
  options.nonfinite = NonFinite::kZero;
  options.method = Method::kSmits;
  options.bands = *Bands::uniform(400, 700, 60);
  const auto write = [&](const char* name) {
    const auto report = upsample_image(from, folder + name, options);
    require(static_cast<bool>(report), "a file of the corpus can be made",
            report ? "" : report.error().message);
  };
  write("spectral.exr");
  options.quantity = Quantity::kIlluminant;
  options.pixel = SampleType::kFloat;
  options.tile = {5, 5};
  write("spectral_tiles.exr");
  options.tile.reset();
  options.store = Store::kCoefficients;
  options.method = Method::kSigmoid;
  options.bands = Bands();
  options.light = NamedLight{"A", *illuminant("A")};
  write("coefficients_light.exr");
  options.light.reset();
  options.quantity = Quantity::kReflectance;
  write("coefficients.exr");
  options.method = Method::kSmitsExact;
  write("coefficients_smits.exr");
}

void films(const std::string& folder) {
  const auto scene = *ProceduralScene::named("mixed");
  FilmOptions options;
  options.width = 18;
  options.height = 10;
  const auto write = [&](const char* name) {
    auto film = Film::create(options);
    require(static_cast<bool>(film), "a film can be made", film ? "" : film.error().message);
    const SceneSampling sampling;
    Execution one;
    one.threads = 1;
    require(static_cast<bool>(simulate(scene, sampling, *film, 0, simulation_steps(options, sampling), one)),
            "a film takes a scene");
    ImageOptions image;
    image.threads = 1;
    image.compression = {CompressionKind::kZip, 9};
    require(static_cast<bool>(save_film(*film, folder + name, "step 1", image)), "a film can be saved");
  };
  write("wavelengths.exr");
  options.input = FilmInput::kBands;
  options.bands = *Bands::uniform(400, 700, 100);
  options.spectral = true;
  options.statistics = PixelStatistics::kVariance;
  options.placement = SamplePlacement::kSplat;
  options.filter = *PixelFilter::gaussian();
  options.crop = PixelWindow{3, 2, 12, 7};
  write("bands.exr");
  options.xyz.reset();
  options.spectral = false;
  options.statistics = PixelStatistics::kCounts;
  options.sensors.push_back({"cie1964", *Sensor::named("cie1964")});
  write("sensor.exr");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} CORPUS_FOLDER\n", argv[0]);
    return 2;
  }
  const std::string folder = argv[1];
  Imf::setGlobalThreadCount(0);
  for (const char* name : {"/exr/", "/film_file/"}) std::filesystem::create_directories(folder + name);
  plain_images(folder + "/exr/");
  upsampled_images(folder + "/exr/");
  films(folder + "/film_file/");
  return 0;
}
