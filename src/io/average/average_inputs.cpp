// AverageInputs: the images of an average, checked to be of one frame, and read side by side.
#include "src/io/average/average_inputs.hpp"

#include <unistd.h>

#include <algorithm>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

std::string to_text(const PixelWindow& window) {
  return fmt::format("{},{} to {},{}", window.x0, window.y0, window.x1 - 1, window.y1 - 1);
}

Result<void> check_kind(const ExrInput& input) {
  if (input.parts() > 1) {
    return make_error(ErrorCode::kBadFile, "{}: has {} parts; only images of one part can be averaged",
                      input.path(), input.parts());
  }
  const auto& channels = input.header(0).channels();
  if (channels.empty()) return make_error(ErrorCode::kBadFile, "{}: has no channels", input.path());
  for (const StoredChannel& channel : channels) SPECTILE_TRY(check_sampling(channel, input.path()));
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
    inputs->chunk_lines_ = std::max(inputs->chunk_lines_, input->header(0).chunk_lines());
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
  for (const StoredChannel& channel : header_.channels()) planes_.push_back({channel.name, channel.type});
  return {};
}

Result<void> AverageInputs::compare(const ExrInput& other) {
  const std::string& first = paths_[0];
  const PartHeader& h = other.header(0);
  const auto differ = [&]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    return make_error(ErrorCode::kBadFile, "{}: {}", other.path(),
                      fmt::format(format, std::forward<Args>(args)...));
  };
  if (h.width() != header_.width() || h.height() != header_.height()) {
    return differ("is {} x {} pixels, but {} is {} x {}", h.width(), h.height(), first, header_.width(),
                  header_.height());
  }
  if (h.data_window() != header_.data_window()) {
    return differ("its data window is {}, but that of {} is {}", to_text(h.data_window()), first,
                  to_text(header_.data_window()));
  }
  if (h.display_window() != header_.display_window()) {
    return differ("its display window is {}, but that of {} is {}", to_text(h.display_window()), first,
                  to_text(header_.display_window()));
  }
  for (const StoredChannel& channel : h.channels()) {
    if (header_.find(channel.name) == nullptr) {
      return differ("has a channel \"{}\", but {} has none", channel.name, first);
    }
  }
  for (PlaneSpec& plane : planes_) {
    const StoredChannel* const channel = h.find(plane.name);
    if (channel == nullptr) return differ("has no channel \"{}\", but {} has one", plane.name, first);
    if ((channel->type == SampleType::kUint32) != (plane.type == SampleType::kUint32)) {
      return differ("channel \"{}\" is {}, but that of {} is {}", plane.name, to_string(channel->type), first,
                    to_string(header_.find(plane.name)->type));
    }
    if (channel->type == SampleType::kFloat) plane.type = SampleType::kFloat;
  }
  return {};
}

bool AverageInputs::is_as_before(const ExrInput& again) const {
  const PartHeader& h = again.header(0);
  if (again.parts() != 1 || h.data_window() != header_.data_window()) return false;
  return std::all_of(planes_.begin(), planes_.end(), [&](const PlaneSpec& plane) {
    const StoredChannel* const channel = h.find(plane.name);
    const bool there = channel != nullptr && !channel->subsampled();
    return there && (channel->type == plane.type ||
                     (channel->type == SampleType::kHalf && plane.type == SampleType::kFloat));
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
  bytes *= static_cast<std::size_t>(header_.width()) * static_cast<std::size_t>(chunk_lines_) * chunks;
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
