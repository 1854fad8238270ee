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
/// Paths, a lane each: 60 coefficients of five bounces stay in the second-level cache.
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
  std::string source;            ///< publication that proposed it, in short; empty for usual practice
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

/// Linear sRGB, and sharpened primaries: the light's own XYZ of each material, relative to its white, in
/// primaries in which products come nearest to those of spectra. Source: Ward and Eydelberg-Vileshin, Picture
/// Perfect RGB Rendering Using Spectral Prefiltering and Sharp Color Primaries, EGWR 2002; the primaries are
/// those of Finlayson and Susstrunk, Spectral Sharpening and the Bradford Transform, 2000.
Products rgb_products(const PathScene& scene, const Xyz& d65_white);
Products sharpened_products(const PathScene& scene);

/// Bands: averages of the materials; weights as the engine projects. Errors: as Projector::reflective().
Result<Products> band_products(const PathScene& scene, const Bands& bands);

/// Leaves of a binary tree over 512 nm, which halves the interval whose averages are most wrong, in XYZ
/// relative to white, for the scene's materials and their products two by two; one tree for all, so that
/// products need no merging. Source: Rougeron and Peroche, An Adaptive Representation of Spectral Data for
/// Reflectance Computations, EGWR 1997, whose trees are of each spectrum.
struct TreeLeaf {
  std::size_t first = 0, count = 0;  ///< samples of the grid
};
std::vector<TreeLeaf> tree_leaves(const PathScene& scene, std::size_t count);
Products tree_products(const PathScene& scene, std::span<const TreeLeaf> leaves);

/// The light as a smooth part, on 16 intervals, and spikes, where materials have their value at one
/// wavelength. Source: Sun, Fracchia, Drew, Calvert, A Spectrally Based Framework for Realistic Image
/// Synthesis, The Visual Computer 17, 2001.
struct Spike {
  double nm = 0;
  Xyz xyz{};  ///< of its power
};
/// Spikes of a light: what rises from the opening of its spectrum, the largest of the smallest values of
/// windows of 25 nm, split where it is lowest between two rises; without those of less than a thousandth of
/// the white's Y.
struct SmoothAndSpikes {
  std::vector<double> smooth;  ///< share of the light in the smooth part, at each nanometre
  std::vector<Spike> spikes;
};
SmoothAndSpikes smooth_and_spikes(const ReferenceLight& light);
Products composite_products(const PathScene& scene);

/// Spectra of lit materials in a basis of characteristic vectors of the scene's lit materials and their
/// products; a material is the symmetric matrix that takes a spectrum's coefficients to those of its product.
/// Source: Peercy, Linear Color Representations for Full Spectral Rendering, SIGGRAPH 1993.
struct LinearBasis {
  std::vector<double> scale;                   ///< that spectra are multiplied by, at each nanometre
  std::vector<double> light;                   ///< so multiplied
  std::vector<std::vector<double>> functions;  ///< orthonormal, [function][kGridSamples]
  std::vector<std::array<double, 3>> weights;  ///< XYZ of each function
};
LinearBasis characteristic_basis(const PathScene& scene, std::size_t functions);
/// With as many functions as kBasisSizes has. Errors: kOutOfMemory.
Result<Representation> linear_basis(const PathScene& scene, std::size_t functions);

/// Materials as cubic polynomials on four intervals; products have their terms above the third dropped in
/// Chebyshev's basis. Source: Raso and Fournier, A Piecewise Polynomial Approach to Shading Using Spectral
/// Distributions, Graphics Interface 1991.
/// Coefficients of Chebyshev's polynomials by least squares. Shapes: [interval][4].
std::vector<double> chebyshev_fit(const std::vector<double>& spectrum);
Result<Representation> polynomials(const PathScene& scene);

/// Wavelengths drawn for each path with a density in proportion to the light that is seen; `wavelengths` at
/// once, `samples` times, 256 in all.
enum class Drawing {
  kStratified,  ///< one in each part of equal probability: Evans and McCool, Stratified Wavelength Clusters
                ///< for Efficient Spectral Monte Carlo Rendering, Graphics Interface 1999
  kHero,  ///< one, and those at even distances from it, by the balance heuristic: Wilkie, Nawaz, Droske,
          ///< Weidlich, Hanika, Hero Wavelength Spectral Sampling, EGSR 2014
};
/// Density by wavelength, linear between nanometres; its integral is 1.
struct WavelengthDensity {
  std::vector<double> density, cumulative;  ///< [kGridSamples]
  double at(double nm) const;
  /// Wavelength below which the share u of the density lies.
  double inverse(double u) const;
};
WavelengthDensity wavelength_density(const ReferenceLight& light);
struct DrawnWavelength {
  double nm = 0;
  double weight = 0;  ///< sums over those drawn of weight times a function are its integral, on average
};
/// As many wavelengths as numbers in [0, 1); a hero's place needs the first alone.
std::vector<DrawnWavelength> draw_wavelengths(const WavelengthDensity& density, Drawing drawing,
                                              std::span<const double> jitter);
Result<Representation> drawn_wavelengths(const PathScene& scene, Drawing drawing, std::size_t wavelengths);

/// Materials known by their RGB alone: spectra on 60 bands that others made of it.
enum class Upsampling {
  kSigmoid,      ///< Jakob and Hanika 2019, the engine's `sigmoid`
  kTetrahedral,  ///< the engine's `tetrahedral`
  kMoments,      ///< bounded maximum entropy of three moments: Peters, Merzbach, Hanika, Dachsbacher, Using
                 ///< Moments to Represent Bounded Signals for Spectral Rendering, SIGGRAPH 2019
  kMeng,         ///< least sum of squared slopes within 0 and 1: Meng, Simon, Hanika, Dachsbacher, Physically
                 ///< Meaningful Rendering Using Tristimulus Colours, EGSR 2015
  kBurns,        ///< least slope of the hyperbolic tangent's argument: Burns, Numerical Methods for Smoothest
                 ///< Reflectance Reconstruction, Color Research and Application 45, 2020
};
/// Errors: kBadArgument where a colour has no such spectrum.
Result<Products> upsampled_products(const PathScene& scene, Upsampling upsampling);

/// Spectra of the last three for given sums. `weights` [bands][3]: their sums with a spectrum are the colour.
/// Nothing where there is none.
std::vector<double> moment_spectrum(std::span<const double> centres_nm,
                                    std::span<const std::array<double, 3>> weights,
                                    const std::array<double, 3>& color);
std::vector<double> smoothest_spectrum(std::span<const std::array<double, 3>> weights,
                                       const std::array<double, 3>& color);
std::vector<double> least_slope_spectrum(std::span<const std::array<double, 3>> weights,
                                         const std::array<double, 3>& color);

/// All of them for a light. Errors: as those that make them.
Result<std::vector<Representation>> representations_for(const PathScene& scene);

/// Light that is seen at a nanometre of the grid: X, Y and Z, each relative to the white's, added.
double seen_at(const ReferenceLight& light, std::size_t sample);
/// The scene's reflectances and products of two of them, at every nanometre: what bases and trees are made
/// for. Shapes: [spectra][kGridSamples].
std::vector<std::vector<double>> spectra_of_scene(const PathScene& scene);

}  // namespace spectile::measure
