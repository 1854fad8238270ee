// Mip levels: an output's smaller levels, filtered from what its job makes of the input, in bounded memory.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "src/io/convert/frame/conversion.hpp"
#include "src/io/exr/exr_writer.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// A job whose output can have mip levels: it says what of a line is averaged, and packs the averages.
class FilteredJob : public LineJob {
 public:
  /// All planes of its strips.
  virtual std::vector<PlaneSpec> strip_planes() const = 0;
  /// A sample of a plane of its strips where there is no pixel; of floats, where it is not 0.
  virtual float padding(std::size_t /*plane*/) const { return 0; }
  /// Planes of its strips that pass through, in the order of the level's strips, where they come first.
  virtual std::vector<std::pair<std::size_t, PlaneSpec>> passing() const = 0;
  /// Rows of floats that are averaged, which come after them. Asked for when level 0 is complete.
  virtual std::size_t filtered_rows() const = 0;
  /// Makes these rows of a line of the whole width; readable, and written, up to whole blocks of lanes. The
  /// slots are beyond those of line().
  virtual void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) = 0;
  /// Packs a line of a level's strip.
  virtual void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) = 0;
  FilteredJob* filtered() override { return this; }
};

/// Slots that a job needs for filter_rows() beyond those of the conversion.
std::size_t filter_slots(const ImageOptions& options);

/// Names of the planes that pass through whose samples name objects of `source`: they are not averaged, the
/// pixel nearest to the centre of a level's is taken.
std::vector<std::string> nearest_channels(const FilteredJob& job, const PartHeader& source);

/// The tiles that options ask for: mip levels come in tiles, of 64 x 64 where no others are asked for.
std::optional<std::array<int, 2>> tiles_of(const ImageOptions& options);

/// Writes all levels but the first, each in another pass over the job's strips, but for the last ones, which
/// are made together in one pass as soon as they fit into memory. `nearest`: channels that are not averaged.
/// Errors: those of run_conversion().
Result<void> write_levels(FilteredJob& job, ExrWriter& writer, std::size_t slots, int strip_lines,
                          const ImageOptions& options, const std::vector<std::string>& nearest);

}  // namespace spectile::io
