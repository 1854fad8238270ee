// DWA compression of one chunk, which the C pipeline of OpenEXR 3.1 lacks.
#include "src/io/exr/encoders/dwa_encoder.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include "src/io/exr/compression.hpp"
#include "src/io/exr/memory_stream.hpp"

namespace spectile::io {

std::vector<char> encode_dwa(const Compression& compression, const std::vector<PackedChannel>& channels,
                             std::size_t line_bytes, int width, int lines, const std::byte* packed,
                             bool tile) {
  Imf::Header header(width, lines);
  header.compression() =
      compression.kind == CompressionKind::kDwab ? Imf::DWAB_COMPRESSION : Imf::DWAA_COMPRESSION;
  if (compression.level >= 0) header.dwaCompressionLevel() = static_cast<float>(compression.level);
  Imf::FrameBuffer source;
  for (const PackedChannel& channel : channels) {
    const auto type = static_cast<Imf::PixelType>(pixel_type(channel.type));
    header.channels().insert(channel.name, Imf::Channel(type));
    // OpenEXR takes a mutable pointer for reading too.
    char* const base = const_cast<char*>(reinterpret_cast<const char*>(packed)) + channel.offset;
    source.insert(channel.name, Imf::Slice(type, base, sample_bytes(channel.type), line_bytes));
  }
  MemoryStream stream;
  std::size_t chunk_start = 0;
  {
    if (tile) {
      header.setTileDescription(
          Imf::TileDescription(static_cast<unsigned>(width), static_cast<unsigned>(lines)));
      Imf::TiledOutputFile file(stream, header, 0);
      chunk_start = stream.tellp();
      file.setFrameBuffer(source);
      file.writeTile(0, 0);
    } else {
      Imf::OutputFile file(stream, header, 0);
      chunk_start = stream.tellp();
      file.setFrameBuffer(source);
      file.writePixels(lines);
    }
  }
  // A chunk is its first line's number, or its tile's place as four numbers; its size; and the data. All
  // numbers are of four bytes.
  const std::size_t size_at = chunk_start + (tile ? 16 : 4);
  const std::vector<char>& bytes = stream.bytes();
  std::int32_t size = 0;
  std::memcpy(&size, bytes.data() + size_at, sizeof(size));
  const auto data = bytes.begin() + static_cast<std::ptrdiff_t>(size_at) + 4;
  return {data, data + size};
}

}  // namespace spectile::io
