// DWA compression of one chunk, which the C pipeline of OpenEXR 3.1 lacks.
#include "src/io/dwa_encoder.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include "src/io/memory_stream.hpp"

namespace spectile::io {

std::vector<char> encode_dwa(Imf::Compression method, int level, const std::vector<PackedChannel>& channels,
                             std::size_t line_bytes, int width, int lines, const std::byte* packed) {
  Imf::Header header(width, lines);
  header.compression() = method;
  if (level >= 0) header.dwaCompressionLevel() = static_cast<float>(level);
  Imf::FrameBuffer source;
  for (const PackedChannel& channel : channels) {
    const auto type = static_cast<Imf::PixelType>(channel.type);
    header.channels().insert(channel.name, Imf::Channel(type));
    // OpenEXR takes a mutable pointer for reading too.
    char* const base = const_cast<char*>(reinterpret_cast<const char*>(packed)) + channel.offset;
    source.insert(channel.name, Imf::Slice(type, base, channel.type == EXR_PIXEL_HALF ? 2 : 4, line_bytes));
  }
  MemoryStream stream;
  std::size_t chunk_start = 0;
  {
    Imf::OutputFile file(stream, header, 0);
    chunk_start = stream.tellp();
    file.setFrameBuffer(source);
    file.writePixels(lines);
  }
  // A chunk is its first line's number and its size, four bytes each, and the data.
  const std::vector<char>& bytes = stream.bytes();
  std::int32_t size = 0;
  std::memcpy(&size, bytes.data() + chunk_start + 4, sizeof(size));
  const auto data = bytes.begin() + static_cast<std::ptrdiff_t>(chunk_start) + 8;
  return {data, data + size};
}

}  // namespace spectile::io
