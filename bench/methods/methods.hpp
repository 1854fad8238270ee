// Run time against error: every method of doing a job is one point.
#pragma once

#include <functional>
#include <memory>
#include <spectile/bench/benchmark.hpp>
#include <string>
#include <vector>

#include "bench/limits/clock.hpp"
#include "bench/methods/reference_colors.hpp"
#include "kernels/abi.hpp"

namespace spectile::measure {

/// Lanes that a method works on at once: a tile that stays in the second-level cache at 60 bands.
inline constexpr std::size_t kMethodLanes = 2048;

/// One method, ready to run: kWayLanes lanes, of which lane i is of reflectance i modulo their number.
struct MethodRun {
  MethodRun(std::string of_family, std::string own_name, std::size_t band_count, std::uint64_t stored)
      : family(std::move(of_family)),
        name(std::move(own_name)),
        bands(static_cast<int>(band_count)),
        bytes(stored) {}

  std::string family, name;
  int bands = 0;
  std::uint64_t bytes = 0;
  std::function<void()> run;
  std::function<Xyz(std::size_t lane)> result;  ///< after a run; on the scale of the light's white, Y = 1
  double per_lane = 1;                          ///< runs that a lane's result needs, as many samples a pixel
};

/// Inputs of the jobs.
struct MethodScene {
  const std::vector<ReferenceReflectance>* reflectances = nullptr;
  const ReferenceLight* light = nullptr;
  const kernels::KernelTable* table = nullptr;
  std::vector<Bands> planned;            ///< for this light; see planned_bands_for()
  std::vector<Bands> planned_for_paths;  ///< the same, for two bounces
  std::uint64_t seed = 1;
};

inline constexpr const char* kRgbJob =
    "RGB texture, under a light, to a colour; the reference is the measured reflectance under the light, "
    "summed at every nanometre in double, and all that a method is given is its RGB under D65";
inline constexpr const char* kFilmJob =
    "Spectral samples, under a light, to a film; the reference is the measured reflectance under the light, "
    "summed at every nanometre in double, and a method is given its averages over bands, or its values at "
    "drawn wavelengths";

/// Bands planned for a light, for the spectra that sigmoids make of colours of sRGB: none of the measured
/// reflectances that errors are over. `counts`: of bands. Errors: as make_plan().
Result<std::vector<Bands>> planned_bands_for(const std::string& light, const std::vector<std::size_t>& counts,
                                             int bounces = 1);

/// Every method for one light. Errors: as those that make them.
Result<std::vector<MethodRun>> rgb_methods(const MethodScene& scene, bool quick);
Result<std::vector<MethodRun>> film_methods(const MethodScene& scene, bool quick);

/// Times them in turn and evaluates them; `times` of an earlier light are taken where a method of that name
/// is in it.
std::vector<MethodSpeed> measure_methods(const std::string& job, const MethodScene& scene,
                                         std::vector<MethodRun>& methods, const TimingBudget& timing,
                                         const std::vector<MethodSpeed>& earlier);

/// Marks those of a job and a light that no other beats or equals in both time and mean error.
void mark_frontier(std::vector<MethodSpeed>& methods);

/// Which to take, in words, for each job and light.
std::vector<BenchmarkAdvice> advice_on(const std::vector<MethodSpeed>& methods);

/// Paths of 1 to 5 reflectances drawn at random, under the scene's light, in every representation of
/// bench/representations. Errors: as those that make them.
Result<std::vector<RepresentationSpeed>> measure_representations(const MethodScene& scene,
                                                                 const TimingBudget& timing);

}  // namespace spectile::measure
