// Intersection with a scene's surfaces, procedural textures, and the scenes themselves.
#include "scene.hpp"

#include <algorithm>
#include <cmath>

namespace tracer {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Surface wall(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Pattern pattern, Rgb first, Rgb second, double repeats) {
  return {Rectangle{corner, edge_u, edge_v}, Material::kDiffuse, pattern, first, second, repeats, -1};
}

Surface panel(Vec3 corner, Vec3 edge_u, Vec3 edge_v, int lamp) {
  return {Rectangle{corner, edge_u, edge_v}, Material::kDiffuse, Pattern::kPlain, {}, {}, 1, lamp};
}

std::int64_t cell(double x) {
  return static_cast<std::int64_t>(std::floor(x));
}

/// A colour of a chart: hues along u, lighter along v, the two lowest rows less saturated.
Rgb patch(double turn, int row) {
  constexpr double kLight[] = {0.10, 0.20, 0.32, 0.48, 0.60, 0.70};
  constexpr double kChroma[] = {0.90, 0.95, 0.95, 0.92, 0.80, 0.60};
  const auto channel = [&](double primary) {
    const double share = 0.5 - 0.5 * std::cos(kTurn * (turn - primary));
    return static_cast<float>(kLight[row] * (1 - kChroma[row] * share));
  };
  return {channel(0), channel(1.0 / 3), channel(2.0 / 3)};
}

Rgb chart(const Surface& s, double u, double v) {
  const double x = std::min(u, 0.999999) * s.repeats;
  const double y = std::min(v, 0.999999) * 6;
  if (std::max(std::abs(x - std::floor(x) - 0.5), std::abs(y - std::floor(y) - 0.5)) > 0.4) return s.first;
  return patch(std::floor(x) / s.repeats, static_cast<int>(y));
}

Rgb bricks(const Surface& s, double u, double v) {
  const double y = v * s.repeats * 2;
  const double x = u * s.repeats + (cell(y) % 2 != 0 ? 0.5 : 0.0);
  const double fx = x - std::floor(x);
  const double fy = y - std::floor(y);
  if (fx < 0.05 || fy < 0.1) return s.second;
  const float shade = 0.8F + 0.2F * static_cast<float>((cell(x) * 7 + cell(y) * 13) % 5) / 4;
  return {s.first[0] * shade, s.first[1] * shade, s.first[2] * shade};
}

}  // namespace

Hit trace(const Scene& scene, const Ray& ray) {
  Hit hit;
  for (const Surface& surface : scene.surfaces) {
    const auto d = std::visit([&](const auto& shape) { return shape.intersect(ray, hit.t); }, surface.shape);
    if (d) hit = {&surface, d->t, d->u, d->v, {}, {}, true};
  }
  if (hit.surface == nullptr) return hit;
  hit.point = ray.origin + hit.t * ray.direction;
  const auto* const rectangle = std::get_if<Rectangle>(&hit.surface->shape);
  hit.normal = rectangle != nullptr ? rectangle->normal()
                                    : normalized(hit.point - std::get<Sphere>(hit.surface->shape).centre);
  hit.front = dot(hit.normal, ray.direction) < 0;
  if (!hit.front) hit.normal = -1.0 * hit.normal;
  return hit;
}

bool blocked(const Scene& scene, const Ray& ray, double far) {
  return std::ranges::any_of(scene.surfaces, [&](const Surface& surface) {
    return std::visit([&](const auto& shape) { return shape.intersect(ray, far).has_value(); },
                      surface.shape);
  });
}

Rgb albedo(const Surface& surface, double u, double v) {
  const double x = u * surface.repeats;
  switch (surface.pattern) {
    case Pattern::kPlain:
      break;
    case Pattern::kChecker:
      return (cell(x) + cell(v * surface.repeats)) % 2 != 0 ? surface.second : surface.first;
    case Pattern::kBricks:
      return bricks(surface, u, v);
    case Pattern::kChart:
      return chart(surface, u, v);
    case Pattern::kPlanks:
      return x - std::floor(x) < 0.5 ? surface.first : surface.second;
  }
  return surface.first;
}

Scene box_scene() {
  Scene scene;
  scene.lamps = {Lamp{"FL11", 36}, Lamp{"A", 28}};
  // Floor, ceiling, back, left, right.
  scene.surfaces = {
      wall({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, Pattern::kChecker, {0.52F, 0.52F, 0.52F}, {0.36F, 0.36F, 0.36F},
           8),
      wall({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, Pattern::kPlain, {0.70F, 0.70F, 0.70F}, {}, 1),
      wall({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, Pattern::kChart, {0.70F, 0.70F, 0.70F}, {}, 8),
      wall({-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, Pattern::kBricks, {0.62F, 0.16F, 0.09F}, {0.62F, 0.60F, 0.56F},
           6),
      wall({1, 0, -1}, {0, 0, 2}, {0, 2, 0}, Pattern::kPlanks, {0.06F, 0.30F, 0.26F}, {0.20F, 0.48F, 0.42F},
           8),
      panel({-0.62, 1.999, -0.55}, {0.14, 0, 0}, {0, 0, 1.1}, 0),
      panel({0.45, 1.999, -0.2}, {0.34, 0, 0}, {0, 0, 0.34}, 1),
      {Sphere{{-0.48, 0.42, -0.30}, 0.42}, Material::kConductor, Pattern::kPlain, {}, {}, 1, -1},
      {Sphere{{0.32, 0.66, 0.12}, 0.38}, Material::kGlass, Pattern::kPlain, {}, {}, 1, -1},
  };
  scene.camera = {{0, 1, 3.75}, {0, 0, -1}, {0.36, 0, 0}, {0, 0.36, 0}};
  return scene;
}

Scene furnace_scene(Rgb albedo) {
  Scene scene = box_scene();
  scene.surfaces.erase(scene.surfaces.begin() + 5, scene.surfaces.end());
  scene.surfaces.push_back(wall({-1, 0, 1}, {0, 2, 0}, {2, 0, 0}, Pattern::kPlain, albedo, {}, 1));
  for (Surface& s : scene.surfaces) {
    s.pattern = Pattern::kPlain;
    s.first = albedo;
    s.lamp = 0;
  }
  // Unseen, of other colours: neighbours in the atlas, so that a wrong texel shows.
  const Surface other = wall({9, 9, 9}, {1, 0, 0}, {0, 1, 0}, Pattern::kPlain, {0.9F, 0.1F, 0.9F}, {}, 1);
  for (std::size_t i = scene.surfaces.size(); i > 0; --i)
    scene.surfaces.insert(scene.surfaces.begin() + static_cast<std::ptrdiff_t>(i), other);
  scene.lamps = {Lamp{"constant:1", 1}, Lamp{"constant:1", 1}};
  scene.camera = {{0, 1, 0.9}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  return scene;
}

Scene sphere_scene(Material material, const Lamp& environment) {
  Scene scene;
  scene.lamps = {environment, environment};
  scene.surfaces = {{Sphere{{0, 0, 0}, 1}, material, Pattern::kPlain, {1, 1, 1}, {}, 1, -1}};
  scene.camera = {{0, 0, 4}, {0, 0, -1}, {0.3, 0, 0}, {0, 0.3, 0}};
  scene.environment = 1;
  return scene;
}

}  // namespace tracer
