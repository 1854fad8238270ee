// Lights as tables, and comparison of lights on different scales.
#include <algorithm>
#include <cmath>
#include <limits>
#include <spectile/spectra/named_light.hpp>

#include "src/base/errors.hpp"
#include "src/spectra/breaks.hpp"

namespace spectile {
namespace {

/// Spectra that differ by no more than this of their largest value are the same.
constexpr double kTolerance = 1e-6;

/// Values below 0 up to this share of the largest are an instrument's dark noise.
constexpr double kDarkNoise = 0.01;

constexpr int kFirstTabulatedNm = 300;
constexpr int kFirstNm = static_cast<int>(kFirstVisibleNm);
constexpr int kLastNm = static_cast<int>(kLastVisibleNm);

/// At every nanometre and on both sides of each sample of its parts, so that no line is passed over and sums
/// of tables are exact; products are linear in between.
Result<MeasuredSpectrum> tabulated(const CombinedSpectrum& light) {
  std::vector<double> places;
  for (int nm = kFirstTabulatedNm; nm <= kLastNm; ++nm) places.push_back(nm);
  add_breaks(Spectrum(light), places);
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<double> wavelengths;
  std::vector<double> values;
  for (const double nm : places) {
    if (nm < kFirstTabulatedNm || nm > kLastNm) continue;
    const double before = light(std::nextafter(nm, 0.0));
    const double after = light(std::nextafter(nm, std::numeric_limits<double>::infinity()));
    // A step, rather than what the last bit of the wavelength makes.
    if (std::abs(before - after) > 1e-9 * std::max(std::abs(before), std::abs(after))) {
      wavelengths.push_back(nm);
      values.push_back(before);
    }
    wavelengths.push_back(nm);
    values.push_back(after);
  }
  return MeasuredSpectrum::from_samples(wavelengths, values, Ends::kZero);
}

}  // namespace

Result<MeasuredSpectrum> tabulated(const Spectrum& light) {
  if (const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&light.kind())) {
    return linear->measured().with_ends(linear->ends());
  }
  if (const auto* const combined = std::get_if<CombinedSpectrum>(&light.kind())) return tabulated(*combined);
  std::vector<double> wavelengths;
  for (int nm = kFirstTabulatedNm; nm <= kLastNm; ++nm) wavelengths.push_back(nm);
  return MeasuredSpectrum::from_samples(wavelengths, light.sample(wavelengths), Ends::kZero);
}

Result<NamedLight> named_light(std::string name, const Spectrum& light) {
  SPECTILE_ASSIGN(auto table, tabulated(light));
  return NamedLight{std::move(name), std::move(table), {}};
}

Result<void> check_light(NamedLight& light) {
  const auto values = light.spectrum.values();
  const double largest = std::ranges::max(values);
  const double smallest = std::ranges::min(values);
  if (smallest < 0) {
    const auto count = std::ranges::count_if(values, [](double v) { return v < 0; });
    if (!(-smallest <= kDarkNoise * largest)) {
      return make_error(ErrorCode::kBadArgument,
                        "{}: {} of {} values are below 0, down to {:.6g}; a light has no negative emission",
                        light.name, count, values.size(), smallest);
    }
    light.notes.push_back(fmt::format("{}: {} of {} values are below 0, down to {:.3g}, and kept", light.name,
                                      count, values.size(), smallest));
  }
  if (!(light.spectrum.integral(kFirstVisibleNm, kLastVisibleNm) > 0)) {
    return make_error(ErrorCode::kBadArgument, "{}: has no energy within {} to {} nm, so it is no light",
                      light.name, kFirstVisibleNm, kLastVisibleNm);
  }
  return {};
}

std::vector<double> relative_values(const MeasuredSpectrum& light) {
  std::vector<double> out;
  for (int nm = kFirstNm; nm <= kLastNm; ++nm) out.push_back(light.at(nm));
  double largest = 0;
  for (const double v : out) largest = std::max(largest, std::abs(v));
  if (!(largest > 0)) return {};
  for (double& v : out) v /= largest;
  return out;
}

bool same_light(const MeasuredSpectrum& a, const MeasuredSpectrum& b) {
  const std::vector<double> p = relative_values(a);
  const std::vector<double> q = relative_values(b);
  return !p.empty() &&
         std::ranges::equal(p, q, [](double x, double y) { return std::abs(x - y) <= kTolerance; });
}

}  // namespace spectile
