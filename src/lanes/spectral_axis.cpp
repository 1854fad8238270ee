// SpectralAxis: its making and its name.
#include <spectile/lanes/spectral_axis.hpp>

#include "src/base/errors.hpp"

namespace spectile {

Result<SpectralAxis> SpectralAxis::own_wavelengths(std::size_t count) {
  if (count == 0 || count > kMaxWavelengths) {
    return make_error(ErrorCode::kBadArgument, "a lane takes 1 to {} wavelengths, not {}", kMaxWavelengths,
                      count);
  }
  return SpectralAxis(count);
}

std::string SpectralAxis::description() const {
  if (bands_) return "bands " + bands_->description();
  return fmt::format("{} wavelength{} of each lane's own", count_, count_ == 1 ? "" : "s");
}

}  // namespace spectile
