// Projection to CIE XYZ, luminance and a sensor's RGB, and XYZ to and from linear sRGB.
#include <algorithm>
#include <cmath>
#include <spectile/color/sensor.hpp>
#include <spectile/spectra/named_light.hpp>

#include "src/color/color_matrix.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/data/tables.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/spectra/band_weights.hpp"

namespace spectile {
namespace {

MeasuredSpectrum matching_function(const data::MatchingFunctions& observer, std::span<const double> values) {
  // Zero beyond the tabulated range, as the standard's sums end there: a step at each end.
  std::vector<double> wavelengths = {observer.first_nm};
  std::vector<double> samples = {0.0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    wavelengths.push_back(observer.first_nm + static_cast<double>(i) * observer.step_nm);
    samples.push_back(values[i]);
  }
  wavelengths.push_back(wavelengths.back());
  samples.push_back(0.0);
  return *MeasuredSpectrum::from_samples(wavelengths, samples);
}

std::array<MeasuredSpectrum, 3> matching_functions(Observer observer) {
  const data::MatchingFunctions& table = observer == Observer::kCie1964 ? data::kCie1964 : data::kCie1931;
  return {matching_function(table, table.x_bar), matching_function(table, table.y_bar),
          matching_function(table, table.z_bar)};
}

/// Share of a white's tint that is taken out: all where no component of its sRGB is more than kNear off 1,
/// none from kFar on, and evenly less in between, so that no small change of the bands makes a step.
double compensated_share(const std::array<double, 3>& white) {
  constexpr double kNear = 0.1;
  constexpr double kFar = 0.3;
  double off = 0;
  for (const double v : times(xyz_to_srgb_matrix(), white)) off = std::max(off, std::abs(v - 1));
  return off <= kFar ? std::min(1.0, (kFar - off) / (kFar - kNear)) : 0;
}

/// XYZ to sRGB with this white, of Y = 1, at RGB 1, 1, 1, as far as the share says.
Matrix3 white_keeping_srgb(const std::array<double, 3>& white, double share) {
  if (share == 0) return xyz_to_srgb_matrix();
  if (share == 1) return inverse(rgb_to_xyz(kRec709, white));
  std::array<double, 3> kept = chromaticity_to_xyz(kRec709.white);
  for (std::size_t k = 0; k < 3; ++k) kept[k] += share * (white[k] - kept[k]);
  return inverse(rgb_to_xyz(kRec709, kept));
}

/// Errors: kBadArgument for bands that overlap, whose integrals would count light twice.
Result<void> check_apart(const Bands& bands) {
  if (!bands.overlap()) return {};
  return make_error(ErrorCode::kBadArgument, "{} overlap, and have no plan that weighs them",
                    bands.description());
}

/// Weights of planned bands: their sensor, times the emission of a light where there is one.
Result<std::vector<std::array<double, 3>>> planned_weights(const BandWeights& own,
                                                           const MeasuredSpectrum* light, Observer observer) {
  SPECTILE_TRY(check_observer(own, observer));
  std::vector<std::array<double, 3>> out = own.sensor;
  if (light == nullptr) return out;
  SPECTILE_ASSIGN(const auto index, find_band_light(own, *light));
  for (std::size_t b = 0; b < out.size(); ++b) {
    for (double& v : out[b]) v *= own.lights[index].emission[b];
  }
  return out;
}

}  // namespace

void Projector::add_band(const std::array<double, 3>& weights) {
  weights_.push_back(weights);
  for (const double v : weights) float_weights_.push_back(static_cast<float>(v));
  float_weights_.push_back(0.0F);
  luminance_weights_.push_back(static_cast<float>(weights[1]));
}

Result<Projector> Projector::of_observer(const Bands& bands, const MeasuredSpectrum* light,
                                         Observer observer) {
  const std::array<MeasuredSpectrum, 3> functions = matching_functions(observer);
  const MeasuredSpectrum d65 = *illuminant("D65");
  std::array<double, 3> d65_white{};
  std::vector<std::array<double, 3>> weights;
  if (bands.weights() != nullptr) {
    for (std::size_t k = 0; k < 3; ++k) d65_white[k] = product_integral(functions[k], d65, 0, 1000);
    // A plan for D65 has its white on its own.
    if (const auto with_d65 = planned_weights(*bands.weights(), &d65, observer)) {
      d65_white = {};
      for (const auto& w : *with_d65) {
        for (std::size_t k = 0; k < 3; ++k) d65_white[k] += w[k];
      }
    }
    SPECTILE_ASSIGN(weights, planned_weights(*bands.weights(), light, observer));
  }
  if (bands.weights() == nullptr) SPECTILE_TRY(check_apart(bands));
  double luminance = 0;
  for (const auto& w : weights) luminance += w[1];
  for (const Band& band : bands.weights() == nullptr ? bands.list() : std::span<const Band>()) {
    std::array<double, 3> w{};
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = light == nullptr ? functions[k].integral(band.lower_nm, band.upper_nm)
                              : product_integral(functions[k], *light, band.lower_nm, band.upper_nm);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      d65_white[k] += light == nullptr ? w[k] * d65.integral(band.lower_nm, band.upper_nm) / band.width_nm()
                                       : product_integral(functions[k], d65, band.lower_nm, band.upper_nm);
    }
    luminance += w[1];
    weights.push_back(w);
  }
  if (!(luminance > 0)) {
    return make_error(ErrorCode::kBadArgument, "bands {} hold no {} luminance", bands.description(),
                      light == nullptr ? "visible" : "of the light's");
  }
  Projector out;
  out.bands_ = bands;
  out.observer_ = observer;
  const std::array<double, 3> seen = {d65_white[0] / d65_white[1], 1.0, d65_white[2] / d65_white[1]};
  out.white_compensation_ = compensated_share(seen);
  out.xyz_to_srgb_ = white_keeping_srgb(seen, out.white_compensation_);
  for (const auto& w : weights) out.add_band({w[0] / luminance, w[1] / luminance, w[2] / luminance});
  return out;
}

Result<Projector> Projector::of_sensor(const Bands& bands, const Spectrum* light, const Sensor& sensor) {
  if (bands.weights() != nullptr) {
    return make_error(ErrorCode::kBadArgument,
                      "planned bands are weighed by their plan's own sensor, the CIE observer, alone");
  }
  SPECTILE_TRY(check_apart(bands));
  Projector out;
  out.bands_ = bands;
  for (const Band& band : bands.list()) {
    std::array<double, 3> weights{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Spectrum& curve = sensor.curves()[c];
      weights[c] =
          sensor.factors()[c] * (light != nullptr ? inner_product(curve, *light, band.lower_nm, band.upper_nm)
                                                  : curve.integral(band.lower_nm, band.upper_nm));
    }
    out.add_band(weights);
  }
  return out;
}

Result<Projector> Projector::emissive(const Bands& bands, Observer observer) {
  return of_observer(bands, nullptr, observer);
}

Result<Projector> Projector::reflective(const Bands& bands, const MeasuredSpectrum& light,
                                        Observer observer) {
  return of_observer(bands, &light, observer);
}

Result<Projector> Projector::reflective(const Bands& bands, const Spectrum& light, Observer observer) {
  SPECTILE_ASSIGN(const auto table, tabulated(light));
  return of_observer(bands, &table, observer);
}

Result<Projector> Projector::reradiating(const Bands& bands, const MeasuredSpectrum& light,
                                         std::span<const BandPair> pairs, Observer observer) {
  if (bands.weights() != nullptr && !pairs.empty()) {
    return make_error(ErrorCode::kBadArgument, "planned bands have no weights for re-radiation");
  }
  SPECTILE_ASSIGN(auto out, of_observer(bands, &light, observer));
  const std::array<MeasuredSpectrum, 3> functions = matching_functions(observer);
  double luminance = 0;
  for (const Band& band : bands.list()) {
    luminance += product_integral(functions[1], light, band.lower_nm, band.upper_nm);
  }
  for (const BandPair& pair : pairs) {
    if (pair.from >= bands.count() || pair.to >= bands.count()) {
      return make_error(ErrorCode::kBadArgument, "re-radiation from band {} to band {} of {}", pair.from,
                        pair.to, bands.count());
    }
    const Band& from = bands[pair.from];
    const Band& to = bands[pair.to];
    const double absorbed = light.integral(from.lower_nm, from.upper_nm) / from.width_nm();
    std::array<double, 3> w{};
    for (std::size_t k = 0; k < 3; ++k)
      w[k] = absorbed * functions[k].integral(to.lower_nm, to.upper_nm) / luminance;
    out.add_band(w);
  }
  return out;
}

Result<Projector> Projector::emissive(const Bands& bands, const Sensor& sensor) {
  return of_sensor(bands, nullptr, sensor);
}

Result<Projector> Projector::reflective(const Bands& bands, const Spectrum& light, const Sensor& sensor) {
  return of_sensor(bands, &light, sensor);
}

std::array<double, 3> Projector::white() const noexcept {
  std::array<double, 3> sum{};
  for (const auto& w : weights_) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += w[k];
  }
  return sum;
}

Result<void> project(const Projector& projector, SampledSpectraView spectra, ColorSpan color,
                     const Execution& execution) {
  SPECTILE_TRY(shape::same_bands("the projector", projector.bands(), spectra.axis));
  SPECTILE_TRY(shape::same_lanes(spectra.lanes, color.lanes));
  SPECTILE_TRY(shape::aligned(spectra.data));
  SPECTILE_TRY(shape::aligned(color));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t bands = spectra.axis.count();
  tiles::for_blocks(spectra.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    float* const dst[3] = {color.c[0] + at, color.c[1] + at, color.c[2] + at};
    table->project(dst, spectra.data + at * bands, ProjectorAccess::weights(projector), bands, count);
  });
  return {};
}

Result<void> luminance(const Projector& projector, SampledSpectraView spectra, LanesSpan y,
                       const Execution& execution) {
  SPECTILE_TRY(shape::same_bands("the projector", projector.bands(), spectra.axis));
  SPECTILE_TRY(shape::same_lanes(spectra.lanes, y.lanes));
  SPECTILE_TRY(shape::aligned(spectra.data));
  SPECTILE_TRY(shape::aligned(y.data));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t bands = spectra.axis.count();
  tiles::for_blocks(spectra.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    table->weighted_sum(y.data + at, spectra.data + at * bands, ProjectorAccess::luminance_weights(projector),
                        bands, count);
  });
  return {};
}

const Matrix3& srgb_to_xyz_matrix() {
  // IEC 61966-2-1:1999: the primaries of ITU-R BT.709 and its D65 white.
  static const Matrix3 matrix = rgb_to_xyz(kRec709);
  return matrix;
}

const Matrix3& xyz_to_srgb_matrix() {
  static const Matrix3 matrix = inverse(srgb_to_xyz_matrix());
  return matrix;
}

Result<void> transform(const Matrix3& matrix, ColorView in, ColorSpan out, const Execution& execution) {
  SPECTILE_TRY(shape::same_lanes(in.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(in));
  SPECTILE_TRY(shape::aligned(out));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::array<float, 9> m = color::to_float(matrix);
  tiles::for_blocks(blocks_for(in.lanes), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const float* const src[3] = {in.c[0] + at, in.c[1] + at, in.c[2] + at};
    float* const dst[3] = {out.c[0] + at, out.c[1] + at, out.c[2] + at};
    table->transform3(dst, src, m.data(), count * kLanesPerBlock);
  });
  return {};
}

Result<void> xyz_to_srgb(ColorView xyz, ColorSpan rgb, const Execution& execution) {
  return transform(xyz_to_srgb_matrix(), xyz, rgb, execution);
}

Result<void> srgb_to_xyz(ColorView rgb, ColorSpan xyz, const Execution& execution) {
  return transform(srgb_to_xyz_matrix(), rgb, xyz, execution);
}

}  // namespace spectile
