// A bounce of the wavefront at its surfaces: directions, next-event estimation, metal and glass.
#include <algorithm>

#include "wavefront.hpp"

namespace tracer {

/// Lamps count where they are seen from the camera or by way of metal and glass only, and are sampled at each
/// matt surface: plain next-event estimation, without multiple importance sampling.
void Wavefront::trace_lane(std::size_t lane, std::uint32_t depth) {
  Path& path = paths_[lane];
  const Hit hit = trace(*scene_, path.ray);
  if (hit.surface == nullptr) {
    path.alive = false;
    if (!path.sees_light || scene_->environment <= 0) return;
    emitted_[lane] = static_cast<float>(scene_->environment);
    any_emitted_ = true;
    return;
  }
  if (hit.surface->lamp >= 0 && hit.front && path.sees_light) {
    emitted_[lane] = 1;
    lamp_[lane] = static_cast<float>(hit.surface->lamp);
    any_emitted_ = true;
  }
  if (hit.surface->material == Material::kDiffuse) return shade_diffuse(lane, hit, depth);
  (hit.surface->material == Material::kConductor ? metals_ : glasses_).push_back({lane, hit});
}

void Wavefront::shade_diffuse(std::size_t lane, const Hit& hit, std::uint32_t depth) {
  Path& path = paths_[lane];
  const auto surface = static_cast<std::size_t>(hit.surface - scene_->surfaces.data());
  const auto [u, v] = spectra_->atlas().point(surface, hit.u, hit.v);
  texture_u_[lane] = u;
  texture_v_[lane] = v;
  if (!lights_.empty()) sample_lamp(lane, hit, depth);
  // The cosine over pi in this density is that of the reflected light, so that the lane's density stays 1.
  const Vec3 d = cosine_direction(hit.normal, path.random(dimension(depth, kDirectionU)),
                                  path.random(dimension(depth, kDirectionV)));
  path.ray = {hit.point, d};
  path.sees_light = lights_.empty();
}

void Wavefront::sample_lamp(std::size_t lane, const Hit& hit, std::uint32_t depth) {
  const Random& random = paths_[lane].random;
  const double choice = random(dimension(depth, kLightChoice));
  const auto light = std::ranges::find_if(lights_, [&](const AreaLight& l) { return choice < l.last; });
  if (light == lights_.end()) return;
  const Vec3 to =
      light->shape.at(random(dimension(depth, kLightU)), random(dimension(depth, kLightV))) - hit.point;
  const double distance = length(to);
  const Ray ray = {hit.point, (1 / distance) * to};
  const double cos_here = dot(ray.direction, hit.normal);
  const double cos_there = -dot(ray.direction, light->shape.normal());
  if (cos_here <= 0 || cos_there <= 0 || blocked(*scene_, ray, distance * (1 - 1e-6))) return;
  lamp_[lane] = static_cast<float>(light->lamp);
  direct_[lane] = static_cast<float>(cos_here * cos_there * light->area_over_p /
                                     (std::numbers::pi * distance * distance));
  any_direct_ = true;
}

Result<void> Wavefront::shade_metals() {
  if (metals_.empty()) return {};
  const std::size_t count = s_.scattering.axis().count();
  const bool own = !spectra_->on_bands();
  for (std::size_t j = 0; own && j < metals_.size(); ++j) {
    for (std::size_t k = 0; k < count; ++k) {
      metal_spectra_.lambda.at(j, k) = s_.wavelengths.lambda_nm.at(metals_[j].lane, k);
    }
  }
  {
    const Clock engine{times_.engine};
    SPECTILE_TRY(spectra_->look_up_metals(metal_spectra_, metals_.size()));
  }
  for (std::size_t j = 0; j < metals_.size(); ++j) {
    const auto& [lane, hit] = metals_[j];
    Path& path = paths_[lane];
    const double cosine = -dot(path.ray.direction, hit.normal);
    const std::size_t row = own ? j : 0;
    for (std::size_t k = 0; k < count; ++k) {
      s_.scattering.at(lane, k) =
          static_cast<float>(conductor_reflectance(cosine, static_cast<double>(metal_spectra_.eta.at(row, k)),
                                                   static_cast<double>(metal_spectra_.k.at(row, k))));
    }
    path.ray = {hit.point, reflect(path.ray.direction, hit.normal)};
    path.sees_light = true;
  }
  return {};
}

/// Glass refracts each wavelength its own way, so a path goes on with one. Own wavelengths: the first, the
/// others are terminated. Bands: one drawn evenly, times their number, once a path.
void Wavefront::choose_wavelengths(std::uint32_t depth) {
  const std::size_t count = s_.scattering.axis().count();
  std::ranges::fill(glass_mask_, 0);
  for (std::size_t j = 0; j < glasses_.size(); ++j) {
    const std::size_t lane = glasses_[j].lane;
    for (std::size_t k = 0; k < count; ++k) s_.scattering.at(lane, k) = 1;
    if (!spectra_->on_bands()) {
      glass_mask_[lane / 64] |= std::uint64_t{1} << (lane % 64);
      glass_spectra_.lambda.at(j, 0) = s_.wavelengths.lambda_nm.at(lane, 0);
      continue;
    }
    Path& path = paths_[lane];
    if (path.band < 0) {
      path.band = static_cast<int>(path.random(dimension(depth, kBandChoice)) * static_cast<double>(count));
      for (std::size_t k = 0; k < count; ++k) s_.scattering.at(lane, k) = 0;
      s_.scattering.at(lane, static_cast<std::size_t>(path.band)) = static_cast<float>(count);
    }
    glass_spectra_.lambda.at(j, 0) = spectra_->band_nm(static_cast<std::size_t>(path.band));
  }
}

Result<void> Wavefront::shade_glasses(std::uint32_t depth) {
  if (glasses_.empty()) return {};
  choose_wavelengths(depth);
  {
    const Clock engine{times_.engine};
    if (!spectra_->on_bands()) SPECTILE_TRY(terminate_secondary(s_.wavelengths, glass_mask_));
    SPECTILE_TRY(spectra_->look_up_glasses(glass_spectra_, glasses_.size()));
  }
  for (std::size_t j = 0; j < glasses_.size(); ++j) {
    const auto& [lane, hit] = glasses_[j];
    Path& path = paths_[lane];
    const auto eta = static_cast<double>(glass_spectra_.eta.at(j, 0));
    const Refraction refraction = refract(path.ray.direction, hit.normal, hit.front ? 1 / eta : eta);
    // Chosen by the reflectance, so that the throughput stays as it is.
    const bool reflects =
        !refraction.direction || path.random(dimension(depth, kFresnel)) < refraction.reflectance;
    path.ray = {hit.point, reflects ? reflect(path.ray.direction, hit.normal) : *refraction.direction};
    path.sees_light = true;
  }
  return {};
}

}  // namespace tracer
