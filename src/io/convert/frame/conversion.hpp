// Conversion: the streaming frame common to every image-to-image job.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <spectile/image/image.hpp>
#include <string>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/convert/frame/line_stats.hpp"
#include "src/io/exr/exr_writer.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

class FilteredJob;

/// One job's own part of a conversion.
class LineJob {
 public:
  virtual ~LineJob() = default;
  /// Makes work spaces for so many slots, those of filter_rows() among them. The writer must outlive the job.
  /// Errors: kOutOfMemory.
  virtual Result<void> prepare(const ExrWriter& writer, std::size_t slots) = 0;
  /// Lines worth reading at once, given those of the output's chunks; fewer than those where they are too
  /// large.
  virtual int strip_lines(int chunk_lines) const = 0;
  /// Reads lines into a strip; in order, one call at a time.
  virtual Result<std::shared_ptr<Strip>> read(int first_line, int lines) = 0;
  /// Makes one line of a strip, which may be a tile and have less pixels a line than the image: with
  /// `packed`, the whole output line; without, only what `stats` needs. `slot` tells
  /// which of the job's work spaces to use; calls with different slots run side by side.
  virtual void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) = 0;
  /// True if lines whose samples in the strip are the same become the same: then chunks of such lines are
  /// encoded once, as far as they are remembered.
  virtual bool repeats() const { return false; }
  /// Itself, where its output can have mip levels.
  virtual FilteredJob* filtered() { return nullptr; }
};

/// A job whose lines are in memory: nothing is read, and each slot has a row of floats to work in.
class MemoryJob : public LineJob {
 public:
  /// `row_floats`: of a slot's row, zeros at first.
  explicit MemoryJob(std::size_t row_floats) : row_floats_(row_floats) {}
  Result<void> prepare(const ExrWriter& writer, std::size_t slots) override;
  int strip_lines(int /*chunk_lines*/) const override { return writer_->height(); }
  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override;

 protected:
  const ExrWriter& writer() const noexcept { return *writer_; }
  float* row(std::size_t slot) noexcept { return rows_[slot].data(); }

 private:
  std::size_t row_floats_;
  const ExrWriter* writer_ = nullptr;
  std::vector<FloatBuffer> rows_;
};

/// Slots (and so encoders) that a conversion runs with.
std::size_t slot_count(const ImageSpec& spec, int width, int threads);

/// Streams a job's lines through the encoders into the present level of the writer's file.
/// `stop_at` is true if what was found so far forbids an output; then the rest is only counted, and the file
/// must not be committed.
/// Errors: from reading and writing, kCancelled.
Result<LineStats> run_conversion(LineJob& job, ExrWriter& writer, std::size_t slots, int strip_lines,
                                 const ImageOptions& options,
                                 const std::function<bool(const LineStats&)>& stop_at);

/// Chunks first to end - 1 of the present level.
struct ChunkRange {
  int first = 0;
  int end = 0;
};

/// The same for some chunks of a job whose lines are in memory, so that an image can be written bit by bit.
Result<LineStats> run_chunks(LineJob& job, ExrWriter& writer, ChunkRange range, std::size_t slots,
                             const ImageOptions& options,
                             const std::function<bool(const LineStats&)>& stop_at);

/// The error for a conversion that stopped at pixels it may not convert; `what` is "non-finite" or
/// "negative".
Error stopped_at(const std::string& path, ErrorCode code, const char* what, const PixelCount& found,
                 const char* remedy);

}  // namespace spectile::io
