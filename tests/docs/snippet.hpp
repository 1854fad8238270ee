// Surroundings of the C++ blocks of README.md and docs/.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/exr_files.hpp"

namespace spectile::test {

/// A working folder for one snippet, removed afterwards; it holds texture.exr: RGB noise of 32 x 32 pixels.
class SnippetFolder {
 public:
  SnippetFolder() : before_(std::filesystem::current_path()) {
    std::filesystem::current_path(folder_.path());
    Picture texture = blank(32, 32);
    add_rgb_noise(texture, Imf::HALF);
    write_scanlines("texture.exr", texture);
  }
  ~SnippetFolder() { std::filesystem::current_path(before_); }
  SnippetFolder(const SnippetFolder&) = delete;
  SnippetFolder& operator=(const SnippetFolder&) = delete;

 private:
  std::filesystem::path before_;
  TempFolder folder_;
};

}  // namespace spectile::test
