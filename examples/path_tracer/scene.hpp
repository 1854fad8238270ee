// Scenes: surfaces with materials and textures, two lamps, a camera.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "geometry.hpp"

namespace tracer {

enum class Material { kDiffuse, kConductor, kGlass };
enum class Pattern { kPlain, kChecker, kBricks, kChart, kPlanks };

using Rgb = std::array<float, 3>;  ///< linear sRGB

struct Surface {
  std::variant<Rectangle, Sphere> shape;
  Material material = Material::kDiffuse;
  Pattern pattern = Pattern::kPlain;
  Rgb first = {0.7F, 0.7F, 0.7F};
  Rgb second = {};
  double repeats = 8;  ///< of the pattern along u
  int lamp = -1;       ///< index of the lamp whose light it gives off at its front; none below 0
};

/// A spectrum by its name in the library, scaled to a luminance Y, relative to radiance 1 at every
/// wavelength.
struct Lamp {
  std::string spectrum = "constant:1";
  double luminance = 0;
};

struct Camera {
  Vec3 eye;
  Vec3 forward, right, up;  ///< the latter two as long as half the picture at distance 1
};

struct Scene {
  std::vector<Surface> surfaces;
  std::array<Lamp, 2> lamps;
  std::string metal_eta = "Cu-eta", metal_k = "Cu-k", glass_eta = "SF10-eta";  ///< names in the library
  Camera camera;
  double environment = 0;  ///< times the first lamp's radiance, from beyond all surfaces
};

/// A hit and the normal on the side that the ray comes from.
struct Hit {
  const Surface* surface = nullptr;  ///< null for none
  double t = kFar, u = 0, v = 0;
  Vec3 point, normal;
  bool front = true;
};

Hit trace(const Scene& scene, const Ray& ray);
bool blocked(const Scene& scene, const Ray& ray, double far);

/// Linear sRGB of a surface at u, v, which the atlas is painted with.
Rgb albedo(const Surface& surface, double u, double v);

/// The box of the picture: two lamps, a copper and a glass sphere, textured walls.
Scene box_scene();
/// A closed box whose walls all have one albedo and give off radiance 1.
Scene furnace_scene(Rgb albedo);
/// A sphere of any material before an environment of one spectrum.
Scene sphere_scene(Material material, const Lamp& environment);

}  // namespace tracer
