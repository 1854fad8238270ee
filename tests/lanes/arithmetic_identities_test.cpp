// Laws of arithmetic, for drawn inputs: lanes do not know of each other, functions rise where theirs do, and
// what is undone comes back.
#include "src/dispatch/dispatch.hpp"
#include "tests/support/drawn_inputs.hpp"

namespace spectile::test {
namespace {

using Unary = Result<void> (*)(SampledSpectraView, SampledSpectraSpan, const Execution&);
using Binary = Result<void> (*)(SampledSpectraView, SampledSpectraView, SampledSpectraSpan, const Execution&);

Bands few_bands() {
  return *Bands::uniform(400, 700, 60);
}

template <class Operation>
SampledSpectra result_of(const SampledSpectra& a, Operation operation) {
  auto out = *SampledSpectra::create(a.axis(), a.lanes());
  const Execution execution = drawn_execution();
  RC_ASSERT(bool(operation(out.span(), execution)));
  return out;
}
SampledSpectra unary(Unary f, const SampledSpectra& a) {
  return result_of(a, [&](auto out, const auto& execution) { return f(a.view(), out, execution); });
}
SampledSpectra binary(Binary f, const SampledSpectra& a, const SampledSpectra& b) {
  return result_of(a, [&](auto out, const auto& execution) { return f(a.view(), b.view(), out, execution); });
}
SampledSpectra power(const SampledSpectra& a, float exponent) {
  return result_of(a,
                   [&](auto out, const auto& execution) { return pow(a.view(), exponent, out, execution); });
}

/// Steps of float from a to b; one step over zero.
std::int64_t steps_between(float a, float b) {
  const auto place = [](float v) {
    const auto bits = std::bit_cast<std::int32_t>(v);
    return bits < 0 ? std::int64_t{std::numeric_limits<std::int32_t>::min()} - bits : std::int64_t{bits};
  };
  return place(b) - place(a);
}

/// The most that two batches are apart, in steps of float; NaN is nearest to NaN.
std::int64_t most_steps(const SampledSpectra& a, const SampledSpectra& b) {
  std::int64_t most = 0;
  for (std::size_t i = 0; i < a.lanes(); ++i) {
    for (std::size_t k = 0; k < a.axis().count(); ++k) {
      const float x = a.at(i, k);
      const float y = b.at(i, k);
      if (std::isnan(x) && std::isnan(y)) continue;
      most = std::max(most, std::isnan(x) || std::isnan(y) ? std::numeric_limits<std::int64_t>::max()
                                                           : std::abs(steps_between(x, y)));
    }
  }
  return most;
}

RC_GTEST_PROP(ArithmeticIdentities, PermutedLanesGivePermutedResults, ()) {
  const std::size_t lanes = drawn_lanes();
  const auto order = drawn_order(lanes);
  SampledSpectra in[3] = {drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random())),
                          drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random())),
                          drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random()))};
  const SampledSpectra mixed[3] = {permuted(in[0], order), permuted(in[1], order), permuted(in[2], order)};
  const float number = ArbitraryFloat(drawn_random())();
  const auto all = [&](const SampledSpectra* x) {
    std::vector<SampledSpectra> out;
    for (const Binary f :
         {Binary(&add), Binary(&subtract), Binary(&multiply), Binary(&divide), Binary(&divide_or_zero)}) {
      out.push_back(binary(f, x[0], x[1]));
    }
    for (const Unary f : {Unary(&negate), Unary(&sqrt), Unary(&exp), Unary(&clamp_zero)}) {
      out.push_back(unary(f, x[0]));
    }
    out.push_back(power(x[0], number));
    const auto view = [&](std::size_t i) { return x[i].view(); };
    out.push_back(
        result_of(x[0], [&](auto to, auto& execution) { return scale(view(0), number, to, execution); }));
    out.push_back(result_of(x[0], [&](auto to, auto& execution) {
      return multiply_add(view(0), view(1), view(2), to, execution);
    }));
    out.push_back(result_of(
        x[0], [&](auto to, auto& execution) { return lerp(view(0), view(1), number, to, execution); }));
    out.push_back(
        result_of(x[0], [&](auto to, auto& execution) { return clamp(view(0), -1, 1, to, execution); }));
    return out;
  };
  const auto straight = all(in);
  const auto crossed = all(mixed);
  for (std::size_t f = 0; f < straight.size(); ++f)
    RC_ASSERT(same_lanes(crossed[f], permuted(straight[f], order)));
}

RC_GTEST_PROP(ArithmeticIdentities, PermutedLanesHavePermutedExtremesAndAverages, ()) {
  const std::size_t lanes = drawn_lanes();
  const auto order = drawn_order(lanes);
  const auto a = drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random()));
  const auto mixed = permuted(a, order);
  for (const auto f : {&minimum, &maximum, &average}) {
    auto straight = *ScalarLanes::create(lanes);
    auto crossed = *ScalarLanes::create(lanes);
    RC_ASSERT(bool(f(a.view(), straight.span(), drawn_execution())));
    RC_ASSERT(bool(f(mixed.view(), crossed.span(), drawn_execution())));
    bool same = true;
    for (std::size_t i = 0; i < lanes; ++i) same = same && same_bits(crossed[i], straight[order[i]]);
    RC_ASSERT(same);
  }
}

RC_GTEST_PROP(ArithmeticIdentities, SumsAndProductsCommuteAndDifferencesFlip, ()) {
  const std::size_t lanes = drawn_lanes();
  const auto a = drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random()));
  const auto b = drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random()));
  RC_ASSERT(same_lanes(binary(&add, a, b), binary(&add, b, a)));
  RC_ASSERT(same_lanes(binary(&multiply, a, b), binary(&multiply, b, a)));
  RC_ASSERT(same_lanes(binary(&subtract, a, b), binary(&add, a, unary(&negate, b))));
  // Steps, for the sign of a zero: a - a is +0.
  RC_ASSERT(most_steps(binary(&subtract, a, b), unary(&negate, binary(&subtract, b, a))) == 0);
}

/// Ascending samples: neighbours of float, and any two.
struct Ascending {
  SampledSpectra low, high;
};
Ascending drawn_ascending(std::size_t lanes, float least, float most) {
  auto low = *SampledSpectra::create(few_bands(), lanes);
  auto high = *SampledSpectra::create(few_bands(), lanes);
  std::mt19937 random = drawn_random();
  std::uniform_real_distribution<float> range(least, most);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < low.axis().count(); ++k) {
      // A third over the whole range, a third of any magnitude.
      float a = range(random);
      if (random() % 3 == 0) a = std::ldexp(a, -static_cast<int>(random() % 150));
      const float b = random() % 2 == 0 ? std::nextafter(a, kInf) : std::max(least, range(random));
      low.at(i, k) = std::min(a, b);
      high.at(i, k) = std::max(a, b);
    }
  }
  return {std::move(low), std::move(high)};
}

/// By how many steps results fall where arguments rise, at most; and whether they fall where the function
/// itself rises so much that results within 0.501 ULP cannot: from n - 0.499 on they round to n or more.
template <class Exact>
std::pair<std::int64_t, bool> falls(const Ascending& x, const SampledSpectra& low, const SampledSpectra& high,
                                    Exact exact) {
  std::int64_t most = 0;
  bool clearly = false;
  for (std::size_t i = 0; i < low.lanes(); ++i) {
    for (std::size_t k = 0; k < low.axis().count(); ++k) {
      const float a = low.at(i, k);
      const float b = high.at(i, k);
      if (a <= b) continue;
      most = std::max(most, steps_between(b, a));
      const double ulp = double(std::nextafter(a, kInf)) - double(a);
      clearly = clearly || !(exact(x.high.at(i, k)) - exact(x.low.at(i, k)) < 0.002 * ulp);
    }
  }
  return {most, clearly};
}

RC_GTEST_PROP(ArithmeticIdentities, ExponentialsRise, ()) {
  const auto x = drawn_ascending(drawn_lanes(), -104, 90);
  const auto [most, clearly] =
      falls(x, unary(&exp, x.low), unary(&exp, x.high), [](double v) { return std::exp(v); });
  RC_ASSERT(most <= 1);
  RC_ASSERT(!clearly);
}

RC_GTEST_PROP(ArithmeticIdentities, PowersRise, ()) {
  const float exponent = *rc::gen::element(0.5F, 1.0F / 3, 2.2F, 1 / 2.4F, 1e-3F, 7.0F, 37.25F);
  const auto x = drawn_ascending(drawn_lanes(), 0, 10);
  const auto [most, clearly] = falls(x, power(x.low, exponent), power(x.high, exponent),
                                     [&](double v) { return std::pow(v, double(exponent)); });
  RC_ASSERT(most <= 1);
  RC_ASSERT(!clearly);
}

RC_GTEST_PROP(ArithmeticIdentities, RootsRiseWithoutException, ()) {
  const auto x = drawn_ascending(drawn_lanes(), 0, 1e30F);
  RC_ASSERT(falls(x, unary(&sqrt, x.low), unary(&sqrt, x.high), [](double v) { return v; }).first == 0);
}

RC_GTEST_PROP(ArithmeticIdentities, SumsProductsAndMixturesRiseWithoutException, ()) {
  const std::size_t lanes = drawn_lanes();
  const auto x = drawn_ascending(lanes, -100, 100);
  const auto other = drawn_spectra(few_bands(), lanes, GridFloats(drawn_random(), -50, 50, 16));
  const float t = *rc::gen::element(0.0F, 0.25F, 0.7F, 1.0F);
  const auto exact = [](double v) { return v; };
  RC_ASSERT(falls(x, binary(&add, x.low, other), binary(&add, x.high, other), exact).first == 0);
  const auto mixed = [&](const SampledSpectra& a) {
    return result_of(
        a, [&](auto to, auto& execution) { return lerp(a.view(), other.view(), t, to, execution); });
  };
  RC_ASSERT(falls(x, mixed(x.low), mixed(x.high), exact).first == 0);
  const auto scaled = [&](const SampledSpectra& a) {
    return result_of(a, [&](auto to, auto& execution) { return scale(a.view(), t, to, execution); });
  };
  RC_ASSERT(falls(x, scaled(x.low), scaled(x.high), exact).first == 0);
}

RC_GTEST_PROP(ArithmeticIdentities, PowersAgreeWithProductsDivisionsAndRoots, ()) {
  const std::size_t lanes = drawn_lanes();
  auto a = drawn_spectra(few_bands(), lanes, ArbitraryFloat(drawn_random()));
  const auto one = *SampledSpectra::constant(few_bands(), lanes, 1);
  // An error below 0.501 ULP leaves what float can hold as it is.
  RC_ASSERT(same_lanes(power(a, 1), a));
  RC_ASSERT(same_lanes(power(a, 0), one));
  // Two results within 0.501 and 0.5 ULP of one number are the same or neighbours.
  RC_ASSERT(most_steps(power(a, 2), binary(&multiply, a, a)) <= 1);
  RC_ASSERT(most_steps(power(a, -1), binary(&divide, one, a)) <= 1);
  // Minus infinity has a power, of +infinity, but no root.
  const auto magnitude =
      result_of(a, [&](auto to, auto& execution) { return clamp(a.view(), 0, kInf, to, execution); });
  RC_ASSERT(most_steps(power(magnitude, 0.5F), unary(&sqrt, magnitude)) <= 1);
}

RC_GTEST_PROP(ArithmeticIdentities, FloatsComeBackFromHalfWithinHalfAStep, ()) {
  std::vector<float> values(256);
  ArbitraryFloat arbitrary(drawn_random());
  for (float& v : values) {
    do v = arbitrary();
    while (!(std::abs(v) < 65504));  // NaN and infinities have tests of their own
    if (*rc::gen::inRange(0, 2) == 0)
      v = std::ldexp(std::frexp(v, std::array<int, 1>{}.data()), *rc::gen::inRange(-25, 16));
  }
  std::sort(values.begin(), values.end());
  for (const kernels::KernelTable* table : dispatch::available()) {
    const Floats in((std::span<const float>(values)));
    Floats back(values.size());
    std::vector<std::uint16_t> halves(values.size());
    table->float_to_half(halves.data(), in.data(), values.size());
    table->half_to_float(back.data(), halves.data(), values.size());
    Worst worst;
    bool rises = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Eleven bits, the least of them 2^-24: half of that bit.
      const double step = std::max(0x1p-24, values[i] == 0 ? 0 : std::ldexp(1.0, std::ilogb(values[i]) - 10));
      worst.add(std::abs(double(back[i]) - values[i]), values[i] == 0 ? 0 : step / 2);
      rises = rises && (i == 0 || back[i - 1] <= back[i]);
    }
    RC_ASSERT(worst.ratio() <= 1.0);
    RC_ASSERT(rises);
  }
}

TEST(ArithmeticIdentities, SeedIsSet) {
  EXPECT_EQ(kLawsSeeded, 0);
}

}  // namespace
}  // namespace spectile::test
