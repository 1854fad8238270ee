// TileReader: the mip levels of a texture's file, and their texels tile by tile.
#include "src/io/texture/tile_reader.hpp"

#include <algorithm>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/texture/evaluators.hpp"

namespace spectile::io {
namespace {

constexpr int kSide = kernels::kTextureTile;

int tiles_along(int texels) {
  return (texels + kSide - 1) / kSide;
}

}  // namespace

void TileSource::add_level(LevelSize size) {
  const int tiles_x = tiles_along(size.width);
  levels_.insert(levels_.end(), {size.width, size.height, tiles_x, static_cast<std::int32_t>(tiles_)});
  tiles_ += static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_along(size.height));
}

Result<std::unique_ptr<TileReader>> TileReader::create(std::unique_ptr<ExrInput> input, int part,
                                                       TexelFormat format) {
  std::unique_ptr<TileReader> reader(new TileReader);
  SPECTILE_ASSIGN(reader->kernels_, dispatch::active());
  SPECTILE_ASSIGN(const auto levels, input->levels(part));
  for (const LevelSize& level : levels) reader->add_level(level);
  SPECTILE_ASSIGN(reader->samples_, FloatBuffer::create(format.planes.size() * kLanesPerBlock));
  reader->input_ = std::move(input);
  reader->part_ = part;
  reader->format_ = std::move(format);
  return reader;
}

/// Lines of the file that are decoded together.
int TileReader::decoded_lines() const {
  const PartHeader& header = input_->header(part_);
  // Of files whose chunks are single lines some more, as the largest chunk of the common compressions.
  return header.tiles() ? header.tiles()->height : std::max(header.chunk_lines(), 16);
}

TileReader::Range TileReader::range_of(std::int32_t tile, std::size_t max_tiles) const {
  std::size_t row = 0;
  while (row + kernels::kTextureLevelRow < levels_.size() &&
         levels_[row + kernels::kTextureLevelRow + 3] <= tile) {
    row += kernels::kTextureLevelRow;
  }
  const std::int32_t* const level = levels_.data() + row;
  const int columns = level[2];
  const int x = (tile - level[3]) % columns;
  const int y = (tile - level[3]) / columns;
  Range out = {static_cast<int>(row / kernels::kTextureLevelRow), level[0], level[1], 0, columns, y, y + 1};
  // Whole tiles of ours within what the file decodes together: the image's edges count as whole.
  const auto whole = [](int at, int side, int texels, int count, int& first, int& last) {
    const std::int64_t begin = std::int64_t{at} * kSide / side * side;
    const std::int64_t end =
        std::min<std::int64_t>((std::int64_t{at} * kSide + kSide - 1) / side * side + side, texels);
    first = static_cast<int>(std::min<std::int64_t>((begin + kSide - 1) / kSide, at));
    last = end == texels ? count : std::max(static_cast<int>(end / kSide), at + 1);
  };
  const auto& tiles = input_->header(part_).tiles();
  if (tiles) whole(x, tiles->width, out.width, columns, out.x0, out.x1);
  whole(y, decoded_lines(), out.height, tiles_along(out.height), out.y0, out.y1);
  const auto limit = [](int at, int count, int& first, int& last) {
    first = std::clamp(at - count / 2, first, std::max(first, last - count));
    last = std::min(last, first + count);
  };
  limit(x, static_cast<int>(std::clamp<std::size_t>(max_tiles, 1, static_cast<std::size_t>(columns))), out.x0,
        out.x1);
  const std::size_t lines = max_tiles / static_cast<std::size_t>(out.x1 - out.x0);
  limit(y, static_cast<int>(std::clamp<std::size_t>(lines, 1, static_cast<std::size_t>(out.y1 - out.y0))),
        out.y0, out.y1);
  return out;
}

/// The strip that is decoded for line y of the range's tiles.
TileReader::Window TileReader::decoded(const Range& range, int y) const {
  const int unit = decoded_lines();
  const int first = y / unit * unit;
  const int lines = static_cast<int>(std::min<std::int64_t>(unit, std::int64_t{range.height} - first));
  const auto& tiles = input_->header(part_).tiles();
  if (!tiles) return {0, range.width, first, lines};
  const int left = range.x0 * kSide / tiles->width * tiles->width;
  const std::int64_t right =
      (std::int64_t{range.x1} * kSide - 1) / tiles->width * tiles->width + tiles->width;
  return {left, static_cast<int>(std::min<std::int64_t>(right, range.width)) - left, first, lines};
}

Result<void> TileReader::fill(const Range& range, const Window& window, Strip& strip) {
  const auto& tiles = input_->header(part_).tiles();
  if (!tiles) return fill_strip(*input_, part_, format_.planes, strip);
  return fill_tiles(*input_, part_, format_.planes,
                    {window.x / tiles->width, (window.x + window.width - 1) / tiles->width,
                     window.y / tiles->height, (window.y + window.lines - 1) / tiles->height, range.level},
                    window.x, strip);
}

/// The strip's lines of the tile x, y into its texels.
void TileReader::copy_lines(const Strip& strip, const Window& window, const Range& range, int x, int y,
                            float* texels) {
  const int left = x * kSide;
  const int top = y * kSide;
  const auto n = static_cast<std::size_t>(std::min(kSide, range.width - left));
  const int last = std::min({window.y + window.lines, top + kSide, range.height});
  for (int line = std::max(window.y, top); line < last; ++line) {
    const Piece piece = {strip, line, static_cast<std::size_t>(left - window.x), n};
    for (std::size_t k = 0; k < format_.planes.size(); ++k)
      load_plane(*kernels_, piece, k, format_.planes[k].type, samples_.data() + k * kLanesPerBlock);
    const auto within = static_cast<std::size_t>(line - top) * static_cast<std::size_t>(kSide);
    format_.pack(*kernels_, samples_.data(), n, texels + within * format_.floats);
  }
}

Result<void> TileReader::read(std::int32_t tile, std::size_t max_tiles, const Take& take) {
  const Range range = range_of(tile, max_tiles);
  SPECTILE_TRY(input_->unchanged());
  std::vector<FloatBuffer> tiles;
  for (int i = 0; i < (range.x1 - range.x0) * (range.y1 - range.y0); ++i) {
    SPECTILE_ASSIGN(auto texels, FloatBuffer::create(kernels::kTextureTileTexels * format_.floats));
    tiles.push_back(std::move(texels));
  }
  const int end = std::min(range.y1 * kSide, range.height);
  std::shared_ptr<Strip> strip;
  for (int y = range.y0 * kSide; y < end;) {
    const Window window = decoded(range, y);
    SPECTILE_ASSIGN(strip, make_strip(format_.planes, window.width, window.y, window.lines));
    SPECTILE_TRY(fill(range, window, *strip));
    y = window.y + window.lines;
    for (int row = range.y0; row < range.y1; ++row) {
      for (int x = range.x0; x < range.x1; ++x) {
        const int at = (row - range.y0) * (range.x1 - range.x0) + (x - range.x0);
        copy_lines(*strip, window, range, x, row, tiles[static_cast<std::size_t>(at)].data());
      }
    }
  }
  const std::int32_t* const level =
      levels_.data() + static_cast<std::size_t>(range.level) * kernels::kTextureLevelRow;
  std::size_t next = 0;
  for (int row = range.y0; row < range.y1; ++row) {
    for (int x = range.x0; x < range.x1; ++x)
      SPECTILE_TRY(take(level[3] + row * level[2] + x, std::move(tiles[next++])));
  }
  return {};
}

}  // namespace spectile::io
