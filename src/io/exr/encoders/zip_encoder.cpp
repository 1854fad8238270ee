// ZIP compression of one chunk: OpenEXR's byte filter, and deflate by ISA-L or libdeflate.
#include "src/io/exr/encoders/zip_encoder.hpp"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
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

// ISA-L 2.30 to 2.32 hash, in place of a block's third position, bits 16 to 47 of the stream object's own
// address (its isal_deflate_icf_body_hash_hist on x86 does not load a register): the compressed bytes would
// depend on where the object lies. They do not where that hash is none of the block's first three positions'.
// So there are several places for the object, 64 KiB apart, and each chunk takes one that is right for it.
// Hashes are CRC-32C of four bytes; four bits of them are always looked at.
constexpr std::size_t kPlaces = 16;
constexpr std::size_t kPlaceBytes = std::size_t{1} << 16;

std::uint32_t hash_class(std::uint32_t four_bytes) {
  for (int bit = 0; bit < 32; ++bit) {
    four_bytes = (four_bytes >> 1) ^ ((four_bytes & 1) != 0 ? 0x82F63B78U : 0U);
  }
  return four_bytes & 15;
}

/// Index of the place for a chunk's stream object.
std::size_t place_for(const std::byte* places, const std::uint8_t* in, std::size_t n) {
  std::uint32_t taken = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t four_bytes = 0;
    if (i + sizeof(four_bytes) > n) continue;
    std::memcpy(&four_bytes, in + i, sizeof(four_bytes));
    taken |= 1U << hash_class(four_bytes);
  }
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const auto address = reinterpret_cast<std::uintptr_t>(places + i * kPlaceBytes);
    if ((taken >> hash_class(static_cast<std::uint32_t>(address >> 16)) & 1) == 0) return i;
  }
  return 0;  // not reached: sixteen neighbours have eight classes or more, and three are taken at most
}

/// True for a chunk that starts with a long run of 0 or 255, which ISA-L writes as a block of its own: the
/// next one starts after it, where these places do not help.
bool starts_with_a_run(const std::uint8_t* in, std::size_t n) {
  constexpr std::size_t kRun = 4096;
  if (n < kRun || (in[0] != 0 && in[0] != 255)) return false;
  return std::all_of(in, in + kRun, [&](std::uint8_t v) { return v == in[0]; });
}

}  // namespace

void ZipEncoder::Free::operator()(libdeflate_compressor* c) const noexcept {
  libdeflate_free_compressor(c);
}

ZipEncoder::ZipEncoder(int level) {
  if (level == 1) {
    work_.resize(ISAL_DEF_LVL1_DEFAULT);
    // The places start at multiples of 64 KiB, and are touched when they are used.
    places_ = std::make_unique_for_overwrite<std::byte[]>((kPlaces + 1) * kPlaceBytes + sizeof(isal_zstream));
  }
  compressor_.reset(libdeflate_alloc_compressor(level));
  if (compressor_ == nullptr) throw std::bad_alloc();
}

std::size_t ZipEncoder::deflate(std::size_t n) {
  auto* const in = reinterpret_cast<std::uint8_t*>(filtered_.data());
  auto* const out = reinterpret_cast<std::uint8_t*>(compressed_.data());
  if (places_ == nullptr || starts_with_a_run(in, n))
    return libdeflate_zlib_compress(compressor_.get(), in, n, out, n - 1);
  // Zeros, here and in the hash table: matches with an earlier chunk's leftovers would make the bytes depend
  // on it.
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(places_.get()) % kPlaceBytes;
  std::byte* const places = places_.get() + before;
  isal_zstream& stream = *new (places + place_for(places, in, n) * kPlaceBytes) isal_zstream{};
  std::fill(work_.begin(), work_.end(), std::byte{0});
  isal_deflate_stateless_init(&stream);
  stream.level = 1;
  stream.level_buf = reinterpret_cast<std::uint8_t*>(work_.data());
  stream.level_buf_size = static_cast<std::uint32_t>(work_.size());
  stream.gzip_flag = IGZIP_ZLIB;
  stream.end_of_stream = 1;
  stream.next_in = in;
  stream.avail_in = static_cast<std::uint32_t>(n);
  stream.next_out = out;
  stream.avail_out = static_cast<std::uint32_t>(n - 1);
  return isal_deflate_stateless(&stream) == COMP_OK ? stream.total_out : 0;
}

std::span<const std::byte> ZipEncoder::encode(std::span<const std::byte> packed) {
  const std::size_t n = packed.size();
  if (n == 0) return packed;
  filtered_.resize(n);
  compressed_.resize(n);
  filter(reinterpret_cast<const std::uint8_t*>(packed.data()),
         reinterpret_cast<std::uint8_t*>(filtered_.data()), n);
  // 0 when it does not fit: then the chunk is stored as it is, which its size tells a reader.
  const std::size_t size = deflate(n);
  if (size == 0) return packed;
  return {compressed_.data(), size};
}

}  // namespace spectile::io
