// Reference colours, which methods are evaluated against: sums at every nanometre in double.
#include "bench/methods/reference_colors.hpp"

#include <algorithm>
#include <numeric>
#include <spectile/color/color_difference.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <variant>

#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

constexpr double kFirstNm = kFirstVisibleNm;
constexpr auto kGrid = static_cast<std::size_t>(kLastVisibleNm - kFirstVisibleNm) + 1;

/// At every nanometre; the sums below are those of CIE 015's tables.
template <class F>
std::vector<double> on_grid(const F& f) {
  std::vector<double> out(kGrid);
  for (std::size_t i = 0; i < kGrid; ++i) out[i] = f(kFirstNm + static_cast<double>(i));
  return out;
}

/// Somewhere twice the mean over the 40 nm around it, where there is light to speak of.
bool has_lines(const std::vector<double>& light) {
  constexpr std::size_t kHalf = 20;
  const double most = *std::max_element(light.begin(), light.end());
  for (std::size_t i = kHalf; i + kHalf < light.size(); ++i) {
    double sum = 0;
    for (std::size_t k = i - kHalf; k <= i + kHalf; ++k) sum += light[k];
    if (light[i] > 0.2 * most && light[i] > 2 * sum / (2 * kHalf + 1)) return true;
  }
  return false;
}

}  // namespace

Result<ReferenceLight> reference_light(const std::string& name) {
  SPECTILE_ASSIGN(auto found, illuminant(name));
  const std::vector<double> power = on_grid([&](double nm) { return found.at(nm); });
  ReferenceLight out{name, found, {}, {}, has_lines(power)};
  const char* const curves[3] = {"cie1931-x", "cie1931-y", "cie1931-z"};
  for (std::size_t k = 0; k < 3; ++k) {
    SPECTILE_ASSIGN(const auto curve, named_spectrum(curves[k]));
    out.weights[k] = on_grid([&](double nm) { return curve(nm); });
    for (std::size_t i = 0; i < kGrid; ++i) out.weights[k][i] *= power[i];
  }
  const double y = std::accumulate(out.weights[1].begin(), out.weights[1].end(), 0.0);
  if (!(y > 0)) return make_error(ErrorCode::kBadArgument, "the light {} has no luminance", name);
  for (std::size_t k = 0; k < 3; ++k) {
    for (double& w : out.weights[k]) w /= y;
    out.white[k] = std::accumulate(out.weights[k].begin(), out.weights[k].end(), 0.0);
  }
  return out;
}

Result<std::vector<Spectrum>> chart_reflectances() {
  std::vector<Spectrum> out;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind != "reflectance") continue;
    SPECTILE_ASSIGN(auto found, named_spectrum(info.name));
    out.push_back(std::move(found));
  }
  return out;
}

Result<std::vector<ReferenceReflectance>> reference_reflectances(const std::vector<Spectrum>& spectra) {
  std::vector<ReferenceReflectance> out;
  for (const Spectrum& spectrum : spectra) {
    std::vector<double> nm;
    std::vector<double> values;
    if (const auto* table = std::get_if<PiecewiseLinearSpectrum>(&spectrum.kind())) {
      nm.assign(table->measured().wavelengths_nm().begin(), table->measured().wavelengths_nm().end());
      values.assign(table->measured().values().begin(), table->measured().values().end());
    } else {
      for (std::size_t i = 0; i < kGrid; ++i) nm.push_back(kFirstNm + static_cast<double>(i));
      values = on_grid([&](double at) { return spectrum(at); });
    }
    for (double& v : values) v = std::clamp(v, 0.0, 1.0);
    SPECTILE_ASSIGN(auto measured, MeasuredSpectrum::from_samples(nm, values));
    ReferenceReflectance one{std::move(measured), {}};
    one.values = on_grid([&](double at) { return one.spectrum.at(at); });
    out.push_back(std::move(one));
  }
  if (out.empty()) return make_error(ErrorCode::kBadArgument, "no reflectances to evaluate colours with");
  return out;
}

Xyz reference_xyz(const ReferenceLight& light, const std::vector<const ReferenceReflectance*>& reflectances) {
  Xyz out{};
  for (std::size_t i = 0; i < kGrid; ++i) {
    double product = 1;
    for (const ReferenceReflectance* r : reflectances) product *= r->values[i];
    for (std::size_t k = 0; k < 3; ++k) out[k] += light.weights[k][i] * product;
  }
  return out;
}

void ErrorList::add(const Xyz& reference, const Xyz& found) {
  values_.push_back(ciede2000(xyz_to_lab(reference, white_), xyz_to_lab(found, white_)));
}

}  // namespace spectile::measure
