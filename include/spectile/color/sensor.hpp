// Sensor: an observer or a camera, with exposure and white balance, and a matrix from its RGB to XYZ.
#pragma once

#include <array>
#include <optional>
#include <spectile/color/response_curves.hpp>
#include <spectile/color/rgb_space.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string_view>
#include <utility>
#include <vector>

namespace spectile {

/// How a sensor is set.
struct SensorOptions {
  double exposure = 1;                         ///< times every response
  std::optional<Spectrum> white_balance = {};  ///< light that gets three equal responses, whatever its scale
};

/// Three response curves, each times a factor: a spectrum that is 1 everywhere gives the second one the
/// exposure (an observer's Y is then 1); white balance changes the first and the third to match it.
class Sensor {
 public:
  /// Any three curves. Errors: kBadArgument where a curve, or the white balance's light through it, has no
  /// positive response in 360 to 830 nm, and for an exposure that is not finite and above 0.
  static Result<Sensor> create(const std::array<Spectrum, 3>& curves, const SensorOptions& options = {});
  /// "cie1931", "cie1964" or "canon-eos-5d-mkii". Errors: also kUnknownName, listing the names.
  static Result<Sensor> named(std::string_view name, const SensorOptions& options = {});
  static std::vector<std::string> names();

  /// Responses to light, and to light off a reflectance. Integrals over 360 to 830 nm, see inner_product().
  std::array<double, 3> response(const Spectrum& light) const;
  std::array<double, 3> response(const Spectrum& light, const Spectrum& reflectance) const;

  const std::array<Spectrum, 3>& curves() const noexcept { return curves_; }
  const std::array<double, 3>& factors() const noexcept { return factors_; }
  /// For radiance at sampled wavelengths: see project() there. Errors: kOutOfMemory.
  Result<ResponseCurves> response_curves() const;

 private:
  Sensor(std::array<Spectrum, 3> curves, const std::array<double, 3>& factors)
      : curves_(std::move(curves)), factors_(factors) {}
  std::array<Spectrum, 3> curves_;
  std::array<double, 3> factors_;
};

/// A matrix from a sensor's RGB to XYZ, and its errors.
struct SensorFit {
  Matrix3 rgb_to_xyz{};         ///< XYZ relative to the perfect diffuser under the light, Y = 1
  double mean_ciede2000 = 0;    ///< over the patches
  double max_ciede2000 = 0;     ///< over the patches
  double white_ciede2000 = 0;   ///< of the perfect diffuser itself
  std::vector<double> patches;  ///< CIEDE2000 of each
};

/// Fits the matrix by least squares in XYZ over the 24 patches of the ColorChecker under a light (their ends
/// constant beyond 380 to 730 nm), as the CIE 1931 observer sees them. Errors: kBadArgument where the three
/// responses are not independent over the patches. Source of the patches: BabelColor, mean of 30 charts.
Result<SensorFit> fit_sensor_to_xyz(const Sensor& sensor, const Spectrum& light);

}  // namespace spectile
