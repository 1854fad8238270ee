// ColorJob: what the jobs share whose output is a colour, with the channels that pass through beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <spectile/image/image.hpp>
#include <utility>
#include <vector>

#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/sources/image_source.hpp"
#include "src/io/convert/stages/color_rows.hpp"

namespace spectile::io {

class ColorJob : public FilteredJob {
 public:
  /// Of the source's planes, those from `first_passing` on pass through, but for names that the colour has.
  /// All references must outlive it.
  /// `names`: the colour's channels, one or three.
  ColorJob(ImageSource& source, std::size_t first_passing, const std::vector<const char*>& names,
           const ImageOptions& options, const kernels::KernelTable& kernels);

  /// Output channels: the colour, then those that pass through.
  const std::vector<ChannelSpec>& channels() const noexcept { return channels_; }

  Result<void> prepare(const ExrWriter& writer, std::size_t slots) final;
  int strip_lines(int chunk_lines) const final { return source_.strip_lines(chunk_lines); }
  Result<std::shared_ptr<Strip>> read(int first_line, int lines) final {
    return source_.read(first_line, lines);
  }
  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) final;
  std::vector<PlaneSpec> strip_planes() const final { return source_.planes(); }
  std::vector<std::pair<std::size_t, PlaneSpec>> passing() const final;
  std::size_t filtered_rows() const final { return colors_; }
  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) final;
  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) final;

 protected:
  /// Floats of work space for spectra that each slot needs, for lines of so many pixels.
  virtual std::size_t spectra_floats(std::size_t width) const = 0;
  float* spectra(std::size_t slot) noexcept { return works_[slot].spectra.data(); }

  /// Makes the colours of a line in the first rows of `color`, whose width is set. With `checks_only`, what
  /// `stats` needs is enough.
  virtual void make_colors(std::size_t slot, const Strip& strip, int line, ColorLine& color, LineStats& stats,
                           bool checks_only) = 0;

  const kernels::KernelTable& kernels() const noexcept { return kernels_; }

 private:
  struct Work {
    ColorLine color;
    FloatBuffer halves;
    FloatBuffer spectra;
  };
  std::uint64_t pack_colors(Work& work, std::size_t width, std::byte* packed) const;
  void pass(const Strip& strip, std::size_t plane, int line, std::size_t channel, std::byte* packed) const;

  ImageSource& source_;
  const ImageOptions& options_;
  const kernels::KernelTable& kernels_;
  const ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
  std::size_t colors_ = 0;
  std::vector<ChannelSpec> channels_;
  std::vector<std::size_t> passing_;  // source planes, of the channels after the colours
};

}  // namespace spectile::io
