// Smits kernels of every instruction set give the reference's bits, in blocks and in rows at any address.
#include <cstring>
#include <spectile/upsampling/upsample.hpp>

#include "src/upsampling/method_rows.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::KernelTable;
using kernels::kLanes;
using kernels::kSmitsRow;

/// Three planes: first every triple of telling values, ties of r, g and b in every combination among them, in
/// an order that mixes cases within a vector; then random pixels.
Floats telling_rgb(std::size_t n, std::uint32_t seed) {
  const float values[] = {0.0F, -0.0F, 0.25F, 0.5F,     1.0F,     -1.0F, kNan,
                          kInf, -kInf, kTiny, 65504.0F, 70000.0F, kMost, -0.125F};
  constexpr std::size_t kCount = std::size(values);
  constexpr std::size_t kTriples = kCount * kCount * kCount;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0F, 1.2F);
  std::vector<std::size_t> order(kTriples);
  for (std::size_t i = 0; i < kTriples; ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  Floats rgb(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t t = order[i % kTriples];
    const std::size_t pick[3] = {t % kCount, t / kCount % kCount, t / kCount / kCount};
    for (std::size_t c = 0; c < 3; ++c) rgb[c * n + i] = i < kTriples ? values[pick[c]] : unit(random);
  }
  return rgb;
}

/// The library's own table, one of both signs and one of any bits.
std::vector<Floats> tables(std::size_t bands) {
  std::vector<Floats> out;
  const auto upsampler =
      *Upsampler::create(Method::kSmits, Quantity::kReflectance, *Bands::uniform(400, 400 + 5.0 * bands, 5));
  out.emplace_back(std::span(UpsamplerAccess::table(upsampler), bands * kSmitsRow));
  out.push_back(plain_floats(bands * kSmitsRow, 71, -1.0F, 1.0F));
  out.push_back(arbitrary_floats(bands * kSmitsRow, 72));
  return out;
}

class SmitsKernels : public KernelTest {
 protected:
  /// Runs both tables' row kernels into rows at odd addresses with guards around each, for n pixels.
  template <class Sample, class Kernel>
  void expect_same_rows(Kernel kernel, std::size_t n, std::size_t bands, const Floats& table, float lowest) {
    constexpr std::size_t kGuard = 67;
    constexpr unsigned char kSentinel = 0xA5;
    const std::size_t padded = blocks_for(n) * kLanes;
    const Floats rgb = telling_rgb(padded, static_cast<std::uint32_t>(n));
    const float* const planes[3] = {rgb.data(), rgb.data() + padded, rgb.data() + 2 * padded};
    const std::size_t bytes = n * sizeof(Sample);
    std::vector<unsigned char> memory[2];
    for (std::size_t run = 0; run < 2; ++run) {
      memory[run].assign(bands * (bytes + 2 * kGuard) + 64, kSentinel);
      const std::uintptr_t base = reinterpret_cast<std::uintptr_t>(memory[run].data());
      unsigned char* start = memory[run].data() + (64 - base % 64) % 64;
      std::vector<void*> rows(bands);
      for (std::size_t band = 0; band < bands; ++band) {
        // Odd whatever the band: the stride may be odd or even, the start is moved to suit.
        unsigned char* row = start + band * (bytes + 2 * kGuard) + kGuard;
        rows[band] = row - (reinterpret_cast<std::uintptr_t>(row) % 2 == 0 ? 1 : 0);
        ASSERT_EQ(reinterpret_cast<std::uintptr_t>(rows[band]) % 2, 1U);
      }
      const KernelTable& t = run == 0 ? k() : ref();
      (t.*kernel)(rows.data(), planes, {table.data(), bands, lowest}, n);
      for (std::size_t band = 0; band < bands; ++band) {
        const auto* row = static_cast<const unsigned char*>(rows[band]);
        for (std::size_t i = 1; i < kGuard - 1; ++i) {
          ASSERT_EQ(*(row - i), kSentinel) << t.name << " wrote " << i << " bytes before row " << band;
          ASSERT_EQ(row[bytes + i - 1], kSentinel) << t.name << " wrote behind row " << band << " of " << n;
        }
        if (run == 0) continue;
        const unsigned char* other = memory[0].data() +
                                     (64 - reinterpret_cast<std::uintptr_t>(memory[0].data()) % 64) % 64 +
                                     (row - start);
        for (std::size_t i = 0; i < n; ++i) {
          Sample want{};
          Sample got{};
          std::memcpy(&want, row + i * sizeof(Sample), sizeof(Sample));
          std::memcpy(&got, other + i * sizeof(Sample), sizeof(Sample));
          ASSERT_TRUE(same(got, want)) << "pixel " << i << " of " << n << ", band " << band;
        }
      }
    }
  }
  static bool same(float a, float b) { return same_bits(a, b); }
  static bool same(std::uint16_t a, std::uint16_t b) {
    return a == b || ((a & 0x7FFFU) > 0x7C00U && (b & 0x7FFFU) > 0x7C00U);
  }
};

TEST_P(SmitsKernels, BlocksGiveTheReferencesBitsHoweverStored) {
  for (const std::size_t bands : {1, 2, 3, 31, 60}) {
    for (const Floats& table : tables(bands)) {
      for (const std::size_t lanes : kSizes) {
        const std::size_t blocks = blocks_for(lanes);
        const std::size_t n = blocks * kLanes;
        const Floats rgb = telling_rgb(n, static_cast<std::uint32_t>(lanes));
        const float* const planes[3] = {rgb.data(), rgb.data() + n, rgb.data() + 2 * n};
        for (const float lowest : {0.0F, -kInf}) {
          Floats want(n * bands);
          ref().smits_blocks(want.data(), planes, {table.data(), bands, lowest}, blocks, false);
          for (const bool non_temporal : {false, true}) {
            Floats got(n * bands);
            k().smits_blocks(got.data(), planes, {table.data(), bands, lowest}, blocks, non_temporal);
            ASSERT_TRUE(same_bits(got, want))
                << bands << " bands, " << lanes << " lanes, non-temporal " << non_temporal;
          }
        }
      }
    }
  }
}

TEST_P(SmitsKernels, FloatRowsGiveTheReferencesBitsAtOddAddresses) {
  for (const std::size_t bands : {1, 5}) {
    for (const Floats& table : tables(bands)) {
      for (const std::size_t n : kSizes) {
        for (const float lowest : {0.0F, -kInf}) {
          expect_same_rows<float>(&KernelTable::smits_rows_float, n, bands, table, lowest);
        }
      }
    }
  }
}

TEST_P(SmitsKernels, HalfRowsGiveTheReferencesBitsAtOddAddresses) {
  for (const std::size_t bands : {1, 5}) {
    for (const Floats& table : tables(bands)) {
      for (const std::size_t n : kSizes) {
        for (const float lowest : {0.0F, -kInf}) {
          expect_same_rows<std::uint16_t>(&KernelTable::smits_rows_half, n, bands, table, lowest);
        }
      }
    }
  }
}

TEST_P(SmitsKernels, EveryRowLengthUpToThreeBlocksGivesTheReferencesBits) {
  const Floats table = std::move(tables(2)[0]);
  for (std::size_t n = 0; n <= 3 * kLanes; ++n) {
    expect_same_rows<float>(&KernelTable::smits_rows_float, n, 2, table, 0.0F);
    expect_same_rows<std::uint16_t>(&KernelTable::smits_rows_half, n, 2, table, 0.0F);
  }
}

TEST(ReferenceSmits, HalfRowsStayFiniteForFiniteSamples) {
  const float one[3][kLanes] = {{70000.0F}, {70000.0F}, {70000.0F}};
  const float* const planes[3] = {one[0], one[1], one[2]};
  const float row[kSmitsRow] = {1, 1, 1, 1, 1, 1, 1, 0};
  std::uint16_t out = 0;
  void* rows[1] = {&out};
  reference::kKernelTable.smits_rows_half(rows, planes, {row, 1, 0.0F}, 1);
  EXPECT_EQ(out, 0x7BFFU);
}

SPECTILE_FOR_EVERY_ISA(SmitsKernels);

}  // namespace
}  // namespace spectile::test
