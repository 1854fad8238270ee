// AverageInputs: the images of an average, checked to be of one frame, and read side by side.
#include "src/io/average/average_inputs.hpp"

#include <unistd.h>

#include <algorithm>

#include "src/base/errors.hpp"
#include "src/io/average/same_meaning.hpp"
#include "src/io/convert/sources/color_space.hpp"

namespace spectile::io {
namespace {

std::string to_text(const PixelWindow& window) {
  return fmt::format("{},{} to {},{}", window.x0, window.y0, window.x1 - 1, window.y1 - 1);
}

/// "PATH", or "PATH, part NAME".
std::string place(const std::string& path, const std::string& part) {
  return part.empty() ? path : fmt::format("{}, part \"{}\"", path, part);
}

Result<void> check_kind(const PartHeader& header, const std::string& where) {
  if (header.deep()) return make_error(ErrorCode::kBadFile, "{}: is deep, which has no average", where);
  if (header.channels().empty()) return make_error(ErrorCode::kBadFile, "{}: has no channels", where);
  for (const StoredChannel& channel : header.channels()) SPECTILE_TRY(check_sampling(channel, where));
  return {};
}

}  // namespace

Result<std::unique_ptr<AverageInputs>> AverageInputs::open(std::span<const std::string> paths, int threads,
                                                           int part) {
  std::unique_ptr<AverageInputs> inputs(new AverageInputs);
  inputs->paths_.assign(paths.begin(), paths.end());
  // Many images are decoded side by side, each by one thread; few by all threads each.
  inputs->threads_each_ = paths.size() < static_cast<std::size_t>(threads) ? threads : 1;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    SPECTILE_ASSIGN(auto input, inputs->open_one(i));
    if (i == 0) {
      inputs->parts_ = input->parts();
      if (inputs->parts_ > 1) inputs->name_ = input->header(part).text("name").value_or("");
      inputs->part_.push_back(part);
    } else {
      SPECTILE_ASSIGN(const int like, inputs->find_part(*input));
      inputs->part_.push_back(like);
    }
    const PartHeader& header = input->header(inputs->part_.back());
    SPECTILE_TRY(check_kind(header, place(paths[i], inputs->name_)));
    if (i == 0) {
      inputs->start(header);
    } else {
      SPECTILE_TRY(inputs->compare(header, paths[i]));
    }
    inputs->windows_.push_back(header.data_window());
    inputs->chunk_lines_ = std::max(inputs->chunk_lines_, header.chunk_lines());
    if (i < inputs->most_open()) inputs->open_.push_back(std::move(input));
  }
  SPECTILE_TRY(inputs->unite());
  return inputs;
}

Result<int> AverageInputs::find_part(const ExrInput& input) const {
  if (input.parts() != parts_) {
    return make_error(ErrorCode::kBadFile, "{}: has {} part{}, but {} has {}", input.path(), input.parts(),
                      input.parts() == 1 ? "" : "s", paths_[0], parts_);
  }
  if (parts_ == 1) return 0;
  for (int part = 0; part < parts_; ++part) {
    if (input.header(part).text("name").value_or("") == name_) return part;
  }
  return make_error(ErrorCode::kBadFile, "{}: has no part \"{}\", but {} has one", input.path(), name_,
                    paths_[0]);
}

Result<std::unique_ptr<ExrInput>> AverageInputs::open_one(std::size_t input) {
  const std::scoped_lock lock(opening_);
  return ExrInput::open(paths_[input], threads_each_);
}

void AverageInputs::start(const PartHeader& first) {
  header_ = first;
  for (const StoredChannel& channel : header_.channels()) planes_.push_back({channel.name, channel.type});
}

Result<void> AverageInputs::compare(const PartHeader& h, const std::string& path) {
  const std::string first = place(paths_[0], name_);
  const auto differ = [&]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    return make_error(ErrorCode::kBadFile, "{}: {}", place(path, name_),
                      fmt::format(format, std::forward<Args>(args)...));
  };
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
  if (const auto difference = difference_of_meaning(h, header_, first)) return differ("{}", *difference);
  if (states_color_space(h) != states_color_space(header_) && space_assumed_of_.empty()) {
    space_assumed_of_ = states_color_space(h) ? paths_[0] : path;
  }
  return {};
}

/// The least window that holds all of them becomes that of the average.
Result<void> AverageInputs::unite() {
  PixelWindow all = windows_[0];
  for (const PixelWindow& one : windows_) {
    crops_ = crops_ || one != all;
    all = {std::min(all.x0, one.x0), std::min(all.y0, one.y0), std::max(all.x1, one.x1),
           std::max(all.y1, one.y1)};
  }
  const std::int64_t width = std::int64_t{all.x1} - all.x0;
  const std::int64_t height = std::int64_t{all.y1} - all.y0;
  if (std::max(width, height) > PartHeader::kMaxSide) {
    return make_error(ErrorCode::kBadFile, "the data windows from {} to {} span {} x {} pixels, at most {}",
                      paths_.front(), paths_.back(), width, height, PartHeader::kMaxSide);
  }
  header_ = header_.with_data_window(all);
  return {};
}

PixelWindow AverageInputs::window(std::size_t input) const {
  const PixelWindow& own = windows_[input];
  const PixelWindow& all = header_.data_window();
  return {own.x0 - all.x0, own.y0 - all.y0, own.x1 - all.x0, own.y1 - all.y0};
}

bool AverageInputs::is_as_before(const ExrInput& again, std::size_t input) const {
  if (again.parts() != parts_) return false;
  const PartHeader& h = again.header(part_[input]);
  if (h.deep() || h.data_window() != windows_[input]) return false;
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
  if (input < open_.size()) return fill_strip(*open_[input], part_[input], planes_, strip);
  SPECTILE_ASSIGN(auto again, open_one(input));
  if (!is_as_before(*again, input)) {
    return make_error(ErrorCode::kBadFile, "{}: is not any more what it was", paths_[input]);
  }
  return fill_strip(*again, part_[input], planes_, strip);
}

}  // namespace spectile::io
