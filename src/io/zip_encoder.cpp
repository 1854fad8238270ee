// ZIP compression of one chunk: OpenEXR's byte filter, and deflate by libdeflate.
#include "src/io/zip_encoder.hpp"

#include <libdeflate.h>

#include <cstdint>
#include <new>

namespace spectile::io {
namespace {

/// Even bytes first, then odd ones: the high and the low bytes of halves come apart.
void split_bytes(const std::uint8_t* in, std::uint8_t* out, std::size_t n) {
  const std::size_t odd = n / 2;
  std::uint8_t* const second = out + (n - odd);
  for (std::size_t i = 0; i < odd; ++i) {
    out[i] = in[2 * i];
    second[i] = in[2 * i + 1];
  }
  if (n % 2 != 0) out[odd] = in[n - 1];
}

/// Differences of neighbours, offset by 128, modulo 256.
void differences(const std::uint8_t* in, std::uint8_t* out, std::size_t n) {
  out[0] = in[0];
  for (std::size_t i = 1; i < n; ++i) out[i] = static_cast<std::uint8_t>(in[i] - in[i - 1] + 128);
}

}  // namespace

void ZipEncoder::Free::operator()(libdeflate_compressor* c) const noexcept {
  libdeflate_free_compressor(c);
}

ZipEncoder::ZipEncoder(int level) : compressor_(libdeflate_alloc_compressor(level)) {
  if (compressor_ == nullptr) throw std::bad_alloc();
}

std::span<const std::byte> ZipEncoder::encode(std::span<const std::byte> packed) {
  const std::size_t n = packed.size();
  if (n == 0) return packed;
  split_.resize(n);
  filtered_.resize(n);
  compressed_.resize(n);
  split_bytes(reinterpret_cast<const std::uint8_t*>(packed.data()),
              reinterpret_cast<std::uint8_t*>(split_.data()), n);
  differences(reinterpret_cast<const std::uint8_t*>(split_.data()),
              reinterpret_cast<std::uint8_t*>(filtered_.data()), n);
  // 0 when it does not fit: then the chunk is stored as it is, which its size tells a reader.
  const std::size_t size =
      libdeflate_zlib_compress(compressor_.get(), filtered_.data(), n, compressed_.data(), n - 1);
  if (size == 0) return packed;
  return {compressed_.data(), size};
}

}  // namespace spectile::io
