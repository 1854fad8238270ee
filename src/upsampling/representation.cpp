// Representations of light and materials with one interface.
#include <algorithm>
#include <spectile/color/sensor.hpp>
#include <spectile/upsampling/representation.hpp>

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
  SPECTILE_ASSIGN(auto reflectances, Upsampler::create(method, Quantity::kReflectance, bands));
  SPECTILE_ASSIGN(auto lights, Upsampler::create(method, Quantity::kIlluminant, bands));
  SPECTILE_ASSIGN(auto projector, Projector::emissive(bands));
  return SampledRepresentation(std::move(reflectances), std::move(lights), std::move(projector));
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
                                                   const Execution& execution) const {
  return upsample_srgb(*lights_, rgb, out, StoreHint::kAuto, execution);
}

Result<void> SampledRepresentation::reflectance_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                                         const Execution& execution) const {
  return upsample_srgb(*reflectances_, rgb, out, StoreHint::kAuto, execution);
}

Result<void> SampledRepresentation::to_xyz(SampledSpectraView light, ColorSpan xyz,
                                           const Execution& execution) const {
  return project(*projector_, light, xyz, execution);
}

Result<void> SampledRepresentation::to_rgb(SampledSpectraView light, ColorSpan rgb,
                                           const Execution& execution) const {
  SPECTILE_TRY(project(*projector_, light, rgb, execution));
  return transform(projector_->xyz_to_srgb(), rgb, rgb, execution);
}

Result<void> SampledRepresentation::luminance(SampledSpectraView light, LanesSpan y,
                                              const Execution& execution) const {
  return spectile::luminance(*projector_, light, y, execution);
}

Result<RgbRepresentation> RgbRepresentation::create() {
  SPECTILE_ASSIGN(auto bands, Bands::from_list({{0.5, 1, 1.5}, {1.5, 2, 2.5}, {2.5, 3, 3.5}}));
  RgbRepresentation out;
  out.bands_ = bands;
  return out;
}

Result<SampledSpectra> RgbRepresentation::constant(std::size_t lanes, float value) const {
  return SampledSpectra::constant(bands_, lanes, value);
}

Result<SampledSpectra> RgbRepresentation::light(const Spectrum& spectrum, std::size_t lanes) const {
  SPECTILE_ASSIGN(const auto observer, Sensor::named("cie1931"));
  return broadcast_rgb(bands_, lanes, xyz_to_srgb_matrix(), observer.response(spectrum));
}

Result<SampledSpectra> RgbRepresentation::reflectance(const Spectrum& spectrum, std::size_t lanes) const {
  SPECTILE_ASSIGN(const auto observer, Sensor::named("cie1931"));
  SPECTILE_ASSIGN(const auto d65, illuminant("D65"));
  const Spectrum light = PiecewiseLinearSpectrum(d65);
  // The white that D65 has here is the space's own but for its chromaticity's four decimals.
  const Matrix3 to_rgb = inverse(rgb_to_xyz(kRec709, observer.response(light)));
  return broadcast_rgb(bands_, lanes, to_rgb, observer.response(light, spectrum));
}

Result<void> RgbRepresentation::light_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                               const Execution& execution) const {
  SPECTILE_TRY(shape::same_bands("the representation", bands_, out.axis));
  SPECTILE_TRY(shape::same_lanes(rgb.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(out.data));
  SPECTILE_TRY(shape::aligned(rgb));
  tiles::for_blocks(blocks_for(rgb.lanes), execution, [&](std::size_t first, std::size_t count) {
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
                                                     const Execution& execution) const {
  return light_from_rgb(rgb, out, execution);
}

Result<void> RgbRepresentation::weighted(const Matrix3& matrix, SampledSpectraView light, ColorSpan out,
                                         const Execution& execution) const {
  SPECTILE_TRY(shape::same_bands("the representation", bands_, light.axis));
  SPECTILE_TRY(shape::same_lanes(light.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(light.data));
  SPECTILE_TRY(shape::aligned(out));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  alignas(64) float weights[3][4] = {};
  for (std::size_t i = 0; i < 9; ++i) weights[i % 3][i / 3] = static_cast<float>(matrix[i]);
  tiles::for_blocks(light.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    float* const dst[3] = {out.c[0] + at, out.c[1] + at, out.c[2] + at};
    table->project(dst, light.data + 3 * at, weights[0], 3, count);
  });
  return {};
}

Result<void> RgbRepresentation::to_xyz(SampledSpectraView light, ColorSpan xyz,
                                       const Execution& execution) const {
  return weighted(srgb_to_xyz_matrix(), light, xyz, execution);
}

Result<void> RgbRepresentation::to_rgb(SampledSpectraView light, ColorSpan rgb,
                                       const Execution& execution) const {
  return weighted({1, 0, 0, 0, 1, 0, 0, 0, 1}, light, rgb, execution);
}

Result<void> RgbRepresentation::luminance(SampledSpectraView light, LanesSpan y,
                                          const Execution& execution) const {
  SPECTILE_TRY(shape::same_bands("the representation", bands_, light.axis));
  SPECTILE_TRY(shape::same_lanes(light.lanes, y.lanes));
  SPECTILE_TRY(shape::aligned(light.data));
  SPECTILE_TRY(shape::aligned(y.data));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  float weights[3];
  for (std::size_t k = 0; k < 3; ++k) weights[k] = static_cast<float>(srgb_to_xyz_matrix()[3 + k]);
  tiles::for_blocks(light.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    table->weighted_sum(y.data + at, light.data + 3 * at, weights, 3, count);
  });
  return {};
}

Result<void> RgbRepresentation::from_sampled(const SampledRepresentation& other, SampledSpectraView light,
                                             SampledSpectraSpan out, const Execution& execution) const {
  SPECTILE_ASSIGN(auto rgb, ColorLanes::create(light.lanes));
  SPECTILE_TRY(other.to_rgb(light, rgb.span(), execution));
  return light_from_rgb(rgb.view(), out, execution);
}

Result<void> RgbRepresentation::to_sampled(const SampledRepresentation& other, SampledSpectraView light,
                                           SampledSpectraSpan out, const Execution& execution) const {
  SPECTILE_ASSIGN(auto rgb, ColorLanes::create(light.lanes));
  SPECTILE_TRY(to_rgb(light, rgb.span(), execution));
  return other.light_from_rgb(rgb.view(), out, execution);
}

}  // namespace spectile
