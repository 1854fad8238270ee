// average_images: renders of one frame become their weighted average, strip by strip.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <spectile/image/average.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/average/average_inputs.hpp"
#include "src/io/average/average_strip.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// Work space of one slot.
struct Work {
  std::vector<double> averages;
  FloatBuffer floats;
  FloatBuffer halves;
  std::vector<char> clamped;
};

class AverageJob : public io::LineJob {
 public:
  AverageJob(io::AverageInputs& inputs, const AverageOptions& options, exact::Weights weights,
             const kernels::KernelTable& kernels)
      : inputs_(inputs), options_(options), kernels_(kernels), nonfinite_(inputs.count()) {
    plan_.planes = inputs.planes();
    plan_.width = inputs.header().width();
    for (const io::PlaneSpec& plane : plan_.planes) {
      plan_.depths.push_back(exact::depth_for(plane.type == SampleType::kHalf, weights));
      has_whole_ = has_whole_ || plane.type == SampleType::kUint32;
    }
    for (std::size_t i = 0; i < inputs.count(); ++i) {
      if (weights.units[i] != 0) read_.push_back(i);
    }
    plan_.weights = std::move(weights);
  }

  std::vector<io::ChannelSpec> channels() const {
    std::vector<io::ChannelSpec> out;
    for (const io::PlaneSpec& plane : plan_.planes) {
      SampleType type = plane.type;
      if (options_.stored && plane.type != SampleType::kUint32) {
        type = *options_.stored;
      }
      out.push_back({plane.name, type});
    }
    return out;
  }

  /// Lines worth a strip: whole chunks of every image, some 4 MiB of sums, which caches hold.
  int strip_lines(int at_least) const override {
    constexpr std::size_t kStripBytes = std::size_t{4} << 20;
    const int unit = std::max(inputs_.chunk_lines(), at_least);
    const auto fitting = static_cast<int>(std::min<std::size_t>(kStripBytes / plan_.line_bytes(), 256));
    return std::clamp(fitting / unit * unit, std::min(unit, inputs_.header().height()),
                      inputs_.header().height());
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) override {
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

  /// The options' progress function as several threads may call it, to stop soon between two images too.
  bool carry_on(const Progress& progress) {
    const std::scoped_lock lock(mutex_);
    progress_ = progress;
    return ask();
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    SPECTILE_ASSIGN(auto sums, io::AverageStrip::create(plan_, first_line, lines));
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
    // The first image's integers are what the others are compared with.
    const std::size_t alone = has_whole_ ? 1 : 0;
    for (std::size_t i = 0; i < alone; ++i) one(i);
    tiles::for_blocks(read_.size() - alone, {options_.threads, kLanesPerBlock},
                      [&](std::size_t first, std::size_t count) {
                        for (std::size_t i = first; i < first + count; ++i) one(alone + i);
                      });
    if (failed < read_.size()) return results[failed].error();
    return std::shared_ptr<Strip>(std::move(sums));
  }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    const auto& sums = static_cast<const io::AverageStrip&>(strip);
    Work& work = works_[slot];
    sums.count_nonfinite(line, stats.nonfinite);
    if (packed == nullptr) return;
    const auto width = static_cast<std::size_t>(plan_.width);
    std::fill(work.clamped.begin(), work.clamped.end(), 0);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      std::byte* const out = packed + writer_->channel_offset(i);
      if (channels_[i].type == SampleType::kUint32) {
        std::memcpy(out, strip.row(i, line), width * sizeof(std::uint32_t));
        continue;
      }
      sums.averages(i, line, work.averages.data());
      store(work, channels_[i].type, out);
    }
    stats.clamped += static_cast<std::uint64_t>(std::count(work.clamped.begin(), work.clamped.end(), 1));
  }

  /// The error for the first image that has pixels which are not finite.
  std::optional<Error> refusal(const LineStats& stats) {
    if (options_.nonfinite != NonFinite::kStop || stats.nonfinite.count == 0) return {};
    const std::scoped_lock lock(mutex_);
    const auto found =
        std::find_if(nonfinite_.begin(), nonfinite_.end(), [](const auto& count) { return count.count > 0; });
    return io::stopped_at(inputs_.path(static_cast<std::size_t>(found - nonfinite_.begin())),
                          ErrorCode::kNonFinite, "non-finite", *found,
                          "--nonfinite zero leaves their samples out");
  }

 private:
  bool ask() const { return !options_.progress || options_.progress(progress_); }

  Result<void> add_image(std::size_t i, io::AverageStrip& sums) {
    const std::size_t input = read_[i];
    {
      const std::scoped_lock lock(mutex_);
      if (!ask()) return make_error(ErrorCode::kCancelled, "stopped on request");
    }
    SPECTILE_ASSIGN(auto samples, io::make_strip(plan_.planes, plan_.width, sums.first_line, sums.lines));
    SPECTILE_TRY(inputs_.fill(input, *samples));
    SPECTILE_ASSIGN(const auto added, sums.add(*samples, plan_.weights.units[input], i, kernels_));
    if (added.difference) {
      const io::Difference& at = *added.difference;
      return make_error(ErrorCode::kBadFile,
                        "{}: channel \"{}\" is {} at {},{}, but {} in {}; integers cannot be averaged",
                        inputs_.path(input), plan_.planes[at.plane].name, at.here, at.x, at.y, at.first,
                        inputs_.path(read_[0]));
    }
    const std::scoped_lock lock(mutex_);
    nonfinite_[input].add(added.nonfinite);
    return {};
  }

  void store(Work& work, SampleType type, std::byte* out) {
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
    io::store_row(kernels_, floats, width, type, work.halves.data(), out);
  }

  io::AverageInputs& inputs_;
  const AverageOptions& options_;
  const kernels::KernelTable& kernels_;
  io::AveragePlan plan_;
  bool has_whole_ = false;
  std::vector<std::size_t> read_;  // images whose weight is not 0
  const io::ExrWriter* writer_ = nullptr;
  std::vector<io::ChannelSpec> channels_;
  std::vector<Work> works_;
  std::mutex mutex_;  // for what follows
  std::vector<io::PixelCount> nonfinite_;
  Progress progress_;
};

Result<ImageReport> average_files(std::span<const std::string> paths, const std::string& output,
                                  const AverageOptions& options) {
  if (paths.empty()) return make_error(ErrorCode::kBadArgument, "no images to average");
  if (!options.weights.empty() && options.weights.size() != paths.size()) {
    return make_error(ErrorCode::kBadArgument, "{} weights for {} images", options.weights.size(),
                      paths.size());
  }
  SPECTILE_ASSIGN(auto weights,
                  exact::whole_weights(options.weights.empty() ? std::vector<double>(paths.size(), 1.0)
                                                               : options.weights));
  if (options.stored == SampleType::kUint32) {
    return make_error(ErrorCode::kBadArgument, "{}: averages are written as half or float", output);
  }
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(paths, output, options));
  SPECTILE_ASSIGN(auto inputs, io::AverageInputs::open(paths, setup.threads));

  const double sum = weights.sum;
  AverageJob job(*inputs, options, std::move(weights), setup.kernels);
  io::ImageSpec spec;
  spec.source = &inputs->header();
  spec.channels = job.channels();
  spec.replaced = {"spectileAverage"};
  spec.text_attributes.emplace_back(
      "spectileAverage",
      fmt::format("{} image{}, weights' sum {}", paths.size(), paths.size() == 1 ? "" : "s", sum));
  ImageOptions run = options;
  run.progress = [&job](const Progress& progress) { return job.carry_on(progress); };
  const auto refusal = [&job](const LineStats& found) { return job.refusal(found); };
  return io::run_image_job({job, output, std::move(spec), run, refusal, {}});
}

}  // namespace

Result<ImageReport> average_images(std::span<const std::string> inputs, const std::string& output,
                                   const AverageOptions& options) {
  return io::timed(output, [&] { return average_files(inputs, output, options); });
}

}  // namespace spectile
