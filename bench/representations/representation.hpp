// Representations of light and materials: what a renderer computes with along a path, ours and the field's.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/methods/methods.hpp"

namespace spectile::measure {

inline constexpr std::size_t kMaxBounces = 5;
/// Paths, a lane each: 60 coefficients of five bounces and their product are 737 KB, for the second-level
/// cache.
inline constexpr std::size_t kPaths = 512;
/// Samples of the grid of reference colours, one a nanometre.
inline constexpr auto kGridSamples = static_cast<std::size_t>(kLastVisibleNm - kFirstVisibleNm) + 1;

/// Paths through a scene: one material a bounce.
struct PathScene {
  const MethodScene* scene = nullptr;
  std::vector<std::array<std::size_t, kMaxBounces>> paths;  ///< [kPaths], indices of reflectances
  std::vector<std::array<double, 3>> colors;                ///< linear sRGB under D65 of each reflectance

  const std::vector<ReferenceReflectance>& reflectances() const { return *scene->reflectances; }
  const ReferenceLight& light() const { return *scene->light; }
};

/// Paths drawn at random. Errors: as reference_light().
Result<PathScene> path_scene(const MethodScene& scene);

/// Light and materials in one form, ready to follow the paths.
struct Representation {
  std::string name;
  std::string
      source;  ///< publication that proposed it, in short; empty for usual practice and spectile's own
  std::size_t coefficients = 0;  ///< of a material
  double samples = 1;            ///< runs whose average is a path's colour
  std::function<void(std::size_t bounces)> run;
  /// Colours [kPaths] after so many bounces, on the scale on which the light's white has Y = 1.
  std::function<std::vector<Xyz>(std::size_t bounces)> colors;
};

/// Coefficients that are multiplied one by one, and the weights that make XYZ of them.
struct Products {
  std::vector<std::vector<double>> reflectances;  ///< [reflectance][coefficients]
  std::vector<std::array<double, 3>> weights;     ///< [coefficients], the light's included
};
/// Paths whose bounces multiply coefficients one by one, by the engine's kernels. Errors: kOutOfMemory.
Result<Representation> multiplied(const PathScene& scene, std::string name, std::string source,
                                  const Products& products);

/// Linear sRGB of the materials under D65, and of the light.
Products rgb_products(const PathScene& scene, const Xyz& d65_white);
/// Each material's own XYZ under the light, relative to white, in sharpened primaries. Source: Ward and
/// Eydelberg-Vileshin, Picture Perfect RGB Rendering Using Spectral Prefiltering and Sharp Color Primaries,
/// EGWR 2002; the primaries: Finlayson and Susstrunk, Spectral Sharpening and the Bradford Transform, 2000.
Products sharpened_products(const PathScene& scene);
/// Averages of the materials over bands; weights as the engine projects. Errors: as Projector::reflective().
Result<Products> band_products(const PathScene& scene, const Bands& bands);

/// Samples of the grid, one after the other.
struct Interval {
  std::size_t first = 0, count = 0;
};
/// Leaves of a binary tree over 512 nm, `count` or as many as differ: always that one is halved by which the
/// XYZ, relative to white, of paths of one and two of the scene's materials change most. One tree serves all
/// spectra, so that products need no merging. Source: Rougeron and Peroche, An Adaptive Representation of
/// Spectral Data for Reflectance Computations, EGWR 1997, whose trees are of each spectrum.
std::vector<Interval> tree_leaves(const PathScene& scene, std::size_t count);
/// Averages of the materials over the leaves.
Products tree_products(const PathScene& scene, std::span<const Interval> leaves);

/// One line of a light.
struct Spike {
  double nm = 0;
  Xyz xyz{};  ///< of its power
};
struct SmoothAndSpikes {
  std::vector<double> smooth;  ///< share of the light in the smooth part, at each nanometre
  std::vector<Spike> spikes;
};
/// A light's lines and the rest. A line is what rises above the opening of the spectrum (the largest of the
/// smallest values of windows of 25 nm) by half or more at its peak; lines that meet are split at the lowest
/// place between them, and those with less than a thousandth of the white's X, Y and Z stay in the rest.
SmoothAndSpikes smooth_and_spikes(const ReferenceLight& light);
/// The smooth part on so many even intervals from 380 to 780 nm, where materials have their averages, and the
/// spikes, where they have their values. Source: Sun, Fracchia, Drew, Calvert, A Spectrally Based Framework
/// for Realistic Image Synthesis, The Visual Computer 17, 2001.
Products composite_products(const PathScene& scene, std::size_t count);

/// Orthonormal functions for spectra of light.
struct LinearBasis {
  std::vector<double> scale;                   ///< that spectra are multiplied by, at each nanometre
  std::vector<double> light;                   ///< so multiplied
  std::vector<std::vector<double>> functions;  ///< [function][kGridSamples], the most important first
  std::vector<std::array<double, 3>> weights;  ///< XYZ of each function
};
/// Characteristic vectors of the light, on the scene's materials and on their products, weighed by what is
/// seen of it.
LinearBasis characteristic_basis(const PathScene& scene, std::size_t functions);
/// The first functions of a basis, their number one of kBasisSizes: a material is the symmetric matrix that
/// takes the coefficients of a light to those of what it reflects. Errors: kOutOfMemory. Source: Peercy,
/// Linear Color Representations for Full Speed Spectral Rendering, SIGGRAPH 1993.
Result<Representation> linear_basis(const PathScene& scene, const LinearBasis& basis, std::size_t functions);

/// Coefficients of Chebyshev's polynomials up to the third on four intervals of 100 nm from 380 nm, by least
/// squares. Shapes: spectrum [kGridSamples], result [interval][4].
std::vector<double> chebyshev_fit(const std::vector<double>& spectrum);
/// Materials as such polynomials; products lose their terms above the third. The light is not approximated.
/// Errors: kOutOfMemory. Source: Raso and Fournier, A Piecewise Polynomial Approach to Shading Using Spectral
/// Distributions, Graphics Interface 1991.
Result<Representation> polynomials(const PathScene& scene);

/// Choice of wavelengths for each path, by a density in proportion to the light that is seen.
enum class Drawing {
  kStratified,  ///< one in each part of equal probability: Evans and McCool, Stratified Wavelength Clusters
                ///< for Efficient Spectral Monte Carlo Rendering, Graphics Interface 1999
  kHero,  ///< one, and those at even distances from it, by the balance heuristic: Wilkie, Nawaz, Droske,
          ///< Weidlich, Hanika, Hero Wavelength Spectral Sampling, EGSR 2014
};
/// Density by wavelength, linear between nanometres; its integral is 1.
struct DensityTable {
  std::vector<double> density, cumulative;  ///< [kGridSamples]
  double at(double nm) const;
  /// Wavelength below which the share u of the density lies.
  double inverse(double u) const;
};
DensityTable wavelength_density(const ReferenceLight& light);
struct DrawnWavelength {
  double nm = 0;
  double weight = 0;  ///< sums over those drawn of weight times a function are its integral, on average
};
/// As many wavelengths as numbers in [0, 1); a hero needs the first number alone.
std::vector<DrawnWavelength> draw_wavelengths(const DensityTable& density, Drawing drawing,
                                              std::span<const double> jitter);
/// So many wavelengths at once, so many times, each time in another part of the strata. Errors: kOutOfMemory.
Result<Representation> drawn_wavelengths(const PathScene& scene, Drawing drawing, std::size_t wavelengths,
                                         std::size_t samples);

/// Ways from a material's RGB to a spectrum on 60 bands.
enum class Upsampling {
  kSigmoid,      ///< Jakob and Hanika 2019, the engine's `sigmoid`
  kTetrahedral,  ///< the engine's `tetrahedral`
  kMoments,      ///< moment_spectrum()
  kMeng,         ///< smoothest_spectrum()
  kBurns,        ///< least_slope_spectrum()
};
/// Materials known by their RGB alone, limited to 0 to 1. Where one of the last three has no spectrum of a
/// colour, it is moved toward its grey, by a tenth more than the least that helps. Errors: those of
/// Upsampler::create().
Result<Products> upsampled_products(const PathScene& scene, Upsampling upsampling);

/// Phase of a wavelength, 0 to pi, as published with moment_spectrum()'s source. Units: nm.
double moment_phase(double nm);
/// The signal within 0 and 1 of the largest entropy for its first three moments, of which the colour is
/// given. Shapes: phases [bands]; weights [bands]: their sums with the spectrum are the colour; result
/// [bands], or nothing where there is none. Source: Peters, Merzbach, Hanika, Dachsbacher, Using Moments to
/// Represent Bounded Signals for Spectral Rendering, ACM Transactions on Graphics 38(4), 2019.
std::vector<double> moment_spectrum(std::span<const double> phases,
                                    std::span<const std::array<double, 3>> weights,
                                    const std::array<double, 3>& color);
/// The spectrum within 0 and 1 with the least sum of squared slopes. Shapes: as above. Source: Meng, Simon,
/// Hanika, Dachsbacher, Physically Meaningful Rendering Using Tristimulus Colours, EGSR 2015.
std::vector<double> smoothest_spectrum(std::span<const std::array<double, 3>> weights,
                                       const std::array<double, 3>& color);
/// (tanh z + 1) / 2 with the least sum of squared slopes of z. Shapes: as above. Source: Burns, Numerical
/// Methods for Smoothest Reflectance Reconstruction, Color Research and Application 45(1), 2020.
std::vector<double> least_slope_spectrum(std::span<const std::array<double, 3>> weights,
                                         const std::array<double, 3>& color);

/// All of them for a light; fewer where `stop` says so. Errors: as those that make them.
Result<std::vector<Representation>> representations_for(const PathScene& scene,
                                                        const std::function<bool()>& stop = {});

/// Light that is seen at a nanometre of the grid: X, Y and Z, each relative to the white's, added.
double seen_at(const ReferenceLight& light, std::size_t sample);
/// Materials that bases and trees are made for: all, or 48 evenly among them.
std::vector<std::size_t> materials_of_scene(const PathScene& scene);
/// White, those materials and the products of two of them. Shapes: [spectra][kGridSamples].
std::vector<std::vector<double>> spectra_of_scene(const PathScene& scene);

}  // namespace spectile::measure
