// CIELAB and the CIEDE2000 colour difference.
#pragma once

#include <array>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <vector>

namespace spectile {

/// A colour in CIELAB: lightness L* (0 black, 100 white), a* (green to red), b* (blue to yellow).
struct Lab {
  double l = 0;
  double a = 0;
  double b = 0;
};

/// Converts XYZ to CIELAB relative to a white.
/// Units: xyz and white in one scale, whichever; what equals the white is exactly (100, 0, 0), zero exactly
/// (0, 0, 0).
/// Numbers: ratios to the white up to 216/24389, negative ones too, are on the straight line with the slope
/// 24389/27 in lightness, so L* may be negative; over 1, L* is over 100. NaN and infinities go through. A
/// component of zero in the white is not caught: the division makes an infinity or NaN of it.
/// Source: CIE 015:2018; ISO/CIE 11664-4:2019.
Lab xyz_to_lab(const std::array<double, 3>& xyz, const std::array<double, 3>& white);

/// The CIEDE2000 difference of two colours, with kL = kC = kH = 1.
/// Units: 1 is about what an observer just notices under the formula's reference conditions.
/// Numbers: in double. Never negative; exactly 0 for equal colours; exactly the same both ways round. A
/// colour without chroma has no hue, whatever the signs of its zeros: others differ from it in lightness
/// and chroma only. Hues exactly opposite average without a turn, as the source has it; there, the formula
/// itself jumps. Negative lightness is taken as it is. NaN or an infinity in any component gives NaN;
/// finite components beyond 1e40 may overflow, to NaN or infinity.
/// Source: Sharma, Wu and Dalal, "The CIEDE2000 color-difference formula: implementation notes,
/// supplementary test data, and mathematical observations", Color Research and Application 30(1), 2005,
/// pages 21 to 30; CIE 142-2001.
double ciede2000(const Lab& reference, const Lab& sample);

/// The CIEDE2000 difference of each lane of two batches of XYZ colours under a common white.
/// Shapes: xyz_a and xyz_b three times [lanes]; difference [lanes], which may be one of their planes; its
/// padding stays as it was.
/// Units: colours and white in one scale, whichever; differences as in the function above.
/// Numbers: each lane as xyz_to_lab() and the function above in double, rounded once to float. The bits
/// depend neither on threads nor on tiles, but on the C library's cube root, arc tangent, sine, cosine and
/// exponential. NaN or an infinity in a lane makes that lane NaN, and no other; zero and negative colours
/// are colours like any other.
/// Errors: kSizeMismatch; kBadArgument when a component of the white is not finite and above 0, or samples
/// do not start at a multiple of 64 bytes.
/// Source: as for the two functions above.
Result<void> ciede2000(ColorView xyz_a, ColorView xyz_b, const std::array<double, 3>& white,
                       LanesSpan difference, const Execution& execution = {});

/// Statistics of colour differences against a reference. Units: CIEDE2000.
struct ColorError {
  double mean = 0;
  double percentile95 = 0;  ///< smallest that at least 95 of 100 differences do not exceed
  double maximum = 0;
};

/// Mean, 95th percentile and maximum of colour differences; zeros for none.
ColorError summarize(std::vector<double> differences);

}  // namespace spectile
