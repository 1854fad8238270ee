// Bands named in a dialect, with a check that its readers take them for the same bands.
#include "src/io/channels/dialect_names.hpp"

#include <cmath>

#include "src/base/errors.hpp"
#include "src/io/channels/spectral_sets.hpp"

namespace spectile::io {
namespace {

// Edges have two decimals in the dialect that has the fewest.
constexpr double kRounded = 0.01 + 1e-9;

/// A band that is read otherwise than it is meant, and how many there are.
struct Misread {
  std::size_t count = 0;
  std::size_t first = 0;
};

Misread misread(const Bands& meant, const Bands& read) {
  Misread out;
  for (std::size_t b = 0; b < meant.count(); ++b) {
    bool same = std::abs(read[b].centre_nm - meant[b].centre_nm) <= 1e-6;
    // A plan goes with its bands, and knows their edges; others are averages, to which centres do not matter.
    if (meant.weights() == nullptr) {
      same = std::abs(read[b].lower_nm - meant[b].lower_nm) <= kRounded &&
             std::abs(read[b].upper_nm - meant[b].upper_nm) <= kRounded;
    }
    if (same) continue;
    if (out.count++ == 0) out.first = b;
  }
  return out;
}

}  // namespace

Result<std::vector<WrittenChannel>> dialect_names(const Dialect& dialect, const Bands& bands,
                                                  Quantity quantity, const std::string& path,
                                                  std::vector<std::string>& notes) {
  if (quantity != Quantity::kIlluminant && !dialect.says_quantity) {
    return make_error(ErrorCode::kBadArgument,
                      "{}: {}'s channels are light, and reflectances would be read as that; the spectral "
                      "layout holds both",
                      path, dialect.name);
  }
  const auto kind = quantity == Quantity::kIlluminant ? SpectralKind::kEmissive : SpectralKind::kReflective;
  std::vector<WrittenChannel> out;
  std::vector<SpectralChannel> read;
  for (std::size_t b = 0; b < bands.count(); ++b) {
    out.push_back(dialect.write(bands[b], b, kind));
    read.push_back(out.back().read);
  }
  const auto again = bands_read(read);
  if (!again) {
    return make_error(ErrorCode::kBadArgument, "{}: {}'s channel names cannot hold its bands: {}", path,
                      dialect.name, again.error().message);
  }
  const Misread found = misread(bands, *again);
  if (found.count == 0) return out;
  const Band& meant = bands[found.first];
  const Band& wrong = (*again)[found.first];
  const std::string change =
      fmt::format("{} of {} bands: {:.2f} to {:.2f} nm becomes {:.2f} to {:.2f} nm", found.count,
                  bands.count(), meant.lower_nm, meant.upper_nm, wrong.lower_nm, wrong.upper_nm);
  if (dialect.key != "layout") {
    return make_error(ErrorCode::kBadArgument, "{}: {}'s channel names would change {}", path, dialect.name,
                      change);
  }
  notes.push_back(fmt::format(
      "the layout names centres, and readers take bands to meet halfway: that changes {}", change));
  return out;
}

}  // namespace spectile::io
