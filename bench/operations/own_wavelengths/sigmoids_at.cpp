// Sigmoids at single wavelengths: of one spectrum, of lanes' own coefficients, of the texels of a texture.
#include <algorithm>
#include <cmath>

#include "bench/operations/own_wavelengths/textures.hpp"
#include "bench/operations/sigmoid_oracle.hpp"
#include "kernels/sigmoid_constants.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile::measure {
namespace {

/// A sample at a wavelength, held within the range of kSigmoidAtWavelengths.
double error_at_wavelength(const double* c, double lambda, double sample) {
  if (std::isnan(lambda)) return std::isnan(sample) ? 0.0 : kBeyond;
  const double held = std::clamp(lambda, static_cast<double>(kSigmoidAtWavelengths.lowest_nm),
                                 static_cast<double>(kSigmoidAtWavelengths.highest_nm));
  const double l = sigmoid_lambda(held);
  const SigmoidPlace at = {l * l, l};
  // Lambda is rounded twice, which the polynomial's slope passes on.
  const double slope = std::abs(2 * c[0] * l + c[1]);
  return std::abs(sample - sigmoid(c, at)) / (allowed_at(c, at) + 0x1p-24 * slope * std::abs(l));
}

/// One spectrum at many wavelengths.
void add_at_wavelengths(std::vector<Operation>& to) {
  Operation& op = add_operation(to, "wavelengths", "sigmoid at wavelengths", "wavelength", {});
  // Held between the ends (4), lambda, NaN (2).
  op.operations = kSigmoidBand + 4 + 1 + 2;
  op.divisions = 1;
  op.unit = "stated bound";
  op.bound = 1;
  op.bottleneck = "one chain of sixteen dependent operations after a division";
  op.fill = uniform_values(1, 360.0F, 830.0F);
  op.run = [](const KernelTable& k, const Arrays& a) {
    k.sigmoid_at(a.out(), a.in(), kSigmoidAtWavelengths, a.n());
  };
  op.error = [](const double* v, const double* out, double /*tiny*/) {
    double c[3];
    for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<double>(kSigmoidAtWavelengths.c[k]);
    return error_at_wavelength(c, v[0], out[0]);
  };
}

/// The same of lanes' own coefficients at their own wavelengths.
void add_at_own_wavelengths(std::vector<Operation>& to) {
  Operation& op = add_own_wavelengths(
      to, "coefficients at 4 wavelengths, sigmoid", "colour",
      [](const KernelTable& k, const float* const c[3], const float* lambda_nm, float* samples) {
        const auto& s = kSigmoidAtWavelengths;
        k.sigmoids_at(samples, {c, nullptr, s.lowest_nm, s.highest_nm, s.form, s.p, s.q}, lambda_nm,
                      kWavelengths, 1);
      });
  op.operations = kWavelengths * (kSigmoidBand + 4 + 1 + 2);
  op.divisions = kWavelengths;
  op.unit = "stated bound";
  op.bound = 1;
  op.bottleneck = "chains of sixteen dependent operations after a division";
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < 3; ++k) v[k] = uniform(random, -3.0F, 3.0F);
    for (std::size_t k = 0; k < kWavelengths; ++k) v[3 + k] = uniform(random, 360.0F, 830.0F);
  };
  op.error = [](const double* v, const double* out, double /*tiny*/) {
    if (!has_bound(v)) return kOutOfDomain;
    double worst = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k)
      worst = std::max(worst, error_at_wavelength(v, v[3 + k], out[k]));
    return worst;
  };
}

/// The same of the texels of a texture, coefficients of the upsampler's sigmoid.
Result<void> add_texture_of_sigmoids(std::vector<Operation>& to,
                                     const std::shared_ptr<const Upsampler>& upsampler) {
  TextureCost cost;
  cost.low = -3;
  cost.high = 3;
  cost.operations = kPlaces + 4 * kWavelengths * (kSigmoidBand + 4 + 1 + 2 + 2);
  cost.divisions = 4 * kWavelengths;
  cost.bottleneck = "four texels a lane, copied one by one";
  cost.unit = "stated bound";
  cost.bound = 1;
  const Bands& bands = upsampler->bands();
  cost.sample = [first = bands[0].centre_nm, last = bands[bands.count() - 1].centre_nm](
                    const float* texel, double lambda) -> SampleAndScale {
    const double c[3] = {static_cast<double>(texel[0]), static_cast<double>(texel[1]),
                         static_cast<double>(texel[2])};
    const double l = sigmoid_lambda(std::clamp(lambda, first, last));
    const SigmoidPlace at = {l * l, l};
    const double slope = std::abs(2 * c[0] * l + c[1]);
    // Weights and sums of the filter: ten roundings.
    return {sigmoid(c, at), allowed_at(c, at) / 0x1p-24 + slope * std::abs(l) + 10};
  };
  return add_texture(to, upsampler, cost);
}

}  // namespace

Result<void> add_sigmoids_at_wavelengths(std::vector<Operation>& to,
                                         const std::shared_ptr<const Upsampler>& upsampler) {
  add_at_wavelengths(to);
  add_at_own_wavelengths(to);
  return add_texture_of_sigmoids(to, upsampler);
}

}  // namespace spectile::measure
