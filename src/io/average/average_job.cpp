// AverageJob: the images of an average as a job, whose strips are exact sums.
#include "src/io/average/average_job.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile::io {

AverageJob::AverageJob(AverageInputs& inputs, const AverageOptions& options, exact::Weights weights,
                       const kernels::KernelTable& kernels)
    : inputs_(inputs), options_(options), kernels_(kernels), nonfinite_(inputs.count()) {
  plan_.planes = inputs.planes();
  plan_.width = inputs.header().width();
  const std::vector<std::string> ids = inputs.header().object_ids();
  for (const PlaneSpec& plane : plan_.planes) {
    plan_.depths.push_back(exact::depth_for(plane.type == SampleType::kHalf, weights));
    plan_.kept.push_back(std::find(ids.begin(), ids.end(), plane.name) != ids.end());
  }
  for (std::size_t i = 0; i < inputs.count(); ++i) {
    if (weights.units[i] == 0) continue;
    read_.push_back(i);
    plan_.windows.push_back(inputs.window(i));
  }
  plan_.weights = std::move(weights);
}

std::vector<ChannelSpec> AverageJob::channels() const {
  std::vector<ChannelSpec> out;
  for (std::size_t i = 0; i < plan_.planes.size(); ++i) {
    const PlaneSpec& plane = plan_.planes[i];
    out.push_back({plane.name, options_.stored && !plan_.kept[i] ? *options_.stored : plane.type});
  }
  return out;
}

int AverageJob::strip_lines(int at_least) const {
  constexpr std::size_t kStripBytes = std::size_t{4} << 20;
  const int unit = std::max(inputs_.chunk_lines(), at_least);
  const auto fitting = static_cast<int>(std::min<std::size_t>(kStripBytes / plan_.line_bytes(), 256));
  return std::clamp(fitting / unit * unit, std::min(unit, inputs_.header().height()),
                    inputs_.header().height());
}

Result<void> AverageJob::prepare(const ExrWriter& writer, std::size_t slots) {
  writer_ = &writer;
  channels_ = channels();
  const auto width = static_cast<std::size_t>(plan_.width);
  const std::size_t padded = blocks_for(width) * kLanesPerBlock;
  for (std::size_t i = 0; i < slots; ++i) {
    Work work;
    SPECTILE_ASSIGN(work.floats, FloatBuffer::create(padded));
    SPECTILE_ASSIGN(work.halves, FloatBuffer::create(padded / 2));
    std::fill_n(work.floats.data(), padded, 0.0F);
    work.averages.resize(width);
    work.clamped.resize(width);
    works_.push_back(std::move(work));
  }
  return {};
}

bool AverageJob::carry_on(const Progress& progress) {
  const std::scoped_lock lock(mutex_);
  progress_ = progress;
  return ask();
}

Result<std::shared_ptr<Strip>> AverageJob::read(int first_line, int lines) {
  SPECTILE_ASSIGN(auto sums, AverageStrip::create(plan_, first_line, lines));
  std::vector<Result<void>> results(read_.size());
  // Which image is the first that failed: those after it need not be read any more, those before it must
  // be, so that the error is the same every time.
  std::atomic<std::size_t> failed = read_.size();
  const auto one = [&](std::size_t i) {
    if (i > failed) return;
    results[i] = add_image(i, *sums);
    std::size_t seen = failed;
    while (!results[i] && i < seen && !failed.compare_exchange_weak(seen, i)) {
    }
  };
  tiles::for_blocks(read_.size(), {options_.threads, kLanesPerBlock},
                    [&](std::size_t first, std::size_t count) {
                      for (std::size_t i = first; i < first + count; ++i) one(i);
                    });
  if (failed < read_.size()) return results[failed].error();
  return std::shared_ptr<Strip>(std::move(sums));
}

void AverageJob::line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) {
  const auto& sums = static_cast<const AverageStrip&>(strip);
  Work& work = works_[slot];
  sums.count_nonfinite(line, stats.nonfinite);
  if (packed == nullptr) return;
  uncovered_ += sums.uncovered(line);
  const auto width = static_cast<std::size_t>(plan_.width);
  std::fill(work.clamped.begin(), work.clamped.end(), 0);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    std::byte* const out = packed + writer_->channel_offset(i);
    if (plan_.kept[i]) {
      std::memcpy(out, strip.row(i, line), width * plan_.pixel_bytes(i));
      continue;
    }
    sums.averages(i, line, work.averages.data());
    store(work, channels_[i].type, out);
  }
  stats.clamped += static_cast<std::uint64_t>(std::count(work.clamped.begin(), work.clamped.end(), 1));
}

std::optional<Error> AverageJob::refusal(const LineStats& stats) {
  if (options_.nonfinite != NonFinite::kStop || stats.nonfinite.count == 0) return {};
  const std::scoped_lock lock(mutex_);
  const auto found =
      std::find_if(nonfinite_.begin(), nonfinite_.end(), [](const auto& count) { return count.count > 0; });
  return stopped_at(inputs_.path(static_cast<std::size_t>(found - nonfinite_.begin())), ErrorCode::kNonFinite,
                    "non-finite", *found, "--nonfinite zero leaves their samples out");
}

std::vector<std::string> AverageJob::notes() const {
  std::vector<std::string> out;
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < plan_.planes.size(); ++i) {
    if (plan_.kept[i]) kept.push_back(plan_.planes[i].name);
  }
  if (!kept.empty() && read_.size() > 1) {
    out.push_back(fmt::format("{} {} objects and {} not averaged: {} of {}", fmt::join(kept, ", "),
                              kept.size() == 1 ? "names" : "name", kept.size() == 1 ? "is" : "are",
                              kept.size() == 1 ? "it is that" : "they are those", inputs_.path(read_[0])));
  }
  if (!inputs_.space_assumed_of().empty()) {
    out.push_back(
        fmt::format("{} names no colour space; that of the others is assumed", inputs_.space_assumed_of()));
  }
  if (!inputs_.crops()) return out;
  const PixelWindow& all = inputs_.header().data_window();
  out.push_back(
      fmt::format("data windows differ: put together to {},{} to {},{}, a pixel in several is "
                  "their average",
                  all.x0, all.y0, all.x1 - 1, all.y1 - 1));
  if (const std::uint64_t count = uncovered_; count > 0) {
    out.push_back(fmt::format("{} pixel{} in no image: 0", count, count == 1 ? " is" : "s are"));
  }
  return out;
}

Result<void> AverageJob::add_image(std::size_t i, AverageStrip& sums) {
  const std::size_t input = read_[i];
  {
    const std::scoped_lock lock(mutex_);
    if (!ask()) return make_error(ErrorCode::kCancelled, "stopped on request");
  }
  const AverageStrip::Lines needed = sums.lines_of(i);
  std::shared_ptr<Strip> samples;
  if (needed.lines > 0) {
    SPECTILE_ASSIGN(samples, make_strip(plan_.planes, plan_.windows[i].width(), needed.first, needed.lines));
    SPECTILE_TRY(inputs_.fill(input, *samples));
  }
  SPECTILE_ASSIGN(const auto nonfinite, sums.add(samples.get(), plan_.weights.units[input], i, kernels_));
  const std::scoped_lock lock(mutex_);
  nonfinite_[input].add(nonfinite);
  return {};
}

void AverageJob::store(Work& work, SampleType type, std::byte* out) {
  const std::size_t width = work.averages.size();
  float* const floats = work.floats.data();
  const bool half = type != SampleType::kFloat;
  for (std::size_t x = 0; x < width; ++x) {
    floats[x] = static_cast<float>(work.averages[x]);
    if (!half) continue;
    const float value = exact::to_odd_float(work.averages[x]);
    if (std::fabs(value) > kernels::kHalfMax) work.clamped[x] = 1;
    floats[x] = std::clamp(value, -kernels::kHalfMax, kernels::kHalfMax);
  }
  store_row(kernels_, floats, width, type, work.halves.data(), out);
}

}  // namespace spectile::io
