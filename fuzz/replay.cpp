// Runs a target over its corpus and over mutations of it, always the same ones: fuzz targets as ordinary
// tests. usage: fuzz_TARGET CORPUS_FOLDER MUTATIONS
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/support.hpp"

namespace {

namespace fs = std::filesystem;
using spectile::fuzz::Choices;
using Case = std::vector<std::uint8_t>;

std::vector<Case> read_corpus(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Case> out;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return out;
}

std::size_t place_in(Choices& choices, const Case& bytes) {
  return bytes.empty() ? 0 : choices.below(static_cast<unsigned>(bytes.size()));
}

/// Numbers at which arithmetic on sizes goes wrong.
void put_number(Choices& choices, Case& bytes) {
  constexpr std::uint32_t kNumbers[] = {0,      1,       0x7F,       0xFF,       0x7FFF,
                                        0xFFFF, 0x40000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  const std::uint32_t number = kNumbers[choices.below(std::size(kNumbers))];
  const std::size_t at = place_in(choices, bytes);
  const std::size_t count = std::min<std::size_t>(sizeof(number), bytes.size() - at);
  std::memcpy(bytes.data() + at, &number, count);
}

void mutate_once(Choices& choices, Case& bytes, const Case& other) {
  const auto at = static_cast<std::ptrdiff_t>(place_in(choices, bytes));
  const auto end = at + static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                            1 + choices.below(16), bytes.size() - static_cast<std::size_t>(at)));
  switch (choices.below(7)) {
    case 0:
      if (!bytes.empty())
        bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1U << choices.below(8));
      break;
    case 1:
      if (!bytes.empty()) bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(choices.below(256));
      break;
    case 2:
      if (!bytes.empty()) put_number(choices, bytes);
      break;
    case 3:
      bytes.erase(bytes.begin() + at, bytes.begin() + end);
      break;
    case 4: {
      const Case copy(bytes.begin() + at, bytes.begin() + end);
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place_in(choices, bytes)), copy.begin(),
                   copy.end());
      break;
    }
    case 5: {
      // The start of this one and the end of another.
      const auto from = static_cast<std::ptrdiff_t>(std::min(static_cast<std::size_t>(at), other.size()));
      bytes.resize(static_cast<std::size_t>(at));
      bytes.insert(bytes.end(), other.begin() + from, other.end());
      break;
    }
    default:
      bytes.insert(bytes.begin() + at, static_cast<std::uint8_t>(choices.below(256)));
  }
}

/// More than any case may take, by far; sanitizers' own memory is beside it.
void require_little_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  constexpr long kMaxKib = 2L << 20;
  spectile::fuzz::require(usage.ru_maxrss < kMaxKib, "cases take less than 2 GiB of memory",
                          fmt::format("{} KiB", usage.ru_maxrss));
}

}  // namespace

int main(int argc, char** argv) {
  unsigned mutations = 0;
  const char* const end = argc == 3 ? argv[2] + std::strlen(argv[2]) : nullptr;
  if (argc != 3 || std::from_chars(argv[2], end, mutations).ptr != end) {
    fmt::print(stderr, "usage: {} CORPUS_FOLDER MUTATIONS\n", argv[0]);
    return 2;
  }
  const std::vector<Case> corpus = read_corpus(argv[1]);
  spectile::fuzz::require(!corpus.empty(), "there is a corpus", argv[1]);
  for (const Case& bytes : corpus) LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  Choices choices({});
  for (unsigned i = 0; i < mutations; ++i) {
    Case bytes = corpus[choices.below(static_cast<unsigned>(corpus.size()))];
    const Case& other = corpus[choices.below(static_cast<unsigned>(corpus.size()))];
    for (unsigned n = 1 + choices.below(4); n > 0; --n) mutate_once(choices, bytes, other);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  require_little_memory();
  fmt::print("{} files, {} mutations\n", corpus.size(), mutations);
  return 0;
}
