// The table of errors against time, and the shares of time.
#include "compare.hpp"

#include <cstdio>

namespace tracer {
namespace {

constexpr std::uint32_t kSampleCounts[] = {16, 64, 256};
/// The reference's own noise must not be that of what is compared.
constexpr std::uint32_t kReferenceSeed = 1;

/// The lamps' mean white at Y = 1, which a white wall in the middle of the box has about.
Result<std::array<double, 3>> white_of(const Scene& scene) {
  SPECTILE_ASSIGN(const auto sensor, Sensor::named("cie1931"));
  std::array<double, 3> white{};
  for (const Lamp& lamp : scene.lamps) {
    SPECTILE_ASSIGN(const auto spectrum, named_spectrum(lamp.spectrum));
    const auto xyz = sensor.response(spectrum);
    for (std::size_t c = 0; c < 3; ++c) white[c] += 0.5 * xyz[c] / xyz[1];
  }
  return white;
}

Result<ColorError> error_of(const Film& film, const ColorLanes& reference,
                            const std::array<double, 3>& white) {
  SPECTILE_ASSIGN(const auto xyz, xyz_of(film));
  SPECTILE_ASSIGN(auto difference, ScalarLanes::create(xyz.lanes()));
  SPECTILE_TRY(ciede2000(reference, xyz, white, difference, kOneThread));
  const auto values = difference.view().values();
  return summarize({values.begin(), values.end()});
}

}  // namespace

void print_stats(Representation representation, const Rendered& rendered, const RenderSettings& settings) {
  const double paths = static_cast<double>(settings.size) * settings.size * settings.samples;
  const Times& t = rendered.times;
  std::printf(
      "%s: %.2f s, %.0f ns a path and thread; engine %.1f %% of the time, of which the film %.1f %%\n",
      std::string(to_string(representation)).c_str(), rendered.wall, 1e9 * t.all / paths,
      100 * t.engine / t.all, 100 * t.film / t.all);
}

Result<bool> compare_representations(const RenderSettings& settings) {
  const Scene scene = box_scene();
  SPECTILE_ASSIGN(const auto white, white_of(scene));
  RenderSettings s = settings;
  s.seed = kReferenceSeed;
  SPECTILE_ASSIGN(const auto fine, SpectralScene::create(scene, Representation::kReference));
  SPECTILE_ASSIGN(const auto reference, render(scene, fine, s));
  print_stats(Representation::kReference, reference, s);
  SPECTILE_ASSIGN(const auto xyz, xyz_of(reference.film));
  std::printf("%-10s %8s %8s %8s %8s %8s %8s\n", "", "samples", "seconds", "engine", "mean", "95 %",
              "maximum");
  for (const auto representation :
       {Representation::kUniform, Representation::kVisible, Representation::kLight, Representation::kEven,
        Representation::kPlanned}) {
    SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, representation));
    for (const std::uint32_t samples : kSampleCounts) {
      s = settings;
      s.samples = samples;
      SPECTILE_ASSIGN(const auto rendered, render(scene, spectra, s));
      SPECTILE_ASSIGN(const auto error, error_of(rendered.film, xyz, white));
      std::printf("%-10s %8u %8.2f %6.1f %% %8.2f %8.2f %8.2f\n",
                  std::string(to_string(representation)).c_str(), samples, rendered.wall,
                  100 * rendered.times.engine / rendered.times.all, error.mean, error.percentile95,
                  error.maximum);
    }
  }
  return true;
}

}  // namespace tracer
