// SpectralAxis: where the samples of a batch of spectra lie in wavelength.
#pragma once

#include <cstddef>
#include <optional>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <string>

namespace spectile {

/// K samples a lane: averages over bands that all lanes share, or values at wavelengths that each lane has of
/// its own, as SampledWavelengths draws them. The axis knows how many those are, not which: that two batches
/// are at the same ones is the caller's to see to.
class SpectralAxis {
 public:
  static constexpr std::size_t kMaxWavelengths = 64;

  /// 400 to 700 nm in 60 bands.
  SpectralAxis() : SpectralAxis(Bands()) {}
  SpectralAxis(const Bands& bands) : bands_(bands), count_(bands.count()) {}  // NOLINT(*-explicit-*)
  /// Wavelengths of each lane's own. Errors: kBadArgument for none or more than kMaxWavelengths.
  static Result<SpectralAxis> own_wavelengths(std::size_t count);

  /// Samples a lane.
  std::size_t count() const noexcept { return count_; }
  /// Null for wavelengths of each lane's own.
  const Bands* bands() const noexcept { return bands_ ? &*bands_ : nullptr; }
  /// "bands 400:700:5", or "4 wavelengths of each lane's own".
  std::string description() const;

  friend bool operator==(const SpectralAxis& a, const SpectralAxis& b) noexcept {
    return a.count_ == b.count_ && a.bands_ == b.bands_;
  }

 private:
  explicit SpectralAxis(std::size_t count) : count_(count) {}
  std::optional<Bands> bands_;
  std::size_t count_ = 0;
};

}  // namespace spectile
