// FittedJob: a job's output cut, or filled up, to another window than its source's.
#include "src/io/convert/frame/fitted_job.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {

int FittedJob::strip_lines(int chunk_lines) const {
  // Strips of as many pixels as the source's, if lines are longer.
  const std::int64_t own = job_.strip_lines(chunk_lines);
  const auto fitting = static_cast<int>(own * std::min(from_.width(), to_.width()) / to_.width());
  return std::clamp(std::max(fitting, chunk_lines), 1, to_.height());
}

Result<std::shared_ptr<Strip>> FittedJob::read(int first_line, int lines) {
  const std::vector<PlaneSpec> planes = job_.strip_planes();
  SPECTILE_ASSIGN(auto out, make_strip(planes, to_.width(), first_line, lines));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const float padding = job_.padding(i);
    std::fill_n(out->planes[i].data(), out->planes[i].size(), padding);
  }
  const int top = to_.y0 + first_line;
  const int y0 = std::max(top, from_.y0);
  const int y1 = std::min(top + lines, from_.y1);
  if (y0 >= y1) return out;
  SPECTILE_ASSIGN(const auto own, job_.read(y0 - from_.y0, y1 - y0));
  const int x0 = std::max(from_.x0, to_.x0);
  const auto pixels = static_cast<std::size_t>(std::min(from_.x1, to_.x1) - x0);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::size_t bytes = planes[i].sample_bytes();
    for (int y = y0; y < y1; ++y) {
      std::memcpy(out->row(i, y - to_.y0) + static_cast<std::size_t>(x0 - to_.x0) * bytes,
                  own->row(i, y - from_.y0) + static_cast<std::size_t>(x0 - from_.x0) * bytes,
                  pixels * bytes);
    }
  }
  return out;
}

}  // namespace spectile::io
