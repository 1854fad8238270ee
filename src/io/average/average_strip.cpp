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

std::size_t sum_bytes(const AveragePlan& plan, std::size_t plane) {
  if (plan.planes[plane].type == SampleType::kUint32) return sizeof(std::uint32_t);
  return exact::words(plan.depths[plane]) * sizeof(std::uint64_t);
}

std::size_t padded(const AveragePlan& plan) {
  return blocks_for(static_cast<std::size_t>(plan.width)) * kLanesPerBlock;
}

}  // namespace

std::size_t AveragePlan::line_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) bytes += sum_bytes(*this, i) + 1;
  return bytes * padded(*this);
}

Result<std::shared_ptr<AverageStrip>> AverageStrip::create(const AveragePlan& plan, int first_line,
                                                           int lines) {
  std::shared_ptr<AverageStrip> strip(new AverageStrip(plan));
  strip->first_line = first_line;
  strip->lines = lines;
  const auto rows = static_cast<std::size_t>(lines);
  for (std::size_t i = 0; i < plan.planes.size(); ++i) {
    const std::size_t stride = sum_bytes(plan, i) * padded(plan);
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

Result<Added> AverageStrip::add(const Strip& samples, exact::Wide units, std::size_t image,
                                const kernels::KernelTable& kernels) {
  SPECTILE_ASSIGN(auto row, FloatBuffer::create(padded(plan_)));
  std::vector<char> bad(static_cast<std::size_t>(plan_.width));
  Added added;
  for (int line = first_line; line < first_line + lines; ++line) {
    for (std::size_t plane = 0; plane < plan_.planes.size(); ++plane) {
      if (plan_.planes[plane].type != SampleType::kUint32 || added.difference) continue;
      added.difference = match_integers(samples, plane, line, image == 0);
    }
  }
  // Images that are added side by side begin at different lines, not to wait for each other at every one.
  std::vector<PixelCount> nonfinite(static_cast<std::size_t>(lines));
  for (int i = 0; i < lines; ++i) {
    const int at = static_cast<int>((static_cast<std::size_t>(i) + image * kLinesApart) % nonfinite.size());
    if (add_line(samples, first_line + at, units, row.data(), bad, kernels)) continue;
    const auto from = std::find(bad.begin(), bad.end(), 1);
    nonfinite[static_cast<std::size_t>(at)].add(static_cast<std::uint64_t>(std::count(from, bad.end(), 1)),
                                                static_cast<int>(from - bad.begin()), first_line + at);
    std::fill(bad.begin(), bad.end(), 0);
  }
  for (const PixelCount& count : nonfinite) added.nonfinite.add(count);
  return added;
}

/// Adds the numbers that can be averaged; false when some are not finite, which `bad` then marks.
bool AverageStrip::add_line(const Strip& samples, int line, exact::Wide units, float* row,
                            std::vector<char>& bad, const kernels::KernelTable& kernels) {
  const auto pixels = static_cast<std::size_t>(plan_.width);
  Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  const std::scoped_lock lock(state.adding);
  bool all_finite = true;
  for (std::size_t plane = 0; plane < plan_.planes.size(); ++plane) {
    const SampleType type = plan_.planes[plane].type;
    if (type == SampleType::kUint32) continue;
    const std::byte* const from = samples.row(plane, line);
    const float* values = reinterpret_cast<const float*>(from);
    if (type == SampleType::kHalf) {
      kernels.half_to_float(row, reinterpret_cast<const std::uint16_t*>(from), padded(plan_));
      values = row;
    }
    if (exact::add_row(plan_.depths[plane], sums(plane, line), flags(plane, line), values, pixels, units)) {
      continue;
    }
    all_finite = false;
    state.missing = true;
    state.units.resize(plan_.planes.size());
    state.units[plane].resize(pixels);
    exact::add_missing(state.units[plane].data(), values, pixels, units);
    for (std::size_t x = 0; x < pixels; ++x) bad[x] = bad[x] != 0 || !std::isfinite(values[x]) ? 1 : 0;
  }
  return all_finite;
}

/// Keeps the first image's integers, or compares another's with them.
std::optional<Difference> AverageStrip::match_integers(const Strip& samples, std::size_t plane, int line,
                                                       bool first) {
  const auto pixels = static_cast<std::size_t>(plan_.width);
  auto* const kept = reinterpret_cast<std::uint32_t*>(Strip::row(plane, line));
  const auto* const here = reinterpret_cast<const std::uint32_t*>(samples.row(plane, line));
  if (first) {
    std::copy_n(here, pixels, kept);
    return {};
  }
  const auto [at, other] = std::mismatch(here, here + pixels, kept);
  if (at == here + pixels) return {};
  return Difference{plane, static_cast<int>(at - here), line, *at, *other};
}

void AverageStrip::averages(std::size_t plane, int line, double* averages) const {
  const Line& state = lines_[static_cast<std::size_t>(line - first_line)];
  const bool missing = state.missing && !state.units[plane].empty();
  exact::finish_row(plan_.depths[plane], averages,
                    reinterpret_cast<const std::uint64_t*>(Strip::row(plane, line)), flags(plane, line),
                    missing ? state.units[plane].data() : nullptr, static_cast<std::size_t>(plan_.width),
                    plan_.weights.total);
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
