// The wavefront loop: camera, bounces in batches, compaction, film.
#include "wavefront.hpp"

#include <algorithm>

namespace tracer {
namespace {

/// A view of the first lanes.
LanesView first_lanes(const ScalarLanes& lanes, std::size_t count) {
  return {lanes.view().data, count};
}

void swap_lanes(SampledSpectra& batch, std::size_t a, std::size_t b) {
  const std::size_t count = batch.axis().count();
  for (std::size_t k = 0; k < count; ++k) std::swap(batch.at(a, k), batch.at(b, k));
}

}  // namespace

Result<Wavefront> Wavefront::create(const Scene& scene, const SpectralScene& spectra,
                                    const RenderSettings& settings, Film& film) {
  Wavefront out(scene, spectra, settings, film);
  out.find_lights();
  SPECTILE_TRY(out.allocate());
  return out;
}

void Wavefront::find_lights() {
  // A light is chosen in proportion to its area times its lamp's luminance.
  double sum = 0;
  for (const Surface& surface : scene_->surfaces) {
    const auto* const shape = std::get_if<Rectangle>(&surface.shape);
    if (!settings_.next_event || surface.lamp < 0 || shape == nullptr) continue;
    const double weight = shape->area() * scene_->lamps[static_cast<std::size_t>(surface.lamp)].luminance;
    if (weight <= 0) continue;
    sum += weight;
    lights_.push_back({*shape, surface.lamp, sum, shape->area() / weight});
  }
  for (AreaLight& light : lights_) {
    light.last /= sum;
    light.area_over_p *= sum;
  }
}

Result<void> Wavefront::allocate() {
  // Where nothing else is asked for, a batch of spectra takes at most 64 KiB, so that some fit into a cache.
  constexpr std::size_t kFloats = 16384;
  const std::size_t blocks = std::max<std::size_t>(1, kFloats / (kLanesPerBlock * spectra_->axis().count()));
  if (settings_.batch == 0) settings_.batch = blocks * kLanesPerBlock;
  const std::size_t lanes = settings_.batch;
  paths_.resize(lanes);
  x_.resize(lanes);
  y_.resize(lanes);
  glass_mask_.resize(blocks_for(lanes));
  SPECTILE_ASSIGN(s_, spectra_->make_paths(lanes));
  SPECTILE_ASSIGN(metal_spectra_, spectra_->make_metals(lanes));
  SPECTILE_ASSIGN(glass_spectra_, spectra_->make_glasses(lanes));
  for (ScalarLanes* scalars : {&u_, &density_, &texture_u_, &texture_v_, &lamp_, &emitted_, &direct_}) {
    SPECTILE_ASSIGN(*scalars, ScalarLanes::create(lanes));
  }
  return {};
}

void Wavefront::aim(std::uint64_t first, std::size_t count) {
  const Camera& camera = scene_->camera;
  for (std::size_t i = 0; i < count; ++i) {
    const auto pixel = static_cast<std::uint32_t>((first + i) / settings_.samples);
    const auto sample = static_cast<std::uint32_t>((first + i) % settings_.samples) + settings_.first_sample;
    const Random random(pixel, sample, settings_.seed);
    const std::uint32_t size = settings_.size;
    // A sum that float rounds up to the next pixel would be in its neighbour.
    const double column = pixel % size;
    const std::uint32_t line = pixel / size;
    const double x = column + std::min(random(kPixelX), 0.999);
    const double y = line + std::min(random(kPixelY), 0.999);
    x_[i] = static_cast<float>(x);
    y_[i] = static_cast<float>(y);
    u_[i] = static_cast<float>(random(kWavelength));
    const Vec3 d = camera.forward + (2 * x / size - 1) * camera.right + (1 - 2 * y / size) * camera.up;
    paths_[i] = {{camera.eye, normalized(d)}, random, true, true, -1};
  }
}

Result<void> Wavefront::run(std::uint64_t first, std::size_t count) {
  const Clock all{times_.all};
  aim(first, count);
  live_ = count;
  {
    const Clock engine{times_.engine};
    SPECTILE_TRY(spectra_->start(u_, s_));
  }
  for (std::uint32_t depth = 0; depth < settings_.max_depth && live_ > 0; ++depth) {
    SPECTILE_TRY(bounce(depth));
  }
  const Clock engine{times_.engine};
  const Clock film{times_.film};
  const SamplePositions at = {{x_.data(), count}, {y_.data(), count}, {}};
  const SampledSpectraView radiance = s_.radiance.view().range(0, count);
  if (spectra_->on_bands()) return film_->add(at, radiance);
  return film_->add(at, radiance, s_.wavelengths.view().range(0, count));
}

Result<void> Wavefront::bounce(std::uint32_t depth) {
  const std::size_t active = std::min(blocks_for(live_) * kLanesPerBlock, paths_.size());
  metals_.clear();
  glasses_.clear();
  any_emitted_ = any_direct_ = false;
  for (std::size_t lane = 0; lane < active; ++lane) {
    texture_u_[lane] = texture_v_[lane] = 0;
    lamp_[lane] = emitted_[lane] = direct_[lane] = 0;
    density_[lane] = 1;
    if (lane < live_) trace_lane(lane, depth);
  }
  const auto throughput = s_.throughput.view().range(0, active);
  const auto scattering = s_.scattering.span().range(0, active);
  {
    const Clock engine{times_.engine};
    if (any_emitted_) SPECTILE_TRY(add_light(throughput, emitted_));
    SPECTILE_TRY(spectra_->reflectances({first_lanes(texture_u_, active), first_lanes(texture_v_, active)},
                                        s_, scattering));
  }
  SPECTILE_TRY(shade_metals());
  SPECTILE_TRY(shade_glasses(depth));
  if (any_direct_) {
    const Clock engine{times_.engine};
    const auto product = s_.product.span().range(0, active);
    SPECTILE_TRY(multiply(throughput, scattering, product, kOneThread));
    SPECTILE_TRY(add_light(product, direct_));
  }
  return scatter(active, depth);
}

Result<void> Wavefront::add_light(SampledSpectraView throughput, const ScalarLanes& factor) {
  const std::size_t active = throughput.lanes;
  const auto light = s_.light.span().range(0, active);
  const auto radiance = s_.radiance.span().range(0, active);
  SPECTILE_TRY(lerp(s_.lamps[0].view().range(0, active), s_.lamps[1].view().range(0, active),
                    first_lanes(lamp_, active), light, kOneThread));
  SPECTILE_TRY(scale(light, first_lanes(factor, active), light, kOneThread));
  return multiply_add(throughput, light, radiance, radiance, kOneThread);
}

Result<void> Wavefront::scatter(std::size_t active, std::uint32_t depth) {
  const bool roulette = depth >= settings_.roulette_from;
  for (std::size_t lane = 0; roulette && lane < live_; ++lane) {
    u_[lane] = static_cast<float>(paths_[lane].random(dimension(depth, kRoulette)));
  }
  LaneMask ended;
  {
    const Clock engine{times_.engine};
    const auto throughput = s_.throughput.span().range(0, active);
    SPECTILE_ASSIGN(
        ended,
        update_throughput(throughput, s_.scattering.view().range(0, active), first_lanes(density_, active),
                          roulette ? first_lanes(u_, active) : LanesView{}, throughput, kOneThread));
  }
  for (std::size_t lane = 0; lane < live_; ++lane) {
    if (((ended[lane / 64] >> (lane % 64)) & 1U) != 0) paths_[lane].alive = false;
  }
  compact();
  return {};
}

/// Ended paths change places with the last that go on. They keep their radiance for the film.
void Wavefront::compact() {
  for (std::size_t lane = 0; lane < live_;) {
    if (paths_[lane].alive) {
      ++lane;
      continue;
    }
    const std::size_t last = --live_;
    if (lane == last) break;
    std::swap(paths_[lane], paths_[last]);
    std::swap(x_[lane], x_[last]);
    std::swap(y_[lane], y_[last]);
    for (SampledSpectra* batch : {&s_.throughput, &s_.radiance}) swap_lanes(*batch, lane, last);
    if (spectra_->on_bands()) continue;
    for (SampledSpectra* batch :
         {&s_.wavelengths.lambda_nm, &s_.wavelengths.density, &s_.lamps[0], &s_.lamps[1]}) {
      swap_lanes(*batch, lane, last);
    }
  }
}

}  // namespace tracer
