// The nodes of a grid over the cube of RGB: where they are, and what is learned of them.
#include "src/upsampling/grid/nodes.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

constexpr std::size_t kLevels = 5;
constexpr std::size_t kMaxWavelengths = 4096;
constexpr double kFirstNodeNm = 100;
constexpr double kLastNodeNm = 10000;
// The sigmoid of a tenth of it is 0 or 1 in float.
constexpr double kMaxOffset = 1000;

}  // namespace

std::span<const float> node_levels() {
  static const auto levels = [] {
    std::array<float, kLevels> out{};
    for (std::size_t k = 0; k < kLevels; ++k)
      out[k] = static_cast<float>(std::pow(static_cast<double>(k) / (kLevels - 1), 1.5));
    return out;
  }();
  return levels;
}

std::array<double, 3> node_color(std::size_t node) {
  const auto levels = node_levels();
  const std::size_t n = levels.size();
  return {static_cast<double>(levels[node / (n * n)]), static_cast<double>(levels[node / n % n]),
          static_cast<double>(levels[node % n])};
}

NodeMixture node_mixture(const std::array<double, 3>& rgb, bool homogeneous) {
  const auto levels = node_levels();
  const std::size_t n = levels.size();
  const std::size_t steps[3] = {n * n, n, 1};
  const double most = std::max({rgb[0], rgb[1], rgb[2]});
  const double size = most > (homogeneous ? 0.0 : 1.0) ? most : 1.0;
  std::array<std::pair<double, std::size_t>, 3> part;  // and the step along that component
  NodeMixture out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double v = rgb[k] / size;
    const auto level = [&](std::size_t i) { return static_cast<double>(levels[i]); };
    std::size_t cell = 0;
    while (cell + 2 < n && v >= level(cell + 1)) ++cell;
    part[k] = {(v - level(cell)) / (level(cell + 1) - level(cell)), steps[k]};
    out.node[0] += cell * steps[k];
  }
  std::sort(part.begin(), part.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  double left = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    out.weight[k] = (left - part[k].first) * size;
    out.node[k + 1] = out.node[k] + part[k].second;
    left = part[k].first;
  }
  out.weight[3] = left * size;
  return out;
}

std::string nodes_flaw(const LearnedNodes& nodes) {
  const std::size_t count = nodes.wavelengths_nm.size();
  if (count == 0 || count > kMaxWavelengths)
    return fmt::format("{} wavelengths are not from 1 to {}", count, kMaxWavelengths);
  for (std::size_t i = 0; i < count; ++i) {
    const double nm = nodes.wavelengths_nm[i];
    if (!(nm >= kFirstNodeNm && nm <= kLastNodeNm))
      return fmt::format("a wavelength of {} nm is not from {} to {} nm", nm, kFirstNodeNm, kLastNodeNm);
    if (i > 0 && !(nm > nodes.wavelengths_nm[i - 1])) {
      return fmt::format("the wavelengths do not ascend: {} nm comes after {} nm", nm,
                         nodes.wavelengths_nm[i - 1]);
    }
  }
  if (nodes.offsets.size() != kNodes * count) {
    return fmt::format("there are {} offsets, not {} for each of {} wavelengths", nodes.offsets.size(),
                       kNodes, count);
  }
  for (const float offset : nodes.offsets) {
    if (!(std::abs(static_cast<double>(offset)) <= kMaxOffset))
      return fmt::format("an offset of {} is not from -{} to {}", offset, kMaxOffset, kMaxOffset);
  }
  return {};
}

}  // namespace spectile
