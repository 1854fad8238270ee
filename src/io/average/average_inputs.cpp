// AverageInputs: the images of an average, checked to be of one frame, and read side by side.
#include "src/io/average/average_inputs.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfTileDescription.h>
#include <unistd.h>

#include <algorithm>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

std::string text_of(const Imath::Box2i& window) {
  return fmt::format("{},{} to {},{}", window.min.x, window.min.y, window.max.x, window.max.y);
}

const char* text_of(Imf::PixelType type) {
  return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint";
}

/// Lines of a chunk, by OpenEXR's file layout.
int chunk_lines_of(const Imf::Header& header) {
  // Tiles may be as high as the image.
  constexpr unsigned kMost = 4096;
  if (header.hasTileDescription()) return static_cast<int>(std::min(header.tileDescription().ySize, kMost));
  switch (header.compression()) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

Result<void> check_kind(const ExrInput& input) {
  if (input.parts() > 1) {
    return make_error(ErrorCode::kBadFile, "{}: has {} parts; only images of one part can be averaged",
                      input.path(), input.parts());
  }
  const Imf::ChannelList& channels = input.header(0).channels();
  if (channels.begin() == channels.end()) {
    return make_error(ErrorCode::kBadFile, "{}: has no channels", input.path());
  }
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling == 1 && it.channel().ySampling == 1) continue;
    return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" is subsampled {} x {}, which is not supported",
                      input.path(), it.name(), it.channel().xSampling, it.channel().ySampling);
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<AverageInputs>> AverageInputs::open(std::span<const std::string> paths, int threads) {
  std::unique_ptr<AverageInputs> inputs(new AverageInputs);
  inputs->paths_.assign(paths.begin(), paths.end());
  // Many images are decoded side by side, each by one thread; few by all threads each.
  inputs->threads_each_ = paths.size() < static_cast<std::size_t>(threads) ? threads : 1;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    SPECTILE_ASSIGN(auto input, inputs->open_one(i));
    SPECTILE_TRY(check_kind(*input));
    SPECTILE_TRY(i == 0 ? inputs->start(*input) : inputs->compare(*input));
    inputs->chunk_lines_ = std::max(inputs->chunk_lines_, chunk_lines_of(input->header(0)));
    if (i < inputs->most_open()) inputs->open_.push_back(std::move(input));
  }
  return inputs;
}

Result<std::unique_ptr<ExrInput>> AverageInputs::open_one(std::size_t input) {
  const std::scoped_lock lock(opening_);
  return ExrInput::open(paths_[input], threads_each_);
}

Result<void> AverageInputs::start(const ExrInput& first) {
  header_ = first.header(0);
  for (auto it = header_.channels().begin(); it != header_.channels().end(); ++it) {
    planes_.push_back({it.name(), it.channel().type});
  }
  return {};
}

Result<void> AverageInputs::compare(const ExrInput& other) {
  const std::string& first = paths_[0];
  const Imf::Header& h = other.header(0);
  const auto differ = [&]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    return make_error(ErrorCode::kBadFile, "{}: {}", other.path(),
                      fmt::format(format, std::forward<Args>(args)...));
  };
  if (width_of(h) != width_of(header_) || height_of(h) != height_of(header_)) {
    return differ("is {} x {} pixels, but {} is {} x {}", width_of(h), height_of(h), first, width_of(header_),
                  height_of(header_));
  }
  if (h.dataWindow() != header_.dataWindow()) {
    return differ("its data window is {}, but that of {} is {}", text_of(h.dataWindow()), first,
                  text_of(header_.dataWindow()));
  }
  if (h.displayWindow() != header_.displayWindow()) {
    return differ("its display window is {}, but that of {} is {}", text_of(h.displayWindow()), first,
                  text_of(header_.displayWindow()));
  }
  for (auto it = h.channels().begin(); it != h.channels().end(); ++it) {
    if (header_.channels().findChannel(it.name()) == nullptr) {
      return differ("has a channel \"{}\", but {} has none", it.name(), first);
    }
  }
  for (PlaneSpec& plane : planes_) {
    const Imf::Channel* channel = h.channels().findChannel(plane.name);
    if (channel == nullptr) return differ("has no channel \"{}\", but {} has one", plane.name, first);
    if ((channel->type == Imf::UINT) != (plane.type == Imf::UINT)) {
      return differ("channel \"{}\" is {}, but that of {} is {}", plane.name, text_of(channel->type), first,
                    text_of(header_.channels().findChannel(plane.name)->type));
    }
    if (channel->type == Imf::FLOAT) plane.type = Imf::FLOAT;
  }
  return {};
}

bool AverageInputs::is_as_before(const ExrInput& again) const {
  const Imf::Header& h = again.header(0);
  if (again.parts() != 1 || h.dataWindow() != header_.dataWindow()) return false;
  return std::all_of(planes_.begin(), planes_.end(), [&](const PlaneSpec& plane) {
    const Imf::Channel* channel = h.channels().findChannel(plane.name);
    const bool there = channel != nullptr && channel->xSampling == 1 && channel->ySampling == 1;
    return there && (channel->type == plane.type || (channel->type == Imf::HALF && plane.type == Imf::FLOAT));
  });
}

std::size_t AverageInputs::most_open() const {
  // OpenEXR keeps the chunks that it decodes for every open file: one, or two for every thread.
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  // Opening 290 of 300 images for every strip took 7 % longer than opening 44 of them.
  constexpr std::size_t kMaxFiles = 64;
  std::size_t bytes = 1;
  for (const PlaneSpec& plane : planes_) bytes += plane.sample_bytes();
  const auto chunks = static_cast<std::size_t>(threads_each_ > 1 ? 2 * threads_each_ : 1);
  bytes *= static_cast<std::size_t>(width_of(header_)) * static_cast<std::size_t>(chunk_lines_) * chunks;
  // The rest of the limit is for the output, and for whoever calls.
  const long limit = ::sysconf(_SC_OPEN_MAX);
  const std::size_t allowed = limit > 0 ? static_cast<std::size_t>(limit) / 2 : kMaxFiles;
  return std::min({kMaxFiles, allowed, kMaxBytes / bytes});
}

Result<void> AverageInputs::fill(std::size_t input, Strip& strip) {
  if (input < open_.size()) return fill_strip(*open_[input], 0, planes_, strip);
  SPECTILE_ASSIGN(auto again, open_one(input));
  if (!is_as_before(*again)) {
    return make_error(ErrorCode::kBadFile, "{}: is not any more what it was", paths_[input]);
  }
  return fill_strip(*again, 0, planes_, strip);
}

}  // namespace spectile::io
