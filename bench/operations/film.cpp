// Film samples to what they contribute to their pixels.
#include <algorithm>
#include <cmath>
#include <memory>
#include <spectile/color/colorimetry.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "bench/operations/films.hpp"
#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"

namespace spectile::measure {
namespace {

constexpr std::int32_t kCurveIntervals = 470;  // 360 to 830 nm
constexpr double kCurvesFirstNm = 360;
/// Three curves' values at a wavelength, and at 4 their differences to the next one, as the kernels want
/// them.
struct alignas(32) CurveRow {
  float values[8] = {};
};
using CurveRows = std::shared_ptr<const std::vector<CurveRow>>;

Result<CurveRows> curve_rows() {
  // One row more behind the last.
  auto rows = std::make_shared<std::vector<CurveRow>>(kCurveIntervals + 2);
  const char* const names[3] = {"cie1931-x", "cie1931-y", "cie1931-z"};
  for (std::size_t c = 0; c < 3; ++c) {
    SPECTILE_ASSIGN(const auto curve, named_spectrum(names[c]));
    for (std::size_t i = 0; i <= kCurveIntervals; ++i) {
      const double nm = kCurvesFirstNm + static_cast<double>(i);
      const auto value = static_cast<float>(curve(nm));
      const float next = i < kCurveIntervals ? static_cast<float>(curve(nm + 1)) : value;
      (*rows)[i].values[c] = value;
      (*rows)[i].values[4 + c] = next - value;
    }
  }
  return CurveRows(std::move(rows));
}

Operation& film_operation(std::vector<Operation>& to, std::string name, std::size_t planes) {
  Operation& op = add_operation(to, "film", std::move(name), "lane", {planes, 1}, {1, 4, Element::kQuad});
  op.cache_only = true;  // a film weighs some thousand samples at once
  return op;
}

void add_wavelength_samples(std::vector<Operation>& to, const CurveRows& rows) {
  Operation& op = film_operation(to, "weigh film samples of 4 wavelengths", 3 * kWavelengths);
  op.item = "sample";
  // For vectors of wavelengths, looking at faults and finding the row; for quads of colours, two products and
  // sums a wavelength, the factor, limits.
  op.operations = kWavelengths * 14 + 4 * (4 * kWavelengths + 5);
  op.divisions = kWavelengths;
  op.bottleneck = "a row of the curves for each sample and wavelength: two loads and a shuffle of their own";
  op.bound = kWavelengths + 8;
  op.fill = fill_path;
  op.run = [rows](const KernelTable& k, const Arrays& a) {
    const PathRows path(a);
    const kernels::FilmCurves curves = {rows->front().values, static_cast<float>(kCurvesFirstNm),
                                        kCurveIntervals, 2};
    k.film_weigh_wavelengths({a.out(), reasons_for(a.n())},
                             {path.values, path.lambda, path.density, nullptr, kWavelengths, a.n()}, curves,
                             kNoLimits, 1.0F / kWavelengths);
  };
  const auto evaluate_errors = error_against(
      3, 2 * kWavelengths, false, op.bound, [rows](const double* v, double* reference, double* scale) {
        for (std::size_t i = 0; i < kWavelengths; ++i) {
          const double density = v[2 * kWavelengths + i];
          const double t = v[kWavelengths + i] - kCurvesFirstNm;
          if (density == 0 || !(t >= 0 && t <= kCurveIntervals)) continue;
          const double ratio = v[i] / density;
          const auto row = static_cast<std::size_t>(t);
          const double part = t - static_cast<double>(row);
          for (std::size_t c = 0; c < 3; ++c) {
            const auto value = static_cast<double>((*rows)[row].values[c]);
            const auto step = static_cast<double>((*rows)[row].values[4 + c]);
            reference[c] += (value + part * step) * ratio / kWavelengths;
            scale[c] += (std::abs(value) + std::abs(part * step)) * std::abs(ratio) / kWavelengths;
          }
        }
      });
  op.error = [evaluate_errors](const double* in, const double* out, double tiny) {
    // Results for samples that a film refuses are not specified: numbers that are not finite, negative
    // densities, ratios beyond float's range.
    for (std::size_t i = 0; i < kWavelengths; ++i) {
      const double density = in[2 * kWavelengths + i];
      const bool good = std::isfinite(in[i]) && std::isfinite(in[kWavelengths + i]) && std::isfinite(density);
      if (!good || density < 0) return kOutOfDomain;
      if (density != 0 && std::abs(in[i] / density) > 0x1p120) return kOutOfDomain;
      // A density flushed to 0, or a ratio below the smallest normal number, is outside of the bound's
      // domain.
      if (density != 0 && (density < 0x1p-126 || std::abs(in[i] / density) < 0x1p-100)) return kOutOfDomain;
    }
    return evaluate_errors(in, out, tiny);
  };
}

void add_band_samples(std::vector<Operation>& to, const Projector& projector) {
  const std::size_t bands = projector.bands().count();
  const auto count = static_cast<double>(bands);
  Operation& op = film_operation(to, "weigh film samples on bands", bands);
  op.item = "spectrum";
  op.operations = 4 * (2 * count + count / 8) + 8;
  op.bound = count / 8 + 12;
  op.bottleneck = "a sample of each band comes alone, to be spread over a quad";
  op.fill = uniform_values(bands, 0.01F, 1.0F);
  auto weights = std::make_shared<std::vector<float>>(ProjectorAccess::weights(projector),
                                                      ProjectorAccess::weights(projector) + 4 * bands);
  auto exact = std::make_shared<std::vector<double>>();
  for (const auto& w : projector.weights()) exact->insert(exact->end(), w.begin(), w.end());
  op.run = [=](const KernelTable& k, const Arrays& a) {
    thread_local std::vector<const float*> rows;
    rows.resize(bands);
    for (std::size_t b = 0; b < bands; ++b) rows[b] = a.in(b);
    k.film_weigh_bands({a.out(), reasons_for(a.n())}, {rows.data(), nullptr, nullptr, nullptr, bands, a.n()},
                       weights->data(), kNoLimits);
  };
  const auto evaluate_errors =
      error_against(3, count, false, op.bound, [=](const double* v, double* reference, double* scale) {
        for (std::size_t i = 0; i < 3 * bands; ++i) {
          const double term = (*exact)[i] * v[i / 3];
          reference[i % 3] += term;
          scale[i % 3] += std::abs(term);
        }
      });
  op.error = [=](const double* in, const double* out, double tiny) {
    if (!std::all_of(in, in + bands, [](double v) { return std::isfinite(v); })) return kOutOfDomain;
    return evaluate_errors(in, out, tiny);
  };
}

}  // namespace

Result<void> add_film(std::vector<Operation>& to, const Bands& bands) {
  SPECTILE_ASSIGN(const auto rows, curve_rows());
  add_wavelength_samples(to, rows);
  // Bands that no observer sees make no film.
  if (const auto projector = Projector::emissive(bands)) add_band_samples(to, *projector);
  return {};
}

}  // namespace spectile::measure
