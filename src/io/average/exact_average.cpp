// Exact weighted averages: weights and sums are integers, so no order of adding can matter, and each
// average is rounded once.
#include "src/io/average/exact_average.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"

namespace spectile::exact {
namespace {

// Bits of the weights' total. A sample is at most 2^24 - 1 times 2^0 to 2^253 of the least float; with these
// many bits more a sum stays below 2^319, 2^383, the room of 5 and 6 words with sign, and a product with one
// word, or two. A half is at most 2^40 times the least, so 22 bits more leave room for the sign.
// With 37 and 100 bits, a ratio of 64 and 128 bits has 27 and 28, more than a float needs to be rounded.
constexpr int kHalfBits = 22;
constexpr int kNarrowBits = 37;
constexpr int kWideBits = 100;

// The least float is 2^-149, the least half 2^-24.
constexpr int kFloatGrid = -149;
constexpr int kHalfGrid = -24;

constexpr std::uint32_t kNegativeZero = 0x80000000U;
constexpr std::uint32_t kExponentField = 255;

int bit_width(std::uint64_t v) {
  return std::bit_width(v);
}
int bit_width(Wide v) {
  const auto high = static_cast<std::uint64_t>(v >> 64);
  return high != 0 ? 64 + std::bit_width(high) : std::bit_width(static_cast<std::uint64_t>(v));
}

Wide common_divisor(Wide a, Wide b) {
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/// 2^exponent, for exponents of normal doubles.
double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

/// q, its last bit set when `more` follows it, in at most 53 bits, times 2^exponent.
template <class Term>
double odd_double(Term q, bool more, int exponent) {
  const int surplus = bit_width(q) - std::numeric_limits<double>::digits;
  if (surplus > 0) {
    more = more || (q & ((Term{1} << surplus) - 1)) != 0;
    q >>= surplus;
    exponent += surplus;
  }
  const auto whole = static_cast<std::uint64_t>(q) | (more ? 1U : 0U);
  return static_cast<double>(static_cast<std::int64_t>(whole)) * power_of_two(exponent);
}

/// The leading bits of an integer, as many as Term has, its first one set; the number is `leading`, and
/// what follows when `more` says so, times 2^exponent. Of `count` words, the last is not 0.
template <class Term>
struct Leading {
  Term leading = 0;
  int exponent = 0;
  bool more = false;

  Leading(const std::uint64_t* number, int count) {
    constexpr int kWords = sizeof(Term) / sizeof(std::uint64_t);
    const int zeros = std::countl_zero(number[count - 1]);
    const auto word = [&](int i) { return i >= 0 ? number[i] : std::uint64_t{0}; };
    for (int i = 1; i <= kWords; ++i) {
      const std::uint64_t shifted =
          zeros == 0 ? word(count - i) : word(count - i) << zeros | word(count - i - 1) >> (64 - zeros);
      leading |= static_cast<Term>(shifted) << (64 * (kWords - i));
    }
    more = (word(count - kWords - 1) << zeros) != 0;
    for (int i = count - kWords - 2; i >= 0; --i) more = more || number[i] != 0;
    exponent = 64 * (count - kWords) - zeros;
  }
};

/// sum * 2^grid / total, rounded to odd; the sum is signed and not 0.
template <int kWords, class Term>
double ratio(const std::uint64_t* sum, Term total, int grid) {
  std::uint64_t magnitude[kWords];
  const bool negative = (sum[kWords - 1] >> 63) != 0;
  std::uint64_t carry = negative ? 1 : 0;
  int count = 0;
  for (int i = 0; i < kWords; ++i) {
    magnitude[i] = (negative ? ~sum[i] : sum[i]) + carry;
    carry = carry != 0 && magnitude[i] == 0 ? 1 : 0;
    if (magnitude[i] != 0) count = i + 1;
  }
  const Leading<Term> top(magnitude, count);
  const Term q = top.leading / total;
  const double out =
      odd_double(q, top.more || static_cast<Term>(q * total) != top.leading, top.exponent + grid);
  return negative ? -out : out;
}

/// Carries into the words up to `end`; the sign's carry runs out there.
void carry_into(std::uint64_t* word, const std::uint64_t* end, bool carry, bool negative) {
  for (; carry && word != end; ++word) carry = negative ? (*word)-- == 0 : ++*word == 0;
}

/// The words at `at`, and `at` + 1, plus or minus `term`; whether that carries.
bool add_two(std::uint64_t* at, Wide term, bool negative) {
  const Wide old = static_cast<Wide>(at[1]) << 64 | at[0];
  const Wide now = negative ? old - term : old + term;
  at[0] = static_cast<std::uint64_t>(now);
  at[1] = static_cast<std::uint64_t>(now >> 64);
  return negative ? old < term : now < old;
}

/// sum [words] += or -= term * 2^shift, shift from 0 to 253.
template <int kWords>
void accumulate(std::uint64_t* sum, std::uint64_t term, int shift, bool negative) {
  std::uint64_t* const at = sum + shift / 64;
  const bool carry = add_two(at, static_cast<Wide>(term) << (shift % 64), negative);
  carry_into(at + 2, sum + kWords, carry, negative);
}

template <int kWords>
void accumulate(std::uint64_t* sum, Wide term, int shift, bool negative) {
  // Two halves, the upper one 64 bits on.
  accumulate<kWords>(sum, static_cast<std::uint64_t>(term), shift, negative);
  const auto upper = static_cast<std::uint64_t>(term >> 64);
  if (upper != 0) accumulate<kWords>(sum, upper, shift + 64, negative);
}

template <int kWords, class Term>
bool add_floats(std::uint64_t* sums, std::uint8_t* flags, const float* samples, std::size_t n, Term units) {
  bool finite = true;
  for (std::size_t x = 0; x < n; ++x) {
    const auto bits = std::bit_cast<std::uint32_t>(samples[x]);
    const std::uint32_t field = (bits >> 23) & kExponentField;
    if (field == kExponentField) {
      flags[x] |= kMissing;
      finite = false;
      continue;
    }
    if (bits != kNegativeZero) flags[x] |= kOther;
    const std::uint32_t normal = field != 0 ? 1 : 0;
    const std::uint32_t significand = (bits & 0x7FFFFFU) | normal << 23;
    accumulate<kWords>(sums + x * kWords, significand * units, static_cast<int>(field - normal),
                       (bits >> 31) != 0);
  }
  return finite;
}

bool add_halves(std::uint64_t* sums, std::uint8_t* flags, const float* samples, std::size_t n,
                std::int64_t units) {
  bool finite = true;
  for (std::size_t x = 0; x < n; ++x) {
    const auto bits = std::bit_cast<std::uint32_t>(samples[x]);
    const bool there = ((bits >> 23) & kExponentField) != kExponentField;
    finite = finite && there;
    flags[x] |= !there ? kMissing : bits != kNegativeZero ? kOther : std::uint8_t{0};
    // Exact: every half is a whole multiple of the least one.
    const auto whole = static_cast<std::int64_t>((there ? samples[x] : 0.0F) * 0x1p24F);
    sums[x] += static_cast<std::uint64_t>(whole * units);
  }
  return finite;
}

template <int kWords, class Term>
void finish(double* averages, const std::uint64_t* sums, const std::uint8_t* flags, const Wide* missing,
            std::size_t n, Wide total, int grid) {
  for (std::size_t x = 0; x < n; ++x) {
    const std::uint64_t* const sum = sums + x * kWords;
    const auto there = static_cast<Term>(missing == nullptr ? total : total - missing[x]);
    const bool zero = std::all_of(sum, sum + kWords, [](std::uint64_t word) { return word == 0; });
    if (zero) {
      averages[x] = there != 0 && (flags[x] & kOther) == 0 ? -0.0 : 0.0;
    } else {
      averages[x] = ratio<kWords, Term>(sum, there, grid);
    }
  }
}

}  // namespace

Result<Weights> whole_weights(std::span<const double> weights) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  int grid = std::numeric_limits<int>::max();
  for (const double weight : weights) {
    if (!std::isfinite(weight) || weight < 0) {
      return make_error(ErrorCode::kBadArgument, "weight {} is not a number from 0 on", weight);
    }
    if (weight == 0) continue;
    least = std::min(least, weight);
    most = std::max(most, weight);
    int exponent = 0;
    const auto digits = static_cast<std::uint64_t>(std::ldexp(std::frexp(weight, &exponent), 53));
    grid = std::min(grid, exponent - 53 + std::countr_zero(digits));
  }
  if (most == 0) return make_error(ErrorCode::kBadArgument, "all weights are 0");
  const Error apart = make_error(ErrorCode::kBadArgument, "weights {} and {} are too far apart", least, most);
  Weights out;
  for (const double weight : weights) {
    int exponent = 0;
    const double fraction = std::frexp(weight, &exponent);
    if (weight > 0 && exponent - grid > kWideBits) return apart;
    const int shift = exponent - 53 - grid;
    Wide units = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    units = shift >= 0 ? units << shift : units >> std::min(-shift, 127);
    out.units.push_back(units);
    out.total += units;
    if (bit_width(out.total) > kWideBits) return apart;
  }
  out.sum = std::ldexp(static_cast<double>(out.total), grid);
  if (!std::isfinite(out.sum))
    return make_error(ErrorCode::kBadArgument, "the weights' sum is beyond double");
  Wide divisor = 0;
  for (const Wide units : out.units) divisor = common_divisor(divisor, units);
  for (Wide& units : out.units) units /= divisor;
  out.total /= divisor;
  return out;
}

Depth depth_for(bool halves, const Weights& weights) noexcept {
  const int bits = bit_width(weights.total);
  if (halves && bits <= kHalfBits) return Depth::kHalf;
  return bits <= kNarrowBits ? Depth::kNarrow : Depth::kWide;
}

std::size_t words(Depth depth) noexcept {
  return depth == Depth::kHalf ? 1 : depth == Depth::kNarrow ? 5 : 6;
}

bool add_row(Depth depth, std::uint64_t* sums, std::uint8_t* flags, const float* samples, std::size_t n,
             Wide units) noexcept {
  switch (depth) {
    case Depth::kHalf:
      return add_halves(sums, flags, samples, n, static_cast<std::int64_t>(units));
    case Depth::kNarrow:
      return add_floats<5>(sums, flags, samples, n, static_cast<std::uint64_t>(units));
    case Depth::kWide:
      break;
  }
  return add_floats<6>(sums, flags, samples, n, units);
}

void add_missing(Wide* missing, const float* samples, std::size_t n, Wide units) noexcept {
  for (std::size_t x = 0; x < n; ++x) {
    if (!std::isfinite(samples[x])) missing[x] += units;
  }
}

void finish_row(Depth depth, double* averages, const std::uint64_t* sums, const std::uint8_t* flags,
                const Wide* missing, std::size_t n, Wide total) noexcept {
  switch (depth) {
    case Depth::kHalf:
      return finish<1, std::uint64_t>(averages, sums, flags, missing, n, total, kHalfGrid);
    case Depth::kNarrow:
      return finish<5, std::uint64_t>(averages, sums, flags, missing, n, total, kFloatGrid);
    case Depth::kWide:
      return finish<6, Wide>(averages, sums, flags, missing, n, total, kFloatGrid);
  }
}

float to_odd_float(double value) noexcept {
  const auto nearest = static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  const auto exact = static_cast<double>(nearest);
  if (exact == value || (bits & 1U) != 0) return nearest;
  // The odd one is the value's other neighbour.
  const bool away = std::fabs(exact) < std::fabs(value);
  return std::bit_cast<float>(away ? bits + 1 : bits - 1);
}

}  // namespace spectile::exact
