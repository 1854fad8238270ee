// Sigmoid kernels: every instruction set gives the reference's bits, whatever the input and the neighbours.
#include <cstring>
#include <numeric>
#include <spectile/upsampling/upsample.hpp>
#include <type_traits>

#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::KernelTable;
using kernels::kLanes;
using kernels::kSigmoidNode;
using kernels::kSigmoidQ;
using kernels::kSigmoidRow;
using kernels::SigmoidForm;
using kernels::SigmoidTable;

constexpr SigmoidForm kForms[] = {SigmoidForm::kQuadratic, SigmoidForm::kFunctions};

Method method_of(SigmoidForm form) {
  return form == SigmoidForm::kQuadratic ? Method::kSigmoid : Method::kSigmoidObserver;
}

/// Tables of 65 bands; the first of them make a table of fewer.
SigmoidTable sigmoid_table(std::size_t bands, SigmoidForm form = SigmoidForm::kQuadratic) {
  const auto make = [](SigmoidForm of) {
    return *Upsampler::create(method_of(of), Quantity::kIlluminant, *Bands::uniform(400, 725, 5));
  };
  static const Upsampler upsamplers[] = {make(SigmoidForm::kQuadratic), make(SigmoidForm::kFunctions)};
  SigmoidTable table = UpsamplerAccess::sigmoid(upsamplers[form == SigmoidForm::kFunctions])->table;
  table.bands = bands;
  return table;
}

/// sRGB reflectances under D65 over the default bands: of quadratics the published case.
SigmoidTable default_table(SigmoidForm form = SigmoidForm::kQuadratic) {
  const auto make = [](SigmoidForm of) {
    return *Upsampler::create(method_of(of), Quantity::kReflectance, Bands());
  };
  static const Upsampler upsamplers[] = {make(SigmoidForm::kQuadratic), make(SigmoidForm::kFunctions)};
  return UpsamplerAccess::sigmoid(upsamplers[form == SigmoidForm::kFunctions])->table;
}

/// Three planes of n: triples of telling values (cube corners, edges and faces, near black and near white,
/// just and far outside the cube, no colour at all) in an order that mixes them, between ordinary colours.
Floats sigmoid_colors(std::size_t n, std::uint32_t seed) {
  const float values[] = {0.0F,  -0.0F,    kTiny, 0x1p-26F, 0x1p-25F, 1e-4F, 0.02F, 0.5F, 1.0F - 0x1p-24F,
                          1.0F,  1.00001F, 1.2F,  -1e-3F,   -0.3F,    70000, kMost, kNan, kInf,
                          -kInf, 0.25F,    0.9F,  -kTiny};
  constexpr std::size_t kCount = std::size(values);
  std::vector<std::size_t> order(kCount * kCount * kCount);
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  Floats rgb(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t t = order[i % order.size()];
    const std::size_t pick[3] = {t % kCount, t / kCount % kCount, t / kCount / kCount};
    // Every other colour is an ordinary one, so that those that need many steps have quick neighbours; and so
    // are the bright greys, of which another test looks at every one.
    const bool grey = pick[0] == pick[1] && pick[1] == pick[2] && values[pick[0]] > 0.5F;
    const bool telling = i % 2 == 0 && !grey;
    for (std::size_t k = 0; k < 3; ++k) rgb[k * n + i] = telling ? values[pick[k]] : unit(random);
  }
  return rgb;
}

/// Coefficients whose polynomial or its square is huge, tiny, denormal, infinite or no number, and ordinary
/// ones.
Floats telling_coefficients(std::size_t n, std::uint32_t seed) {
  Floats out = arbitrary_floats(3 * n, seed);
  const Floats plain = plain_floats(3 * n, seed + 1, -20.0F, 20.0F);
  for (std::size_t i = 0; i < 3 * n; ++i) {
    if (i % n % 3 == 1) out[i] = plain[i];
    if (i % n % 3 == 2) out[i] = std::ldexp(plain[i], static_cast<int>(i % 161) - 80);
  }
  return out;
}

struct Solved {
  Floats c;
  std::vector<std::uint64_t> unsolved;
};

Solved solved(const KernelTable& t, const SigmoidTable& table, const Floats& rgb) {
  const std::size_t n = rgb.size() / 3;
  Solved out{Floats(3 * n), std::vector<std::uint64_t>(n / kLanes, 0x5A5A5A5A5A5A5A5AU)};
  const float* const in[3] = {rgb.data(), rgb.data() + n, rgb.data() + 2 * n};
  float* const c[3] = {out.c.data(), out.c.data() + n, out.c.data() + 2 * n};
  t.sigmoid_solve(c, in, table, out.unsolved.data(), n);
  return out;
}

class SigmoidKernels : public KernelTest {
 protected:
  void expect_same_solutions(const SigmoidTable& table, const Floats& rgb) {
    const Solved got = solved(k(), table, rgb);
    const Solved want = solved(ref(), table, rgb);
    ASSERT_TRUE(same_bits(got.c, want.c));
    ASSERT_EQ(got.unsolved, want.unsolved);
  }

  template <class Sample, class Kernel>
  void expect_same_rows(Kernel kernel, std::size_t n, std::size_t bands, const float* scale, bool white,
                        SigmoidForm form);
};

TEST_P(SigmoidKernels, SolutionsAreTheReferencesForEveryKindOfColour) {
  for (const SigmoidForm form : kForms) {
    expect_same_solutions(default_table(form), sigmoid_colors(4160, 1));
    for (const std::size_t lanes : kSizes) {
      const Floats rgb = plain_floats(3 * blocks_for(lanes) * kLanes, 2, -0.05F, 1.05F);
      expect_same_solutions(default_table(form), rgb);
    }
  }
}

TEST_P(SigmoidKernels, SolutionsAreTheReferencesForEveryCountOfBands) {
  const Floats rgb = sigmoid_colors(10 * kLanes, 3);
  for (std::size_t bands = 1; bands <= 65; ++bands) {
    SCOPED_TRACE(bands);
    for (const SigmoidForm form : kForms) expect_same_solutions(sigmoid_table(bands, form), rgb);
  }
}

TEST_P(SigmoidKernels, SolutionsAreTheReferencesForTablesOfAnyBits) {
  constexpr std::int32_t kSteps = 3;
  for (const bool arbitrary : {false, true}) {
    const auto floats = [&](std::size_t n, std::uint32_t seed) {
      return arbitrary ? arbitrary_floats(n, seed) : plain_floats(n, seed, -1.0F, 1.0F);
    };
    const Floats rows = floats(9 * kSigmoidRow, 11);
    const Floats weights = floats(4 * 9, 12);
    const Floats nodes = floats(3 * kSteps * kSteps * kSteps * kSigmoidNode, 13);
    for (const SigmoidForm form : kForms) {
      const SigmoidTable table = {9, rows.data(), weights.data(), nodes.data(), kSteps, form};
      expect_same_solutions(table, sigmoid_colors(640, 4));
    }
  }
}

TEST_P(SigmoidKernels, SolutionsMayReplaceTheirColours) {
  const Floats rgb = sigmoid_colors(1280, 5);
  const std::size_t n = rgb.size() / 3;
  const Solved want = solved(k(), default_table(), rgb);
  Floats c(std::span(rgb.data(), rgb.size()));
  float* const planes[3] = {c.data(), c.data() + n, c.data() + 2 * n};
  std::vector<std::uint64_t> unsolved(n / kLanes);
  k().sigmoid_solve(planes, planes, default_table(), unsolved.data(), n);
  EXPECT_TRUE(same_bits(c, want.c));
  EXPECT_EQ(unsolved, want.unsolved);
}

TEST_P(SigmoidKernels, ALaneDoesNotDependOnItsNeighbours) {
  const std::size_t n = 4160;
  const Floats rgb = sigmoid_colors(n, 6);
  const Solved straight = solved(k(), default_table(), rgb);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937 random(7);
  std::shuffle(order.begin(), order.end(), random);
  Floats shuffled(3 * n);
  for (std::size_t i = 0; i < 3 * n; ++i) shuffled[i] = rgb[i / n * n + order[i % n]];
  const Solved mixed = solved(k(), default_table(), shuffled);
  const auto bit = [](const Solved& s, std::size_t i) { return s.unsolved[i / kLanes] >> (i % kLanes) & 1U; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_TRUE(same_bits(mixed.c[c * n + i], straight.c[c * n + order[i]])) << "lane " << i << " of " << n;
    }
    ASSERT_EQ(bit(mixed, i), bit(straight, order[i])) << "lane " << i;
  }
}

TEST_P(SigmoidKernels, BlocksAreTheReferencesHoweverStoredAndScaled) {
  for (const std::size_t bands : {1, 2, 7, 8, 9, 31, 60, 65}) {
    const Floats arbitrary_rows = arbitrary_floats(bands * kSigmoidRow, 21);
    for (const std::size_t lanes : {std::size_t{1}, std::size_t{65}, bands == 60 ? std::size_t{4099} : 17}) {
      const std::size_t blocks = blocks_for(lanes);
      const std::size_t n = blocks * kLanes;
      const Floats coefficients = telling_coefficients(n, 22);
      const Floats scales = arbitrary_floats(n, 23);
      const float* const c[3] = {coefficients.data(), coefficients.data() + n, coefficients.data() + 2 * n};
      for (const float* rows : {sigmoid_table(bands).rows, sigmoid_table(bands, SigmoidForm::kFunctions).rows,
                                arbitrary_rows.data()}) {
        for (const float* scale : {static_cast<const float*>(nullptr), scales.data()}) {
          for (const bool white : {false, true}) {
            Floats want(n * bands);
            for (const SigmoidForm form : kForms) {
              const kernels::SigmoidSpectra spectra = {c, scale, rows, bands, white, form};
              ref().sigmoid_blocks(want.data(), spectra, blocks, false);
              for (const bool non_temporal : {false, true}) {
                Floats got(n * bands);
                k().sigmoid_blocks(got.data(), spectra, blocks, non_temporal);
                ASSERT_TRUE(same_bits(got, want))
                    << bands << " bands, " << lanes << " lanes, " << non_temporal;
              }
            }
          }
        }
      }
    }
  }
}

TEST_P(SigmoidKernels, FusedMultiplyAddsRoundOnce) {
  // The inner sum lies so near the middle between two floats that rounding it to double first would make it
  // the middle itself, and then the wrong neighbour; the outer sum subtracts what the right one is, which
  // leaves 0.
  constexpr std::size_t kLanesHere = 4096;
  constexpr std::size_t kBands = 16;
  const Floats lambdas = plain_floats(kBands, 31, 0.5F, 1.5F);
  Floats rows(kBands * kSigmoidRow);
  for (std::size_t b = 0; b < kBands; ++b) rows[b * kSigmoidRow + kSigmoidQ] = lambdas[b];
  rows[kSigmoidQ] = 1.0F + 0x1p-23F;
  Floats c(3 * kLanesHere);
  std::mt19937 random(32);
  for (std::size_t i = 0; i < kLanesHere; ++i) {
    const float lambda = rows[i % kBands * kSigmoidRow + kSigmoidQ];
    const float middle = std::ldexp(random() % 2 == 0 ? 0x1p-24F : -0x1p-24F, static_cast<int>(random() % 2));
    c[i] = middle / lambda;
    c[kLanesHere + i] = 1.0F + 0x1p-23F * static_cast<float>(random() >> 9);
    c[2 * kLanesHere + i] = -(std::fma(c[i], lambda, c[kLanesHere + i]) * lambda);
  }
  // A case by hand: 2^-24 (1 - 2^-23) times 1 + 2^-23 is just under half a place of 1 + 2^-23.
  c[0] = 0x1p-24F * (1.0F - 0x1p-23F);
  c[kLanesHere] = 1.0F + 0x1p-23F;
  c[2 * kLanesHere] = -(1.0F + 0x1p-22F);
  const float* const planes[3] = {c.data(), c.data() + kLanesHere, c.data() + 2 * kLanesHere};
  Floats got(kLanesHere * kBands);
  Floats want(kLanesHere * kBands);
  const kernels::SigmoidSpectra spectra = {planes, nullptr, rows.data(), kBands};
  k().sigmoid_blocks(got.data(), spectra, kLanesHere / kLanes, false);
  ref().sigmoid_blocks(want.data(), spectra, kLanesHere / kLanes, false);
  EXPECT_TRUE(same_bits(got, want));
  EXPECT_EQ(got[0], 0.5F);
}

template <class Sample, class Kernel>
void SigmoidKernels::expect_same_rows(Kernel kernel, std::size_t n, std::size_t bands, const float* scale,
                                      bool white, SigmoidForm form) {
  constexpr unsigned char kSentinel = 0xA5;
  const std::size_t padded = blocks_for(n) * kLanes;
  const Floats c = telling_coefficients(padded, static_cast<std::uint32_t>(n));
  const float* const planes[3] = {c.data(), c.data() + padded, c.data() + 2 * padded};
  const std::size_t bytes = n * sizeof(Sample);
  const std::size_t stride = (bytes + 70) | 1U;  // odd, so that every second row starts at an odd address
  std::vector<unsigned char> memory[2];
  for (std::size_t run = 0; run < 2; ++run) {
    memory[run].assign(bands * stride + 70, kSentinel);
    std::vector<void*> rows(bands);
    for (std::size_t b = 0; b < bands; ++b) rows[b] = memory[run].data() + 35 + b * stride;
    const KernelTable& t = run == 0 ? k() : ref();
    (t.*kernel)(rows.data(), {planes, scale, sigmoid_table(bands, form).rows, bands, white, form}, n);
  }
  for (std::size_t at = 0; at < memory[0].size(); ++at) {
    const bool in_row = at >= 35 && (at - 35) % stride < bytes && (at - 35) / stride < bands;
    ASSERT_TRUE(in_row || memory[0][at] == kSentinel) << "byte " << at << " of rows of " << n;
  }
  for (std::size_t b = 0; b < bands; ++b) {
    for (std::size_t i = 0; i < n; ++i) {
      Sample sample[2];
      for (std::size_t run = 0; run < 2; ++run) {
        std::memcpy(&sample[run], memory[run].data() + 35 + b * stride + i * sizeof(Sample), sizeof(Sample));
      }
      if constexpr (std::is_same_v<Sample, float>) {
        ASSERT_TRUE(same_bits(sample[0], sample[1])) << "pixel " << i << " of " << n << ", band " << b;
      } else {
        const bool nan = (sample[0] & 0x7FFFU) > 0x7C00U && (sample[1] & 0x7FFFU) > 0x7C00U;
        ASSERT_TRUE(nan || sample[0] == sample[1]) << "pixel " << i << " of " << n << ", band " << b;
      }
    }
  }
}

TEST_P(SigmoidKernels, RowsAreTheReferencesAtAnyAddressAndLength) {
  const Floats scales = arbitrary_floats(4160, 41);
  const auto both = [&](std::size_t n, std::size_t bands, const float* scale, bool white) {
    for (const SigmoidForm form : kForms) {
      expect_same_rows<float>(&KernelTable::sigmoid_rows_float, n, bands, scale, white, form);
      expect_same_rows<std::uint16_t>(&KernelTable::sigmoid_rows_half, n, bands, scale, white, form);
    }
  };
  for (std::size_t n = 0; n <= 3 * kLanes; ++n) both(n, 2, n % 2 == 0 ? nullptr : scales.data(), n % 3 == 0);
  for (const bool white : {false, true}) {
    both(4099, 5, nullptr, white);
    both(4099, 5, scales.data(), white);
    both(17, 65, scales.data(), white);
  }
}

TEST_P(SigmoidKernels, ProjectionsAreTheReferencesAlsoInPlace) {
  for (const std::size_t bands : {1, 7, 8, 9, 60, 65}) {
    for (const std::size_t lanes : kSizes) {
      const std::size_t n = blocks_for(lanes) * kLanes;
      const Floats c = telling_coefficients(n, 51);
      const Floats scales = plain_floats(n, 52, 0.0F, 4.0F);
      const Floats weights =
          lanes == 65 ? arbitrary_floats(4 * bands, 53) : plain_floats(4 * bands, 54, -0.1F, 2.0F);
      const float* const in[3] = {c.data(), c.data() + n, c.data() + 2 * n};
      for (const float* scale : {static_cast<const float*>(nullptr), scales.data()}) {
        const auto project = [&](const KernelTable& t, Floats& dst, bool in_place, SigmoidForm form) {
          float* const out[3] = {dst.data(), dst.data() + n, dst.data() + 2 * n};
          const float* const from[3] = {in_place ? out[0] : in[0], in_place ? out[1] : in[1],
                                        in_place ? out[2] : in[2]};
          t.sigmoid_project(out, {from, scale, sigmoid_table(bands, form).rows, bands, lanes % 2 == 0, form},
                            weights.data(), n);
        };
        for (const SigmoidForm form : kForms) {
          Floats want(3 * n);
          Floats got(3 * n);
          Floats replaced(std::span(c.data(), c.size()));
          project(ref(), want, false, form);
          project(k(), got, false, form);
          project(k(), replaced, true, form);
          ASSERT_TRUE(same_bits(got, want)) << bands << " bands, " << lanes << " lanes";
          ASSERT_TRUE(same_bits(replaced, want)) << bands << " bands, " << lanes << " lanes, in place";
        }
      }
    }
  }
}

SPECTILE_FOR_EVERY_ISA(SigmoidKernels);

}  // namespace
}  // namespace spectile::test
