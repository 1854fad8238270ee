// Sensor: responses, and the fit of its RGB to XYZ.
#include <algorithm>
#include <cmath>
#include <spectile/color/color_difference.hpp>
#include <spectile/color/sensor.hpp>

#include "src/base/errors.hpp"
#include "src/data/tables.hpp"

namespace spectile {
namespace {

using Triple = std::array<double, 3>;

constexpr std::size_t kScaled = 1;  // the curve that the exposure is relative to

Spectrum tabulated(double first_nm, std::span<const double> values) {
  return *DenselySampledSpectrum::from_values(static_cast<int>(first_nm), {values.begin(), values.end()});
}

std::array<Spectrum, 3> observer_curves(const data::MatchingFunctions& cie) {
  return {tabulated(cie.first_nm, cie.x_bar), tabulated(cie.first_nm, cie.y_bar),
          tabulated(cie.first_nm, cie.z_bar)};
}

Spectrum tabulated_curve(const data::NamedTable& table) {
  std::vector<double> nm;
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    nm.push_back(table.first_nm + static_cast<double>(i) * table.step_nm);
  }
  return *PiecewiseLinearSpectrum::from_samples(nm, table.values);
}

/// A patch's reflectance over the whole visible range, its ends constant.
Spectrum patch_reflectance(const data::NamedTable& table) {
  std::vector<double> nm = {kFirstVisibleNm};
  std::vector<double> values = {table.values.front()};
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    nm.push_back(table.first_nm + static_cast<double>(i) * table.step_nm);
    values.push_back(table.values[i]);
  }
  nm.push_back(kLastVisibleNm);
  values.push_back(table.values.back());
  return *PiecewiseLinearSpectrum::from_samples(nm, values);
}

}  // namespace

Result<Sensor> Sensor::create(const std::array<Spectrum, 3>& curves, const SensorOptions& options) {
  if (!(options.exposure > 0) || !std::isfinite(options.exposure)) {
    return make_error(ErrorCode::kBadArgument, "an exposure of {} is not above 0 and finite",
                      options.exposure);
  }
  Triple of_one{};
  Triple of_white{};
  for (std::size_t c = 0; c < 3; ++c) {
    of_one[c] = curves[c].integral();
    of_white[c] = options.white_balance ? inner_product(curves[c], *options.white_balance) : 1;
    for (const double v : {of_one[c], of_white[c]}) {
      if (v > 0 && std::isfinite(v)) continue;
      return make_error(ErrorCode::kBadArgument,
                        "response curve {} gives {} {} from 360 to 830 nm; it must be above 0 and finite",
                        c + 1, v, &v == &of_one[c] ? "for equal energy" : "for the white balance's light");
    }
  }
  Triple factors{};
  for (std::size_t c = 0; c < 3; ++c) {
    factors[c] = options.exposure / of_one[kScaled] * (of_white[kScaled] / of_white[c]);
  }
  return Sensor(curves, factors);
}

Result<Sensor> Sensor::named(std::string_view name, const SensorOptions& options) {
  if (name == "cie1931") return create(observer_curves(data::kCie1931), options);
  if (name == "cie1964") return create(observer_curves(data::kCie1964), options);
  if (name == "canon-eos-5d-mkii") {
    const auto tables = data::canon_eos_5d_mkii();
    return create({tabulated_curve(tables[0]), tabulated_curve(tables[1]), tabulated_curve(tables[2])},
                  options);
  }
  return make_error(ErrorCode::kUnknownName, "sensor \"{}\" is unknown; there are {}", name,
                    fmt::join(names(), ", "));
}

std::vector<std::string> Sensor::names() {
  return {"cie1931", "cie1964", "canon-eos-5d-mkii"};
}

std::array<double, 3> Sensor::response(const Spectrum& light) const {
  Triple out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = factors_[c] * inner_product(curves_[c], light);
  return out;
}

std::array<double, 3> Sensor::response(const Spectrum& light, const Spectrum& reflectance) const {
  Triple out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = factors_[c] * inner_product(curves_[c], light, reflectance);
  return out;
}

Result<ResponseCurves> Sensor::response_curves() const {
  return ResponseCurves::create(curves_, factors_);
}

Result<SensorFit> fit_sensor_to_xyz(const Sensor& sensor, const Spectrum& light) {
  SPECTILE_ASSIGN(const auto observer, Sensor::named("cie1931"));
  const Triple white = observer.response(light);
  if (!(white[1] > 0)) return make_error(ErrorCode::kBadArgument, "the light has no luminance");
  std::vector<Triple> seen;
  std::vector<Triple> wanted;
  for (const data::NamedTable& table : data::colorchecker()) {
    const Spectrum patch = patch_reflectance(table);
    seen.push_back(sensor.response(light, patch));
    Triple xyz = observer.response(light, patch);
    for (double& v : xyz) v /= white[1];
    wanted.push_back(xyz);
  }
  // Normal equations, with the responses scaled to about 1: wanted = matrix * seen.
  Triple scale{};
  for (const Triple& rgb : seen) {
    for (std::size_t c = 0; c < 3; ++c) scale[c] = std::max(scale[c], std::abs(rgb[c]));
  }
  for (double& v : scale) v = v > 0 ? 1 / v : 0;
  Matrix3 squares{};
  Matrix3 products{};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        squares[3 * a + b] += seen[i][a] * scale[a] * seen[i][b] * scale[b];
        products[3 * a + b] += wanted[i][a] * seen[i][b] * scale[b];
      }
    }
  }
  constexpr double kMinDeterminant = 1e-9;  // of 24 patches of about 1
  if (!(determinant(squares) > kMinDeterminant)) {
    return make_error(ErrorCode::kBadArgument,
                      "the sensor's responses to the 24 patches under this light are not independent");
  }
  SensorFit out;
  out.rgb_to_xyz = product(products, inverse(squares));
  for (std::size_t i = 0; i < 9; ++i) out.rgb_to_xyz[i] *= scale[i % 3];
  const Triple white_xyz = {white[0] / white[1], 1, white[2] / white[1]};
  const auto miss = [&](const Triple& rgb, const Triple& xyz) {
    return ciede2000(xyz_to_lab(times(out.rgb_to_xyz, rgb), white_xyz), xyz_to_lab(xyz, white_xyz));
  };
  for (std::size_t i = 0; i < seen.size(); ++i) {
    out.patches.push_back(miss(seen[i], wanted[i]));
    out.mean_ciede2000 += out.patches.back() / static_cast<double>(seen.size());
    out.max_ciede2000 = std::max(out.max_ciede2000, out.patches.back());
  }
  out.white_ciede2000 = miss(sensor.response(light), white_xyz);
  return out;
}

}  // namespace spectile
