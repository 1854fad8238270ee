// The header of a converted spectral image: which attributes still hold, and what is said about the others.
#pragma once

#include <spectile/image/convert.hpp>
#include <string>
#include <vector>

#include "src/io/channels/spectral_layout.hpp"
#include "src/io/convert/sources/sets_source.hpp"
#include "src/io/exr/exr_writer.hpp"

namespace spectile::io {

/// The output's bands of one of the source's quantities, and their names.
struct ConvertedSpectra {
  const SourceSpectra* from = nullptr;
  Bands bands;
  std::vector<WrittenChannel> names;
};

/// The header of an output with these channels. Adds notes on attributes and channels.
ImageSpec converted_spec(const SetsSource& source, const Dialect& dialect,
                         const std::vector<ConvertedSpectra>& spectra, std::vector<ChannelSpec> channels,
                         const ConvertImageOptions& options, std::vector<std::string>& notes);

}  // namespace spectile::io
