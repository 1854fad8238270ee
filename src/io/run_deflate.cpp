// RunDeflate: deflate in one quick pass over filtered samples, in which long runs cost next to nothing.
//
// Filtered samples are of two kinds: noise, for which a prefix code is all that helps, and runs of one byte,
// which black and constant parts make. So strings are looked for in one place only, ever more rarely where
// none are found, and what is found is taken as far as it goes, whatever its length.
#include "src/io/run_deflate.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "src/io/huffman_code.hpp"

namespace spectile::io {
namespace {

// RFC 1951, 3.2.5: symbols of literals, the end of a block and lengths; of distances.
constexpr std::size_t kLiterals = 286;
constexpr std::size_t kDistances = 30;
constexpr std::size_t kEndOfBlock = 256;
constexpr std::uint32_t kLongestMatch = 258;
constexpr std::uint32_t kShortestMatch = 3;
constexpr std::size_t kWindow = 32768;
// 3.2.7: the order in which the lengths of the code of lengths are written.
constexpr std::array<std::uint8_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                 11, 4,  12, 3, 13, 2, 14, 1, 15};

constexpr int kHashBits = 15;
// A block's literals and sequences: as many as share one code well.
constexpr std::size_t kBlockLiterals = 65536;
constexpr std::size_t kBlockSequences = 16384;
// Bytes of a block at most, so that all counts stay far from overflow.
constexpr std::size_t kBlockBytes = std::size_t{1} << 28;
// Two to this many bytes without a match make the search's steps one longer.
constexpr int kPatience = 8;
// The longest code: four literals then fit between two flushes of the bits.
constexpr int kMostBits = 14;

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

/// A symbol and the bits after it.
struct Extra {
  std::uint32_t symbol;
  std::uint32_t value;
  int bits;
};

Extra of_length(std::uint32_t length) {
  const std::uint32_t v = length - kShortestMatch;
  if (length == kLongestMatch) return {285, 0, 0};
  if (v < 8) return {257 + v, 0, 0};
  const int bits = std::bit_width(v) - 3;
  return {257 + static_cast<std::uint32_t>(bits) * 4 + (v >> bits), v & ((1U << bits) - 1), bits};
}

Extra of_distance(std::uint32_t distance) {
  const std::uint32_t v = distance - 1;
  if (v < 4) return {v, 0, 0};
  const int bits = std::bit_width(v) - 2;
  return {static_cast<std::uint32_t>(bits) * 2 + (v >> bits), v & ((1U << bits) - 1), bits};
}

/// Deflate knows no matches above 258: one of any length as `whole` of that and up to two more.
struct Pieces {
  std::uint32_t whole;
  std::array<std::uint32_t, 2> rest;  // 0 for none
};

Pieces pieces_of(std::uint32_t length) {
  Pieces out{length / kLongestMatch, {length % kLongestMatch, 0}};
  if (out.rest[0] > 0 && out.rest[0] < kShortestMatch) {
    --out.whole;
    out.rest = {kLongestMatch - kShortestMatch, out.rest[0] + kShortestMatch};
  }
  return out;
}

/// Bits to bytes, the first bit lowest.
class Bits {
 public:
  explicit Bits(std::uint8_t* out) : out_(out) {}
  /// Up to 56 bits between two flushes.
  void put(std::uint64_t v, int bits) {
    held_ |= v << count_;
    count_ += bits;
  }
  void flush() {
    std::memcpy(out_, &held_, sizeof(held_));
    out_ += count_ / 8;
    held_ >>= count_ / 8 * 8;
    count_ %= 8;
  }
  /// Fills the last byte with zeros.
  void align() {
    count_ = (count_ + 7) / 8 * 8;
    flush();
  }
  std::uint8_t* end() const { return out_; }
  void copy(const std::uint8_t* from, std::size_t n) {
    std::memcpy(out_, from, n);
    out_ += n;
  }

 private:
  std::uint8_t* out_;
  std::uint64_t held_ = 0;
  int count_ = 0;
};

/// Bytes as deflate stores them, up to 65535 at a time.
void put_stored(Bits& bits, const std::uint8_t* from, std::size_t n, bool last) {
  do {
    const std::size_t some = std::min<std::size_t>(n, 65535);
    bits.put(last && some == n ? 1 : 0, 3);
    bits.align();
    bits.put(some | (~some & 0xFFFF) << 16, 32);
    bits.flush();
    bits.copy(from, some);
    from += some;
    n -= some;
  } while (n > 0);
}

}  // namespace

/// One block: its counts, codes and bits.
class RunDeflate::Block {
 public:
  Block(const std::uint8_t* from, std::span<const Sequence> sequences) : from_(from), sequences_(sequences) {
    count();
    literal_ = huffman_code(literals_, kMostBits);
    distance_ = huffman_code(distances_, kMostBits);
    describe();
  }

  void put(Bits& bits, bool last) const {
    if (size_bits() >= 8 * (bytes_ + 5 * (bytes_ / 65535 + 1))) {
      put_stored(bits, from_, bytes_, last);
      return;
    }
    bits.put((last ? 1U : 0U) | 2U << 1, 3);
    put_description(bits);
    const std::uint8_t* at = from_;
    for (const Sequence& sequence : sequences_) {
      at = put_literals(bits, at, sequence.literals);
      if (sequence.length > 0) put_match(bits, sequence);
      at += sequence.length;
    }
    bits.put(literal_.code[kEndOfBlock], literal_.bits[kEndOfBlock]);
    bits.flush();
  }

 private:
  void count() {
    // Four counts of every byte, so that one of a run need not wait for the last.
    std::array<std::array<std::uint32_t, 256>, 4> bytes{};
    const std::uint8_t* at = from_;
    for (const Sequence& sequence : sequences_) {
      std::uint32_t i = 0;
      for (; i + 4 <= sequence.literals; i += 4) {
        for (std::size_t k = 0; k < 4; ++k) ++bytes[k][at[i + k]];
      }
      for (; i < sequence.literals; ++i) ++bytes[0][at[i]];
      at += sequence.literals + sequence.length;
      if (sequence.length == 0) continue;
      const Pieces pieces = pieces_of(sequence.length);
      std::uint32_t matches = pieces.whole;
      literals_[285] += pieces.whole;
      for (const std::uint32_t rest : pieces.rest) {
        if (rest == 0) continue;
        const Extra length = of_length(rest);
        ++literals_[length.symbol];
        extra_bits_ += static_cast<std::uint64_t>(length.bits);
        ++matches;
      }
      const Extra distance = of_distance(sequence.distance);
      distances_[distance.symbol] += matches;
      extra_bits_ += std::uint64_t{matches} * static_cast<std::uint64_t>(distance.bits);
    }
    bytes_ = static_cast<std::size_t>(at - from_);
    for (std::size_t b = 0; b < 256; ++b) {
      literals_[b] = bytes[0][b] + bytes[1][b] + bytes[2][b] + bytes[3][b];
    }
    literals_[kEndOfBlock] = 1;
  }

  /// The two codes' lengths, in the words of RFC 1951, 3.2.7.
  void describe() {
    std::vector<std::uint8_t> lengths(literal_.bits);
    lengths.insert(lengths.end(), distance_.bits.begin(), distance_.bits.end());
    std::array<std::uint32_t, 19> counts{};
    for (std::size_t i = 0; i < lengths.size();) {
      std::size_t same = 1;
      while (i + same < lengths.size() && lengths[i + same] == lengths[i]) ++same;
      Extra word{lengths[i], 0, 0};
      std::size_t taken = 1;
      if (lengths[i] == 0 && same >= 11) {
        taken = std::min<std::size_t>(same, 138);
        word = {18, static_cast<std::uint32_t>(taken - 11), 7};
      } else if (lengths[i] == 0 && same >= 3) {
        taken = same;
        word = {17, static_cast<std::uint32_t>(taken - 3), 3};
      } else if (lengths[i] != 0 && i > 0 && lengths[i - 1] == lengths[i] && same >= 3) {
        taken = std::min<std::size_t>(same, 6);
        word = {16, static_cast<std::uint32_t>(taken - 3), 2};
      }
      ++counts[word.symbol];
      words_.push_back(word);
      i += taken;
    }
    lengths_ = huffman_code(counts, 7);
    order_ = kOrder.size();
    while (order_ > 4 && lengths_.bits[kOrder[order_ - 1]] == 0) --order_;
  }

  void put_description(Bits& bits) const {
    bits.put(kLiterals - 257, 5);
    bits.put(kDistances - 1, 5);
    bits.put(order_ - 4, 4);
    bits.flush();
    for (std::size_t i = 0; i < order_; ++i) {
      bits.put(lengths_.bits[kOrder[i]], 3);
      bits.flush();
    }
    for (const Extra& word : words_) {
      bits.put(lengths_.code[word.symbol], lengths_.bits[word.symbol]);
      bits.put(word.value, word.bits);
      bits.flush();
    }
  }

  std::uint64_t size_bits() const {
    std::uint64_t out = 17 + 3 * order_ + extra_bits_;
    for (const Extra& word : words_) {
      out += static_cast<std::uint64_t>(lengths_.bits[word.symbol] + word.bits);
    }
    for (std::size_t s = 0; s < kLiterals; ++s) out += std::uint64_t{literals_[s]} * literal_.bits[s];
    for (std::size_t s = 0; s < kDistances; ++s) out += std::uint64_t{distances_[s]} * distance_.bits[s];
    return out;
  }

  const std::uint8_t* put_literals(Bits& bits, const std::uint8_t* at, std::uint32_t n) const {
    const std::uint16_t* const code = literal_.code.data();
    const std::uint8_t* const length = literal_.bits.data();
    const std::uint8_t* const end = at + n;
    for (; end - at >= 4; at += 4) {
      for (std::size_t k = 0; k < 4; ++k) bits.put(code[at[k]], length[at[k]]);
      bits.flush();
    }
    for (; at < end; ++at) bits.put(code[*at], length[*at]);
    bits.flush();
    return at;
  }

  void put_match(Bits& bits, const Sequence& sequence) const {
    const Extra distance = of_distance(sequence.distance);
    const auto put_distance = [&] {
      bits.put(distance_.code[distance.symbol], distance_.bits[distance.symbol]);
      bits.put(distance.value, distance.bits);
      bits.flush();
    };
    const Pieces pieces = pieces_of(sequence.length);
    for (std::uint32_t i = 0; i < pieces.whole; ++i) {
      bits.put(literal_.code[285], literal_.bits[285]);
      put_distance();
    }
    for (const std::uint32_t rest : pieces.rest) {
      if (rest == 0) continue;
      const Extra length = of_length(rest);
      bits.put(literal_.code[length.symbol], literal_.bits[length.symbol]);
      bits.put(length.value, length.bits);
      put_distance();
    }
  }

  const std::uint8_t* from_;
  std::span<const Sequence> sequences_;
  std::size_t bytes_ = 0;
  std::array<std::uint32_t, kLiterals> literals_{};
  std::array<std::uint32_t, kDistances> distances_{};
  std::uint64_t extra_bits_ = 0;
  HuffmanCode literal_;
  HuffmanCode distance_;
  HuffmanCode lengths_;
  std::vector<Extra> words_;
  std::size_t order_ = 0;
};

RunDeflate::RunDeflate() : seen_(std::size_t{1} << kHashBits) {
  sequences_.reserve(kBlockSequences + 1);
}

std::size_t RunDeflate::compress(std::span<const std::uint8_t> in, std::uint8_t* out) {
  const std::uint8_t* const bytes = in.data();
  const std::size_t n = in.size();
  std::fill(seen_.begin(), seen_.end(), 0);
  Bits bits(out);
  std::size_t block = 0;   // where the present block begins
  std::size_t anchor = 0;  // the first byte not yet in a sequence
  std::size_t literals = 0;
  sequences_.clear();
  const auto end_block = [&](std::size_t end) {
    sequences_.push_back({static_cast<std::uint32_t>(end - anchor), 0, 0});
    Block(bytes + block, sequences_).put(bits, end == n);
    sequences_.clear();
    block = anchor = end;
    literals = 0;
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
      i += 1 + ((i - anchor) >> kPatience);
      continue;
    }
    const std::size_t most = std::min(n, block + kBlockBytes);
    std::size_t length = 4 + equal_bytes(bytes + i + 4, bytes + found + 4, bytes + most);
    while (i > anchor && found > 0 && bytes[i - 1] == bytes[found - 1]) {
      --i;
      --found;
      ++length;
    }
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
