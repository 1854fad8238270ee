// texture_reflectances: the colours of a texture, as few reflectances that stand for them.
#include <algorithm>
#include <cmath>
#include <spectile/image/plan_file.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/convert/stages/color_stage.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using Color = std::array<double, 3>;

/// Steps of a component's square root, which are about as visible as each other.
constexpr std::size_t kSteps = 64;

/// Colours of a cell of the grid, or of several.
struct Cell {
  double count = 0;
  Color sum{};
  void add(const Cell& other) {
    count += other.count;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += other.sum[c];
  }
  double mean(std::size_t c) const { return sum[c] / count; }
};

/// How often each colour occurs, on a grid; black, of which a plan learns nothing, is left out.
class Census {
 public:
  Census() : cells_(kSteps * kSteps * kSteps) {}

  void add(const float* const rgb[3], std::size_t width) {
    for (std::size_t x = 0; x < width; ++x) {
      // The caller refuses the image for it.
      if (std::isnan(rgb[0][x] + rgb[1][x] + rgb[2][x])) continue;
      std::size_t index = 0;
      Cell one = {1, {}};
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = std::clamp(rgb[c][x], 0.0F, 1.0F);
        const auto step = static_cast<std::size_t>(std::sqrt(value) * static_cast<float>(kSteps));
        index = index * kSteps + std::min(step, kSteps - 1);
        one.sum[c] = static_cast<double>(value);
      }
      if (one.sum == Color{}) continue;
      cells_[index].add(one);
    }
  }

  std::vector<Cell> cells() const {
    std::vector<Cell> out;
    std::copy_if(cells_.begin(), cells_.end(), std::back_inserter(out),
                 [](const Cell& cell) { return cell.count > 0; });
    return out;
  }

 private:
  std::vector<Cell> cells_;
};

/// A run of cells that one colour may stand for, and where it is best cut in two.
struct Box {
  std::size_t first = 0;
  std::size_t last = 0;  // one past
  double worth = 0;      // of cutting it; 0 where it cannot be cut
  std::size_t axis = 0;
  double middle = 0;  // along the axis
};

double place(const Cell& cell, std::size_t c) {
  return std::sqrt(cell.mean(c));
}

Box measure(const std::vector<Cell>& cells, std::size_t first, std::size_t last) {
  Box box = {first, last, 0, 0, 0};
  double longest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double low = place(cells[first], c);
    double high = low;
    for (std::size_t i = first; i < last; ++i) {
      low = std::min(low, place(cells[i], c));
      high = std::max(high, place(cells[i], c));
    }
    if (high - low <= longest) continue;
    longest = high - low;
    box.axis = c;
    box.middle = (low + high) / 2;
  }
  double count = 0;
  for (std::size_t i = first; i < last; ++i) count += cells[i].count;
  // Length counts most, so that small flowers are not lost in a large meadow; but 256 times the pixels make a
  // box twice as worth cutting.
  box.worth = longest * std::pow(count, 0.125);
  return box;
}

/// At most `most` groups of cells, cut in two where it was most worth it.
std::vector<Cell> merged(std::vector<Cell> cells, std::size_t most) {
  if (cells.size() <= most) return cells;
  std::vector<Box> boxes = {measure(cells, 0, cells.size())};
  while (boxes.size() < most) {
    const auto widest = std::ranges::max_element(boxes, {}, &Box::worth);
    if (!(widest->worth > 0)) break;
    const Box box = *widest;
    const auto begin = cells.begin();
    const auto cut = std::stable_partition(
        begin + static_cast<std::ptrdiff_t>(box.first), begin + static_cast<std::ptrdiff_t>(box.last),
        [&](const Cell& cell) { return place(cell, box.axis) < box.middle; });
    const auto at = static_cast<std::size_t>(cut - begin);
    if (at == box.first || at == box.last) {
      widest->worth = 0;
      continue;
    }
    *widest = measure(cells, box.first, at);
    boxes.push_back(measure(cells, at, box.last));
  }
  std::vector<Cell> out;
  for (const Box& box : boxes) {
    Cell all;
    for (std::size_t i = box.first; i < box.last; ++i) all.add(cells[i]);
    out.push_back(all);
  }
  return out;
}

Result<Census> census_of(const std::string& path, const Upsampler& upsampler, const MethodOptions& options,
                         std::vector<std::string>* notes) {
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  SPECTILE_ASSIGN(auto opened,
                  io::RgbSource::open(path, options.channels, tiles::thread_count(options.threads),
                                      options.region, options.input_space));
  io::RgbSource& source = *opened;
  if (notes != nullptr) {
    *notes = source.notes();
    if (source.alpha()) {
      notes->push_back(
          fmt::format("{}: colours are planned for as they are stored, whatever their alpha", path));
    }
  }
  const io::ColorStage stage(source, upsampler, options, *kernels);
  SPECTILE_ASSIGN(auto line, io::ColorLine::create(source.width()));
  Census census;
  io::LineStats stats;
  const int lines = io::strip_lines(source.header(), source.planes(), 1);
  const auto pixels_to = [&](int y) {
    return static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(source.width());
  };
  for (int first = 0; first < source.height(); first += lines) {
    const int count = std::min(lines, source.height() - first);
    SPECTILE_ASSIGN(const auto strip, source.read(first, count));
    for (int y = first; y < first + count; ++y) {
      stage.line(*strip, y, line, stats);
      const float* const rgb[3] = {line.rows[0], line.rows[1], line.rows[2]};
      census.add(rgb, static_cast<std::size_t>(source.width()));
    }
    if (options.progress && !options.progress({pixels_to(first + count), pixels_to(source.height())})) {
      return make_error(ErrorCode::kCancelled, "stopped on request");
    }
  }
  if (auto refused = stage.refusal(path, stats)) return *std::move(refused);
  return census;
}

Result<std::vector<Spectrum>> reflectances_of(const std::string& path, std::size_t most,
                                              const MethodOptions& wanted, std::vector<std::string>* notes) {
  if (most == 0) return make_error(ErrorCode::kBadArgument, "{}: no colour can stand for all", path);
  if (wanted.quantity == Quantity::kIlluminant) {
    return make_error(ErrorCode::kBadArgument, "{}: colours of light are no reflectances", path);
  }
  MethodOptions options = wanted;
  options.quantity = Quantity::kReflectance;
  SPECTILE_ASSIGN(options.bands, Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 5));
  SPECTILE_ASSIGN(const auto upsampler, io::upsampler_for(options));
  SPECTILE_ASSIGN(const auto census, census_of(path, upsampler, options, notes));
  std::vector<Cell> cells = merged(census.cells(), most);
  std::ranges::stable_sort(cells, std::greater<>{}, &Cell::count);
  std::vector<Spectrum> out;
  for (const Cell& cell : cells) {
    const Color color = {cell.mean(0), cell.mean(1), cell.mean(2)};
    SPECTILE_ASSIGN(auto spectrum, rgb_spectrum(upsampler, color));
    out.emplace_back(std::move(spectrum));
  }
  return out;
}

}  // namespace

Result<std::vector<Spectrum>> texture_reflectances(const std::string& path, std::size_t most,
                                                   const MethodOptions& options,
                                                   std::vector<std::string>* notes) {
  return io::contained<std::vector<Spectrum>>(path,
                                              [&] { return reflectances_of(path, most, options, notes); });
}

}  // namespace spectile
