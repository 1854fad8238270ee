// ZIP compression of one chunk: OpenEXR's byte filter, and deflate by libdeflate, which is several times
// faster than the zlib that OpenEXR 3.1 uses and gives the same bytes on every processor.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

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

  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  std::vector<std::byte> filtered_;
  std::vector<std::byte> compressed_;
};

}  // namespace spectile::io
