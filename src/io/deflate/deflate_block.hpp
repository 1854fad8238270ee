// One block of deflate: what was found in its bytes, with a prefix code of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace spectile::io {

/// Literals, and then a match of any length, or none at a block's end.
struct DeflateSequence {
  std::uint32_t literals = 0;
  std::uint32_t length = 0;
  std::uint32_t distance = 0;
};

/// Bits to bytes, the first bit lowest. Writes whole words, up to eight bytes beyond the end.
class DeflateBits {
 public:
  explicit DeflateBits(std::uint8_t* out) : out_(out) {}
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
    if (n > 0) std::memcpy(out_, from, n);  // which takes no null pointer, not even for nothing
    out_ += n;
  }

 private:
  std::uint8_t* out_;
  std::uint64_t held_ = 0;
  int count_ = 0;
};

/// Writes the bytes from `from` on that the sequences cover, in a code of their own, or as they are where
/// that is no longer. `last`: whether it is the stream's last block. May throw std::bad_alloc.
void put_deflate_block(DeflateBits& bits, const std::uint8_t* from,
                       std::span<const DeflateSequence> sequences, bool last);

}  // namespace spectile::io
