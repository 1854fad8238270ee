// Element-wise kernels, folds, masks, sums and transforms of every instruction set give the reference's bits.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::KernelTable;
using kernels::kLanes;

// A name, a lane count and this many functions, all of them tested in the kernels*_test.cpp files: a new one
// needs its test there before it is counted here.
constexpr std::size_t kFunctions = 78;
static_assert(sizeof(KernelTable) == 2 * sizeof(void*) + kFunctions * sizeof(void (*)()));

using Unary = void (*KernelTable::*)(float*, const float*, std::size_t) noexcept;
using Binary = void (*KernelTable::*)(float*, const float*, const float*, std::size_t) noexcept;
using Fold = void (*KernelTable::*)(float*, const float*, std::size_t, std::size_t) noexcept;
using MaskOf = void (*KernelTable::*)(std::uint64_t*, const float*, std::size_t, std::size_t) noexcept;

constexpr std::size_t kBandCounts[] = {1, 2, 3, 31, 60};

class Kernels : public KernelTest {
 protected:
  /// Runs `f(table, dst)` with this table and with the reference, both on the same data.
  template <class F>
  void expect_same(std::size_t n, F f) {
    Floats got(n);
    Floats want(n);
    f(k(), got.data());
    f(ref(), want.data());
    EXPECT_TRUE(same_bits(got, want));
  }
};

TEST_P(Kernels, UnaryOperationsGiveTheReferencesBits) {
  for (const Unary f :
       {&KernelTable::negate, &KernelTable::complement, &KernelTable::sqrt, &KernelTable::exp}) {
    for (const std::size_t lanes : kSizes) {
      const Floats a = arbitrary_floats(blocks_for(lanes) * kLanes, static_cast<std::uint32_t>(lanes));
      expect_same(a.size(), [&](const KernelTable& t, float* dst) { (t.*f)(dst, a.data(), a.size()); });
    }
  }
}

TEST_P(Kernels, UnaryOperationsWorkInPlace) {
  for (const Unary f :
       {&KernelTable::negate, &KernelTable::complement, &KernelTable::sqrt, &KernelTable::exp}) {
    const Floats a = arbitrary_floats(17 * kLanes, 4);
    expect_same(a.size(), [&](const KernelTable& t, float* dst) {
      std::copy_n(a.data(), a.size(), dst);
      (t.*f)(dst, dst, a.size());
    });
  }
}

TEST_P(Kernels, BinaryOperationsGiveTheReferencesBits) {
  for (const Binary f : {&KernelTable::add, &KernelTable::subtract, &KernelTable::multiply,
                         &KernelTable::divide, &KernelTable::divide_or_zero}) {
    for (const std::size_t lanes : kSizes) {
      const Floats a = arbitrary_floats(blocks_for(lanes) * kLanes, static_cast<std::uint32_t>(lanes) + 100);
      const Floats b = arbitrary_floats(a.size(), static_cast<std::uint32_t>(lanes) + 200);
      expect_same(a.size(),
                  [&](const KernelTable& t, float* dst) { (t.*f)(dst, a.data(), b.data(), a.size()); });
    }
  }
}

TEST_P(Kernels, BinaryOperationsGiveTheReferencesBitsForEveryPairOfSpecialValues) {
  const auto& special = special_values();
  const std::size_t pairs = special.size() * special.size();
  Floats a(blocks_for(pairs) * kLanes);
  Floats b(a.size());
  for (std::size_t i = 0; i < pairs; ++i) {
    a[i] = special[i / special.size()];
    b[i] = special[i % special.size()];
  }
  for (const Binary f : {&KernelTable::add, &KernelTable::subtract, &KernelTable::multiply,
                         &KernelTable::divide, &KernelTable::divide_or_zero}) {
    expect_same(a.size(),
                [&](const KernelTable& t, float* dst) { (t.*f)(dst, a.data(), b.data(), a.size()); });
    for (const bool onto_first : {true, false}) {
      expect_same(a.size(), [&](const KernelTable& t, float* dst) {
        std::copy_n(onto_first ? a.data() : b.data(), a.size(), dst);
        (t.*f)(dst, onto_first ? dst : a.data(), onto_first ? b.data() : dst, a.size());
      });
    }
  }
}

TEST_P(Kernels, ScaleAndClampGiveTheReferencesBits) {
  const Floats a = arbitrary_floats(65 * kLanes, 11);
  for (const float s : special_values()) {
    expect_same(a.size(), [&](const KernelTable& t, float* dst) { t.scale(dst, a.data(), s, a.size()); });
  }
  const float limits[][2] = {{0, 1},    {-0.0F, 0.0F}, {0.0F, -0.0F}, {0.25F, 0.25F}, {-kInf, kInf},
                             {0, kInf}, {-1, kMost},   {kInf, kInf},  {kTiny, 1}};
  for (const auto& limit : limits) {
    expect_same(a.size(), [&](const KernelTable& t, float* dst) {
      t.clamp(dst, a.data(), limit[0], limit[1], a.size());
    });
  }
}

TEST_P(Kernels, MultiplyAddGivesTheReferencesBitsAndRoundsTwice) {
  for (const std::size_t lanes : kSizes) {
    const Floats a = arbitrary_floats(blocks_for(lanes) * kLanes, static_cast<std::uint32_t>(lanes) + 1);
    const Floats b = arbitrary_floats(a.size(), static_cast<std::uint32_t>(lanes) + 2);
    const Floats c = arbitrary_floats(a.size(), static_cast<std::uint32_t>(lanes) + 3);
    expect_same(a.size(), [&](const KernelTable& t, float* dst) {
      t.multiply_add(dst, a.data(), b.data(), c.data(), a.size());
    });
  }
  // (1 + e)^2 - (1 + 2e) is 0 with the product rounded first, e^2 when fused.
  Floats x(kLanes);
  Floats minus(kLanes);
  std::fill_n(x.data(), kLanes, 1.0F + 0x1p-23F);
  std::fill_n(minus.data(), kLanes, -(1.0F + 0x1p-22F));
  Floats out(kLanes);
  k().multiply_add(out.data(), x.data(), x.data(), minus.data(), kLanes);
  EXPECT_EQ(out[0], 0.0F);
  EXPECT_NE(std::fma(x[0], x[0], minus[0]), 0.0F);
}

TEST_P(Kernels, LerpGivesTheReferencesBits) {
  const Floats a = arbitrary_floats(65 * kLanes, 21);
  const Floats b = arbitrary_floats(65 * kLanes, 22);
  for (const float t : {0.0F, 1.0F, 0.5F, 0.1F, 1.0F / 3.0F, -2.0F, 7.5F, 0x1p-25F, kInf, kNan}) {
    expect_same(a.size(), [&](const KernelTable& table, float* dst) {
      table.lerp(dst, a.data(), b.data(), t, a.size());
    });
  }
}

TEST_P(Kernels, OneNumberALaneOrABandGivesTheReferencesBits) {
  using OfTwo = void (*KernelTable::*)(float*, const float*, const float*, std::size_t, std::size_t) noexcept;
  for (const OfTwo f : {&KernelTable::scale_lanes, &KernelTable::scale_bands, &KernelTable::transmittance}) {
    for (const std::size_t bands : kBandCounts) {
      for (const std::size_t lanes : kSizes) {
        const std::size_t blocks = blocks_for(lanes);
        const Floats a = arbitrary_floats(blocks * bands * kLanes, static_cast<std::uint32_t>(lanes + bands));
        const Floats other = arbitrary_floats(std::max(blocks, bands) * kLanes, 41);
        expect_same(a.size(), [&](const KernelTable& t, float* dst) {
          (t.*f)(dst, a.data(), other.data(), bands, blocks);
        });
        expect_same(a.size(), [&](const KernelTable& t, float* dst) {  // in place
          std::copy_n(a.data(), a.size(), dst);
          (t.*f)(dst, dst, other.data(), bands, blocks);
        });
        const Floats b = arbitrary_floats(a.size(), 42);
        expect_same(a.size(), [&](const KernelTable& t, float* dst) {
          t.lerp_lanes(dst, a.data(), b.data(), other.data(), bands, blocks);
        });
        expect_same(a.size(), [&](const KernelTable& t, float* dst) {
          t.multiply_add_lanes(dst, a.data(), other.data(), b.data(), bands, blocks);
        });
      }
    }
  }
}

TEST_P(Kernels, TransmittanceGivesTheReferencesBitsOverItsWholeRange) {
  Floats a(2048 * kLanes);
  Floats t(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = -90.0F + 200.0F * static_cast<float>(i) / static_cast<float>(a.size());
    t[i] = 0.5F + static_cast<float>(i % 97) / 96.0F;
  }
  expect_same(a.size(), [&](const KernelTable& k, float* dst) {
    k.transmittance(dst, a.data(), t.data(), 1, a.size() / kLanes);
  });
}

TEST_P(Kernels, ExpGivesTheReferencesBitsOverItsWholeRange) {
  Floats a(2048 * kLanes);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = -110.0F + 210.0F * static_cast<float>(i) / static_cast<float>(a.size());
  }
  expect_same(a.size(), [&](const KernelTable& t, float* dst) { t.exp(dst, a.data(), a.size()); });
}

TEST_P(Kernels, PowGivesTheReferencesBitsForEveryKindOfExponent) {
  std::vector<float> exponents = {
      2,      3,    -2,    -3,    -0.5F,         1.0F / 3.0F,  2.4F,       1.0F / 2.4F,
      2.2F,   1e8F, -1e8F, 1e-8F, 16777215.0F,   -16777215.0F, 8388607.5F, 0.999F,
      149.0F, -149, 37.5F, 128,   2147483648.0F, 4294967296.0F};
  exponents.insert(exponents.end(), special_values().begin(), special_values().end());
  const Floats a = arbitrary_floats(32 * kLanes, 31);
  for (const float y : exponents) {
    SCOPED_TRACE("to the " + std::to_string(y));
    expect_same(a.size(), [&](const KernelTable& t, float* dst) { t.pow(dst, a.data(), y, a.size()); });
    expect_same(a.size(), [&](const KernelTable& t, float* dst) {
      std::copy_n(a.data(), a.size(), dst);
      t.pow(dst, dst, y, a.size());
    });
    if (HasFailure()) return;  // one exponent says enough
  }
}

TEST_P(Kernels, ExtremesPerLaneGiveTheReferencesBits) {
  for (const Fold f : {&KernelTable::minimum, &KernelTable::maximum}) {
    for (const std::size_t bands : kBandCounts) {
      for (const std::size_t lanes : kSizes) {
        const std::size_t blocks = blocks_for(lanes);
        const Floats a = arbitrary_floats(blocks * bands * kLanes, static_cast<std::uint32_t>(lanes + bands));
        expect_same(blocks * kLanes,
                    [&](const KernelTable& t, float* dst) { (t.*f)(dst, a.data(), bands, blocks); });
      }
    }
  }
}

/// Mostly zeros of both signs, so that black lanes occur; some NaN and denormals.
Floats sparse_floats(std::size_t count, std::uint32_t seed, std::uint32_t rarity) {
  std::mt19937 random(seed);
  Floats out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float zero = random() % 2 == 0 ? 0.0F : -0.0F;
    const float other[] = {kNan, kTiny, -kTiny, 1.0F, -kInf};
    out[i] = random() % rarity == 0 ? other[random() % 5] : zero;
  }
  return out;
}

TEST_P(Kernels, MasksGiveTheReferencesBits) {
  for (const std::size_t bands : kBandCounts) {
    for (const std::size_t lanes : kSizes) {
      const std::size_t blocks = blocks_for(lanes);
      for (const std::uint32_t rarity : {3U, 40U, 100000U}) {
        const Floats a = sparse_floats(blocks * bands * kLanes, 7 + rarity, rarity);
        const Floats b = sparse_floats(a.size(), 8 + rarity, 500);
        std::vector<std::uint64_t> got(blocks + 1, 0x5A5A5A5A5A5A5A5AU);
        std::vector<std::uint64_t> want = got;
        for (const MaskOf f : {&KernelTable::black_mask, &KernelTable::nan_mask}) {
          (k().*f)(got.data(), a.data(), bands, blocks);
          (ref().*f)(want.data(), a.data(), bands, blocks);
          ASSERT_EQ(got, want) << bands << " bands, " << lanes << " lanes";
        }
        k().equal_mask(got.data(), a.data(), b.data(), bands, blocks);
        ref().equal_mask(want.data(), a.data(), b.data(), bands, blocks);
        ASSERT_EQ(got, want) << bands << " bands, " << lanes << " lanes";
      }
    }
  }
}

TEST_P(Kernels, MasksHaveExactlyTheBitOfTheLaneConcerned) {
  constexpr std::size_t kBands = 3;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t band = 0; band < kBands; ++band) {
      Floats a(kBands * kLanes);
      const Floats zeros(a.size());
      a[band * kLanes + lane] = kNan;
      std::uint64_t black = 0;
      std::uint64_t nan = 0;
      std::uint64_t equal = 0;
      k().black_mask(&black, a.data(), kBands, 1);
      k().nan_mask(&nan, a.data(), kBands, 1);
      k().equal_mask(&equal, a.data(), zeros.data(), kBands, 1);
      ASSERT_EQ(black, ~(std::uint64_t{1} << lane));
      ASSERT_EQ(nan, std::uint64_t{1} << lane);
      ASSERT_EQ(equal, ~(std::uint64_t{1} << lane));
    }
  }
}

TEST_P(Kernels, WeightedSumsGiveTheReferencesBits) {
  for (const bool arbitrary : {false, true}) {
    for (const std::size_t bands : kBandCounts) {
      const Floats weights =
          arbitrary ? arbitrary_floats(4 * bands, 41) : plain_floats(4 * bands, 42, -0.1F, 2.0F);
      for (const std::size_t lanes : kSizes) {
        const std::size_t blocks = blocks_for(lanes);
        const std::size_t n = blocks * kLanes;
        const Floats a = arbitrary ? arbitrary_floats(n * bands, 43) : plain_floats(n * bands, 44);
        expect_same(n, [&](const KernelTable& t, float* dst) {
          t.weighted_sum(dst, a.data(), weights.data(), bands, blocks);
        });
        expect_same(3 * n, [&](const KernelTable& t, float* dst) {
          float* const out[3] = {dst, dst + n, dst + 2 * n};
          t.project(out, a.data(), weights.data(), bands, blocks);
        });
      }
    }
  }
}

TEST_P(Kernels, TransformGivesTheReferencesBitsAlsoInPlace) {
  for (const bool arbitrary : {false, true}) {
    const Floats m = arbitrary ? arbitrary_floats(9, 51) : plain_floats(9, 52, -2.0F, 3.0F);
    for (const std::size_t lanes : kSizes) {
      const std::size_t n = blocks_for(lanes) * kLanes;
      const Floats a = arbitrary ? arbitrary_floats(3 * n, 53) : plain_floats(3 * n, 54, -1.0F, 2.0F);
      const float* const src[3] = {a.data(), a.data() + n, a.data() + 2 * n};
      expect_same(3 * n, [&](const KernelTable& t, float* dst) {
        float* const out[3] = {dst, dst + n, dst + 2 * n};
        t.transform3(out, src, m.data(), n);
      });
      expect_same(3 * n, [&](const KernelTable& t, float* dst) {
        std::copy_n(a.data(), 3 * n, dst);
        float* const out[3] = {dst, dst + n, dst + 2 * n};
        const float* const in[3] = {dst, dst + n, dst + 2 * n};
        t.transform3(out, in, m.data(), n);
      });
    }
  }
}

SPECTILE_FOR_EVERY_ISA(Kernels);

}  // namespace
}  // namespace spectile::test
