// HuffmanCode: the prefix code of a deflate alphabet for given counts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace spectile::io {

/// Code and length of each symbol; 0 bits for symbols that do not occur.
struct HuffmanCode {
  std::vector<std::uint16_t> code;  ///< its bits in the order in which deflate writes them
  std::vector<std::uint8_t> bits;
};

/// A complete code of at least two symbols, no longer than `most_bits`, for counts of symbols; where fewer
/// occur, the first ones do as if once. At most 2^most_bits symbols.
HuffmanCode huffman_code(std::span<const std::uint32_t> counts, int most_bits);

}  // namespace spectile::io
