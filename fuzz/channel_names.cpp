// Fuzzes names of spectral channels: what is read as one has a wavelength, and its written form means the
// same.
#include <fmt/format.h>

#include <cmath>

#include "fuzz/support.hpp"
#include "src/io/channels/spectral_layout.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectile;
  const std::string_view name = fuzz::text_of({data, size});
  const auto channel = io::parse_spectral_channel(name, {});
  if (!channel) return 0;
  const double nm = channel->wavelength_nm;
  fuzz::require(std::isfinite(nm) && nm > 0, "a wavelength is positive and finite", fmt::format("{}", nm));
  if (channel->kind == io::SpectralKind::kPolarised || channel->kind == io::SpectralKind::kReradiating)
    return 0;
  // Names hold six decimals: beyond them, and where they would be zeros only, nothing is guaranteed.
  if (nm < 1e-3 || nm > 1e9) return 0;
  const std::string written = io::spectral_channel_name(channel->kind, nm);
  const auto again = io::parse_spectral_channel(written, {});
  fuzz::require(again.has_value(), "a written name can be read", written);
  fuzz::require(again->kind == channel->kind, "a written name is of the same kind", written);
  fuzz::require(std::abs(again->wavelength_nm - nm) <= 5.1e-7,
                "a written name has its wavelength to six decimals", written);
  fuzz::require(io::spectral_channel_name(again->kind, again->wavelength_nm) == written,
                "a name written twice is the same", written);
  return 0;
}
