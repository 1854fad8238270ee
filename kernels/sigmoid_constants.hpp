// Constants of the search for sigmoid coefficients, common to the kernels and their scalar twin.
#pragma once

#include <cstdint>

#include "kernels/abi/upsampling.hpp"

namespace spectile::kernels {

/// Half the inverse square root: a guess from this less half the bits, a step of third order and one of
/// second. The guess and the two constants of the first step make its largest error least, 1.7e-4 (found by
/// search; starting from Lomont, Fast Inverse Square Root, 2003, and the series 15/8 - 10/8 e + 3/8 e^2,
/// scaled so that its last coefficient is 1); the constant of the second is 3/4 of the cube root of 4, which
/// makes its other coefficient 1.
inline constexpr std::uint32_t kRootGuess = 0x5F021E39U;
inline constexpr float kRootFirst = 1.57632448F;
inline constexpr float kRootSecond = 1.87161556F;
inline constexpr float kRootThird = 1.19055079F;

/// Largest component below which a colour counts as black: less than a sample's rounding.
inline constexpr float kSigmoidBlack = 0x1p-25F;
/// A residual below this is as good as the samples' rounding lets it be.
inline constexpr float kSigmoidFloor = 0x1p-25F;
/// Colours darker than this whose first step does not suffice are searched from above: four times as bright
/// as often as it takes to reach it, then down again, a quarter at a time. Towards black a sigmoid is a
/// quarter of the inverse square of its polynomial, so twice the coefficients are a start for a quarter of
/// the colour, even for dark purples, whose spectra rise at both ends.
inline constexpr float kSigmoidLit = 0x1p-6F;
inline constexpr int kSigmoidLevels = 10;
/// A step is the last where the residual times the step's length is below this part of the colour's largest
/// component (or of kSigmoidDark, if that is more): the error that it leaves was found to be at most 2.7
/// times that product, below rounding.
inline constexpr float kSigmoidClose = 5e-7F;
inline constexpr float kSigmoidDark = 0.05F;
/// Steps count as good, and the first one is taken, only from this near; the first relative to the largest
/// component.
inline constexpr float kSigmoidNear = 0.05F;
/// A colour whose residual stays above this, or above this part of its largest component, has no
/// coefficients; the third is what rounding may leave of colours so dark that their part is less.
inline constexpr float kSigmoidUnsolved = 1e-5F;
inline constexpr float kSigmoidMet = 0.01F;
inline constexpr float kSigmoidRounding = 0x1p-22F;
/// Evaluations at most, outside the cube and inside it, and the shortest part of a step that is tried.
inline constexpr int kSigmoidStepsOutside = 12;
inline constexpr int kSigmoidSteps = 80;
inline constexpr float kSigmoidShortest = 0x1p-12F;

/// The way from a colour's grey to the colour, for what those searches do not find. The shortest part of it
/// that is tried at once, the shortest part of a Newton step, and how many evaluations a place on the way may
/// take: patient for colours in the cube, where a way across the far ends of the range turns sharply, and
/// brief for those outside, where most ways end.
struct ContinuationEffort {
  float shortest, damped, tries;
};
inline constexpr ContinuationEffort kContinuationInside = {0x1p-12F, 0x1p-8F, 16.0F};
inline constexpr ContinuationEffort kContinuationOutside = {0x1p-9F, 0.5F, 5.0F};
/// The first part that is tried, evaluations at most, and how near (relative to the grey) places must be met.
/// At the end steps go on as long as they halve the residual.
inline constexpr float kContinuationFirst = 0.25F;
inline constexpr int kContinuationSteps = 256;
inline constexpr float kContinuationNear = 1e-3F;
inline constexpr float kContinuationGain = 0.5F;
/// Greys below this are black here: what is that dark and outside the cube may still be a colour's luminance.
inline constexpr float kContinuationBlack = 0x1p-60F;

}  // namespace spectile::kernels
