// Representations on intervals of their own choice: the leaves of a tree, and smooth light with spikes.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/representations/representation.hpp"

namespace spectile::measure {
namespace {

/// XYZ of a spectrum's samples in an interval, and of their average in their place.
Xyz averaging_error(const ReferenceLight& light, const std::vector<double>& spectrum, const TreeLeaf& leaf) {
  double mean = 0;
  for (std::size_t i = leaf.first; i < leaf.first + leaf.count; ++i) mean += spectrum[i];
  mean /= static_cast<double>(leaf.count);
  Xyz out{};
  for (std::size_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[k] += light.weights[k][i] * (spectrum[i] - mean);
  }
  return out;
}

/// Decrease of the errors, squared and summed over spectra, that halving an interval brings.
double gain(const ReferenceLight& light, const std::vector<std::vector<double>>& spectra, const TreeLeaf& a,
            const TreeLeaf& b) {
  const TreeLeaf whole{a.first, a.count + b.count};
  double sum = 0;
  for (const auto& spectrum : spectra) {
    const Xyz of_a = averaging_error(light, spectrum, a);
    const Xyz of_b = averaging_error(light, spectrum, b);
    const Xyz of_whole = averaging_error(light, spectrum, whole);
    for (std::size_t k = 0; k < 3; ++k) {
      const double moved = (of_whole[k] - of_a[k] - of_b[k]) / light.white[k];
      sum += moved * moved;
    }
  }
  return sum;
}

double average(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) / static_cast<double>(count);
}

/// Weights of intervals: the light times a share of it at each nanometre, summed.
std::vector<std::array<double, 3>> interval_weights(const ReferenceLight& light,
                                                    const std::vector<double>& share,
                                                    std::span<const TreeLeaf> intervals) {
  std::vector<std::array<double, 3>> out;
  for (const TreeLeaf& leaf : intervals) {
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
/// Of the white's Y, below which a rise is no spike.
constexpr double kMinSpike = 1e-3;
/// Intervals of the smooth part: 380 to 780 nm in 16 of 25 nm.
constexpr std::size_t kSmoothFirst = 20;
constexpr std::size_t kSmoothWidth = 25;
constexpr std::size_t kSmoothCount = 16;

}  // namespace

std::vector<TreeLeaf> tree_leaves(const PathScene& scene, std::size_t count) {
  const auto spectra = spectra_of_scene(scene);
  struct Node {
    TreeLeaf leaf;
    std::size_t width;  // of the node, of which a part may lie beyond the grid
    double gain = 0;    // of halving it
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
    if (b.leaf.count > 0) n.gain = gain(scene.light(), spectra, a.leaf, b.leaf);
  };
  // The grid has 471 samples of the tree's 512.
  std::vector<Node> nodes = {{{0, kGridSamples}, 512}};
  weigh(nodes[0]);
  while (nodes.size() < count) {
    const auto best = std::max_element(nodes.begin(), nodes.end(),
                                       [](const Node& a, const Node& b) { return a.gain < b.gain; });
    if (best->gain == 0) break;
    auto [a, b] = halves(*best);
    weigh(a);
    weigh(b);
    *best = a;
    nodes.push_back(b);
  }
  std::vector<TreeLeaf> out;
  for (const Node& n : nodes) out.push_back(n.leaf);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

Products tree_products(const PathScene& scene, std::span<const TreeLeaf> leaves) {
  Products out;
  out.weights = interval_weights(scene.light(), std::vector<double>(kGridSamples, 1.0), leaves);
  for (const ReferenceReflectance& r : scene.reflectances()) {
    std::vector<double>& samples = out.reflectances.emplace_back();
    for (const TreeLeaf& leaf : leaves) samples.push_back(average(r.values, leaf.first, leaf.count));
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
    for (std::size_t i = first; i < end; ++i) {
      const double share = power[i] > 0 ? rise(i) / power[i] : 0;
      double weight = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        spike.xyz[k] += share * light.weights[k][i];
        weight += share * light.weights[k][i];
      }
      spike.nm += weight * (kFirstVisibleNm + static_cast<double>(i));
      sum += weight;
    }
    if (spike.xyz[1] >= kMinSpike) {
      spike.nm /= sum;
      out.spikes.push_back(spike);
      for (std::size_t i = first; i < end; ++i) out.smooth[i] = opening[i] / power[i];
    }
    first = end;
  }
  return out;
}

Products composite_products(const PathScene& scene) {
  const SmoothAndSpikes light = smooth_and_spikes(scene.light());
  std::vector<TreeLeaf> intervals;
  for (std::size_t i = 0; i < kSmoothCount; ++i) {
    intervals.push_back({kSmoothFirst + i * kSmoothWidth, kSmoothWidth});
  }
  Products out;
  out.weights = interval_weights(scene.light(), light.smooth, intervals);
  for (const Spike& spike : light.spikes) out.weights.push_back(spike.xyz);
  for (const ReferenceReflectance& r : scene.reflectances()) {
    std::vector<double>& samples = out.reflectances.emplace_back();
    for (const TreeLeaf& leaf : intervals) samples.push_back(average(r.values, leaf.first, leaf.count));
    for (const Spike& spike : light.spikes) samples.push_back(r.spectrum.at(spike.nm));
  }
  return out;
}

}  // namespace spectile::measure
