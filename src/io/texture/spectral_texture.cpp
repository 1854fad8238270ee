// SpectralTexture: the spectra of a part of an image, or of points on it, at the wavelengths asked for,
// whichever way they are stored.
#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/texture/texture_image.hpp"

namespace spectile {
namespace {

Result<void> check_region(const PixelWindow& r, int width, int height) {
  if (!r.empty() && r.x0 >= 0 && r.y0 >= 0 && r.x1 <= width && r.y1 <= height) return {};
  return make_error(ErrorCode::kBadArgument,
                    "a region of {} x {} pixels at {},{} is not one of the image's {} x {}",
                    std::int64_t{r.x1} - r.x0, std::int64_t{r.y1} - r.y0, r.x0, r.y0, width, height);
}

/// Bands centred at wavelengths, edges halfway; unlike Bands::from_centres(), the first may reach down to 0.
Result<Bands> bands_at(std::span<const double> wavelengths_nm) {
  const std::size_t n = wavelengths_nm.size();
  if (n == 0 || n > Bands::kMaxBands) {
    return make_error(ErrorCode::kBadArgument, "{} wavelengths: there must be 1 to {}", n, Bands::kMaxBands);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i == 0 ? 0 : wavelengths_nm[i - 1];
    if (wavelengths_nm[i] > before && std::isfinite(wavelengths_nm[i])) continue;
    return make_error(ErrorCode::kBadArgument,
                      "wavelength {} of {}, {} nm after {} nm: they must be positive and ascend strictly",
                      i + 1, n, wavelengths_nm[i], before);
  }
  std::vector<Band> list(n);
  for (std::size_t i = 0; i < n; ++i) list[i].centre_nm = wavelengths_nm[i];
  for (std::size_t i = 0; i + 1 < n; ++i) {
    list[i].upper_nm = list[i + 1].lower_nm = 0.5 * (wavelengths_nm[i] + wavelengths_nm[i + 1]);
  }
  Band& first = list.front();
  Band& last = list.back();
  if (n == 1) first.upper_nm = first.centre_nm + 0.5;
  first.lower_nm = std::max(0.0, 2 * first.centre_nm - first.upper_nm);
  if (n > 1) last.upper_nm = 2 * last.centre_nm - last.lower_nm;
  return Bands::from_list(std::move(list));
}

}  // namespace

Result<SpectralTexture> SpectralTexture::open(const std::string& path, int threads) {
  return open(path, TextureOptions{.threads = threads});
}

Result<SpectralTexture> SpectralTexture::open(const std::string& path, const TextureOptions& options) {
  return io::contained<SpectralTexture>(path, [&]() -> Result<SpectralTexture> {
    SPECTILE_ASSIGN(auto image, Image::open(path, options));
    return SpectralTexture(std::move(image));
  });
}

int SpectralTexture::width() const noexcept {
  return image_->width();
}

int SpectralTexture::height() const noexcept {
  return image_->height();
}

Quantity SpectralTexture::quantity() const noexcept {
  return image_->quantity();
}

const Bands& SpectralTexture::bands() const noexcept {
  return image_->bands();
}

bool SpectralTexture::compact() const noexcept {
  return image_->compact();
}

std::uint64_t SpectralTexture::samples_read() const noexcept {
  return image_->samples_read();
}

Result<SampledSpectra> SpectralTexture::evaluate(const PixelWindow& region,
                                                 std::span<const double> wavelengths_nm) const {
  return io::contained<SampledSpectra>(image_->path(), [&]() -> Result<SampledSpectra> {
    SPECTILE_TRY(check_region(region, width(), height()));
    SPECTILE_ASSIGN(const auto bands, bands_at(wavelengths_nm));
    SPECTILE_ASSIGN(auto spectra,
                    SampledSpectra::create(bands, static_cast<std::size_t>(region.width()) *
                                                      static_cast<std::size_t>(region.height())));
    SPECTILE_TRY(image_->evaluate(region, spectra.span()));
    return spectra;
  });
}

Result<void> SpectralTexture::evaluate(const PixelWindow& region, SampledSpectraSpan spectra) const {
  return io::contained<void>(image_->path(), [&]() -> Result<void> {
    SPECTILE_TRY(check_region(region, width(), height()));
    return image_->evaluate(region, spectra);
  });
}

Result<void> SpectralTexture::sample(const TexturePoints& at, SampledSpectraView lambda_nm,
                                     SampledSpectraSpan samples, const TextureLookup& lookup,
                                     const Execution& execution) const {
  return io::contained<void>(image_->path(),
                             [&] { return image_->sample(at, &lambda_nm, samples, lookup, execution); });
}

Result<void> SpectralTexture::sample(const TexturePoints& at, SampledSpectraSpan samples,
                                     const TextureLookup& lookup, const Execution& execution) const {
  return io::contained<void>(image_->path(),
                             [&] { return image_->sample(at, nullptr, samples, lookup, execution); });
}

Result<int> SpectralTexture::levels() const {
  return io::contained<int>(image_->path(), [&]() -> Result<int> {
    SPECTILE_ASSIGN(const io::TextureTiles* const tiles, image_->tiles());
    return static_cast<int>(tiles->levels().size() / kernels::kTextureLevelRow);
  });
}

TextureCacheStats SpectralTexture::cache_stats() const {
  return image_->cache().stats();
}

}  // namespace spectile
