// MemoryStream: an OpenEXR output stream that collects what is written.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace spectile::io {

class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : OStream("memory") {}
  void write(const char data[], int count) override {
    const auto bytes = static_cast<std::size_t>(count);
    if (bytes == 0) return;
    bytes_.resize(std::max(bytes_.size(), position_ + bytes));
    std::memcpy(bytes_.data() + position_, data, bytes);
    position_ += bytes;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  std::vector<char> bytes_;
  std::size_t position_ = 0;
};

}  // namespace spectile::io
