// ZIP compression of one chunk: OpenEXR's byte filter, and deflate by libdeflate.
#include "src/io/exr/encoders/zip_encoder.hpp"

#include <libdeflate.h>

#include <cstdint>
#include <new>

namespace spectile::io {
namespace {

// Below so many bytes libdeflate's other kinds of blocks matter, and time does not.
constexpr std::size_t kQuickBytes = 8192;

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

ZipEncoder::ZipEncoder(int level) : level_(level), compressor_(libdeflate_alloc_compressor(level)) {
  if (compressor_ == nullptr) throw std::bad_alloc();
}

std::size_t ZipEncoder::deflate(std::size_t n) {
  const auto* const in = reinterpret_cast<const std::uint8_t*>(filtered_.data());
  if (level_ != 1 || n < kQuickBytes) {
    compressed_.resize(n);
    return libdeflate_zlib_compress(compressor_.get(), in, n, compressed_.data(), n - 1);
  }
  // RFC 1950: a window of 32 KiB, the fastest level; at the end, the sum of the bytes.
  compressed_.resize(RunDeflate::bound(n) + 6);
  auto* const out = reinterpret_cast<std::uint8_t*>(compressed_.data());
  out[0] = 0x78;
  out[1] = 0x01;
  std::size_t size = 2 + quick_.compress({in, n}, out + 2);
  const std::uint32_t sum = libdeflate_adler32(1, in, n);
  for (int shift = 24; shift >= 0; shift -= 8) out[size++] = static_cast<std::uint8_t>(sum >> shift);
  return size < n ? size : 0;
}

std::span<const std::byte> ZipEncoder::encode(std::span<const std::byte> packed) {
  const std::size_t n = packed.size();
  if (n == 0) return packed;
  filtered_.resize(n);
  filter(reinterpret_cast<const std::uint8_t*>(packed.data()),
         reinterpret_cast<std::uint8_t*>(filtered_.data()), n);
  // 0 when it does not fit: then the chunk is stored as it is, which its size tells a reader.
  const std::size_t size = deflate(n);
  if (size == 0) return packed;
  return {compressed_.data(), size};
}

}  // namespace spectile::io
