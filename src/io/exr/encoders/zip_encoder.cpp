// ZIP compression of one chunk: OpenEXR's byte filter, and deflate by libdeflate.
#include "src/io/exr/encoders/zip_encoder.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <new>

namespace spectile::io {
namespace {

std::uint8_t difference(std::uint8_t a, std::uint8_t b) {
  return static_cast<std::uint8_t>(a - b + 128);
}

/// Even bytes first, then odd ones, so that the high and the low bytes of halves come apart; of these, the
/// differences of neighbours, offset by 128, modulo 256. In one pass, of which compilers take several at a
/// time.
void filter(const std::uint8_t* in, std::uint8_t* out, std::size_t n) {
  const std::size_t odd = n / 2;
  std::uint8_t* const second = out + (n - odd);
  out[0] = in[0];
  if (n == 1) return;
  second[0] = difference(in[1], in[(n - 1) / 2 * 2]);
  for (std::size_t i = 1; i < odd; ++i) {
    out[i] = difference(in[2 * i], in[2 * i - 2]);
    second[i] = difference(in[2 * i + 1], in[2 * i - 1]);
  }
  if (n % 2 != 0) out[odd] = difference(in[n - 1], in[n - 3]);
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
  filtered_.resize(n);
  compressed_.resize(n);
  filter(reinterpret_cast<const std::uint8_t*>(packed.data()),
         reinterpret_cast<std::uint8_t*>(filtered_.data()), n);
  // 0 when it does not fit: then the chunk is stored as it is, which its size tells a reader.
  const std::size_t size =
      libdeflate_zlib_compress(compressor_.get(), filtered_.data(), n, compressed_.data(), n - 1);
  if (size == 0) return packed;
  return {compressed_.data(), size};
}

}  // namespace spectile::io
