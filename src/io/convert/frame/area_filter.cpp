// AreaFilter: one plane of an image becomes smaller levels of itself, line by line, each pixel the average of
// the area that it covers.
#include "src/io/convert/frame/area_filter.hpp"

#include <algorithm>

#include "src/reference/half.hpp"

namespace spectile::io {

LevelTree::LevelTree(LevelSize image, int first, int count) : image_(image) {
  for (int i = 0; i < count; ++i) {
    Level level;
    level.size = level_size(image, first + i);
    level.from = image;
    // The smallest that will do.
    for (std::size_t parent = levels_.size(); parent-- > 0;) {
      const LevelSize from = levels_[parent].size;
      if (from.width % level.size.width != 0 || from.height % level.size.height != 0) continue;
      level.from = from;
      level.of_image = false;
      levels_[parent].children.push_back(levels_.size());
      break;
    }
    levels_.push_back(std::move(level));
  }
}

int lines_needed(int image_height, int level_height, int end) {
  return static_cast<int>((std::int64_t{end} * image_height + level_height - 1) / level_height);
}

namespace {

/// out[j] = average of row over [j, j + 1) * from / to, for `to` pixels made of `from`.
template <class Sample>
void average_across(const Sample* row, int from, int to, double* out) {
  const auto value = [row](std::int64_t i) {
    if constexpr (sizeof(Sample) == 2) {
      return static_cast<double>(reference::float_from_half(row[i]));
    } else {
      return static_cast<double>(row[i]);
    }
  };
  const int ratio = from / to;
  if (from == 2 * to) {
    for (std::int64_t j = 0; j < to; ++j) out[j] = 0.5 * (value(2 * j) + value(2 * j + 1));
    return;
  }
  if (from == ratio * to) {
    for (std::int64_t j = 0; j < to; ++j) {
      double sum = 0;
      for (std::int64_t i = j * ratio; i < (j + 1) * ratio; ++i) sum += value(i);
      out[j] = sum / ratio;
    }
    return;
  }
  for (std::int64_t j = 0; j < to; ++j) {
    // In units in which a pixel of the row is `to` wide, and a pixel made of it `from`: all are whole.
    const std::int64_t begin = j * from;
    const std::int64_t end = begin + from;
    double sum = 0;
    for (std::int64_t i = begin / to; i * to < end; ++i) {
      const std::int64_t overlap = std::min((i + 1) * to, end) - std::max(i * to, begin);
      sum += static_cast<double>(overlap) * value(i);
    }
    out[j] = sum / from;
  }
}

}  // namespace

AreaFilter::AreaFilter(const LevelTree& tree) : tree_(tree) {
  for (const LevelTree::Level& level : tree.levels()) {
    const auto width = static_cast<std::size_t>(level.size.width);
    sums_.push_back({std::vector<double>(width), std::vector<double>(width)});
  }
}

template <class Sample>
void AreaFilter::add(int y, const Sample* row, const Emit& emit) {
  for (std::size_t i = 0; i < tree_.levels().size(); ++i) {
    if (tree_.levels()[i].of_image) feed(i, y, row, emit);
  }
}

template <class Sample>
void AreaFilter::feed(std::size_t index, int y, const Sample* row, const Emit& emit) {
  const LevelTree::Level& level = tree_.levels()[index];
  Sums& sums = sums_[index];
  average_across(row, level.from.width, level.size.width, sums.across.data());
  // As across: a line is `to` high, one that is made of it `from`.
  const std::int64_t from = level.from.height;
  const std::int64_t to = level.size.height;
  const std::int64_t end = (std::int64_t{y} + 1) * to;
  std::int64_t at = std::int64_t{y} * to;
  while (at < end) {
    const std::int64_t line = at / from;
    const std::int64_t stop = std::min(end, (line + 1) * from);
    const auto overlap = static_cast<double>(stop - at);
    for (std::size_t j = 0; j < sums.line.size(); ++j) sums.line[j] += overlap * sums.across[j];
    at = stop;
    if (stop < (line + 1) * from) continue;
    for (double& sum : sums.line) sum /= static_cast<double>(from);
    emit(index, static_cast<int>(line), sums.line.data());
    for (const std::size_t child : level.children) {
      feed(child, static_cast<int>(line), static_cast<const double*>(sums.line.data()), emit);
    }
    std::fill(sums.line.begin(), sums.line.end(), 0.0);
  }
}

template void AreaFilter::add(int y, const float* row, const Emit& emit);
template void AreaFilter::add(int y, const std::uint16_t* row, const Emit& emit);

}  // namespace spectile::io
