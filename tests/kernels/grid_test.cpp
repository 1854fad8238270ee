// Kernels that interpolate in a grid of spectra: every instruction set gives the reference's bits.
#include <cstring>
#include <numeric>

#include "kernels/abi.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::GridSpectra;
using kernels::GridTable;
using kernels::KernelTable;
using kernels::kLanes;

/// A grid with arbitrary samples.
struct Grid {
  Grid(std::size_t bands, std::int32_t count, std::uint32_t seed, bool arbitrary = false)
      : stride((bands + 15) / 16 * 16),
        nodes(arbitrary ? arbitrary_floats(nodes_of(count) * stride, seed)
                        : plain_floats(nodes_of(count) * stride, seed, 0.0F, 1.0F)) {
    for (std::int32_t i = 0; i < count; ++i) {
      const float part = static_cast<float>(i) / static_cast<float>(count - 1);
      levels.push_back(part * std::sqrt(part));
    }
    for (std::size_t i = 0; i + 1 < levels.size(); ++i)
      per_width.push_back(1.0F / (levels[i + 1] - levels[i]));
    table = {nodes.data(), stride, bands, levels.data(), per_width.data(), count, 0.0F, false};
  }
  static std::size_t nodes_of(std::int32_t count) { return static_cast<std::size_t>(count * count * count); }
  std::size_t stride;
  Floats nodes;
  std::vector<float> levels, per_width;
  GridTable table;
};

/// Triples of telling values, also the grid's own levels, between ordinary colours.
Floats grid_colors(const Grid& grid, std::size_t n, std::uint32_t seed) {
  std::vector<float> values = {0.0F,  -0.0F, kTiny, 1e-4F, 0.5F, 1.0F, 1.00001F,
                               70000, kMost, -0.3F, kNan,  kInf, -kInf};
  values.insert(values.end(), grid.levels.begin(), grid.levels.end());
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  Floats rgb(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      rgb[k * n + i] = i % 2 == 0 ? values[random() % values.size()] : unit(random);
  }
  return rgb;
}

class GridKernels : public KernelTest {};

TEST_P(GridKernels, BlocksAreTheReferencesHoweverStoredAndScaled) {
  for (const std::size_t bands : {1, 3, 4, 8, 16, 17, 60, 64, 65, 81, 200}) {
    for (const std::int32_t count : {2, 3, 5}) {
      Grid grid(bands, count, 3, bands == 17);
      const std::size_t blocks = bands == 60 ? 12 : 3;
      const std::size_t n = blocks * kLanes;
      const Floats colors = grid_colors(grid, n, 4);
      const Floats scales = arbitrary_floats(n, 5);
      const float* const rgb[3] = {colors.data(), colors.data() + n, colors.data() + 2 * n};
      for (const float* scale : {static_cast<const float*>(nullptr), scales.data()}) {
        for (const bool homogeneous : {false, true}) {
          grid.table.homogeneous = homogeneous;
          grid.table.lowest = homogeneous ? -kInf : 0.0F;
          const GridSpectra spectra = {rgb, scale, grid.table};
          Floats want(n * bands);
          ref().grid_blocks(want.data(), spectra, blocks, false);
          for (const bool non_temporal : {false, true}) {
            Floats got(n * bands);
            k().grid_blocks(got.data(), spectra, blocks, non_temporal);
            ASSERT_TRUE(same_bits(got, want)) << bands << " bands, " << count << " levels, " << non_temporal;
          }
        }
      }
    }
  }
}

TEST_P(GridKernels, RowsAreTheReferencesAtAnyAddressAndLength) {
  const Grid grid(21, 5, 6);
  for (std::size_t n = 0; n <= 3 * kLanes; n += n < 70 ? 1 : 13) {
    const std::size_t padded = (n + kLanes - 1) / kLanes * kLanes;
    const Floats colors = grid_colors(grid, padded, static_cast<std::uint32_t>(n));
    const float* const rgb[3] = {colors.data(), colors.data() + padded, colors.data() + 2 * padded};
    const GridSpectra spectra = {rgb, nullptr, grid.table};
    for (const std::size_t size : {sizeof(float), sizeof(std::uint16_t)}) {
      const std::size_t stride = (n * size + 70) | 1U;
      std::vector<unsigned char> memory[2];
      for (std::size_t run = 0; run < 2; ++run) {
        memory[run].assign(21 * stride + 70, 0xA5);
        std::vector<void*> rows(21);
        for (std::size_t b = 0; b < 21; ++b) rows[b] = memory[run].data() + 35 + b * stride;
        const KernelTable& t = run == 0 ? k() : ref();
        (size == sizeof(float) ? t.grid_rows_float : t.grid_rows_half)(rows.data(), spectra, n);
      }
      for (std::size_t b = 0; b < 21; ++b) {
        for (std::size_t i = 0; i < n; ++i) {
          if (std::isnan(colors[i]) || std::isnan(colors[padded + i]) || std::isnan(colors[2 * padded + i]))
            continue;
          if (std::isinf(colors[i]) || std::isinf(colors[padded + i]) || std::isinf(colors[2 * padded + i]))
            continue;
          const std::size_t at = 35 + b * stride + i * size;
          ASSERT_EQ(std::memcmp(memory[0].data() + at, memory[1].data() + at, size), 0)
              << n << " " << b << " " << i;
        }
      }
      for (std::size_t at = 0; at < memory[0].size(); ++at) {
        const bool in_row = at >= 35 && (at - 35) % stride < n * size && (at - 35) / stride < 21;
        ASSERT_TRUE(in_row || memory[0][at] == 0xA5) << "byte " << at << " of rows of " << n;
      }
    }
  }
}

TEST_P(GridKernels, FoldedColoursAreTheReferencesAlsoInPlace) {
  Grid grid(3, 5, 7);
  grid.table.stride = kernels::kGridColor;
  for (const bool homogeneous : {false, true}) {
    grid.table.homogeneous = homogeneous;
    const std::size_t n = 10 * kLanes;
    Floats colors = grid_colors(grid, n, 8);
    const Floats scales = plain_floats(n, 9, 0.0F, 4.0F);
    const float* const rgb[3] = {colors.data(), colors.data() + n, colors.data() + 2 * n};
    for (const float* scale : {static_cast<const float*>(nullptr), scales.data()}) {
      Floats want(3 * n);
      Floats got(3 * n);
      Floats replaced(std::span(colors.data(), colors.size()));
      float* const expected[3] = {want.data(), want.data() + n, want.data() + 2 * n};
      float* const out[3] = {got.data(), got.data() + n, got.data() + 2 * n};
      float* const in_place[3] = {replaced.data(), replaced.data() + n, replaced.data() + 2 * n};
      const float* const same[3] = {in_place[0], in_place[1], in_place[2]};
      ref().grid_fold(expected, {rgb, scale, grid.table}, n);
      k().grid_fold(out, {rgb, scale, grid.table}, n);
      k().grid_fold(in_place, {same, scale, grid.table}, n);
      ASSERT_TRUE(same_bits(got, want));
      ASSERT_TRUE(same_bits(replaced, want));
    }
  }
}

SPECTILE_FOR_EVERY_ISA(GridKernels);

}  // namespace
}  // namespace spectile::test
