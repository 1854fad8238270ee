// ZipEncoder: the same bytes wherever its memory lies, and that zlib's format is what they are in.
#include "src/io/exr/encoders/zip_encoder.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace spectile::test {
namespace {

using Bytes = std::vector<std::byte>;

/// Bytes with a short period and some that break it; a start of zeros, ones or neither.
Bytes periodic_bytes(std::mt19937& random) {
  Bytes out(2 + random() % (random() % 8 == 0 ? 20000 : 200));
  Bytes pattern(2 + random() % 8);
  for (std::byte& b : pattern) b = static_cast<std::byte>(random() % 3 * 64);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = random() % 9 == 0 ? static_cast<std::byte>(random() % 4 * 50) : pattern[i % pattern.size()];
  }
  const std::size_t start = random() % 3 == 0 ? random() % out.size() : 0;
  std::fill_n(out.begin(), start, static_cast<std::byte>(random() % 2 * 255));
  return out;
}

Bytes encoded(io::ZipEncoder& encoder, const Bytes& packed) {
  const auto out = encoder.encode(packed);
  return {out.begin(), out.end()};
}

TEST(ZipEncoder, GivesTheSameBytesAtEveryAddress) {
  std::mt19937 random(7);
  std::vector<Bytes> chunks(3000);
  for (Bytes& chunk : chunks) chunk = periodic_bytes(random);
  std::vector<std::unique_ptr<io::ZipEncoder>> encoders;
  for (int i = 0; i < 24; ++i) encoders.push_back(std::make_unique<io::ZipEncoder>(1));
  std::vector<std::size_t> different(encoders.size());
  for (const Bytes& chunk : chunks) {
    const Bytes want = encoded(*encoders.front(), chunk);
    for (std::size_t i = 1; i < encoders.size(); ++i) different[i] += encoded(*encoders[i], chunk) != want;
  }
  EXPECT_EQ(different, std::vector<std::size_t>(encoders.size()));
}

TEST(ZipEncoder, DecodesToTheFilteredBytes) {
  std::mt19937 random(11);
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflate(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  for (const int level : {1, 4, 9}) {
    io::ZipEncoder encoder(level);
    for (int trial = 0; trial < 1000; ++trial) {
      const Bytes packed = periodic_bytes(random);
      const Bytes compressed = encoded(encoder, packed);
      if (compressed.size() == packed.size()) {
        EXPECT_EQ(compressed, packed);
        continue;
      }
      Bytes filtered(packed.size());
      ASSERT_EQ(libdeflate_zlib_decompress(inflate.get(), compressed.data(), compressed.size(),
                                           filtered.data(), filtered.size(), nullptr),
                LIBDEFLATE_SUCCESS);
      // Sums of differences, then even bytes and odd ones together again.
      for (std::size_t i = 1; i < filtered.size(); ++i) {
        filtered[i] =
            static_cast<std::byte>(static_cast<int>(filtered[i]) + static_cast<int>(filtered[i - 1]) - 128);
      }
      Bytes back(packed.size());
      const std::size_t half = (packed.size() + 1) / 2;
      for (std::size_t i = 0; i < back.size(); ++i) back[i] = filtered[i % 2 == 0 ? i / 2 : half + i / 2];
      EXPECT_EQ(back, packed);
    }
  }
}

}  // namespace
}  // namespace spectile::test
