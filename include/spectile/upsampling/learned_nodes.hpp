// LearnedNodes: spectra of the tetrahedral method's nodes, learned from measured reflectances.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <spectile/color/color_difference.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/named_light.hpp>
#include <spectile/spectra/observer.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Levels of the nodes of Method::kTetrahedral along each component of RGB, ((k / 4)^1.5), and their number.
std::span<const float> node_levels();
inline constexpr std::size_t kNodes = 125;
/// Wavelengths between which colours tell of a spectrum: those of learned offsets. Units: nm.
inline constexpr double kFirstLearnedNm = 400;
inline constexpr double kLastLearnedNm = 720;
/// Reflectances that are learned from, at least.
inline constexpr std::size_t kMinReflectances = 10;

/// How the spectra of measured materials differ from the smooth ones of their colours, at each node.
///
/// A node's reflectance is S(c0 p + c1 q + c2 + offset), S(x) = 1/2 + x / (2 sqrt(1 + x^2)), with p and q as
/// in Method::kSigmoidObserver and the three coefficients for which its colour is the node's, exactly, in
/// any bands. Between wavelengths the offset is linear, beyond the outer ones constant. Where no coefficients
/// have the colour, the offset is halved until some have; greys have none and stay flat.
struct LearnedNodes {
  NamedLight light;  ///< under which RGB 1, 1, 1 is the perfect diffuser; the primaries are those of sRGB
  Observer observer = Observer::kCie1931;
  std::size_t reflectances = 0;        ///< number of them that the nodes were learned from
  std::vector<double> wavelengths_nm;  ///< ascending
  std::vector<float> offsets;          ///< [red][green][blue][wavelengths]
};

/// The first flaw of nodes, in words, empty for none: wavelengths that do not ascend or are not from 100 to
/// 10000 nm, more than 4096 of them, lists of different lengths, offsets beyond -1000 to 1000.
std::string nodes_flaw(const LearnedNodes& nodes);

/// Reflectances of one origin: a file's.
struct ReflectanceSet {
  std::string name;
  std::vector<Spectrum> reflectances;
};

struct LearningOptions {
  std::optional<NamedLight> light = {};  ///< as in LearnedNodes; D65 where none
  Observer observer = Observer::kCie1931;
  std::function<bool()> go_on = {};  ///< asked some times a second; false stops with kCancelled
};

/// Learns nodes.
///
/// Method: each reflectance R, limited to 0.006 to 0.994, becomes x = y / sqrt(1 - y^2), y = 2 R - 1, every
/// 5 nm from 380 to 780; less what c0 p + c1 q + c2 can make of it (least squares), and smoothed, that is an
/// offset at the reflectance's colour in CIELAB under the light. The offset at a node is the mean of a
/// Gaussian process (Matern 3/2, length 0.8 over L/100, a/60, b/60) whose noise grows with the size of the
/// set, 4 sqrt(n / 50), so that large sets do not drown small ones; from 400 to 720 nm, where colours tell of
/// it. Errors: kBadArgument for fewer than 10 reflectances or more than 4096, or one that is not finite;
/// kOutOfMemory; kCancelled. Source of the process: Rasmussen, Williams, Gaussian Processes for Machine
/// Learning, MIT Press 2006; of the function of colour: our own.
Result<LearnedNodes> learn_nodes(std::span<const ReflectanceSet> sets, const LearningOptions& options = {});

/// Errors over reflectances that took no part, of methods that were given their RGB: CIEDE2000 under A, FL2,
/// FL11, LED-B3 and HP1, over those within the cube of sRGB.
struct LearningTrial {
  std::string held_out;          ///< the set's name; empty for the fifths
  std::size_t reflectances = 0;  ///< evaluated: 0 where none is within the cube, or too few are left
  std::size_t learned_from = 0;  ///< of a set: reflectances of the others
  ColorError sigmoid;
  ColorError sigmoid_observer;
  ColorError tetrahedral;  ///< not learned
  ColorError learned;
  /// True if learning has the least mean of all of them.
  bool pays() const;
};

/// Learns from all but a part, and evaluates on that: a fifth of each set, five times, as it lies in the
/// file, since neighbours are often alike; then each set where there are several, from 10 reflectances of the
/// others on. What is held out is not learned from where it occurs twice. Errors: as learn_nodes().
Result<std::vector<LearningTrial>> try_learning(std::span<const ReflectanceSet> sets,
                                                const LearningOptions& options = {});

}  // namespace spectile
