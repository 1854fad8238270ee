// Representations on intervals of their own choice: the leaves of a tree, and smooth light with spikes.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/representations/representation.hpp"

namespace spectile::measure {
namespace {

double average(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) / static_cast<double>(count);
}

/// Paths of one and two materials: averages over an interval, and the interval's weights.
struct Averages {
  Averages(const PathScene& scene, const Interval& interval) {
    for (std::size_t i = interval.first; i < interval.first + interval.count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) weights[k] += scene.light().weights[k][i] / scene.light().white[k];
    }
    for (const std::size_t r : materials_of_scene(scene)) {
      values.push_back(average(scene.reflectances()[r].values, interval.first, interval.count));
    }
  }
  Xyz weights{};
  std::vector<double> values;  // of some materials
};

/// Change of the paths' XYZ, squared and summed over them, where an interval is halved.
double change(const PathScene& scene, const Interval& left, const Interval& right) {
  const Averages a(scene, left);
  const Averages b(scene, right);
  const Averages whole(scene, {left.first, left.count + right.count});
  double weight_a = 0;
  double weight_b = 0;
  double across = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    weight_a += a.weights[k] * a.weights[k];
    weight_b += b.weights[k] * b.weights[k];
    across += a.weights[k] * b.weights[k];
  }
  double sum = 0;
  const auto add = [&](double of_a, double of_b, double of_whole) {
    const double x = of_whole - of_a;
    const double y = of_whole - of_b;
    sum += x * x * weight_a + 2 * x * y * across + y * y * weight_b;
  };
  for (std::size_t i = 0; i < whole.values.size(); ++i) {
    add(a.values[i], b.values[i], whole.values[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      add(a.values[i] * a.values[j], b.values[i] * b.values[j], whole.values[i] * whole.values[j]);
    }
  }
  return sum;
}

/// Weights of intervals: the light times a share of it at each nanometre, summed.
std::vector<std::array<double, 3>> interval_weights(const ReferenceLight& light,
                                                    const std::vector<double>& share,
                                                    std::span<const Interval> intervals) {
  std::vector<std::array<double, 3>> out;
  for (const Interval& leaf : intervals) {
    Xyz sum{};
    for (std::size_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += light.weights[k][i] * share[i];
    }
    out.push_back(sum);
  }
  return out;
}

/// For each sample the smallest or largest of those at most `margin` away.
template <class Better>
std::vector<double> filtered(const std::vector<double>& in, std::size_t margin, Better better) {
  std::vector<double> out = in;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const std::size_t end = std::min(in.size(), i + margin + 1);
    for (std::size_t k = i < margin ? 0 : i - margin; k < end; ++k) {
      if (better(in[k], out[i])) out[i] = in[k];
    }
  }
  return out;
}

/// Windows of 25 nm.
constexpr std::size_t kMargin = 12;
/// Share of the white's X, Y and Z of which a spike has at least one.
constexpr double kMinSpike = 1e-3;
/// Height of a spike's peak over what is below it; daylight's own rises are a twentieth.
constexpr double kMinRise = 0.5;
/// Range of the smooth part's intervals: 380 to 780 nm.
constexpr std::size_t kSmoothFirst = 20;
constexpr std::size_t kSmoothRange = 400;

}  // namespace

std::vector<Interval> tree_leaves(const PathScene& scene, std::size_t count) {
  struct Node {
    Interval leaf;
    std::size_t width;  // of the node, of which a part may lie beyond the grid
    double change = 0;  // by halving it
  };
  const auto halves = [](const Node& n) {
    const std::size_t half = n.width / 2;
    const std::size_t left = std::min(half, n.leaf.count);
    return std::array<Node, 2>{
        {{{n.leaf.first, left}, half}, {{n.leaf.first + left, n.leaf.count - left}, half}}};
  };
  const auto weigh = [&](Node& n) {
    if (n.width < 2) return;
    const auto [a, b] = halves(n);
    if (b.leaf.count > 0) n.change = change(scene, a.leaf, b.leaf);
  };
  // The grid has 471 samples of the tree's 512.
  std::vector<Node> nodes = {{{0, kGridSamples}, 512}};
  weigh(nodes[0]);
  while (nodes.size() < count) {
    const auto best = std::max_element(nodes.begin(), nodes.end(),
                                       [](const Node& a, const Node& b) { return a.change < b.change; });
    if (best->change == 0) break;
    auto [a, b] = halves(*best);
    weigh(a);
    weigh(b);
    *best = a;
    nodes.push_back(b);
  }
  std::vector<Interval> out;
  out.reserve(nodes.size());
  for (const Node& n : nodes) out.push_back(n.leaf);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

Products tree_products(const PathScene& scene, std::span<const Interval> leaves) {
  Products out;
  out.weights = interval_weights(scene.light(), std::vector<double>(kGridSamples, 1.0), leaves);
  for (const ReferenceReflectance& r : scene.reflectances()) {
    std::vector<double>& samples = out.reflectances.emplace_back();
    for (const Interval& leaf : leaves) samples.push_back(average(r.values, leaf.first, leaf.count));
  }
  return out;
}

SmoothAndSpikes smooth_and_spikes(const ReferenceLight& light) {
  std::vector<double> power(kGridSamples);
  for (std::size_t i = 0; i < kGridSamples; ++i) {
    power[i] = light.spectrum.at(kFirstVisibleNm + static_cast<double>(i));
  }
  const auto opening = filtered(filtered(power, kMargin, std::less<>()), kMargin, std::greater<>());
  SmoothAndSpikes out{std::vector<double>(kGridSamples, 1.0), {}};
  const auto rise = [&](std::size_t i) { return power[i] - opening[i]; };
  for (std::size_t first = 0; first < kGridSamples;) {
    if (rise(first) <= 0) {
      ++first;
      continue;
    }
    // Up to its end, or to where it rises again.
    std::size_t end = first + 1;
    bool falls = false;
    while (end < kGridSamples && rise(end) > 0) {
      const bool higher = rise(end) > rise(end - 1);
      if (falls && higher) break;
      falls = falls || rise(end) < rise(end - 1);
      ++end;
    }
    Spike spike;
    double sum = 0;
    double steepest = 0;
    for (std::size_t i = first; i < end; ++i) {
      const double share = rise(i) / power[i];
      double weight = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        spike.xyz[k] += share * light.weights[k][i];
        weight += share * light.weights[k][i];
      }
      steepest = std::max(steepest, rise(i) - kMinRise * opening[i]);
      spike.nm += weight * (kFirstVisibleNm + static_cast<double>(i));
      sum += weight;
    }
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, spike.xyz[k] / light.white[k]);
    if (most >= kMinSpike && steepest > 0) {
      spike.nm /= sum;
      out.spikes.push_back(spike);
      for (std::size_t i = first; i < end; ++i) out.smooth[i] = opening[i] / power[i];
    }
    first = end;
  }
  return out;
}

Products composite_products(const PathScene& scene, std::size_t count) {
  const SmoothAndSpikes light = smooth_and_spikes(scene.light());
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = kSmoothFirst + i * kSmoothRange / count;
    intervals.push_back({first, kSmoothFirst + (i + 1) * kSmoothRange / count - first});
  }
  Products out;
  out.weights = interval_weights(scene.light(), light.smooth, intervals);
  for (const Spike& spike : light.spikes) out.weights.push_back(spike.xyz);
  for (const ReferenceReflectance& r : scene.reflectances()) {
    std::vector<double>& samples = out.reflectances.emplace_back();
    for (const Interval& leaf : intervals) samples.push_back(average(r.values, leaf.first, leaf.count));
    for (const Spike& spike : light.spikes) samples.push_back(r.spectrum.at(spike.nm));
  }
  return out;
}

}  // namespace spectile::measure
