// ZIP compression of one chunk: OpenEXR's byte filter; deflate by RunDeflate at level 1, else by libdeflate,
// which is several times faster than the zlib that OpenEXR 3.1 uses.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "src/io/deflate/run_deflate.hpp"

struct libdeflate_compressor;

namespace spectile::io {

/// One thread's compressor; its output is what OpenEXR's "zip" and "zips" chunks hold.
class ZipEncoder {
 public:
  /// Levels as zlib's, 1 to 9. Throws std::bad_alloc.
  explicit ZipEncoder(int level);

  /// The chunk's compressed form, or `packed` itself where that is no larger; valid until the next call.
  std::span<const std::byte> encode(std::span<const std::byte> packed);

 private:
  struct Free {
    void operator()(libdeflate_compressor* c) const noexcept;
  };
  std::size_t deflate(std::size_t n);

  int level_;
  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  RunDeflate quick_;
  std::vector<std::byte> filtered_;
  std::vector<std::byte> compressed_;
};

}  // namespace spectile::io
