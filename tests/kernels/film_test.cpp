// Kernels of the film: every instruction set gives the reference's bits.
#include <cstring>

#include "src/film/state.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::FilmEntries;
using kernels::KernelTable;
using kernels::kFilmReasons;
using kernels::kFilmTilePixels;

constexpr std::size_t kSamples = 1088;
constexpr std::int32_t kIntervals = 470;

/// Rows of numbers that renderers hand over, with some that they should not.
struct Rows {
  Rows(std::size_t count, std::uint32_t seed, float low, float high, bool arbitrary) {
    for (std::size_t k = 0; k < count; ++k) {
      rows.push_back(plain_floats(kSamples, seed + static_cast<std::uint32_t>(k), low, high));
      const Floats strange = arbitrary_floats(kSamples, seed + 100 + static_cast<std::uint32_t>(k));
      for (std::size_t i = k; arbitrary && i < kSamples; i += 13) rows.back()[i] = strange[i];
    }
    for (const Floats& row : rows) pointers.push_back(row.data());
  }
  std::vector<Floats> rows;
  std::vector<const float*> pointers;
};

struct Batch {
  explicit Batch(std::size_t count, bool arbitrary)
      : radiance(count, 1, -1, 50, arbitrary),
        lambda(count, 40, 350, 840, arbitrary),
        density(count, 80, 0.001F, 0.01F, arbitrary),
        weight(plain_floats(kSamples, 7, 0.1F, 3)),
        position_x(plain_floats(kSamples, 8, -3, 70)),
        position_y(plain_floats(kSamples, 9, -3, 40)) {
    for (std::size_t i = 0; i < kSamples; i += 17) density.rows[i % count][i] = 0;
    for (std::size_t i = 5; i < kSamples; i += 19) lambda.rows[i % count][i] = std::round(400 + i % 400);
    lambda.rows[0][0] = 830;
    lambda.rows[0][1] = 360;
    if (!arbitrary) return;
    const Floats strange = arbitrary_floats(kSamples, 10);
    for (std::size_t i = 0; i < kSamples; i += 11) weight[i] = strange[i];
    for (std::size_t i = 3; i < kSamples; i += 23) position_x[i] = strange[i];
    for (std::size_t i = 4; i < kSamples; i += 29) position_y[i] = strange[i];
    density.rows[count - 1][2] = -0.5F;
  }
  kernels::FilmSamples samples() const {
    return {radiance.pointers.data(), lambda.pointers.data(),
            density.pointers.data(),  weight.data(),
            radiance.pointers.size(), kSamples};
  }
  Rows radiance, lambda, density;
  Floats weight, position_x, position_y;
};

Floats curves() {
  Floats out = plain_floats(8 * (kIntervals + 2), 3, 0, 2);
  for (std::size_t i = 3; i < out.size(); i += 4) out[i] = 0;
  for (std::size_t i = 8 * kIntervals + 4; i < out.size(); ++i) out[i] = 0;
  return out;
}

constexpr kernels::FilmLimits kLoose = {kInf, 0x1p32F, 0x1p16F};
constexpr kernels::FilmLimits kTight = {3, 5, 2.5F};

/// Quads and reasons of one table.
struct Weighed {
  Floats quads{4 * kSamples};
  std::vector<std::int32_t> reasons = std::vector<std::int32_t>(kSamples, 77);

  /// Those of samples that are refused are not compared.
  void expect_same(const Weighed& want) const {
    ASSERT_EQ(reasons, want.reasons);
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (reasons[i] != 0) continue;
      ++accepted;
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_TRUE(same_bits(quads[4 * i + c], want.quads[4 * i + c])) << i << " " << c;
      }
    }
    EXPECT_GT(accepted, kSamples / 10);
    EXPECT_TRUE(quads.guard_holds());
  }
};

class FilmKernels : public KernelTest {};

TEST_P(FilmKernels, WavelengthsWeighAsInTheReference) {
  const Floats rows = curves();
  const kernels::FilmCurves table = {rows.data(), 360, kIntervals, 4};
  for (const std::size_t count : {1, 3, 4, 8, 9, 64}) {
    for (const bool arbitrary : {false, true}) {
      const Batch b(count, arbitrary);
      for (const kernels::FilmLimits& limits : {kLoose, kTight}) {
        for (const bool weighted : {false, true}) {
          for (const bool luminance : {false, true}) {
            const auto run = [&](const KernelTable& t) {
              Weighed out;
              kernels::FilmSamples samples = b.samples();
              if (!weighted) samples.weight = nullptr;
              t.film_weigh_wavelengths({out.quads.data(), out.reasons.data(), luminance}, samples, table,
                                       limits, 1 / static_cast<float>(count) / 10000);
              return out;
            };
            run(k()).expect_same(run(ref()));
          }
        }
      }
    }
  }
}

TEST_P(FilmKernels, BandsWeighAsInTheReference) {
  for (const std::size_t bands : {1, 3, 8, 9, 60}) {
    const Floats weights = plain_floats(4 * bands, 5, 0, 0.02F);
    for (const bool arbitrary : {false, true}) {
      const Batch b(bands, arbitrary);
      for (const kernels::FilmLimits& limits : {kLoose, kTight}) {
        const auto run = [&](const KernelTable& t) {
          Weighed out;
          t.film_weigh_bands({out.quads.data(), out.reasons.data(), true}, b.samples(), weights.data(),
                             limits);
          return out;
        };
        run(k()).expect_same(run(ref()));
        const std::size_t stride = (bands + 3) / 4 * 4;
        const auto quads = [&](const KernelTable& t, Floats& to) {
          std::vector<std::int32_t> reasons = run(ref()).reasons;
          t.film_band_quads(to.data(), stride, reasons.data(), b.samples(), limits);
          return reasons;
        };
        Floats got(stride * kSamples);
        Floats want(stride * kSamples);
        const auto reasons = quads(k(), got);
        ASSERT_EQ(reasons, quads(ref(), want));
        for (std::size_t i = 0; i < got.size(); ++i) {
          if (reasons[i / stride] != 0) continue;
          ASSERT_TRUE(same_bits(got[i], want[i])) << i;
        }
        EXPECT_TRUE(got.guard_holds());
      }
    }
  }
}

TEST_P(FilmKernels, HitsAreTheReferences) {
  const float edges[] = {400, 410, 420.5F, 500, 500.25F, 700, kInf, kInf, kInf, kInf};
  const std::int32_t band[] = {0, 1, -1, 2, 3, -1};
  const std::int32_t start[] = {0, 2, 4, 4};
  const kernels::BucketTable table = {edges, band, 6, start, 4.0F / 300, 4, 2};
  for (const std::size_t count : {1, 4, 7}) {
    for (const bool arbitrary : {false, true}) {
      const Batch b(count, arbitrary);
      for (const kernels::FilmLimits& limits : {kLoose, kTight}) {
        const auto run = [&](const KernelTable& t, std::vector<std::int32_t>& bands, Floats& hits) {
          std::vector<std::int32_t> reasons(kSamples, 0);
          bands.assign(count * kSamples, 77);
          t.film_hits({bands.data(), hits.data(), reasons.data()}, b.samples(), table, limits, 1.0F / 512);
          return reasons;
        };
        std::vector<std::int32_t> got_bands;
        std::vector<std::int32_t> want_bands;
        Floats got(2 * count * kSamples);
        Floats want(2 * count * kSamples);
        const auto reasons = run(k(), got_bands, got);
        ASSERT_EQ(reasons, run(ref(), want_bands, want));
        ASSERT_EQ(got_bands, want_bands);
        std::size_t compared = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
          const std::size_t sample = i / 2 % kSamples;
          const bool finite = std::isfinite(b.weight[sample]);
          if (reasons[sample] != 0 || !finite || got_bands[i / 2] < 0) continue;
          ++compared;
          ASSERT_TRUE(same_bits(got[i], want[i])) << i;
        }
        EXPECT_GT(compared, 100U);
        EXPECT_TRUE(got.guard_holds());
      }
    }
  }
}

TEST_P(FilmKernels, PlacesAreTheReferences) {
  for (const bool negative : {false, true}) {
    for (const std::size_t n : {1, 15, 16, 17, 64, 1087, 1088}) {
      const Batch b(1, true);
      const kernels::FilmWindow window = {3, 0, 60, 37, 0, 0, 4, negative};
      std::vector<std::int32_t> reasons(kSamples, 0);
      for (std::size_t i = 0; i < kSamples; i += 7) reasons[i] = static_cast<std::int32_t>(i % kFilmReasons);
      const auto run = [&](const KernelTable& t, std::array<std::uint64_t, kFilmReasons>& counts,
                           std::array<std::int32_t, 2>& tiles) {
        std::vector<std::int32_t> address(kSamples, 0);
        t.film_place({address.data(), tiles.data(), counts.data()}, window,
                     {b.position_x.data(), b.position_y.data(), b.weight.data(), reasons.data(), n});
        return address;
      };
      std::array<std::uint64_t, kFilmReasons> got{};
      std::array<std::uint64_t, kFilmReasons> want{};
      std::array<std::int32_t, 2> got_tiles = {1000, -1};
      std::array<std::int32_t, 2> want_tiles = {1000, -1};
      const auto address = run(k(), got, got_tiles);
      const auto expected = run(ref(), want, want_tiles);
      EXPECT_EQ(got_tiles, want_tiles);
      EXPECT_TRUE(
          std::equal(address.begin(), address.begin() + static_cast<std::ptrdiff_t>(n), expected.begin()));
      EXPECT_EQ(got, want);
      std::uint64_t sum = 0;
      for (const std::uint64_t c : got) sum += c;
      EXPECT_EQ(sum, n);
    }
  }
}

/// A few tiles of limbs.
struct Tiles {
  static constexpr std::size_t kTiles = 3;
  std::size_t limbs;
  FloatBuffer memory;
  std::vector<std::int64_t*> pointers;
  explicit Tiles(std::size_t per_tile)
      : limbs(per_tile), memory(*FloatBuffer::create(2 * kTiles * per_tile)) {
    std::fill_n(memory.data(), memory.size(), 0.0F);
    for (std::size_t t = 0; t < kTiles; ++t) {
      pointers.push_back(reinterpret_cast<std::int64_t*>(memory.data()) + t * per_tile);
    }
  }
  bool operator==(const Tiles& other) const {
    return std::memcmp(memory.data(), other.memory.data(), memory.size() * sizeof(float)) == 0;
  }
};

/// Numbers of every size that fits into the range, and on the grid's halves.
Floats contributions(std::size_t count) {
  Floats out = plain_floats(count, 21, -1, 1);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = std::ldexp(out[i], static_cast<int>(i % 90) - 58);
    if (i % 31 == 0) out[i] = 0x1p32F;
    if (i % 37 == 0) out[i] = -0.0F;
    if (i % 41 == 0) out[i] = std::ldexp(static_cast<float>(static_cast<int>(i % 64) - 32), -44);
  }
  return out;
}

class FilmSums : public FilmKernels {
 protected:
  FilmSums() {
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < kSamples; ++i) {
      state = state * 1664525U + 1013904223U;
      address.push_back(
          i % 10 == 3 ? -3 : static_cast<std::int32_t>((state >> 8) % (Tiles::kTiles * kFilmTilePixels)));
      sample.push_back((state >> 5) % kSamples);
      factor.push_back(static_cast<float>(state >> 20) / 4096);
    }
    for (std::size_t i = 0; i < kSamples; ++i) {
      in_one.push_back(address[i] < 0
                           ? -1
                           : static_cast<std::int32_t>(address[i] % static_cast<int>(kFilmTilePixels)) +
                                 2 * static_cast<int>(kFilmTilePixels));
    }
    for (std::size_t c = 0; c < 4; ++c) {
      grid.coarse[c] = std::ldexp(1.5, 52 + (c == 3 ? 16 : 32) - 31);
      grid.rest[c] = std::ldexp(1.5, 52 + (c == 3 ? 16 : 32) - 75);
    }
    for (int j = 0; j < 4; ++j) moments.luminance[j] = std::ldexp(1.5, 52 + 80 - 31 - 44 * j);
    for (int j = 0; j < 3; ++j) moments.weight[j] = std::ldexp(1.5, 52 + 32 - 31 - 44 * j);
  }
  std::vector<FilmEntries> all_entries() const {
    return {{nullptr, address.data(), nullptr, kSamples, -1},
            {nullptr, in_one.data(), nullptr, kSamples, 2},
            {sample.data(), address.data(), nullptr, kSamples, -1},
            {sample.data(), address.data(), factor.data(), kSamples, -1},
            {sample.data(), address.data(), factor.data(), 5, -1}};
  }
  template <class Add>
  void expect_same(std::size_t per_tile, Add add) {
    for (const FilmEntries& entries : all_entries()) {
      const Tiles got(per_tile);
      const Tiles want(per_tile);
      add(k(), got.pointers.data(), entries);
      add(ref(), want.pointers.data(), entries);
      EXPECT_TRUE(got == want);
      EXPECT_FALSE(got == Tiles(per_tile));
    }
  }
  std::vector<std::int32_t> address, in_one;
  std::vector<std::uint32_t> sample;
  std::vector<float> factor;
  kernels::FilmGrid grid{};
  kernels::FilmMomentGrid moments{};
};

TEST_P(FilmSums, QuadsAddUpAsInTheReference) {
  for (const std::size_t count : {1, 3}) {
    Floats quads = contributions(4 * count * kSamples);
    for (std::size_t i = 3; i < quads.size(); i += 4) quads[i] = std::ldexp(quads[i], -16);
    expect_same((8 * count + 8) * kFilmTilePixels,
                [&](const KernelTable& t, auto* tiles, const FilmEntries& e) {
                  t.film_add({tiles, 8, 8 * count}, grid, e, quads.data(), count);
                });
  }
}

TEST_P(FilmSums, HitsAddUpAsInTheReference) {
  constexpr std::size_t kWavelengths = 3;
  constexpr std::size_t kBands = 5;
  Floats hits = contributions(2 * kWavelengths * kSamples);
  std::vector<std::int32_t> band;
  for (std::size_t i = 0; i < kWavelengths * kSamples; ++i)
    band.push_back(static_cast<std::int32_t>(i % (kBands + 1)) - 1);
  expect_same(4 * kBands * kFilmTilePixels, [&](const KernelTable& t, auto* tiles, const FilmEntries& e) {
    t.film_add_hits({tiles, 0, 4 * kBands}, grid, e, {band.data(), hits.data(), kWavelengths, kSamples});
  });
}

TEST_P(FilmSums, MomentsAndCountsAddUpAsInTheReference) {
  Floats quads = contributions(4 * kSamples);
  const Floats weights = plain_floats(kSamples, 5, 0, 60000);
  for (std::size_t i = 0; i < kSamples; ++i) {
    // A luminance of at most the range, by a weight from 1e-9 on; and weights of 0.
    quads[4 * i + 3] = i % 9 == 0 ? 0.0F : i % 5 == 0 ? weights[i] * 1e-13F : weights[i];
    quads[4 * i + 1] *= quads[4 * i + 3] * 0x1p-16F;
  }
  expect_same(8 * kFilmTilePixels, [&](const KernelTable& t, auto* tiles, const FilmEntries& e) {
    t.film_add_moments({tiles, 0, 8}, moments, e, quads.data());
  });
  expect_same(kFilmTilePixels, [&](const KernelTable& t, auto* tiles, const FilmEntries& e) {
    t.film_count({tiles, 0, 1}, e);
  });
}

SPECTILE_FOR_EVERY_ISA(FilmKernels);
SPECTILE_FOR_EVERY_ISA(FilmSums);

}  // namespace
}  // namespace spectile::test
