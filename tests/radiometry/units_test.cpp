// Quantities with units: what compiles, what must not, and the numbers.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <concepts>
#include <cstdlib>
#include <limits>
#include <spectile/units.hpp>
#include <type_traits>

#include "tests/radiometry/drawn_numbers.hpp"

namespace spectile::test {
namespace {

template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
}
|| requires(A a, B b) {
  a - b;
}
|| requires(A a, B b) {
  a += b;
};
template <class A, class B>
concept Comparable = requires(A a, B b) {
  a < b;
}
|| requires(A a, B b) {
  a == b;
};

// Of one unit: yes. Of different units, or with plain numbers: does not compile.
static_assert(Addable<Radiance, Radiance> && Comparable<Radiance, Radiance>);
static_assert(!Addable<Radiance, Irradiance> && !Comparable<Radiance, Irradiance>);
static_assert(!Addable<Radiance, SpectralRadiance> && !Comparable<Radiance, SpectralRadiance>);
static_assert(!Addable<Radiance, Luminance> && !Comparable<Radiance, Luminance>);
static_assert(!Addable<RadiantIntensity, LuminousIntensity>);
static_assert(!Addable<LuminousFlux, LuminousIntensity>);
static_assert(!Addable<Length, Wavelength>);
static_assert(!Addable<Radiance, double> && !Addable<double, Radiance> && !Comparable<Radiance, double>);
static_assert(!std::convertible_to<double, Radiance> && !std::convertible_to<Radiance, double>);
static_assert(!std::constructible_from<Radiance, Irradiance>);
static_assert(!std::assignable_from<Radiance&, Irradiance>);

// Units of products and ratios.
static_assert(std::same_as<decltype(Radiance() * SolidAngle()), Irradiance>);
static_assert(std::same_as<decltype(Irradiance() * Area()), RadiantFlux>);
static_assert(std::same_as<decltype(RadiantFlux() / Area() / SolidAngle() / Wavelength()), SpectralRadiance>);
static_assert(std::same_as<decltype(RadiantIntensity() / Area()), Radiance>);
static_assert(std::same_as<decltype(RadiantFlux() * LuminousEfficacy()), LuminousFlux>);
static_assert(std::same_as<decltype(Radiance() * LuminousEfficacy()), Luminance>);
static_assert(std::same_as<decltype(LuminousIntensity() / Area()), Luminance>);
static_assert(std::same_as<decltype(SpectralIrradiance() * Wavelength()), Irradiance>);
static_assert(std::same_as<decltype(RadiantEnergy() / Duration()), RadiantFlux>);
static_assert(std::same_as<decltype(RadiantFlux() / RadiantEnergy()), Rate>);
static_assert(std::same_as<decltype(Radiance() / Radiance()), double>);
static_assert(std::same_as<decltype(1.0 / Duration()), Rate>);
static_assert(std::same_as<decltype(1.0 / Rate()), Duration>);
static_assert(std::same_as<decltype(Rate() * Duration()), double>);

// All of it at compile time, and no larger than the number.
static_assert((3.0 * kWatt / kSquareMetre + Irradiance(1)).value() == 4);
static_assert(5 * kLumen / kSteradian == 5 * kCandela);
static_assert(sizeof(Radiance) == sizeof(double) && std::is_trivially_copyable_v<Radiance>);

TEST(Units, AsText) {
  EXPECT_EQ(to_text(SpectralRadiance::unit()), "W m^-2 sr^-1 nm^-1");
  EXPECT_EQ(to_text(RadiantEnergy::unit()), "W s");
  EXPECT_EQ(to_text(LuminousEfficacy::unit()), "W^-1 lm");
  EXPECT_EQ(to_text(Unit{}), "1");
  EXPECT_EQ(to_text(465.25 * kLux), "465.25 lm m^-2");
  EXPECT_EQ(to_text(Temperature(-0.1)), "-0.1 K");
}

TEST(Units, DefaultIsZero) {
  EXPECT_EQ(Radiance(), Radiance(0));
}

TEST(Units, SpecialNumbersGoThrough) {
  EXPECT_EQ((Radiance(1) / 0).value(), kInfinity);
  EXPECT_EQ((Irradiance(-1) / SolidAngle(0)).value(), -kInfinity);
  EXPECT_EQ((Radiance(1e300) * 1e300).value(), kInfinity);
  const Radiance nan(std::nan(""));
  EXPECT_TRUE(std::isnan((nan + Radiance(1)).value()));
  EXPECT_FALSE(nan == nan);
  EXPECT_FALSE(nan < Radiance(1));
  EXPECT_TRUE(Radiance(-kInfinity) < Radiance(0));
  EXPECT_EQ(Radiance(-0.0), Radiance(0));
}

RC_GTEST_PROP(Units, NumbersAreThoseOfPlainArithmetic, (double a, double b)) {
  const Radiance p(a);
  const Radiance q(b);
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  RC_ASSERT(same((p + q).value(), a + b));
  RC_ASSERT(same((p - q).value(), a - b));
  RC_ASSERT(same((-p).value(), -a));
  RC_ASSERT(same((p * b).value(), a * b));
  RC_ASSERT(same((b * p).value(), a * b));
  RC_ASSERT(same((p / b).value(), a / b));
  RC_ASSERT(same(p / q, a / b));
  RC_ASSERT(same((p * SolidAngle(b)).value(), a * b));
  RC_ASSERT((p < q) == (a < b) && (p == q) == (a == b));
  Radiance r = p;
  RC_ASSERT(same((r += q).value(), a + b));
  RC_ASSERT(same((r -= p).value(), (a + b) - a));
}

}  // namespace
}  // namespace spectile::test
