// OpenEXR alone writing planes, and the textures to measure with; bench/figures.py drives it.
//
// usage: spectile_bench_exr texture OUT SIZE full|quadrant|islands LEVELS zip|none [IMAGE]
//        spectile_bench_exr write PLANES OUT none|piz|zip:LEVEL THREADS     (prints seconds)
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

/// Channels of float or half samples, each a plane [height][width].
struct Planes {
  std::size_t width = 0, height = 0;
  std::vector<std::string> names;
  std::vector<std::vector<half>> samples;
};

Imf::FrameBuffer frame_buffer(Planes& planes) {
  Imf::FrameBuffer out;
  for (std::size_t k = 0; k < planes.names.size(); ++k) {
    out.insert(planes.names[k], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(planes.samples[k].data()),
                                           sizeof(half), sizeof(half) * planes.width));
  }
  return out;
}

void write(const std::string& path, Planes& planes, const std::string& compression) {
  Imf::Header header(static_cast<int>(planes.width), static_cast<int>(planes.height));
  header.compression() = compression == "none"  ? Imf::NO_COMPRESSION
                         : compression == "piz" ? Imf::PIZ_COMPRESSION
                                                : Imf::ZIP_COMPRESSION;
  if (compression.rfind("zip:", 0) == 0) header.zipCompressionLevel() = std::atoi(compression.c_str() + 4);
  for (const std::string& name : planes.names) header.channels().insert(name, Imf::Channel(Imf::HALF));
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame_buffer(planes));
  file.writePixels(static_cast<int>(planes.height));
}

Planes read(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  Planes out;
  out.width = static_cast<std::size_t>(window.max.x + 1);
  out.height = static_cast<std::size_t>(window.max.y + 1);
  for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
    out.names.emplace_back(it.name());
    out.samples.emplace_back(out.width * out.height);
  }
  file.setFrameBuffer(frame_buffer(out));
  file.readPixels(window.min.y, window.max.y);
  return out;
}

/// A hash of two numbers, in [0, 1).
double noise(unsigned x, unsigned y) {
  unsigned h = x * 374761393U + y * 668265263U;
  h = (h ^ (h >> 13U)) * 1274126177U;
  return ((h ^ (h >> 16U)) & 0xFFFFFFU) / 16777216.0;
}

/// Smooth noise at a scale of `cell` pixels.
double smooth(std::size_t x, std::size_t y, double cell, unsigned seed) {
  const double u = static_cast<double>(x) / cell;
  const double v = static_cast<double>(y) / cell;
  const auto i = static_cast<unsigned>(u);
  const auto j = static_cast<unsigned>(v);
  const auto row = [&](unsigned q) {
    return std::lerp(noise(i + 7919 * seed, j + q), noise(i + 1 + 7919 * seed, j + q), u - i);
  };
  return std::lerp(row(0), row(1), v - j);
}

/// Component k of a procedural texture: noise at four scales, with colours from all over the lower half of
/// the cube.
double texture(std::size_t x, std::size_t y, unsigned k) {
  return 0.5 * smooth(x, y, 301, k) + 0.3 * smooth(x, y, 37, 9) + 0.15 * smooth(x, y, 5, 11) +
         0.05 * noise(static_cast<unsigned>(x), static_cast<unsigned>(y) + 31 * k);
}

/// True for the pixels of an atlas that are not black.
bool is_used(const std::string& pattern, std::size_t x, std::size_t y, std::size_t n) {
  if (pattern == "quadrant") return x < n / 2 && y < n / 2;
  return pattern == "full" || (x / 256 + 3 * (y / 256) + y / 512) % 4 == 0;
}

int make_texture(char** argv, const char* image) {
  const auto n = static_cast<std::size_t>(std::atoi(argv[3]));
  const double levels = std::atof(argv[5]);
  const Planes source = image != nullptr ? read(image) : Planes();
  Planes out{n, n, {"B", "G", "R"}, {}};
  for (unsigned k = 0; k < 3; ++k) {
    const std::vector<half>* plane = nullptr;
    for (std::size_t i = 0; i < source.names.size(); ++i) {
      if (source.names[i] == out.names[k]) plane = &source.samples[i];
    }
    out.samples.emplace_back(n * n);
    for (std::size_t i = 0; i < n * n; ++i) {
      const std::size_t x = i % n;
      const std::size_t y = i / n;
      double v = plane != nullptr ? double{(*plane)[y % source.height * source.width + x % source.width]}
                                  : texture(x, y, 2 - k);
      if (levels > 0) v = std::round(v * levels) / levels;
      out.samples.back()[i] = half(static_cast<float>(is_used(argv[4], x, y, n) ? v : 0));
    }
  }
  write(argv[2], out, argv[6]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "texture" && argc >= 7) return make_texture(argv, argc > 7 ? argv[7] : nullptr);
  if (command != "write" || argc != 6) {
    std::fputs("usage: see the first lines of bench/exr_only.cpp\n", stderr);
    return 2;
  }
  Imf::setGlobalThreadCount(std::atoi(argv[5]));
  Planes planes = read(argv[2]);
  const auto start = std::chrono::steady_clock::now();
  write(argv[3], planes, argv[4]);
  std::printf("%.6f\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}
