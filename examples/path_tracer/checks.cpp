// Checks with known answers: furnaces, energy, equal bits, the rate of convergence, noise of colour.
#include "checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tracer {
namespace {

/// Rounding of a path's two dozen bounces in float.
constexpr double kFloatTolerance = 1e-5;

bool report(const char* subject, double value, const char* relation, double bound, bool good) {
  std::printf("  %-52s %.7g, %s %.7g: %s\n", subject, value, relation, bound, good ? "ok" : "WRONG");
  return good;
}
bool below(const char* subject, double value, double bound) {
  return report(subject, value, "at most", bound, value <= bound);
}

/// Renders and develops the spectrum of each pixel in bands.
Result<FilmDevelopment> spectral_picture(const Scene& scene, Representation representation,
                                         RenderSettings settings, const Bands& bands) {
  SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, representation));
  settings.kept = bands;
  SPECTILE_ASSIGN(const auto rendered, render(scene, spectra, settings));
  SPECTILE_ASSIGN(auto layer, FilmDevelopment::create(rendered.film, FilmLayer::kSpectrum));
  SPECTILE_TRY(layer.update(kOneThread));
  return layer;
}

/// Mean radiance of each pixel over all wavelengths, each weighed by one over its density: 1 without noise
/// where every wavelength carries 1, which colours are not.
Result<std::vector<double>> mean_radiances(const Scene& scene, const RenderSettings& settings) {
  SPECTILE_ASSIGN(const auto all,
                  Bands::uniform(kFirstVisibleNm, kLastVisibleNm, kLastVisibleNm - kFirstVisibleNm));
  SPECTILE_ASSIGN(const auto layer, spectral_picture(scene, Representation::kVisible, settings, all));
  std::vector<double> out;
  for (int i = 0; i < layer.width() * layer.height(); ++i) {
    out.push_back(static_cast<double>(layer.at(0, i % layer.width(), i / layer.width())));
  }
  return out;
}

double largest_deviation(const std::vector<double>& values, double expected) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v / expected - 1));
  return largest;
}

RenderSettings furnace_settings(std::uint32_t depth) {
  return {.size = 16,
          .samples = 16,
          .max_depth = depth,
          .roulette_from = RenderSettings::kNever,
          .next_event = false};
}

/// Light off `depth` surfaces of a closed furnace: the sum of rho^i below the depth, the limit of which is
/// 1 / (1 - rho). A path's direction does not change its radiance, so that there is no noise.
double furnace_radiance(double rho, std::uint32_t depth) {
  return (1 - std::pow(rho, depth)) / (1 - rho);
}

Result<bool> check_furnace() {
  constexpr std::uint32_t kDepth = 20;
  const RenderSettings settings = furnace_settings(kDepth);
  bool good = true;
  for (const float rho : {0.2F, 0.5F, 0.8F}) {
    SPECTILE_ASSIGN(const auto values, mean_radiances(furnace_scene({rho, rho, rho}), settings));
    const double expected = furnace_radiance(static_cast<double>(rho), kDepth);
    good &= below("grey furnace, largest relative deviation", largest_deviation(values, expected),
                  kFloatTolerance);
  }
  // A colour, band by band: the film keeps the spectrum.
  const Rgb color = {0.7F, 0.3F, 0.1F};
  const Bands bands;
  SPECTILE_ASSIGN(const auto layer,
                  spectral_picture(furnace_scene(color), Representation::kEven, settings, bands));
  SPECTILE_ASSIGN(const auto upsampler, Upsampler::create(kDefaultMethod, Quantity::kReflectance, bands));
  SPECTILE_ASSIGN(const auto rho,
                  rgb_spectrum(upsampler, {static_cast<double>(color[0]), static_cast<double>(color[1]),
                                           static_cast<double>(color[2])}));
  double largest = 0;
  for (std::size_t k = 0; k < bands.count(); ++k) {
    const double expected = furnace_radiance(rho(bands[k].centre_nm), kDepth);
    for (int i = 0; i < layer.width(); ++i) {
      largest = std::max(largest, std::abs(static_cast<double>(layer.at(k, i, i)) / expected - 1));
    }
  }
  return good & below("coloured furnace, largest relative deviation", largest, kFloatTolerance);
}

/// Mean Y, and the sum of the variances of X, Y and Z over pixels, each relative to its mean squared.
struct ColorNoise {
  double mean_y = 0, variance = 0;
};

Result<ColorNoise> color_noise(const Scene& scene, Representation representation,
                               const RenderSettings& settings) {
  SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, representation));
  SPECTILE_ASSIGN(const auto rendered, render(scene, spectra, settings));
  SPECTILE_ASSIGN(const auto xyz, xyz_of(rendered.film));
  const auto pixels = static_cast<double>(xyz.lanes());
  ColorNoise out;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < xyz.lanes(); ++i) {
      const auto value = static_cast<double>(xyz.at(i, c));
      sum += value;
      squares += value * value;
    }
    if (c == 1) out.mean_y = sum / pixels;
    out.variance += squares * pixels / (sum * sum) - 1;
  }
  return out;
}

Result<bool> check_energy() {
  // In uniform light an object that absorbs nothing vanishes. A metal without eta reflects all.
  RenderSettings settings = furnace_settings(400);
  Scene metal = sphere_scene(Material::kConductor, {"constant:1", 1});
  metal.metal_eta = "constant:0";
  metal.metal_k = "constant:3";
  bool good = true;
  for (const Scene& scene : {metal, sphere_scene(Material::kGlass, {"constant:1", 1}),
                             sphere_scene(Material::kDiffuse, {"constant:1", 1})}) {
    SPECTILE_ASSIGN(const auto values, mean_radiances(scene, settings));
    good &= below("white furnace, largest deviation from 1", largest_deviation(values, 1), kFloatTolerance);
  }
  // In the box under uniform light nothing is brighter than that.
  Scene box = box_scene();
  box.lamps = {Lamp{"constant:1", 1}, Lamp{"constant:1", 1}};
  box.environment = 1;
  settings.max_depth = RenderSettings().max_depth;
  SPECTILE_ASSIGN(const auto values, mean_radiances(box, settings));
  good &= below("box in uniform light, largest", *std::ranges::max_element(values), 1 + kFloatTolerance);
  // Lamps sampled or hit by chance give the same light. The lamps are large, or chance would rarely hit them.
  Scene lit = box_scene();
  std::erase_if(lit.surfaces, [](const Surface& s) { return s.material != Material::kDiffuse; });
  for (Surface& s : lit.surfaces) {
    if (s.lamp >= 0) s.shape = Rectangle({s.lamp == 0 ? -0.8 : 0.2, 1.9, -0.8}, {0.6, 0, 0}, {0, 0, 1.6});
  }
  lit.lamps[1].luminance *= 0.5;
  RenderSettings many = {.size = 32, .samples = 256};
  SPECTILE_ASSIGN(const auto sampled, color_noise(lit, Representation::kLight, many));
  many.next_event = false;
  SPECTILE_ASSIGN(const auto hit, color_noise(lit, Representation::kLight, many));
  return good & below("lamps sampled against hit, relative difference",
                      std::abs(sampled.mean_y / hit.mean_y - 1), 0.01);
}

Result<bool> check_bits() {
  const Scene scene = box_scene();
  SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, Representation::kLight));
  RenderSettings settings = {.size = 40, .samples = 16, .threads = 1, .batch = 64};
  SPECTILE_ASSIGN(const auto first, render(scene, spectra, settings));
  bool good = true;
  for (const std::size_t threads : {1U, 8U}) {
    for (const std::size_t batch : {64U, 192U, 1000U, 4096U}) {
      settings.threads = threads;
      settings.batch = batch;
      SPECTILE_ASSIGN(const auto other, render(scene, spectra, settings));
      const bool same = other.film.same_contents(first.film) && other.film.stats().rejected.total() == 0;
      std::printf("  %zu threads, batches of %zu: %s\n", threads, batch, same ? "the same bits" : "WRONG");
      good &= same;
    }
  }
  return good;
}

/// Sum over pixels and X, Y, Z of squared differences.
double squared_difference(const ColorLanes& a, const ColorLanes& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.lanes(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) sum += std::pow(static_cast<double>(a.at(i, c) - b.at(i, c)), 2);
  }
  return sum;
}

Result<bool> check_convergence() {
  const Scene scene = box_scene();
  SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, Representation::kLight));
  RenderSettings settings = {.size = 16, .samples = 4096, .seed = 1};
  settings.limit = 6;  // of all pictures, so that no few paths from matt to glass to lamp decide the slope
  SPECTILE_ASSIGN(const auto reference, render(scene, spectra, settings));
  SPECTILE_ASSIGN(const auto expected, xyz_of(reference.film));
  settings.seed = 0;
  // As many samples are spent on each count: several pictures, whose squared errors are averaged.
  constexpr std::uint32_t kSpent = 1024;
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (const std::uint32_t samples : {4U, 16U, 64U, 256U}) {
    settings.samples = samples;
    double squares = 0;
    for (settings.first_sample = 0; settings.first_sample < kSpent; settings.first_sample += samples) {
      SPECTILE_ASSIGN(const auto rendered, render(scene, spectra, settings));
      SPECTILE_ASSIGN(const auto xyz, xyz_of(rendered.film));
      squares += squared_difference(xyz, expected) * samples / kSpent;
    }
    const double rms = std::sqrt(squares / static_cast<double>(3 * expected.lanes()));
    std::printf("  %u samples: RMS error of XYZ %.5f\n", samples, rms);
    const double x = std::log(samples);
    const double y = std::log(rms);
    sx += x, sy += y, sxx += x * x, sxy += x * y, n += 1;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return report("slope", slope, "from -0.5 by at most", 0.05, std::abs(slope + 0.5) <= 0.05);
}

/// Of a sphere that fills the picture, in light of FL11 from everywhere: all noise is of wavelengths.
Result<ColorNoise> sphere_noise(Material material, Representation representation) {
  Scene scene = sphere_scene(material, {"FL11", 1});
  for (Vec3* axis : {&scene.camera.right, &scene.camera.up}) *axis = 0.5 * *axis;
  RenderSettings settings = furnace_settings(64);
  settings.size = 128;
  settings.samples = 1;
  return color_noise(scene, representation, settings);
}

Result<bool> check_variance() {
  SPECTILE_ASSIGN(const auto uniform, sphere_noise(Material::kDiffuse, Representation::kUniform));
  SPECTILE_ASSIGN(const auto light, sphere_noise(Material::kDiffuse, Representation::kLight));
  std::printf("  colour variance of white, uniform %.3f, of the light %.3f\n", uniform.variance,
              light.variance);
  bool good = below("light over uniform", light.variance / uniform.variance, 0.5);
  // Glass leaves one wavelength, or band: as much light, and more noise.
  SPECTILE_ASSIGN(const auto glass, sphere_noise(Material::kGlass, Representation::kLight));
  SPECTILE_ASSIGN(const auto banded, sphere_noise(Material::kGlass, Representation::kEven));
  good &= below("white over glass, colour variance", light.variance / glass.variance, 0.5);
  good &= below("glass, relative difference of Y", std::abs(glass.mean_y / light.mean_y - 1), 0.05);
  return good &
         below("glass on bands, relative difference of Y", std::abs(banded.mean_y / light.mean_y - 1), 0.05);
}

}  // namespace

Result<bool> run_check(std::string_view name) {
  if (name == "furnace") return check_furnace();
  if (name == "energy") return check_energy();
  if (name == "bits") return check_bits();
  if (name == "convergence") return check_convergence();
  if (name == "variance") return check_variance();
  return Error{ErrorCode::kUnknownName, "no check is called " + std::string(name) +
                                            "; there are furnace, energy, bits, convergence, variance"};
}

}  // namespace tracer
