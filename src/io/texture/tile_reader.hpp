// TileReader: the mip levels of a texture's file, and their texels tile by tile.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/texture/texels.hpp"

namespace spectile::io {

/// Where a texture's tiles come from.
class TileSource {
 public:
  virtual ~TileSource() = default;
  /// A row of kTextureLevelRow numbers for each mip level.
  const std::vector<std::int32_t>& levels() const noexcept { return levels_; }
  std::size_t tiles() const noexcept { return tiles_; }
  const TexelFormat& format() const noexcept { return format_; }

  using Take = std::function<Result<void>(std::int32_t tile, FloatBuffer texels)>;
  /// Hands over a tile, and others that come with it, no more than `max_tiles`. Shapes: texels
  /// [64][64][floats], undefined beyond the level's edges. Errors: kBadFile, kOutOfMemory; those of `take`.
  virtual Result<void> read(std::int32_t tile, std::size_t max_tiles, const Take& take) = 0;

 protected:
  TileSource() = default;
  void add_level(LevelSize size);
  TexelFormat format_;
  std::vector<std::int32_t> levels_;
  std::size_t tiles_ = 0;
};

/// Decodes whole tiles, or runs of lines, of the file, and makes tiles of 64 x 64 texels of them, those at
/// the right and lower edges smaller. Not thread-safe.
class TileReader : public TileSource {
 public:
  /// Errors: kBadFile; those of dispatch::active().
  static Result<std::unique_ptr<TileReader>> create(std::unique_ptr<ExrInput> input, int part,
                                                    TexelFormat format);

  Result<void> read(std::int32_t tile, std::size_t max_tiles, const Take& take) override;

 private:
  TileReader() = default;
  /// Tiles x0 to x1 of the rows y0 to y1 of a level, none of the last ones included.
  struct Range {
    int level;
    int width, height;  // of the level
    int x0, x1, y0, y1;
  };
  /// Lines of a strip, whose first pixel is at x.
  struct Window {
    int x, width;
    int y, lines;
  };
  Range range_of(std::int32_t tile, std::size_t max_tiles) const;
  int decoded_lines() const;
  Window decoded(const Range& range, int y) const;
  Result<void> fill(const Range& range, const Window& window, Strip& strip);
  void copy_lines(const Strip& strip, const Window& window, const Range& range, int x, int y, float* texels);

  std::unique_ptr<ExrInput> input_;
  const kernels::KernelTable* kernels_ = nullptr;
  int part_ = 0;
  FloatBuffer samples_;  // [planes][64]
};

}  // namespace spectile::io
