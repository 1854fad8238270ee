// One block of deflate: what was found in its bytes, with a prefix code of its own.
#include "src/io/deflate/deflate_block.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "src/io/deflate/huffman_code.hpp"

namespace spectile::io {
namespace {

// RFC 1951, 3.2.5: symbols of literals, the end of a block and lengths; of distances.
constexpr std::size_t kLiterals = 286;
constexpr std::size_t kDistances = 30;
constexpr std::size_t kEndOfBlock = 256;
constexpr std::uint32_t kLongestMatch = 258;
constexpr std::uint32_t kShortestMatch = 3;
// 3.2.7: the order in which the lengths of the code of lengths are written.
constexpr std::array<std::uint8_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                 11, 4,  12, 3, 13, 2, 14, 1, 15};

// The longest code: four literals then fit between two flushes of the bits.
constexpr int kMaxBits = 14;

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

/// Bytes as deflate stores them, up to 65535 at a time.
void put_stored(DeflateBits& bits, const std::uint8_t* from, std::size_t n, bool last) {
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

/// One block: its counts, codes and bits.
class Block {
 public:
  Block(const std::uint8_t* from, std::span<const DeflateSequence> sequences)
      : from_(from), sequences_(sequences) {
    count();
    literal_ = huffman_code(literals_, kMaxBits);
    distance_ = huffman_code(distances_, kMaxBits);
    describe();
  }

  void put(DeflateBits& bits, bool last) const {
    if (size_bits() >= 8 * (bytes_ + 5 * (bytes_ / 65535 + 1))) {
      put_stored(bits, from_, bytes_, last);
      return;
    }
    bits.put((last ? 1U : 0U) | 2U << 1, 3);
    put_description(bits);
    const std::uint8_t* at = from_;
    for (const DeflateSequence& sequence : sequences_) {
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
    for (const DeflateSequence& sequence : sequences_) {
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

  void put_description(DeflateBits& bits) const {
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

  const std::uint8_t* put_literals(DeflateBits& bits, const std::uint8_t* at, std::uint32_t n) const {
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

  void put_match(DeflateBits& bits, const DeflateSequence& sequence) const {
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
  std::span<const DeflateSequence> sequences_;
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

}  // namespace

void put_deflate_block(DeflateBits& bits, const std::uint8_t* from,
                       std::span<const DeflateSequence> sequences, bool last) {
  Block(from, sequences).put(bits, last);
}

}  // namespace spectile::io
