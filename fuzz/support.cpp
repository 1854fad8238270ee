// Shared by the fuzz targets: invariants, whose breach ends the process, and a file and a folder for each
// case.
#include "fuzz/support.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

namespace spectile::fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with the process.
class ProcessFolder {
 public:
  ProcessFolder() {
    // Files in memory are several times as fast, and a disk that no case wears out.
    std::error_code ignored;
    const fs::path memory = "/dev/shm";
    const bool usable = fs::is_directory(memory, ignored) && ::access(memory.c_str(), W_OK) == 0;
    std::string pattern = ((usable ? memory : fs::temp_directory_path()) / "spectile-fuzz-XXXXXX").string();
    require(::mkdtemp(pattern.data()) != nullptr, "there is a temporary folder", pattern);
    path_ = pattern;
  }
  ~ProcessFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ProcessFolder(const ProcessFolder&) = delete;
  ProcessFolder& operator=(const ProcessFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

const fs::path& folder() {
  static const ProcessFolder kFolder;
  return kFolder.path();
}

}  // namespace

void broken(const char* law, const std::string& detail) {
  fmt::print(stderr, "spectile fuzz: does not hold: {}{}{}\n", law, detail.empty() ? "" : ": ", detail);
  std::abort();
}

void require_sentence(const Error& error) {
  const std::string& text = error.message;
  require(!text.empty(), "an error has a text");
  require(!text.ends_with('.') || text.ends_with(".."), "an error's text has no full stop", text);
}

Choices::Choices(Bytes bytes) : state_(0xCBF29CE484222325U) {
  // FNV-1a.
  for (const std::uint8_t byte : bytes) state_ = (state_ ^ byte) * 0x100000001B3U;
}

unsigned Choices::below(unsigned n) {
  // Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014: SplitMix64.
  std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<unsigned>((z ^ (z >> 31U)) % n);
}

CaseFolder::CaseFolder(Bytes bytes)
    : bytes_(bytes), input_((folder() / "case").string()), output_((folder() / "output").string()) {
  std::ofstream file(input_, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  require(file.good(), "the case's file can be written", input_);
}

void CaseFolder::require_tidy(bool written) const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder())) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  const std::vector<std::string> expected =
      written ? std::vector<std::string>{"case", "output"} : std::vector<std::string>{"case"};
  require(names == expected, "a call leaves its whole output or nothing",
          fmt::format("{}", fmt::join(names, ", ")));
  std::ifstream file(input_, std::ios::binary);
  const std::vector<char> now((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  require(std::equal(now.begin(), now.end(), bytes_.begin(), bytes_.end(),
                     [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }),
          "a call leaves its input as it was");
  if (written) fs::remove(output_);
}

}  // namespace spectile::fuzz
