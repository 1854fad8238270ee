// A disk lamp over a table: its spectral irradiance, its illuminance, and the colours of cards that lie
// there.
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <spectile/radiometry/irradiance.hpp>
#include <spectile/radiometry/radiometry.hpp>
#include <spectile/spectile.hpp>
#include <vector>

namespace {

using namespace spectile;

constexpr double kTemperatureK = 3000;
constexpr double kRadiusM = 0.005;
constexpr double kHeightM = 1;

int failures = 0;

void check(const char* what, double got, double want, double tolerance) {
  const bool good = std::abs(got - want) <= tolerance * std::abs(want);
  std::printf("  %-34s %.8g, expected %.8g: %s\n", what, got, want, good ? "ok" : "WRONG");
  failures += good ? 0 : 1;
}

/// How much of the lamp the table sees: in closed form and by two quadratures.
Result<SolidAngle> lamp_from_table() {
  const DiskEmitter lamp = {.centre_m = {0, 0, kHeightM}, .normal = {0, 0, -1}, .radius_m = kRadiusM};
  const Receiver table = {.position_m = {0, 0, 0}, .normal = {0, 0, 1}};
  auto exact = projected_solid_angle(lamp, table);
  const auto over_area = projected_solid_angle_by_area(lamp, table, 10'000);
  const auto over_directions = projected_solid_angle_by_directions(lamp, table, 250'000);
  if (!exact) return exact.error();
  if (!over_area) return over_area.error();
  if (!over_directions) return over_directions.error();
  const double r2 = kRadiusM * kRadiusM;
  check("pi r^2 / (r^2 + h^2), sr", exact->value(), std::numbers::pi * r2 / (r2 + kHeightM * kHeightM),
        1e-12);
  check("over the lamp's area, sr", over_area->value(), exact->value(), 1e-6);
  check("over directions, sr", over_directions->value(), exact->value(), 1e-3);
  return exact;
}

/// Cards of four reflectances under the lamp: illuminance in, colours out. One lane is one card.
Result<void> show_cards(const Spectrum& radiance, SolidAngle lamp) {
  constexpr std::array<std::array<float, 3>, 4> kCards = {
      {{1.0F, 1.0F, 1.0F}, {0.18F, 0.18F, 0.18F}, {0.7F, 0.15F, 0.1F}, {0.1F, 0.2F, 0.6F}}};
  const auto bands = Bands::uniform(380, 780, 5);
  if (!bands) return bands.error();
  const auto upsampler = Upsampler::create(Method::kSigmoid, Quantity::kReflectance, *bands);
  if (!upsampler) return upsampler.error();
  auto rgb = ColorLanes::create(kCards.size());
  auto cards = SampledSpectra::create(*bands, kCards.size());
  auto leaving = SampledSpectra::create(*bands, kCards.size());
  auto xyz = ColorLanes::create(kCards.size());
  if (!rgb || !cards || !leaving || !xyz) return Error{ErrorCode::kOutOfMemory, "no memory for four cards"};
  for (std::size_t card = 0; card < kCards.size(); ++card) {
    for (std::size_t k = 0; k < 3; ++k) rgb->at(card, k) = kCards[card][k];
  }
  if (auto done = upsample_srgb(*upsampler, rgb->view(), cards->span()); !done) return done;

  // Radiance that leaves a matt card: reflectance times irradiance over pi. The irradiance is the same for
  // all.
  std::vector<float> irradiance = radiance.average_over(*bands);
  for (float& sample : irradiance) sample *= static_cast<float>(lamp.value() / std::numbers::pi);
  const auto light = SampledSpectra::broadcast(*bands, kCards.size(), irradiance);
  if (!light) return light.error();
  if (auto done = multiply(cards->view(), light->view(), leaving->span()); !done) return done;
  const auto projector = Projector::emissive(*bands);
  if (!projector) return projector.error();
  if (auto done = project(*projector, leaving->view(), xyz->span()); !done) return done;

  // The projector's Y is 1 where every band holds 1 W/(m^2 sr nm): that has this luminance.
  const double unit = luminance(ConstantSpectrum(1)).value();
  const Illuminance arriving = luminance(radiance) * lamp;
  std::printf("\n  card (sRGB)         cd/m^2      x       y\n");
  for (std::size_t card = 0; card < kCards.size(); ++card) {
    const double x = xyz->at(card, 0);
    const double y = xyz->at(card, 1);
    const double sum = x + y + xyz->at(card, 2);
    const auto& c = kCards[card];
    std::printf("  %.2f %.2f %.2f  %10.3f  %.4f  %.4f\n", static_cast<double>(c[0]),
                static_cast<double>(c[1]), static_cast<double>(c[2]), unit * y, x / sum, y / sum);
  }
  std::printf("\n");
  check("white card, cd/m^2", unit * xyz->at(0, 1), arriving.value() / std::numbers::pi, 1e-4);
  check("grey over white", xyz->at(1, 1) / xyz->at(0, 1), 0.18, 1e-4);
  // Chromaticity of the black body itself; the observer's table by 1 nm, the bands from 380 to 780 nm.
  check("white card's x at 3000 K", xyz->at(0, 0) / (xyz->at(0, 0) + xyz->at(0, 1) + xyz->at(0, 2)), 0.4369,
        5e-4);
  return {};
}

}  // namespace

int main() {
  const auto lamp = BlackbodySpectrum::create(kTemperatureK);
  if (!lamp) return 1;
  std::printf("A black body disk of %g K, radius %g m, %g m above a table\n\n", kTemperatureK, kRadiusM,
              kHeightM);
  const auto seen = lamp_from_table();
  if (!seen) {
    std::puts(seen.error().message.c_str());
    return 1;
  }
  std::printf("\n  wavelength   spectral irradiance\n");
  for (const double nm : {400.0, 500.0, 600.0, 700.0}) {
    const SpectralIrradiance irradiance = SpectralRadiance((*lamp)(nm)) * *seen;
    std::printf("  %6g nm    %s\n", nm, to_text(irradiance).c_str());
  }
  const Irradiance all = blackbody_radiance(kTemperatureK) * *seen;
  const Illuminance lux = luminance(*lamp) * *seen;
  std::printf("\n  all wavelengths %s, illuminance %s\n", to_text(all).c_str(), to_text(lux).c_str());
  if (const auto done = show_cards(*lamp, *seen); !done) {
    std::puts(done.error().message.c_str());
    return 1;
  }
  const auto efficacy = luminous_efficacy(*lamp);
  if (!efficacy) return 1;
  check("lux from W/m^2 times lm/W", (all * *efficacy).value(), lux.value(), 1e-9);
  return failures == 0 ? 0 : 1;
}
