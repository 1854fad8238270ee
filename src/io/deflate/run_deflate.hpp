// RunDeflate: deflate in one quick pass over filtered samples, in which long runs cost next to nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/io/deflate/deflate_block.hpp"

namespace spectile::io {

/// One thread's compressor. Its output depends on its input alone.
class RunDeflate {
 public:
  /// Work space; grows with what is compressed. May throw std::bad_alloc.
  RunDeflate();

  /// Compresses `in`, less than 4 GiB, to raw deflate at `out` and returns its size. `out` holds
  /// bound(in.size()) bytes.
  std::size_t compress(std::span<const std::uint8_t> in, std::uint8_t* out);

  /// The most that compress() writes, its room for whole words included.
  static std::size_t bound(std::size_t n) { return n + n / 4096 + 4096; }

 private:
  std::vector<std::uint32_t> seen_;  // where four bytes of a hash were last
  std::vector<DeflateSequence> sequences_;
};

}  // namespace spectile::io
