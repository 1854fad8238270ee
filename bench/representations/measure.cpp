// Representations of light and materials side by side, in scenes of some bounces: time and error.
#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <spectile/color/rgb_space.hpp>

#include "bench/representations/lane_loops.hpp"
#include "bench/representations/representation.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// Adds one that multiplies coefficients, where making its coefficients went well.
Result<void> add(std::vector<Representation>& to, const PathScene& scene, std::string name,
                 std::string source, const Result<Products>& products) {
  if (!products) return products.error();
  SPECTILE_ASSIGN(auto made, multiplied(scene, std::move(name), std::move(source), *products));
  to.push_back(std::move(made));
  return {};
}

}  // namespace

Result<PathScene> path_scene(const MethodScene& scene) {
  PathScene out;
  out.scene = &scene;
  std::mt19937_64 random(scene.seed);
  out.paths.resize(kPaths);
  for (auto& path : out.paths) {
    for (std::size_t& at : path) at = random() % scene.reflectances->size();
  }
  SPECTILE_ASSIGN(const auto d65, reference_light("D65"));
  const Matrix3 to_rgb = inverse(rgb_to_xyz(kRec709, d65.white));
  for (const ReferenceReflectance& r : *scene.reflectances) {
    out.colors.push_back(times(to_rgb, reference_xyz(d65, {&r})));
  }
  return out;
}

double seen_at(const ReferenceLight& light, std::size_t sample) {
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k) out += light.weights[k][sample] / light.white[k];
  return out;
}

std::vector<std::size_t> materials_of_scene(const PathScene& scene) {
  constexpr std::size_t kMost = 48;
  const std::size_t count = scene.reflectances().size();
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < std::min(kMost, count); ++i) out.push_back(i * count / std::min(kMost, count));
  return out;
}

std::vector<std::vector<double>> spectra_of_scene(const PathScene& scene) {
  std::vector<std::vector<double>> out = {std::vector<double>(kGridSamples, 1.0)};
  const auto materials = materials_of_scene(scene);
  for (const std::size_t i : materials) {
    const std::vector<double>& values = scene.reflectances()[i].values;
    out.push_back(values);
    for (const std::size_t j : materials) {
      if (j > i) break;
      std::vector<double>& product = out.emplace_back(values);
      for (std::size_t s = 0; s < kGridSamples; ++s) product[s] *= scene.reflectances()[j].values[s];
    }
  }
  return out;
}

Result<std::vector<Representation>> representations_for(const PathScene& scene,
                                                        const std::function<bool()>& stop) {
  std::vector<Representation> out;
  const auto stopped = [&] { return stop && stop(); };
  SPECTILE_ASSIGN(const auto d65, reference_light("D65"));
  SPECTILE_TRY(add(out, scene, "RGB", "", rgb_products(scene, d65.white)));
  SPECTILE_TRY(
      add(out, scene, "sharpened RGB", "Ward and Eydelberg-Vileshin 2002", sharpened_products(scene)));
  std::vector<std::pair<std::string, Bands>> lists;
  for (const char* text : {"400:700:10", "400:700:5"}) {
    SPECTILE_ASSIGN(auto bands, Bands::parse(text));
    lists.emplace_back(fmt::format("{} even bands", bands.count()), bands);
  }
  for (const Bands& bands : scene.scene->planned) {
    lists.emplace_back(fmt::format("{} planned bands", bands.count()), bands);
  }
  for (const Bands& bands : scene.scene->planned_for_paths) {
    lists.emplace_back(fmt::format("{} planned bands, for 2 bounces", bands.count()), bands);
  }
  for (const auto& [name, bands] : lists)
    SPECTILE_TRY(add(out, scene, name, "", band_products(scene, bands)));
  for (const std::size_t count : {16, 32}) {
    const auto leaves = tree_leaves(scene, count);
    SPECTILE_TRY(add(out, scene, fmt::format("{} leaves of a tree", leaves.size()),
                     "Rougeron and Peroche 1997", tree_products(scene, leaves)));
  }
  for (const std::size_t count : {16, 32}) {
    SPECTILE_TRY(add(out, scene, fmt::format("{} intervals and spikes", count), "Sun et al. 2001",
                     composite_products(scene, count)));
  }
  if (stopped()) return out;
  SPECTILE_ASSIGN(auto cubic, polynomials(scene));
  out.push_back(std::move(cubic));
  const LinearBasis vectors = characteristic_basis(scene, kBasisSizes[std::size(kBasisSizes) - 1]);
  for (const std::size_t functions : kBasisSizes) {
    SPECTILE_ASSIGN(auto basis, linear_basis(scene, vectors, functions));
    out.push_back(std::move(basis));
  }
  if (stopped()) return out;
  struct Drawn {
    Drawing drawing;
    std::size_t wavelengths, samples;
  };
  constexpr Drawn kDrawn[] = {{Drawing::kStratified, 16, 1},
                              {Drawing::kStratified, 16, 16},
                              {Drawing::kHero, 4, 4},
                              {Drawing::kHero, 4, 64}};
  for (const Drawn& d : kDrawn) {
    SPECTILE_ASSIGN(auto drawn, drawn_wavelengths(scene, d.drawing, d.wavelengths, d.samples));
    out.push_back(std::move(drawn));
  }

  // A renderer that is given RGB has spectra made of it.
  struct Made {
    const char* name;
    const char* source;
    Upsampling upsampling;
  };
  constexpr Made kMade[] = {{"RGB to sigmoids, 60 bands", "Jakob and Hanika 2019", Upsampling::kSigmoid},
                            {"RGB to tetrahedral, 60 bands", "", Upsampling::kTetrahedral},
                            {"RGB to moments, 60 bands", "Peters et al. 2019", Upsampling::kMoments},
                            {"RGB to smoothest, 60 bands", "Meng et al. 2015", Upsampling::kMeng},
                            {"RGB to least slope, 60 bands", "Burns 2020", Upsampling::kBurns}};
  for (const Made& m : kMade) {
    if (stopped()) return out;
    SPECTILE_TRY(add(out, scene, m.name, m.source, upsampled_products(scene, m.upsampling)));
  }
  return out;
}

Result<std::vector<RepresentationSpeed>> measure_representations(const MethodScene& of,
                                                                 const TimingBudget& timing) {
  SPECTILE_ASSIGN(const auto scene, path_scene(of));
  SPECTILE_ASSIGN(const auto made, representations_for(scene, timing.stop));
  std::vector<Timed> timed;
  for (const Representation& r : made) {
    for (std::size_t bounces = 1; bounces <= kMaxBounces; ++bounces) {
      timed.emplace_back().run = [&r, bounces] { r.run(bounces); };
    }
  }
  std::vector<Timed*> work;
  work.reserve(timed.size());
  for (Timed& t : timed) work.push_back(&t);
  time_in_turn(work, timing);
  std::vector<RepresentationSpeed> out;
  for (std::size_t i = 0; i < made.size(); ++i) {
    for (std::size_t bounces = 1; bounces <= kMaxBounces; ++bounces) {
      const auto colors = made[i].colors(bounces);
      ErrorList errors(scene.light().white);
      for (std::size_t p = 0; p < kPaths; ++p) {
        std::vector<const ReferenceReflectance*> along;
        for (std::size_t b = 0; b < bounces; ++b) along.push_back(&scene.reflectances()[scene.paths[p][b]]);
        errors.add(reference_xyz(scene.light(), along), colors[p]);
      }
      const Timed& t = timed[i * kMaxBounces + bounces - 1];
      RepresentationSpeed& speed = out.emplace_back();
      speed.light = scene.light().name;
      speed.line_spectrum = scene.light().line_spectrum;
      speed.name = made[i].name;
      speed.source = made[i].source;
      speed.coefficients = static_cast<int>(made[i].coefficients);
      speed.bounces = static_cast<int>(bounces);
      speed.nanoseconds = 1e9 * t.seconds / static_cast<double>(kPaths) * made[i].samples;
      speed.spread = t.spread;
      speed.error = errors.summary();
    }
  }
  return out;
}

}  // namespace spectile::measure
