// AverageStrip: a run of lines of exact sums, to which images are added side by side.
#include "src/io/average/average_strip.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

// Prime to the usual heights of strips, and more lines than threads drift apart while they add.
constexpr std::size_t kLinesApart = 7;

std::size_t padded(const AveragePlan& plan) {
  return blocks_for(static_cast<std::size_t>(plan.width)) * kLanesPerBlock;
}

}  // namespace

std::size_t AveragePlan::pixel_bytes(std::size_t plane) const {
  if (kept[plane]) return planes[plane].sample_bytes();
  return exact::words(depths[plane]) * sizeof(std::uint64_t);
}

std::size_t AveragePlan::line_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) bytes += pixel_bytes(i) + 1;
  return bytes * padded(*this);
}

Result<std::shared_ptr<AverageStrip>> AverageStrip::create(const AveragePlan& plan, int first_line,
                                                           int lines) {
  std::shared_ptr<AverageStrip> strip(new AverageStrip(plan));
  strip->first_line = first_line;
  strip->lines = lines;
  const auto rows = static_cast<std::size_t>(lines);
  for (std::size_t i = 0; i < plan.planes.size(); ++i) {
    const std::size_t stride = plan.pixel_bytes(i) * padded(plan);
    SPECTILE_ASSIGN(auto sums, FloatBuffer::create(stride * rows / sizeof(float)));
    std::memset(sums.data(), 0, stride * rows);
    strip->planes.push_back(std::move(sums));
    strip->stride_bytes.push_back(stride);
  }
  const std::size_t bytes = plan.planes.size() * rows * padded(plan);
  SPECTILE_ASSIGN(strip->flags_, FloatBuffer::create(bytes / sizeof(float)));
  std::memset(strip->flags_.data(), 0, bytes);
  strip->lines_ = std::vector<Line>(rows);
  return strip;
}

std::uint8_t* AverageStrip::flags(std::size_t plane, int line) const {
  const std::size_t row =
      plane * static_cast<std::size_t>(lines) + static_cast<std::size_t>(line - first_line);
  return reinterpret_cast<std::uint8_t*>(const_cast<float*>(flags_.data())) + row * padded(plan_);
}

std::uint64_t* AverageStrip::sums(std::size_t plane, int line) {
  return reinterpret_cast<std::uint64_t*>(Strip::row(plane, line));
}

AverageStrip::Lines AverageStrip::lines_of(std::size_t image) const {
  const PixelWindow& window = plan_.windows[image];
  const int first = std::max(first_line, window.y0);
  const int end = std::min(first_line + lines, window.y1);
  return {first - window.y0, std::max(end - first, 0)};
}

Result<PixelCount> AverageStrip::add(const Strip* samples, exact::Wide units, std::size_t image,
                                     const kernels::KernelTable& kernels) {
  const PixelWindow& window = plan_.windows[image];
  const std::size_t own = blocks_for(static_cast<std::size_t>(window.width())) * kLanesPerBlock;
  SPECTILE_ASSIGN(auto row, FloatBuffer::create(own));
  std::vector<char> bad(static_cast<std::size_t>(window.width()));
  // Images that are added side by side begin at different lines, not to wait for each other at every one.
  std::vector<PixelCount> nonfinite(static_cast<std::size_t>(lines));
  for (int i = 0; i < lines; ++i) {
    const int at = static_cast<int>((static_cast<std::size_t>(i) + image * kLinesApart) % nonfinite.size());
    const int line = first_line + at;
    if (line < window.y0 || line >= window.y1) {
      leave_out(line, units, 0, plan_.width);
      continue;
    }
    keep_line(*samples, line, image);
    leave_out(line, units, 0, window.x0);
    leave_out(line, units, window.x1, plan_.width);
    if (add_line(*samples, line, units, image, row.data(), bad, kernels)) continue;
    const auto from = std::find(bad.begin(), bad.end(), 1);
    nonfinite[static_cast<std::size_t>(at)].add(static_cast<std::uint64_t>(std::count(from, bad.end(), 1)),
                                                static_cast<int>(from - bad.begin()), line - window.y0);
    std::fill(bad.begin(), bad.end(), 0);
  }
  PixelCount out;
  for (const PixelCount& count : nonfinite) out.add(count);
  return out;
}

/// Takes units off the weights' total for the pixels from..to - 1, which an image does not cover.
void AverageStrip::leave_out(int line, exact::Wide units, int from, int to) {
  if (from >= to) return;
  Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  const std::scoped_lock lock(state.adding);
  state.outside.resize(static_cast<std::size_t>(plan_.width));
  for (int x = from; x < to; ++x) state.outside[static_cast<std::size_t>(x)] += units;
}

/// Adds the numbers that can be averaged; false when some are not finite, which `bad` then marks.
bool AverageStrip::add_line(const Strip& samples, int line, exact::Wide units, std::size_t image, float* row,
                            std::vector<char>& bad, const kernels::KernelTable& kernels) {
  const PixelWindow& window = plan_.windows[image];
  const auto left = static_cast<std::size_t>(window.x0);
  const std::size_t pixels = bad.size();
  Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  const std::scoped_lock lock(state.adding);
  bool all_finite = true;
  for (std::size_t plane = 0; plane < plan_.planes.size(); ++plane) {
    if (plan_.kept[plane]) continue;
    const std::byte* const from = samples.row(plane, line - window.y0);
    const float* values = reinterpret_cast<const float*>(from);
    if (plan_.planes[plane].type == SampleType::kHalf) {
      kernels.half_to_float(row, reinterpret_cast<const std::uint16_t*>(from),
                            blocks_for(pixels) * kLanesPerBlock);
      values = row;
    }
    std::uint64_t* const to = sums(plane, line) + left * exact::words(plan_.depths[plane]);
    if (exact::add_row(plan_.depths[plane], to, flags(plane, line) + left, values, pixels, units)) {
      continue;
    }
    all_finite = false;
    state.missing = true;
    state.units.resize(plan_.planes.size());
    state.units[plane].resize(static_cast<std::size_t>(plan_.width));
    exact::add_missing(state.units[plane].data() + left, values, pixels, units);
    for (std::size_t x = 0; x < pixels; ++x) bad[x] = bad[x] != 0 || !std::isfinite(values[x]) ? 1 : 0;
  }
  return all_finite;
}

/// Keeps the samples that are not averaged where this is the first image that covers a pixel, so that no two
/// write to the same.
void AverageStrip::keep_line(const Strip& samples, int line, std::size_t image) {
  if (std::none_of(plan_.kept.begin(), plan_.kept.end(), [](bool kept) { return kept; })) return;
  const PixelWindow& window = plan_.windows[image];
  std::vector<char> taken(static_cast<std::size_t>(window.width()));
  for (std::size_t before = 0; before < image; ++before) {
    const PixelWindow& other = plan_.windows[before];
    if (line < other.y0 || line >= other.y1) continue;
    const int from = std::clamp(other.x0, window.x0, window.x1) - window.x0;
    const int to = std::clamp(other.x1, window.x0, window.x1) - window.x0;
    std::fill(taken.begin() + from, taken.begin() + to, 1);
    if (to - from == window.width()) return;
  }
  for (std::size_t plane = 0; plane < plan_.planes.size(); ++plane) {
    if (!plan_.kept[plane]) continue;
    const std::size_t bytes = plan_.pixel_bytes(plane);
    const std::byte* const from = samples.row(plane, line - window.y0);
    std::byte* const to = Strip::row(plane, line) + static_cast<std::size_t>(window.x0) * bytes;
    for (std::size_t x = 0; x < taken.size(); ++x) {
      if (taken[x] == 0) std::memcpy(to + x * bytes, from + x * bytes, bytes);
    }
  }
}

void AverageStrip::averages(std::size_t plane, int line, double* averages) const {
  const Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  const exact::Wide* missing = nullptr;
  std::vector<exact::Wide> both;
  if (state.missing && !state.units[plane].empty()) missing = state.units[plane].data();
  if (!state.outside.empty()) {
    both = state.outside;
    for (std::size_t x = 0; missing != nullptr && x < both.size(); ++x) both[x] += missing[x];
    missing = both.data();
  }
  exact::finish_row(plan_.depths[plane], averages,
                    reinterpret_cast<const std::uint64_t*>(Strip::row(plane, line)), flags(plane, line),
                    missing, static_cast<std::size_t>(plan_.width), plan_.weights.total);
}

std::uint64_t AverageStrip::uncovered(int line) const {
  const Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  return static_cast<std::uint64_t>(
      std::count(state.outside.begin(), state.outside.end(), plan_.weights.total));
}

void AverageStrip::count_nonfinite(int line, PixelCount& count) const {
  const Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  if (!state.missing) return;
  const auto has_none = [&](int x) {
    for (std::size_t plane = 0; plane < plan_.planes.size(); ++plane) {
      if ((flags(plane, line)[x] & exact::kMissing) != 0) return false;
    }
    return true;
  };
  for (int x = 0; x < plan_.width; ++x) {
    if (!has_none(x)) count.add(1, x, line);
  }
}

}  // namespace spectile::io
