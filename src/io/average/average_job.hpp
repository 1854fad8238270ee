// AverageJob: the images of an average as a job, whose strips are exact sums.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <spectile/image/average.hpp>
#include <string>
#include <vector>

#include "src/io/average/average_inputs.hpp"
#include "src/io/average/average_strip.hpp"
#include "src/io/convert/frame/conversion.hpp"

namespace spectile::io {

class AverageJob : public LineJob {
 public:
  /// All but the weights must outlive it.
  AverageJob(AverageInputs& inputs, const AverageOptions& options, exact::Weights weights,
             const kernels::KernelTable& kernels);

  std::vector<ChannelSpec> channels() const;

  /// Lines worth a strip: whole chunks of every image, some 4 MiB of sums, which caches hold.
  int strip_lines(int at_least) const override;
  Result<void> prepare(const ExrWriter& writer, std::size_t slots) override;
  /// The options' progress function as several threads may call it, to stop soon between two images too.
  bool carry_on(const Progress& progress);
  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override;
  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override;

  /// The error for the first image that has pixels which are not finite.
  std::optional<Error> refusal(const LineStats& stats);
  /// Notes on channels that are not averaged, and on windows that differ, once all is done.
  std::vector<std::string> notes() const;

 private:
  /// Work space of one slot.
  struct Work {
    std::vector<double> averages;
    FloatBuffer floats;
    FloatBuffer halves;
    std::vector<char> clamped;
  };
  bool ask() const { return !options_.progress || options_.progress(progress_); }
  Result<void> add_image(std::size_t i, AverageStrip& sums);
  void store(Work& work, SampleType type, std::byte* out);

  AverageInputs& inputs_;
  const AverageOptions& options_;
  const kernels::KernelTable& kernels_;
  AveragePlan plan_;
  std::vector<std::size_t> read_;  // images whose weight is not 0
  const ExrWriter* writer_ = nullptr;
  std::vector<ChannelSpec> channels_;
  std::vector<Work> works_;
  std::atomic<std::uint64_t> uncovered_ = 0;  // pixels
  std::mutex mutex_;                          // for what follows
  std::vector<PixelCount> nonfinite_;
  Progress progress_;
};

}  // namespace spectile::io
