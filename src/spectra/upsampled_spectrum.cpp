// UpsampledSpectrum: the spectrum of an RGB colour at any wavelength.
#include <algorithm>
#include <cmath>
#include <span>
#include <spectile/spectra/spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/spectra/quadrature.hpp"
#include "src/spectra/sigmoid_functions.hpp"

namespace spectile {
namespace {

double sigmoid(const std::array<float, 3>& c, const SigmoidFunctions& functions, double lambda_nm) {
  const auto [p, q] = functions.at(lambda_nm);
  const double x = static_cast<double>(c[0]) * p + static_cast<double>(c[1]) * q + static_cast<double>(c[2]);
  const double root = std::sqrt(1 + x * x);
  // From the side where nothing cancels.
  return x < 0 ? 0.5 / (root * (root - x)) : 0.5 + 0.5 * x / root;
}

}  // namespace

Result<UpsampledSpectrum> UpsampledSpectrum::create(Parts parts) {
  if (!parts.sigmoid && !parts.table) {
    return make_error(ErrorCode::kBadArgument, "an upsampled spectrum takes a sigmoid or a table");
  }
  return UpsampledSpectrum(std::move(parts));
}

double UpsampledSpectrum::operator()(double lambda_nm) const noexcept {
  if (std::isnan(lambda_nm)) return lambda_nm;
  const double held = std::clamp(lambda_nm, parts_.first_nm, parts_.last_nm);
  if (!parts_.sigmoid) return parts_.table->at(held);
  const double white = parts_.table ? parts_.table->at(held) : 1.0;
  return sigmoid(*parts_.sigmoid, SigmoidFunctions::of(parts_.observer), held) * white *
         static_cast<double>(parts_.scale);
}

double UpsampledSpectrum::max_value() const noexcept {
  if (!parts_.sigmoid) return *std::max_element(parts_.table->values().begin(), parts_.table->values().end());
  double best = std::max((*this)(parts_.first_nm), (*this)(parts_.last_nm));
  if (!parts_.table && parts_.observer) {
    // It rises or falls between whole nanometres.
    for (double nm = std::ceil(parts_.first_nm); nm < parts_.last_nm; ++nm)
      best = std::max(best, (*this)(nm));
    return best;
  }
  if (!parts_.table) {
    // A sigmoid rises and falls with its quadratic: the other place for a maximum is the vertex.
    const std::array<float, 3>& c = *parts_.sigmoid;
    const double vertex = c[0] < 0 ? -0.5 * static_cast<double>(c[1]) / static_cast<double>(c[0]) : 0;
    return std::max(best, (*this)(c[0] < 0 ? 550 + 150 * vertex : parts_.first_nm));
  }
  constexpr double kStepsPerNm = 10;
  const auto steps = static_cast<std::size_t>((parts_.last_nm - parts_.first_nm) * kStepsPerNm);
  for (std::size_t i = 0; i <= steps; ++i) {
    best = std::max(best, (*this)(parts_.first_nm + static_cast<double>(i) / kStepsPerNm));
  }
  for (const double nm : parts_.table->wavelengths_nm()) best = std::max(best, (*this)(nm));
  return best;
}

double UpsampledSpectrum::integral(double first_nm, double last_nm) const noexcept {
  if (!(last_nm > first_nm)) return 0;
  if (!parts_.sigmoid) return parts_.table->integral(first_nm, last_nm);
  double sum = 0;
  if (first_nm < parts_.first_nm)
    sum += (std::min(last_nm, parts_.first_nm) - first_nm) * (*this)(parts_.first_nm);
  if (last_nm > parts_.last_nm)
    sum += (last_nm - std::max(first_nm, parts_.last_nm)) * (*this)(parts_.last_nm);
  const double from = std::max(first_nm, parts_.first_nm);
  const double to = std::min(last_nm, parts_.last_nm);
  if (!(to > from)) return sum;
  double at = from;
  const auto add_up_to = [&](double nm) {
    if (nm <= at || nm >= to) return;
    sum += quadrature::adaptive(*this, at, nm, 1e-10);
    at = nm;
  };
  // Piece by piece, each without a corner.
  std::size_t next = 0;
  const auto add_samples_up_to = [&](double nm) {
    if (!parts_.table) return;
    const std::span<const double> samples = parts_.table->wavelengths_nm();
    for (; next < samples.size() && samples[next] <= nm; ++next) add_up_to(samples[next]);
  };
  for (double nm = std::ceil(from); parts_.observer && nm < to; ++nm) {
    add_samples_up_to(nm);
    add_up_to(nm);
  }
  add_samples_up_to(to);
  return sum + quadrature::adaptive(*this, at, to, 1e-10);
}

std::string UpsampledSpectrum::to_text() const {
  return fmt::format("{} of RGB {} {} {} by {}, {} to {} nm", parts_.quantity, parts_.rgb[0], parts_.rgb[1],
                     parts_.rgb[2], parts_.method, parts_.first_nm, parts_.last_nm);
}

}  // namespace spectile
