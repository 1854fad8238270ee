// Constants and the treatment of the exponent shared by every form of exp and pow.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace spectile::kernels {

inline constexpr double kLn2 = 0.6931471805599453094;
inline constexpr double kLog2E = 1.4426950408889634074;
inline constexpr double kTwoOverLn2 = 2.8853900817779268147;
inline constexpr double kSqrt2 = 1.4142135623730950488;
// 1.5 * 2^52: adding it to a double of magnitude below 2^51 rounds to the nearest integer.
inline constexpr double kRoundMagic = 6755399441055744.0;
inline constexpr double kTwo52PlusBias = 4503599627370496.0 + 1023.0;
inline constexpr std::uint64_t kTwo52Bits = 0x4330000000000000U;
inline constexpr std::uint64_t kOneBits = 0x3FF0000000000000U;
inline constexpr std::uint64_t kMantissaMask = 0x000FFFFFFFFFFFFFU;
// Beyond float's range in both directions, inside double's.
inline constexpr double kExponentLimit = 1000.0;

// Taylor series of e^x: 12 terms leave less than 7e-15 for |x| <= ln(2)/2.
inline constexpr std::size_t kExpTerms = 12;
inline constexpr double kExpSeries[kExpTerms] = {
    1.0,         1.0,          1.0 / 2.0,     1.0 / 6.0,      1.0 / 24.0,      1.0 / 120.0,
    1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0, 1.0 / 39916800.0};

// Taylor series of atanh(s)/s in s^2: 9 terms leave less than 1e-15 for |s| <= (sqrt(2)-1)/(sqrt(2)+1).
inline constexpr std::size_t kAtanhTerms = 9;
inline constexpr double kAtanhSeries[kAtanhTerms] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0, 1.0 / 9.0,
                                                     1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0};

// The same in float. 1.5 * 2^23 rounds magnitudes below 2^22 to the nearest integer; the series of (e^t - 1 -
// t) / t^2 up to t^5 leaves a quarter of a rounding of e^t - 1 for |t| <= ln(2)/2.
inline constexpr float kRoundMagicFloat = 12582912.0F;
inline constexpr std::uint32_t kRoundMagicFloatBits = 0x4B400000U;
inline constexpr float kLn2Float = 0.693147181F;
inline constexpr std::size_t kPlanckTerms = 6;
inline constexpr float kPlanckSeries[kPlanckTerms] = {1.0F / 2,   1.0F / 6,   1.0F / 24,
                                                      1.0F / 120, 1.0F / 720, 1.0F / 5040};
// Exponents from here on give 0: 2^-252 is below every float, whatever finite factor it has.
inline constexpr float kPlanckLimit = 252.0F;
inline constexpr float kPlanckUnit = 1024.0F;  // nm
// Longest wavelength in that unit: far beyond where there is no light left, and divisions by it are no zeros.
inline constexpr float kPlanckLongest = 0x1p90F;

// e^r in float. ln 2 in two parts, the first of nine bits, whose product with an exponent is exact; the
// series of (e^r - 1 - r) / r^2, of the least largest error for |r| <= ln(2)/2, leaves a twentieth of 2^-24
// of e^r.
inline constexpr float kLog2EFloat = 1.44269504F;
inline constexpr float kLn2HighFloat = 0.693359375F;
inline constexpr float kLn2LowFloat = -2.12194440e-4F;
inline constexpr std::size_t kExpFloatTerms = 5;
inline constexpr float kExpFloatSeries[kExpFloatTerms] = {0x1.fffffcp-2F, 0x1.55549p-3F, 0x1.5558f4p-5F,
                                                          0x1.123a6cp-7F, 0x1.6a2352p-10F};
inline constexpr float kExpFloatLimit = 150.0F;  // beyond the range of float both ways
// The upper twelve bits of a mantissa: products of such halves are exact.
inline constexpr std::uint32_t kUpperHalf = 0xFFFFF000U;

/// An exponent y and its results for special values of the base, as C's pow defines them (C17 7.12.7.4,
/// F.10.4.4).
struct PowExponent {
  double factor;      ///< y, with infinities replaced by a finite number beyond every range
  bool zero;          ///< y is +0 or -0: the result is 1 whatever the base
  bool nan;           ///< y is NaN: the result is NaN, but for a base of 1
  bool integer;       ///< a negative base has a real result
  bool odd;           ///< ... which is negative
  float at_zero;      ///< result at |base| = 0
  float at_infinity;  ///< result at |base| = infinity

  // Always inlined: one definition per instruction set must not be merged with another's.
  __attribute__((always_inline)) explicit PowExponent(float y) noexcept {
    const bool infinite = __builtin_isinf(y);
    nan = __builtin_isnan(y);
    zero = y == 0.0F;
    factor = infinite ? (y < 0 ? -1e30 : 1e30) : static_cast<double>(y);
    const float magnitude = __builtin_fabsf(y);
    // Every float of 2^24 and more is an even integer; below, the conversion is exact.
    const bool large = magnitude >= 16777216.0F;
    const std::int32_t whole = large || nan ? 0 : static_cast<std::int32_t>(magnitude);
    integer = large || (!nan && static_cast<float>(whole) == magnitude);
    odd = integer && !large && (whole & 1) != 0;
    at_zero = y < 0 ? __builtin_inff() : 0.0F;
    at_infinity = y < 0 ? 0.0F : __builtin_inff();
  }
};

}  // namespace spectile::kernels
