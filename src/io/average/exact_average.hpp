// Exact weighted averages: weights and sums are integers, so no order of adding can matter, and each
// average is rounded once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/result.hpp>
#include <vector>

namespace spectile::exact {

/// An integer of 128 bits.
__extension__ using Wide = unsigned __int128;

/// Weights as whole multiples of one number, which are all that an average needs of them.
struct Weights {
  std::vector<Wide> units;
  Wide total = 0;
  double sum = 0;  ///< of the weights as they were, rounded once
};

/// Finds them. Errors: kBadArgument for weights that are negative or not finite, that are all 0, or so far
/// apart that their sum takes more than 100 bits.
Result<Weights> whole_weights(std::span<const double> weights);

/// How a sum is kept: in how many words of 64 bits, and for which samples and weights they suffice.
enum class Depth {
  kHalf,    ///< 1: samples that are halves, weights' total below 2^22
  kNarrow,  ///< 5: any floats, total below 2^37
  kWide,    ///< 6: any floats, total below 2^100
};

Depth depth_for(bool halves, const Weights& weights) noexcept;
std::size_t words(Depth depth) noexcept;

/// Flags of a sum.
inline constexpr std::uint8_t kOther = 1;    ///< a sample that is not -0 has been added
inline constexpr std::uint8_t kMissing = 2;  ///< a sample that is not finite has been left out

/// Adds units * samples to a row of sums; leaves out samples that are not finite, and says whether there are
/// none. Shapes: sums [n][words], zeros at the start; flags [n], zeros at the start; samples [n].
bool add_row(Depth depth, std::uint64_t* sums, std::uint8_t* flags, const float* samples, std::size_t n,
             Wide units) noexcept;

/// Adds units to `missing` where a sample is not finite. Shapes: missing [n]; samples [n].
void add_missing(Wide* missing, const float* samples, std::size_t n, Wide units) noexcept;

/// The averages: each sum over the total of its weights, rounded to odd, so that rounding them again to
/// float or half gives what rounding the exact average once would. Zero is -0 where every sample was; 0 where
/// all are missing. Shapes: as above; `missing` may be null when nothing is; averages [n].
void finish_row(Depth depth, double* averages, const std::uint64_t* sums, const std::uint8_t* flags,
                const Wide* missing, std::size_t n, Wide total) noexcept;

/// A double, rounded to odd, as a float, rounded to odd, so that rounding that to half rounds once.
float to_odd_float(double value) noexcept;

}  // namespace spectile::exact
