// Continuous spectra of RGB colours, by the upsampling methods.
#include <cmath>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile {
namespace {

Result<UpsampledSpectrum> upsampled(const Upsampler& upsampler, Quantity quantity,
                                    const std::array<double, 3>& rgb) {
  if (upsampler.quantity() != quantity) {
    return make_error(ErrorCode::kBadArgument, "the upsampler makes {} spectra, not {} ones",
                      to_string(upsampler.quantity()), to_string(quantity));
  }
  return rgb_spectrum(upsampler, rgb);
}

Error cannot_make(const Upsampler& upsampler, const std::array<double, 3>& rgb) {
  return make_error(ErrorCode::kBadArgument, "RGB {}, {}, {} is no colour that {} makes as {}", rgb[0],
                    rgb[1], rgb[2], to_string(upsampler.method()), to_string(upsampler.quantity()));
}

}  // namespace

Result<UpsampledSpectrum> rgb_spectrum(const Upsampler& upsampler, const std::array<double, 3>& rgb) {
  SPECTILE_ASSIGN(auto lanes, ColorLanes::create(1));
  for (std::size_t k = 0; k < 3; ++k) {
    lanes.at(0, k) = static_cast<float>(rgb[k]);
    if (!std::isfinite(lanes.at(0, k))) return cannot_make(upsampler, rgb);
  }
  SPECTILE_ASSIGN(const auto report, gamut_clip(upsampler, lanes.span(), GamutPolicy::kKeep));
  if (report.outside > 0) return cannot_make(upsampler, rgb);
  const Bands& bands = upsampler.bands();
  UpsampledSpectrum::Parts out;
  out.method = to_string(upsampler.method());
  out.quantity = to_string(upsampler.quantity());
  out.rgb = rgb;
  out.first_nm = bands[0].centre_nm;
  out.last_nm = bands[bands.count() - 1].centre_nm;
  std::vector<double> centres;
  for (const Band& band : bands.list()) centres.push_back(band.centre_nm);
  std::vector<double> values;
  if (!rows::stores_rgb(upsampler)) {
    SPECTILE_ASSIGN(auto found, CoefficientLanes::create(upsampler, 1));
    SPECTILE_TRY(coefficients(upsampler, lanes.view(), found));
    out.sigmoid = {found.c.at(0, 0), found.c.at(0, 1), found.c.at(0, 2)};
    if (upsampler.method() == Method::kSigmoidObserver) out.observer = upsampler.options().observer;
    if (rows::has_scale(upsampler)) out.scale = found.scale[0];
    if (upsampler.quantity() != Quantity::kIlluminant) return UpsampledSpectrum::create(std::move(out));
    const float* const own = UpsamplerAccess::sigmoid(upsampler)->table.rows;
    for (std::size_t b = 0; b < bands.count(); ++b) {
      values.push_back(own[b * kernels::kSigmoidRow + kernels::kSigmoidWhite]);
    }
  } else {
    SPECTILE_ASSIGN(auto spectra, SampledSpectra::create(bands, 1));
    SPECTILE_TRY(upsample_srgb(upsampler, lanes.view(), spectra.span()));
    for (std::size_t b = 0; b < bands.count(); ++b) values.push_back(spectra.at(0, b));
  }
  SPECTILE_ASSIGN(auto table, MeasuredSpectrum::from_samples(centres, values));
  out.table = std::make_shared<const MeasuredSpectrum>(std::move(table));
  return UpsampledSpectrum::create(std::move(out));
}

Result<UpsampledSpectrum> rgb_albedo_spectrum(const Upsampler& upsampler, const std::array<double, 3>& rgb) {
  for (const double v : rgb) {
    if (!(v >= 0 && v <= 1)) {
      return make_error(ErrorCode::kBadArgument, "an albedo's components are 0 to 1, not {}, {}, {}", rgb[0],
                        rgb[1], rgb[2]);
    }
  }
  return upsampled(upsampler, Quantity::kReflectance, rgb);
}

Result<UpsampledSpectrum> rgb_unbounded_spectrum(const Upsampler& upsampler,
                                                 const std::array<double, 3>& rgb) {
  return upsampled(upsampler, Quantity::kUnbounded, rgb);
}

Result<UpsampledSpectrum> rgb_illuminant_spectrum(const Upsampler& upsampler,
                                                  const std::array<double, 3>& rgb) {
  return upsampled(upsampler, Quantity::kIlluminant, rgb);
}

}  // namespace spectile
