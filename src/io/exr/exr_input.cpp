// ExrInput: an OpenEXR file open for reading, with exceptions turned into errors.
#include "src/io/exr/exr_input.hpp"

#include <OpenEXR/IexErrnoExc.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>
#include <spectile/image/limits.hpp>
#include <vector>

#include "src/base/atomic_file.hpp"
#include "src/base/errors.hpp"
#include "src/io/exr/exr_threads.hpp"

namespace spectile::io {
namespace {

// Of chunks that several threads may decode side by side.
constexpr std::size_t kMaxChunkBytes = std::size_t{128} << 20;

/// One line of what a library says: no line breaks, no final full stop, no file name before it.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

/// The errno of an OpenEXR exception, which has one for each; 0 for those that say nothing of the system.
int error_number_of(const Iex::ErrnoExc& error) {
  if (dynamic_cast<const Iex::EaccesExc*>(&error) != nullptr) return EACCES;
  if (dynamic_cast<const Iex::EmfileExc*>(&error) != nullptr) return EMFILE;
  if (dynamic_cast<const Iex::EnfileExc*>(&error) != nullptr) return ENFILE;
  if (dynamic_cast<const Iex::EioExc*>(&error) != nullptr) return EIO;
  if (dynamic_cast<const Iex::EnomemExc*>(&error) != nullptr) return ENOMEM;
  return 0;
}

Result<void> check_is_exr(const std::string& path) {
  // Not to wait for the writer of a pipe.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return system_error(path, "read", errno);
  struct stat status {};
  std::array<unsigned char, 4> magic{};
  const bool known = ::fstat(fd, &status) == 0;
  const bool folder = known && S_ISDIR(status.st_mode);
  const bool plain = known && S_ISREG(status.st_mode);
  const ssize_t got = plain ? ::pread(fd, magic.data(), magic.size(), 0) : 0;
  const int failed = got < 0 ? errno : 0;
  Result<void> sizes = plain ? check_attribute_sizes(fd, path) : Result<void>();
  ::close(fd);
  if (folder) return make_error(ErrorCode::kBadFile, "{}: cannot read: is a directory", path);
  if (!plain) return make_error(ErrorCode::kBadFile, "{}: cannot read: not a plain file", path);
  // The magic number of OpenEXR files, little-endian 20000630.
  constexpr std::array<unsigned char, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};
  if (failed != 0) return system_error(path, "read", failed);
  if (got == 0) return make_error(ErrorCode::kBadFile, "{}: not an OpenEXR file: it is empty", path);
  if (got != 4 || magic != kMagic) return make_error(ErrorCode::kBadFile, "{}: not an OpenEXR file", path);
  return sizes;
}

}  // namespace

Result<void> guarded(const std::string& path, const std::function<void()>& action, const char* remark) {
  // Made beforehand: there may be no memory for it afterwards.
  Error out_of_memory = make_error(ErrorCode::kOutOfMemory, "{}: not enough memory{}", path, remark);
  try {
    action();
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory;
  } catch (const Iex::ErrnoExc& error) {
    if (const int number = error_number_of(error); number != 0) return system_error(path, "read", number);
    return make_error(ErrorCode::kBadFile, "{}: {}", path, one_line(error.what()));
  } catch (const std::exception& error) {
    std::string text = one_line(error.what());
    // OpenEXR's own words where it gets no memory for its buffers.
    if (text.find("Failed to allocate memory") != std::string::npos) return out_of_memory;
    // The library's messages often begin with the file's name in some form of sentence.
    return make_error(ErrorCode::kBadFile, "{}: {}", path, text.empty() ? "damaged" : text);
  } catch (...) {
    return make_error(ErrorCode::kBadFile, "{}: damaged", path);
  }
}

ExrInput::ExrInput(std::string path) : path_(std::move(path)) {}

ExrInput::~ExrInput() = default;

namespace {

std::atomic<std::uint64_t> max_pixels = kDefaultMaxPixels;

Result<void> check_pixels(const std::string& path, const std::vector<PartHeader>& parts) {
  const std::uint64_t most = max_pixels;
  for (const PartHeader& part : parts) {
    const auto pixels = static_cast<std::uint64_t>(part.width()) * static_cast<std::uint64_t>(part.height());
    if (most == 0 || pixels <= most || part.deep()) continue;
    return make_error(ErrorCode::kBadFile, "{}: has {} x {} pixels, more than {} (--max-pixels)", path,
                      part.width(), part.height(), most);
  }
  return {};
}

/// guarded(), for a file that is read.
Result<void> guarded_read(const std::string& path, const std::function<void()>& action) {
  return guarded(path, action, " for what it claims to hold (a damaged file may claim any size)");
}

// As much as zlib takes to decompress: its state, some 10 KiB, and a window of 32 KiB.
constexpr std::size_t kInflateBytes = std::size_t{64} << 10;

bool memory_is_left() {
  void* volatile memory = std::malloc(kInflateBytes);  // volatile: a compiler may leave out the pair
  std::free(memory);
  return memory != nullptr;
}

/// guarded_read() for samples. OpenEXR says "decompression failed" of damaged data, and also where zlib gets
/// no memory; so what fails is read once more. `action` must be repeatable.
Result<void> read_samples(const std::string& path, const std::function<void()>& action) {
  Result<void> read = guarded_read(path, action);
  if (read || read.error().code != ErrorCode::kBadFile) return read;
  read = guarded_read(path, action);
  if (read || read.error().code != ErrorCode::kBadFile || memory_is_left()) return read;
  return make_error(ErrorCode::kOutOfMemory, "{}: not enough memory to decompress it", path);
}

}  // namespace

Result<std::unique_ptr<ExrInput>> ExrInput::open(const std::string& path, int threads) {
  SPECTILE_TRY(check_is_exr(path));
  std::unique_ptr<ExrInput> input(new ExrInput(path));
  SPECTILE_ASSIGN(input->identity_, identify(path));
  SPECTILE_TRY(guarded_read(path, [&] {
    Imf::Header::setMaxImageSize(PartHeader::kMaxSide, PartHeader::kMaxSide);
    Imf::Header::setMaxTileSize(PartHeader::kMaxSide, PartHeader::kMaxSide);
    const int workers = threads > 1 ? threads : 0;
    set_exr_threads(workers);
    input->file_ = std::make_unique<Imf::MultiPartInputFile>(path.c_str(), workers);
    for (int part = 0; part < input->file_->parts(); ++part) {
      input->headers_.emplace_back(input->file_->header(part));
    }
    // OpenEXR holds two chunks for each thread, and one without any.
    const auto too_large = [](const PartHeader& header) {
      return !header.deep() && header.chunk_bytes() > kMaxChunkBytes;
    };
    if (workers > 0 && std::ranges::any_of(input->headers_, too_large)) {
      input->file_ = std::make_unique<Imf::MultiPartInputFile>(path.c_str(), 0);
    }
  }));
  SPECTILE_TRY(check_pixels(path, input->headers_));
  if (std::all_of(input->headers_.begin(), input->headers_.end(), [](const auto& h) { return h.deep(); }))
    return make_error(ErrorCode::kBadFile, "{}: holds deep images only, which are not supported", path);
  return input;
}

Result<ExrInput::Identity> ExrInput::identify(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return system_error(path, "read", errno);
  return Identity{static_cast<std::int64_t>(status.st_dev), static_cast<std::int64_t>(status.st_ino),
                  status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

Result<void> ExrInput::unchanged() const {
  SPECTILE_ASSIGN(const auto now, identify(path_));
  if (now == identity_) return {};
  return make_error(ErrorCode::kBadFile, "{}: was changed while it was read", path_);
}

Result<void> ExrInput::read(int part, const Imf::FrameBuffer& target, int y0, int y1) {
  return read_samples(path_, [&] {
    Imf::InputPart input(*file_, part);
    input.setFrameBuffer(target);
    input.readPixels(y0, y1);
  });
}

Result<std::vector<LevelSize>> ExrInput::levels(int part) {
  const PartHeader& h = header(part);
  std::vector<LevelSize> out = {{h.width(), h.height()}};
  if (!h.tiles() || !h.tiles()->has_levels) return out;
  SPECTILE_TRY(guarded_read(path_, [&] {
    const Imf::TiledInputPart input(*file_, part);
    for (int level = 1; level < std::min(input.numXLevels(), input.numYLevels()); ++level)
      out.push_back({input.levelWidth(level), input.levelHeight(level)});
  }));
  return out;
}

Result<void> ExrInput::read_tiles(int part, const Imf::FrameBuffer& target, const TileRange& tiles) {
  return read_samples(path_, [&] {
    Imf::TiledInputPart input(*file_, part);
    input.setFrameBuffer(target);
    input.readTiles(tiles.x0, tiles.x1, tiles.y0, tiles.y1, tiles.level, tiles.level);
  });
}

Result<void> ExrInput::read_last(int part) {
  return read_samples(path_, [&] {
    // A channel that there is not; lines and tiles are decoded all the same.
    std::vector<float> samples;
    Imf::FrameBuffer target;
    const auto aim_at = [&](const Imath::Box2i& window) {
      const int width = window.max.x - window.min.x + 1;
      const int height = window.max.y - window.min.y + 1;
      samples.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
      target.insert("spectile.none", Imf::Slice::Make(Imf::FLOAT, samples.data(), window.min, width, height));
    };
    const PartHeader& h = header(part);
    if (!h.tiles() || !h.tiles()->has_levels) {
      const PixelWindow& w = h.data_window();
      aim_at({{w.x0, w.y1 - 1}, {w.x1 - 1, w.y1 - 1}});
      Imf::InputPart input(*file_, part);
      input.setFrameBuffer(target);
      input.readPixels(w.y1 - 1, w.y1 - 1);
      return;
    }
    Imf::TiledInputPart input(*file_, part);
    const int level_x = input.numXLevels() - 1;
    const int level_y = input.numYLevels() - 1;
    const int x = input.numXTiles(level_x) - 1;
    const int y = input.numYTiles(level_y) - 1;
    aim_at(input.dataWindowForTile(x, y, level_x, level_y));
    input.setFrameBuffer(target);
    input.readTile(x, y, level_x, level_y);
  });
}

}  // namespace spectile::io

namespace spectile {

void set_max_pixels(std::uint64_t pixels) {
  io::max_pixels = pixels;
}

}  // namespace spectile
