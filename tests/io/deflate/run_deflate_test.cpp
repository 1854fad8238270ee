// The output of RunDeflate is deflate, and gives its input back.
#include "src/io/deflate/run_deflate.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "src/io/deflate/huffman_code.hpp"
#include "src/io/exr/encoders/zip_encoder.hpp"

namespace spectile {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Compresses and decompresses; returns the size between.
std::size_t round_trip(io::RunDeflate& deflate, const Bytes& bytes) {
  struct Free {
    void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
  };
  const std::unique_ptr<libdeflate_decompressor, Free> inflate(libdeflate_alloc_decompressor());
  Bytes out(io::RunDeflate::bound(bytes.size()));
  const std::size_t size = deflate.compress(bytes, out.data());
  EXPECT_LE(size, out.size());
  Bytes back(bytes.size() + 1);
  std::size_t taken = 0;
  std::size_t got = 0;
  EXPECT_EQ(libdeflate_deflate_decompress_ex(inflate.get(), out.data(), size, back.data(), back.size(),
                                             &taken, &got),
            LIBDEFLATE_SUCCESS);
  EXPECT_EQ(taken, size);
  EXPECT_EQ(got, bytes.size());
  back.resize(bytes.size());
  EXPECT_EQ(back, bytes);
  return size;
}

/// Bytes of one of several kinds: noise, runs, few values, skewed ones, repetitions near and far.
Bytes made_up(std::mt19937& random, std::size_t n, unsigned kind) {
  Bytes out;
  while (out.size() < n) {
    const std::size_t longest[] = {1, 600, 5000, 40, 40, 400, 1};
    const std::size_t run = std::min<std::size_t>(1 + random() % longest[kind], n - out.size());
    const auto byte = static_cast<std::uint8_t>(kind == 3   ? random() % 4
                                                : kind == 4 ? 128 + random() % 3 * (random() % 5)
                                                : kind == 6 ? random() % 16 * (random() % 2)
                                                            : random());
    const std::size_t back =
        kind == 5 && !out.empty() ? 1 + random() % std::min<std::size_t>(out.size(), 40000) : 0;
    for (std::size_t i = 0; i < run; ++i) out.push_back(back > 0 ? out[out.size() - back] : byte);
  }
  return out;
}

TEST(RunDeflate, GivesBackEverySizeAndKind) {
  std::mt19937 random(7);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  io::RunDeflate deflate;
  for (unsigned kind = 0; kind < 7; ++kind) {
    for (std::size_t n = 0; n < 70; ++n) round_trip(deflate, made_up(random, n, kind));
    for (int i = 0; i < 20; ++i) round_trip(deflate, made_up(random, random() % 30000, kind));
    round_trip(deflate, made_up(random, 400000 + random() % 100, kind));
    ASSERT_FALSE(testing::Test::HasFailure()) << "kind " << kind;
  }
}

TEST(RunDeflate, EveryLengthOfARunComesBack) {
  io::RunDeflate deflate;
  for (std::size_t run = 1; run < 1100; ++run) {
    Bytes bytes(run + 40, 9);
    std::iota(bytes.begin(), bytes.begin() + 20, std::uint8_t{0});
    std::iota(bytes.end() - 20, bytes.end(), std::uint8_t{100});
    round_trip(deflate, bytes);
    ASSERT_FALSE(testing::Test::HasFailure()) << "run of " << run;
  }
}

TEST(RunDeflate, AMegabyteOfOneByteTakesNextToNothing) {
  io::RunDeflate deflate;
  EXPECT_LT(round_trip(deflate, Bytes(std::size_t{1} << 20, 128)), 1100U);
}

TEST(RunDeflate, NoiseGrowsLittle) {
  std::mt19937 random(8);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  io::RunDeflate deflate;
  const Bytes noise = made_up(random, std::size_t{1} << 20, 0);
  EXPECT_LT(round_trip(deflate, noise), noise.size() + 200);
}

TEST(RunDeflate, OutputDependsOnItsInputOnly) {
  std::mt19937 random(9);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  const Bytes a = made_up(random, 200000, 4);
  const Bytes b = made_up(random, 300000, 6);
  const auto packed = [](io::RunDeflate& deflate, const Bytes& bytes) {
    Bytes out(io::RunDeflate::bound(bytes.size()));
    out.resize(deflate.compress(bytes, out.data()));
    return out;
  };
  io::RunDeflate fresh;
  io::RunDeflate used;
  packed(used, b);
  EXPECT_EQ(packed(used, a), packed(fresh, a));
}

TEST(HuffmanCode, IsCompleteAndWithinItsLength) {
  // Fibonacci's counts make the deepest trees.
  std::vector<std::uint32_t> deep = {1, 1};
  while (deep.size() < 28) deep.push_back(deep[deep.size() - 1] + deep[deep.size() - 2]);
  for (const auto& counts : {deep, std::vector<std::uint32_t>(286, 5), {0, 0, 7, 0}, {3, 0, 0, 1}}) {
    for (const int most : {9, 14}) {
      const io::HuffmanCode code = io::huffman_code(counts, most);
      std::uint64_t used = 0;
      for (std::size_t s = 0; s < counts.size(); ++s) {
        EXPECT_LE(code.bits[s], most);
        EXPECT_TRUE(counts[s] == 0 || code.bits[s] > 0);
        if (code.bits[s] > 0) used += std::uint64_t{1} << (most - code.bits[s]);
      }
      EXPECT_EQ(used, std::uint64_t{1} << most);
    }
  }
}

}  // namespace
}  // namespace spectile
