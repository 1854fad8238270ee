// Wavefront: one worker's batch of paths, traced bounce by bounce with all spectral work in library calls.
#pragma once

#include <chrono>
#include <limits>

#include "fresnel.hpp"
#include "random.hpp"
#include "spectral_scene.hpp"

namespace tracer {

/// A rendering's size and samples, and its pieces: the picture depends on neither threads nor batch.
struct RenderSettings {
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t size = 128;  ///< pixels a side
  std::uint32_t samples = 16;
  std::uint32_t first_sample = 0;
  std::uint32_t seed = 0;
  std::size_t threads = 2;
  std::size_t batch = 0;                                 ///< lanes; 0: as many as suit a cache
  std::uint32_t max_depth = 24;                          ///< surfaces along a path
  std::uint32_t roulette_from = 3;                       ///< bounces before Russian roulette; kNever for none
  float limit = std::numeric_limits<float>::infinity();  ///< of a sample's X, Y and Z
  bool next_event = true;          ///< false: lamps count where paths hit them by chance
  std::optional<Bands> kept = {};  ///< bands that the film keeps spectra in, beside XYZ
};

/// Seconds of a worker, or of all together.
struct Times {
  double engine = 0;  ///< in calls of the library
  double film = 0;    ///< ... of which Film::add
  double all = 0;
};

/// Adds the seconds of its life to a sum.
struct Clock {
  double& sum;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  ~Clock() { sum += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
};

class Wavefront {
 public:
  /// The scenes and the film must outlive it.
  static Result<Wavefront> create(const Scene& scene, const SpectralScene& spectra,
                                  const RenderSettings& settings, Film& film);
  /// Traces the paths first to first + count, and adds them to the film. Paths are numbered pixel by pixel.
  Result<void> run(std::uint64_t first, std::size_t count);
  const Times& times() const noexcept { return times_; }
  std::size_t batch() const noexcept { return settings_.batch; }

 private:
  struct Path {
    Ray ray;
    Random random;
    bool sees_light = true;  ///< lamps that it hits were not sampled at the last surface
    bool alive = true;
    int band = -1;  ///< the only one left after glass; all below 0
  };
  struct SpecularLane {
    std::size_t lane = 0;
    Hit hit;
  };
  struct AreaLight {
    Rectangle shape;
    int lamp = 0;
    double last = 1;         ///< cumulative probability
    double area_over_p = 0;  ///< area over the probability to be chosen
  };

  Wavefront(const Scene& scene, const SpectralScene& spectra, const RenderSettings& settings, Film& film)
      : scene_(&scene), spectra_(&spectra), settings_(settings), film_(&film) {}
  Result<void> allocate();
  void find_lights();
  void aim(std::uint64_t first, std::size_t count);
  Result<void> bounce(std::uint32_t depth);
  void trace_lane(std::size_t lane, std::uint32_t depth);
  void shade_diffuse(std::size_t lane, const Hit& hit, std::uint32_t depth);
  void sample_lamp(std::size_t lane, const Hit& hit, std::uint32_t depth);
  /// Adds to the radiance: the lane's lamp times its factor, times a throughput.
  Result<void> add_light(SampledSpectraView throughput, const ScalarLanes& factor);
  Result<void> shade_metals();
  Result<void> shade_glasses(std::uint32_t depth);
  void choose_wavelengths(std::uint32_t depth);
  Result<void> scatter(std::size_t active, std::uint32_t depth);
  void compact();

  const Scene* scene_;
  const SpectralScene* spectra_;
  RenderSettings settings_;
  Film* film_;
  Times times_;

  std::vector<AreaLight> lights_;
  std::vector<Path> paths_;
  std::vector<float> x_, y_;
  std::size_t live_ = 0;  ///< the first lanes, whose paths go on
  PathSpectra s_;
  OpticalConstants metal_spectra_, glass_spectra_;
  std::vector<SpecularLane> metals_, glasses_;
  LaneMask glass_mask_;
  ScalarLanes u_, density_;
  ScalarLanes texture_u_, texture_v_;  ///< points of the atlas; any where there is no matt surface
  ScalarLanes lamp_;                   ///< 0 or 1
  ScalarLanes emitted_, direct_;       ///< factors of that lamp's radiance
  bool any_emitted_ = false, any_direct_ = false;
};

}  // namespace tracer
