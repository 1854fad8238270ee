// HuffmanCode: the prefix code of a deflate alphabet for given counts.
#include "src/io/deflate/huffman_code.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace spectile::io {
namespace {

struct Symbol {
  std::uint32_t count;
  std::uint32_t symbol;
};

/// How many symbols have codes of each length. `sorted` ascends by count and is used up.
/// Source: Moffat, Katajainen, In-Place Calculation of Minimum-Redundancy Codes, WADS 1995.
std::array<std::uint32_t, 33> lengths_of(std::vector<Symbol>& sorted) {
  const std::size_t n = sorted.size();
  std::vector<std::uint32_t> a(n);
  for (std::size_t i = 0; i < n; ++i) a[i] = sorted[i].count;
  // Inner nodes take the places of leaves used up, and then point to their parents.
  std::size_t root = 0;
  std::size_t leaf = 0;
  for (std::size_t next = 0; next + 1 < n; ++next) {
    std::uint32_t sum = 0;
    for (int child = 0; child < 2; ++child) {
      if (leaf >= n || (root < next && a[root] < a[leaf])) {
        sum += a[root];
        a[root++] = static_cast<std::uint32_t>(next);
      } else {
        sum += a[leaf++];
      }
    }
    a[next] = sum;
  }
  std::array<std::uint32_t, 33> out{};
  // Depths of inner nodes, from the root down; what they leave free are leaves.
  a[n - 2] = 0;
  for (std::size_t i = n - 2; i-- > 0;) a[i] = a[a[i]] + 1;
  std::size_t open = 1;
  std::size_t used = 0;
  std::uint32_t depth = 0;
  std::size_t left = n - 1;  // inner nodes not yet seen
  while (open > 0) {
    while (left > 0 && a[left - 1] == depth) {
      ++used;
      --left;
    }
    out[std::min<std::uint32_t>(depth, 32)] += static_cast<std::uint32_t>(open - used);
    open = 2 * used;
    ++depth;
    used = 0;
  }
  return out;
}

/// Shortens codes longer than `most`, and lengthens others until every prefix is someone's again.
void limit(std::array<std::uint32_t, 33>& lengths, std::size_t most) {
  for (std::size_t i = most + 1; i < lengths.size(); ++i) {
    lengths[most] += lengths[i];
    lengths[i] = 0;
  }
  std::uint64_t total = 0;
  for (std::size_t i = 1; i <= most; ++i) total += std::uint64_t{lengths[i]} << (most - i);
  while (total > std::uint64_t{1} << most) {
    --lengths[most];
    for (std::size_t i = most - 1; i > 0; --i) {
      if (lengths[i] == 0) continue;
      --lengths[i];
      lengths[i + 1] += 2;
      break;
    }
    --total;
  }
}

std::uint16_t reversed(std::uint32_t code, int bits) {
  std::uint32_t out = 0;
  for (int i = 0; i < bits; ++i) out |= (code >> i & 1U) << (bits - 1 - i);
  return static_cast<std::uint16_t>(out);
}

}  // namespace

HuffmanCode huffman_code(std::span<const std::uint32_t> counts, int most_bits) {
  HuffmanCode out;
  out.code.resize(counts.size());
  out.bits.resize(counts.size());
  std::vector<Symbol> sorted;
  for (std::uint32_t s = 0; s < counts.size(); ++s) {
    if (counts[s] > 0) sorted.push_back({counts[s], s});
  }
  for (std::uint32_t s = 0; sorted.size() < 2; ++s) {
    if (counts[s] == 0) sorted.push_back({1, s});
  }
  std::sort(sorted.begin(), sorted.end(), [](const Symbol& a, const Symbol& b) {
    return a.count != b.count ? a.count < b.count : a.symbol < b.symbol;
  });
  auto lengths = lengths_of(sorted);
  limit(lengths, static_cast<std::size_t>(most_bits));
  std::size_t at = 0;
  for (int bits = most_bits; bits > 0; --bits) {
    for (std::uint32_t i = 0; i < lengths[static_cast<std::size_t>(bits)]; ++i) {
      out.bits[sorted[at++].symbol] = static_cast<std::uint8_t>(bits);
    }
  }
  // Codes of a length count up in the order of the symbols (RFC 1951, 3.2.2).
  std::array<std::uint32_t, 33> next{};
  for (std::size_t i = 1; i + 1 < next.size(); ++i) next[i + 1] = (next[i] + lengths[i]) << 1;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (out.bits[s] > 0) out.code[s] = reversed(next[out.bits[s]]++, out.bits[s]);
  }
  return out;
}

}  // namespace spectile::io
