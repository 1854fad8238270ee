// Representations of light and materials with one interface.
#include <algorithm>
#include <spectile/upsampling/representation.hpp>
#include <spectile/color/sensor.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

Result<SampledSpectra> broadcast_rgb(const Bands& bands, std::size_t lanes, const Matrix3& to_rgb,
                                     const std::array<double, 3>& xyz) {
  const auto rgb = times(to_rgb, xyz);
  const float values[3] = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                           static_cast<float>(rgb[2])};
  return SampledSpectra::broadcast(bands, lanes, values);
}

}  // namespace

SampledRepresentation::SampledRepresentation(Upsampler reflectances, Upsampler lights, Projector projector)
    : reflectances_(std::make_shared<const Upsampler>(std::move(reflectances))),
      lights_(std::make_shared<const Upsampler>(std::move(lights))),
      projector_(std::make_shared<const Projector>(std::move(projector))) {}

Result<SampledRepresentation> SampledRepresentation::create(const Bands& bands, Method method) {
  auto reflectances = Upsampler::create(method, Quantity::kReflectance, bands);
  if (!reflectances) return reflectances.error();
  auto lights = Upsampler::create(method, Quantity::kIlluminant, bands);
  if (!lights) return lights.error();
  auto projector = Projector::emissive(bands);
  if (!projector) return projector.error();
  return SampledRepresentation(*std::move(reflectances), *std::move(lights), *std::move(projector));
}

Result<SampledSpectra> SampledRepresentation::constant(std::size_t lanes, float value) const {
  return SampledSpectra::constant(bands(), lanes, value);
}

Result<SampledSpectra> SampledRepresentation::light(const Spectrum& spectrum, std::size_t lanes) const {
  return SampledSpectra::broadcast(bands(), lanes, spectrum.average_over(bands()));
}

Result<SampledSpectra> SampledRepresentation::reflectance(const Spectrum& spectrum, std::size_t lanes) const {
  return light(spectrum, lanes);
}

Result<void> SampledRepresentation::light_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                                   const Execution& how) const {
  return upsample_srgb(*lights_, rgb, out, Stores::kAuto, how);
}

Result<void> SampledRepresentation::reflectance_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                                         const Execution& how) const {
  return upsample_srgb(*reflectances_, rgb, out, Stores::kAuto, how);
}

Result<void> SampledRepresentation::to_xyz(SampledSpectraView light, ColorSpan xyz,
                                           const Execution& how) const {
  return project(*projector_, light, xyz, how);
}

Result<void> SampledRepresentation::to_rgb(SampledSpectraView light, ColorSpan rgb,
                                           const Execution& how) const {
  SPECTILE_TRY(project(*projector_, light, rgb, how));
  return transform(projector_->xyz_to_srgb(), rgb, rgb, how);
}

Result<void> SampledRepresentation::luminance(SampledSpectraView light, LanesSpan y,
                                              const Execution& how) const {
  return spectile::luminance(*projector_, light, y, how);
}

Result<RgbRepresentation> RgbRepresentation::create() {
  auto bands = Bands::from_list({{0.5, 1, 1.5}, {1.5, 2, 2.5}, {2.5, 3, 3.5}});
  if (!bands) return bands.error();
  RgbRepresentation out;
  out.bands_ = *bands;
  return out;
}

Result<SampledSpectra> RgbRepresentation::constant(std::size_t lanes, float value) const {
  return SampledSpectra::constant(bands_, lanes, value);
}

Result<SampledSpectra> RgbRepresentation::light(const Spectrum& spectrum, std::size_t lanes) const {
  const auto observer = Sensor::named("cie1931");
  if (!observer) return observer.error();
  return broadcast_rgb(bands_, lanes, xyz_to_srgb_matrix(), observer->response(spectrum));
}

Result<SampledSpectra> RgbRepresentation::reflectance(const Spectrum& spectrum, std::size_t lanes) const {
  const auto observer = Sensor::named("cie1931");
  if (!observer) return observer.error();
  const auto d65 = illuminant("D65");
  if (!d65) return d65.error();
  const Spectrum light = PiecewiseLinearSpectrum(*d65);
  // The white that D65 has here is the space's own but for its chromaticity's four decimals.
  const Matrix3 to_rgb = inverse(rgb_to_xyz(kRec709, observer->response(light)));
  return broadcast_rgb(bands_, lanes, to_rgb, observer->response(light, spectrum));
}

Result<void> RgbRepresentation::light_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                               const Execution& how) const {
  SPECTILE_TRY(shape::bands_of("the representation", bands_, out.bands));
  SPECTILE_TRY(shape::same_lanes(rgb.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(out.data));
  for (const float* plane : rgb.c) SPECTILE_TRY(shape::aligned(plane));
  tiles::for_blocks(blocks_for(rgb.lanes), how, [&](std::size_t first, std::size_t count) {
    for (std::size_t block = first; block < first + count; ++block) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::copy_n(rgb.c[k] + block * kLanesPerBlock, kLanesPerBlock,
                    out.data + (3 * block + k) * kLanesPerBlock);
      }
    }
  });
  return {};
}

Result<void> RgbRepresentation::reflectance_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                                     const Execution& how) const {
  return light_from_rgb(rgb, out, how);
}

Result<void> RgbRepresentation::weighted(const Matrix3& matrix, SampledSpectraView light, ColorSpan out,
                                         const Execution& how) const {
  SPECTILE_TRY(shape::bands_of("the representation", bands_, light.bands));
  SPECTILE_TRY(shape::same_lanes(light.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(light.data));
  for (const float* plane : out.c) SPECTILE_TRY(shape::aligned(plane));
  const auto table = dispatch::active();
  if (!table) return table.error();
  alignas(64) float weights[3][4] = {};
  for (std::size_t i = 0; i < 9; ++i) weights[i % 3][i / 3] = static_cast<float>(matrix[i]);
  tiles::for_blocks(light.blocks(), how, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    (*table)->project(out.c[0] + at, out.c[1] + at, out.c[2] + at, light.data + 3 * at, weights[0], 3, count);
  });
  return {};
}

Result<void> RgbRepresentation::to_xyz(SampledSpectraView light, ColorSpan xyz, const Execution& how) const {
  return weighted(srgb_to_xyz_matrix(), light, xyz, how);
}

Result<void> RgbRepresentation::to_rgb(SampledSpectraView light, ColorSpan rgb, const Execution& how) const {
  return weighted({1, 0, 0, 0, 1, 0, 0, 0, 1}, light, rgb, how);
}

Result<void> RgbRepresentation::luminance(SampledSpectraView light, LanesSpan y, const Execution& how) const {
  SPECTILE_TRY(shape::bands_of("the representation", bands_, light.bands));
  SPECTILE_TRY(shape::same_lanes(light.lanes, y.lanes));
  SPECTILE_TRY(shape::aligned(light.data));
  SPECTILE_TRY(shape::aligned(y.data));
  const auto table = dispatch::active();
  if (!table) return table.error();
  float weights[3];
  for (std::size_t k = 0; k < 3; ++k) weights[k] = static_cast<float>(srgb_to_xyz_matrix()[3 + k]);
  tiles::for_blocks(light.blocks(), how, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    (*table)->weighted_sum(y.data + at, light.data + 3 * at, weights, 3, count);
  });
  return {};
}

Result<void> RgbRepresentation::from_sampled(const SampledRepresentation& other, SampledSpectraView light,
                                             SampledSpectraSpan out, const Execution& how) const {
  auto rgb = ColorLanes::create(light.lanes);
  if (!rgb) return rgb.error();
  SPECTILE_TRY(other.to_rgb(light, rgb->span(), how));
  return light_from_rgb(rgb->view(), out, how);
}

Result<void> RgbRepresentation::to_sampled(const SampledRepresentation& other, SampledSpectraView light,
                                           SampledSpectraSpan out, const Execution& how) const {
  auto rgb = ColorLanes::create(light.lanes);
  if (!rgb) return rgb.error();
  SPECTILE_TRY(to_rgb(light, rgb->span(), how));
  return other.light_from_rgb(rgb->view(), out, how);
}

}  // namespace spectile
