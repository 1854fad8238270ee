// Images for the tests, written and read with OpenEXR's own C++ classes, and folders that vanish after use.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <spectile/image/image.hpp>
#include <string>
#include <vector>

namespace spectile::test {

/// The usual options; named, since GCC 12 takes defaulted arguments with a std::function inside for
/// uninitialised.
inline const UpsampleImageOptions kUpsample;
inline const ProjectImageOptions kProject;

/// An empty folder of its own, removed with all it holds.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = testing::TempDir() + "spectile-XXXXXX";
    if (::mkdtemp(pattern.data()) == nullptr) ADD_FAILURE() << "no temporary folder";
    path_ = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Names of all that it holds, hidden ones too.
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      out.push_back(entry.path().filename());
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  std::filesystem::path path_;
};

/// One channel's samples in the type that the file holds, line after line.
struct Plane {
  Imf::PixelType type = Imf::HALF;
  std::vector<char> bytes;

  static std::size_t sample_bytes(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }
  void set(std::size_t i, double v) {
    const auto put = [&](auto sample) {
      std::memcpy(bytes.data() + i * sizeof(sample), &sample, sizeof(sample));
    };
    if (type == Imf::HALF) return put(half(static_cast<float>(v)));
    if (type == Imf::UINT) return put(static_cast<std::uint32_t>(v));
    put(static_cast<float>(v));
  }
  double at(std::size_t i) const {
    const auto get = [&](auto sample) {
      std::memcpy(&sample, bytes.data() + i * sizeof(sample), sizeof(sample));
      return sample;
    };
    if (type == Imf::HALF) return static_cast<double>(static_cast<float>(get(half())));
    if (type == Imf::UINT) return get(std::uint32_t{});
    return static_cast<double>(get(float{}));
  }
  friend bool operator==(const Plane&, const Plane&) = default;
};

/// A header and whole planes of one part.
struct Picture {
  Imf::Header header;
  std::map<std::string, Plane> planes;

  int width() const { return header.dataWindow().max.x - header.dataWindow().min.x + 1; }
  int height() const { return header.dataWindow().max.y - header.dataWindow().min.y + 1; }
  std::size_t pixels() const {
    return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x);
  }
  double at(const std::string& name, int x, int y) const { return planes.at(name).at(index(x, y)); }

  /// Adds a channel whose sample at x, y (from the upper left corner) is value(x, y).
  void add(const std::string& name, Imf::PixelType type, const std::function<double(int, int)>& value) {
    Plane& plane = planes[name];
    plane.type = type;
    plane.bytes.resize(pixels() * Plane::sample_bytes(type));
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) plane.set(index(x, y), value(x, y));
    }
    header.channels().insert(name, Imf::Channel(type));
  }
  Imf::FrameBuffer frame_buffer() {
    Imf::FrameBuffer frame;
    const Imath::Box2i w = header.dataWindow();
    for (auto& [name, plane] : planes) {
      frame.insert(name, Imf::Slice::Make(plane.type, plane.bytes.data(), w.min, width(), height()));
    }
    return frame;
  }
};

/// An image without channels; data and display window start at `origin`.
inline Picture blank(int width, int height, Imath::V2i origin = {0, 0}) {
  const Imath::Box2i window(origin, {origin.x + width - 1, origin.y + height - 1});
  return {Imf::Header(window, window), {}};
}

/// A value of 0 to 1 that depends on place and channel only.
inline double noise(int x, int y, int channel) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U +
                    static_cast<std::uint32_t>(y) * 0x85EBCA77U +
                    static_cast<std::uint32_t>(channel) * 0xC2B2AE3DU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return static_cast<double>((h ^ (h >> 15)) >> 8) * 0x1p-24;
}

/// R, G, B of noise from 0 to `scale`, under a prefix.
inline void add_rgb_noise(Picture& picture, Imf::PixelType type, double scale = 1,
                          const std::string& prefix = "") {
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    picture.add(prefix + name, type, [=](int x, int y) { return scale * noise(x, y, c); });
  }
}

inline void write_scanlines(const std::string& path, Picture& picture) {
  Imf::OutputFile file(path.c_str(), picture.header);
  file.setFrameBuffer(picture.frame_buffer());
  file.writePixels(picture.height());
}

/// Writes tiles; with `mipmaps` every level, the smaller ones from the upper left corner of the picture.
inline void write_tiles(const std::string& path, Picture& picture, unsigned side, bool mipmaps) {
  picture.header.setTileDescription(
      Imf::TileDescription(side, side, mipmaps ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL, Imf::ROUND_DOWN));
  Imf::TiledOutputFile file(path.c_str(), picture.header);
  file.setFrameBuffer(picture.frame_buffer());
  for (int level = 0; level < file.numLevels(); ++level) {
    file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
}

/// Reads every channel that is not subsampled, in its own type.
inline Picture read_picture(const std::string& path, int part = 0) {
  Imf::MultiPartInputFile file(path.c_str());
  Picture picture{file.header(part), {}};
  const Imf::ChannelList& channels = picture.header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) continue;
    Plane& plane = picture.planes[it.name()];
    plane.type = it.channel().type;
    plane.bytes.resize(picture.pixels() * Plane::sample_bytes(plane.type));
  }
  Imf::InputPart input(file, part);
  input.setFrameBuffer(picture.frame_buffer());
  input.readPixels(picture.header.dataWindow().min.y, picture.header.dataWindow().max.y);
  return picture;
}

/// The header but for one attribute. OpenEXR 3.1's Header::erase leaks what it takes out.
inline Imf::Header without(const Imf::Header& header, const std::string& name) {
  Imf::Header out(header.displayWindow(), header.dataWindow());
  for (auto it = header.begin(); it != header.end(); ++it) {
    if (name != it.name()) out.insert(it.name(), it.attribute());
  }
  return out;
}

/// The bytes that an attribute's value takes in a file.
inline std::string attribute_bytes(const Imf::Attribute& attribute) {
  Imf::StdOSStream stream;
  attribute.writeValueTo(stream, 2);
  return stream.str();
}

inline std::string file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A folder of real images that need not exist.
inline std::filesystem::path shared_images(const char* folder) {
  return std::filesystem::path(SPECTILE_TEST_SHARED) / "images" / folder;
}

/// All files of such a folder, by name.
inline std::vector<std::string> shared_files(const char* folder) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(shared_images(folder))) {
    out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace spectile::test

/// Skips a test, visibly, where there are no real images.
#define SPECTILE_NEEDS_IMAGES(folder)                              \
  if (!std::filesystem::is_directory(test::shared_images(folder))) \
  GTEST_SKIP() << "no folder " << test::shared_images(folder)
