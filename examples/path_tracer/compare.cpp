// The table of errors against time, and the shares of time.
#include "compare.hpp"

#include <algorithm>
#include <cstdio>

namespace tracer {
namespace {

constexpr std::uint32_t kSampleCounts[] = {16, 128, 1024};

Result<ColorError> error_of(const Film& film, const ColorLanes& reference,
                            const std::array<double, 3>& white) {
  SPECTILE_ASSIGN(const auto xyz, xyz_of(film));
  SPECTILE_ASSIGN(auto difference, ScalarLanes::create(xyz.lanes()));
  SPECTILE_TRY(ciede2000(reference, xyz, white, difference, kOneThread));
  const auto values = difference.view().values();
  return summarize({values.begin(), values.end()});
}

/// The reference's film, of two halves, whose difference tells its noise.
Result<Film> render_reference(const Scene& scene, RenderSettings settings,
                              const std::array<double, 3>& white) {
  SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, Representation::kReference));
  settings.samples = std::max(1U, settings.samples / 2);
  settings.seed = 1;  // its noise must not be that of what is compared
  SPECTILE_ASSIGN(auto first, render(scene, spectra, settings));
  print_stats(Representation::kReference, first, settings);
  settings.first_sample = settings.samples;
  SPECTILE_ASSIGN(const auto second, render(scene, spectra, settings));
  SPECTILE_ASSIGN(const auto second_xyz, xyz_of(second.film));
  SPECTILE_ASSIGN(const auto halves, error_of(first.film, second_xyz, white));
  std::printf("mean CIEDE2000 between the reference's halves: %.2f, about twice that of its own noise\n",
              halves.mean);
  SPECTILE_TRY(first.film.merge(second.film));
  return std::move(first.film);
}

Result<void> compare_in(const Scene& scene, const RenderSettings& settings) {
  // A white wall in the middle of the box has about the lamps' mean white.
  SPECTILE_ASSIGN(auto white, white_of(scene.lamps[0]));
  SPECTILE_ASSIGN(const auto second, white_of(scene.lamps[1]));
  for (std::size_t c = 0; c < 3; ++c) white[c] = 0.5 * (white[c] + second[c]);
  SPECTILE_ASSIGN(const auto reference, render_reference(scene, settings, white));
  SPECTILE_ASSIGN(const auto xyz, xyz_of(reference));
  std::printf("%-10s %8s %8s %8s %8s %8s\n", "", "samples", "seconds", "engine", "mean", "95 %");
  for (const auto representation :
       {Representation::kUniform, Representation::kVisible, Representation::kLight, Representation::kEven,
        Representation::kPlanned}) {
    SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, representation));
    RenderSettings s = settings;
    s.samples = 1;  // which read the texture's file, so that no time below has that
    SPECTILE_TRY(render(scene, spectra, s));
    for (const std::uint32_t samples : kSampleCounts) {
      s.samples = samples;
      SPECTILE_ASSIGN(const auto rendered, render(scene, spectra, s));
      SPECTILE_ASSIGN(const auto error, error_of(rendered.film, xyz, white));
      std::printf("%-10s %8u %8.2f %6.1f %% %8.2f %8.2f\n", std::string(to_string(representation)).c_str(),
                  samples, rendered.seconds, 100 * rendered.times.engine / rendered.times.all, error.mean,
                  error.percentile95);
    }
  }
  return {};
}

}  // namespace

void print_stats(Representation representation, const Rendered& rendered, const RenderSettings& settings) {
  const double paths = static_cast<double>(settings.size) * settings.size * settings.samples;
  const Times& t = rendered.times;
  std::printf("%s: %.2f s of the processor, %.0f ns a path; engine %.1f %% of the time, its film %.1f %%\n",
              std::string(to_string(representation)).c_str(), rendered.seconds,
              1e9 * rendered.seconds / paths, 100 * t.engine / t.all, 100 * t.film / t.all);
  const TextureCacheStats& c = rendered.cache;
  std::printf("textures: texels %.4g found, %.4g missed; %zu bytes\n", static_cast<double>(c.hits),
              static_cast<double>(c.misses), c.bytes);
}

Result<bool> compare_representations(const RenderSettings& settings) {
  Scene scene = box_scene();
  std::printf("The box\n");
  SPECTILE_TRY(compare_in(scene, settings));
  std::erase_if(scene.surfaces, [](const Surface& s) { return s.material == Material::kGlass; });
  std::printf("\nWithout the glass\n");
  SPECTILE_TRY(compare_in(scene, settings));
  return true;
}

}  // namespace tracer
