// RunDeflate: deflate in one quick pass over filtered samples, in which long runs cost next to nothing.
//
// Filtered samples are of two kinds: noise, for which a prefix code is all that helps, and runs of one byte,
// which black and constant parts make. So strings are looked for in one place only, ever more rarely where
// none are found, and what is found is taken as far as it goes, whatever its length.
#include "src/io/deflate/run_deflate.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace spectile::io {
namespace {

// RFC 1951: how far back a match may begin.
constexpr std::size_t kWindow = 32768;

constexpr int kHashBits = 15;
// A block's literals and sequences: as many as share one code well.
constexpr std::size_t kBlockLiterals = 65536;
constexpr std::size_t kBlockSequences = 16384;
// Bytes of a block at most, so that all counts stay far from overflow.
constexpr std::size_t kBlockBytes = std::size_t{1} << 28;
// Two to this many bytes in which no string was found make the search's steps one longer, up to a limit.
constexpr int kSkipShift = 8;
constexpr std::size_t kMaxMissed = std::size_t{1} << 16;
// Runs from so many bytes on are black or constant parts.
constexpr std::size_t kLongRun = 512;
std::uint32_t load32(const std::uint8_t* at) {
  std::uint32_t v = 0;
  std::memcpy(&v, at, sizeof(v));
  return v;
}

std::uint64_t load64(const std::uint8_t* at) {
  std::uint64_t v = 0;
  std::memcpy(&v, at, sizeof(v));
  return v;
}

std::size_t hash(std::uint32_t v) {
  // Knuth's multiplier, 2^32 divided by the golden ratio.
  return (v * 2654435761U) >> (32 - kHashBits);
}

/// How many bytes at `a` equal those at `b`, before `end` of a.
std::size_t equal_bytes(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* end) {
  const std::uint8_t* const start = a;
  // Black parts are long: four words at a time, until they differ.
  while (end - a >= 32) {
    const std::uint64_t differences = (load64(a) ^ load64(b)) | (load64(a + 8) ^ load64(b + 8)) |
                                      (load64(a + 16) ^ load64(b + 16)) | (load64(a + 24) ^ load64(b + 24));
    if (differences != 0) break;
    a += 32;
    b += 32;
  }
  while (end - a >= 8) {
    const std::uint64_t difference = load64(a) ^ load64(b);
    if (difference != 0) return static_cast<std::size_t>(a - start) + std::countr_zero(difference) / 8;
    a += 8;
    b += 8;
  }
  while (a < end && *a == *b) {
    ++a;
    ++b;
  }
  return static_cast<std::size_t>(a - start);
}

/// How many bytes before `a` equal those before `b`, up to `most`.
std::size_t equal_bytes_before(const std::uint8_t* a, const std::uint8_t* b, std::size_t most) {
  std::size_t n = 0;
  while (most - n >= 8) {
    const std::uint64_t difference = load64(a - n - 8) ^ load64(b - n - 8);
    if (difference != 0) return n + static_cast<std::size_t>(std::countl_zero(difference)) / 8;
    n += 8;
  }
  while (n < most && a[-1 - static_cast<std::ptrdiff_t>(n)] == b[-1 - static_cast<std::ptrdiff_t>(n)]) ++n;
  return n;
}

}  // namespace

RunDeflate::RunDeflate() : seen_(std::size_t{1} << kHashBits) {
  sequences_.reserve(kBlockSequences + 1);
}

std::size_t RunDeflate::compress(std::span<const std::uint8_t> in, std::uint8_t* out) {
  const std::uint8_t* const bytes = in.data();
  const std::size_t n = in.size();
  std::fill(seen_.begin(), seen_.end(), 0);
  DeflateBits bits(out);
  std::size_t block = 0;   // where the present block begins
  std::size_t anchor = 0;  // the first byte not yet in a sequence
  std::size_t literals = 0;
  // Bytes looked through since a string was found. Long runs do not count: noise between black parts is
  // noise.
  std::size_t missed = 0;
  sequences_.clear();
  const auto end_block = [&](std::size_t end) {
    sequences_.push_back({static_cast<std::uint32_t>(end - anchor), 0, 0});
    put_deflate_block(bits, bytes + block, sequences_, end == n);
    sequences_.clear();
    block = anchor = end;
    literals = 0;
    missed = 0;
  };
  // A match is looked for where eight bytes can be read, and begins after the first byte.
  std::size_t i = 1;
  while (n >= 16 && i + 8 <= n) {
    if (literals + (i - anchor) >= kBlockLiterals || sequences_.size() >= kBlockSequences ||
        i - block >= kBlockBytes) {
      end_block(i);
    }
    const std::uint32_t v = load32(bytes + i);
    std::uint32_t& place = seen_[hash(v)];
    std::size_t found = place;
    place = static_cast<std::uint32_t>(i);
    const bool run = load64(bytes + i) == load64(bytes + i - 1);
    if (run) found = i - 1;
    if (!run && (i - found > kWindow || load32(bytes + found) != v)) {
      const std::size_t step = 1 + (missed >> kSkipShift);
      missed = std::min(missed + step, kMaxMissed);
      i += step;
      continue;
    }
    const std::size_t most = std::min(n, block + kBlockBytes);
    std::size_t length = 4 + equal_bytes(bytes + i + 4, bytes + found + 4, bytes + most);
    // The bytes before it too, as far as no sequence has them.
    const std::size_t before = equal_bytes_before(bytes + i, bytes + found, std::min(i - anchor, found));
    i -= before;
    found -= before;
    length += before;
    if (!run || length < kLongRun) missed = 0;
    sequences_.push_back({static_cast<std::uint32_t>(i - anchor), static_cast<std::uint32_t>(length),
                          static_cast<std::uint32_t>(i - found)});
    literals += i - anchor;
    i += length;
    anchor = i;
    if (i + 2 <= n) seen_[hash(load32(bytes + i - 2))] = static_cast<std::uint32_t>(i - 2);
  }
  end_block(n);
  bits.align();
  return static_cast<std::size_t>(bits.end() - out);
}

}  // namespace spectile::io
