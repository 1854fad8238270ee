// Bands named in a dialect, with a check that its readers take them for the same bands.
#pragma once

#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/io/channels/spectral_layout.hpp"

namespace spectile::io {

/// The channels of bands in a dialect. Edges that its readers take for others are noted where names hold
/// centres alone and the dialect is the layout. Errors: kBadArgument, naming `path`, for a quantity that the
/// dialect does not know, and for edges that another dialect would change.
Result<std::vector<WrittenChannel>> dialect_names(const Dialect& dialect, const Bands& bands,
                                                  Quantity quantity, const std::string& path,
                                                  std::vector<std::string>& notes);

}  // namespace spectile::io
