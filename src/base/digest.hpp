// A short digest of numbers.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>

namespace spectile {

/// FNV-1a over the bits of numbers. Source: Fowler, Noll, Vo; draft-eastlake-fnv.
class Digest {
 public:
  Digest& add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) {
      hash_ = (hash_ ^ ((bits >> shift) & 0xFFU)) * 0x100000001B3U;
    }
    return *this;
  }
  std::string text() const { return fmt::format("{:016x}", hash_); }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

}  // namespace spectile
