// Physical quantities whose units the compiler checks: radiance plus irradiance does not compile.
#pragma once

#include <compare>
#include <string>

namespace spectile {

/// The power to which a unit holds each base unit. The lumen stands for itself (not as candela steradian), so
/// that luminous quantities differ from radiant ones; nanometres of wavelength are not metres of length, so
/// that a spectral quantity's "per nm" does not mix with its "per m^2".
struct Unit {
  int watt = 0;
  int lumen = 0;
  int second = 0;
  int metre = 0;
  int steradian = 0;
  int nanometre = 0;
  int kelvin = 0;
  friend constexpr bool operator==(const Unit&, const Unit&) = default;
};

/// The unit of a product.
constexpr Unit operator*(const Unit& a, const Unit& b) noexcept {
  return {a.watt + b.watt,           a.lumen + b.lumen,         a.second + b.second, a.metre + b.metre,
          a.steradian + b.steradian, a.nanometre + b.nanometre, a.kelvin + b.kelvin};
}
/// The unit of a ratio.
constexpr Unit operator/(const Unit& a, const Unit& b) noexcept {
  return {a.watt - b.watt,           a.lumen - b.lumen,         a.second - b.second, a.metre - b.metre,
          a.steradian - b.steradian, a.nanometre - b.nanometre, a.kelvin - b.kelvin};
}

/// "W m^-2 sr^-1 nm^-1"; "1" where all powers are 0.
std::string to_text(const Unit& unit);

/// A number in a unit. Sums, differences and comparisons are of one unit only; products and ratios have
/// the unit that comes out, and are plain numbers where none is left. Numbers are doubles as IEEE 754 says:
/// one rounding per operation, a zero divisor, NaN and infinities go through. Nothing converts on its own:
/// from a number by the constructor, to one by value().
template <Unit kUnit>
class PhysicalQuantity {
 public:
  static constexpr Unit unit() noexcept { return kUnit; }
  constexpr PhysicalQuantity() noexcept = default;
  explicit constexpr PhysicalQuantity(double value) noexcept : value_(value) {}
  constexpr double value() const noexcept { return value_; }

  constexpr PhysicalQuantity& operator+=(PhysicalQuantity other) noexcept {
    value_ += other.value_;
    return *this;
  }
  constexpr PhysicalQuantity& operator-=(PhysicalQuantity other) noexcept {
    value_ -= other.value_;
    return *this;
  }
  constexpr PhysicalQuantity& operator*=(double factor) noexcept {
    value_ *= factor;
    return *this;
  }
  constexpr PhysicalQuantity& operator/=(double divisor) noexcept {
    value_ /= divisor;
    return *this;
  }
  friend constexpr PhysicalQuantity operator+(PhysicalQuantity a, PhysicalQuantity b) noexcept {
    return a += b;
  }
  friend constexpr PhysicalQuantity operator-(PhysicalQuantity a, PhysicalQuantity b) noexcept {
    return a -= b;
  }
  friend constexpr PhysicalQuantity operator-(PhysicalQuantity a) noexcept {
    return PhysicalQuantity(-a.value_);
  }
  friend constexpr PhysicalQuantity operator*(PhysicalQuantity a, double s) noexcept { return a *= s; }
  friend constexpr PhysicalQuantity operator*(double s, PhysicalQuantity a) noexcept { return a *= s; }
  friend constexpr PhysicalQuantity operator/(PhysicalQuantity a, double s) noexcept { return a /= s; }
  friend constexpr auto operator<=>(PhysicalQuantity, PhysicalQuantity) noexcept = default;
  friend constexpr bool operator==(PhysicalQuantity, PhysicalQuantity) noexcept = default;

 private:
  double value_ = 0;
};

namespace detail {
/// A number in a unit, or a plain number where there is no unit.
template <Unit kUnit>
constexpr auto quantity_or_number(double value) noexcept {
  if constexpr (kUnit == Unit{}) {
    return value;
  } else {
    return PhysicalQuantity<kUnit>(value);
  }
}
}  // namespace detail

template <Unit kA, Unit kB>
constexpr auto operator*(PhysicalQuantity<kA> a, PhysicalQuantity<kB> b) noexcept {
  return detail::quantity_or_number<kA * kB>(a.value() * b.value());
}
template <Unit kA, Unit kB>
constexpr auto operator/(PhysicalQuantity<kA> a, PhysicalQuantity<kB> b) noexcept {
  return detail::quantity_or_number<kA / kB>(a.value() / b.value());
}
template <Unit kA>
constexpr auto operator/(double a, PhysicalQuantity<kA> b) noexcept {
  return detail::quantity_or_number<Unit{} / kA>(a / b.value());
}

namespace detail {
std::string to_text(double value, const Unit& unit);
}  // namespace detail

/// Value and unit: "465.2 lm m^-2", with as many digits as tell the value from all others.
template <Unit kUnit>
std::string to_text(PhysicalQuantity<kUnit> quantity) {
  return detail::to_text(quantity.value(), kUnit);
}

/// The unit of a product of quantities, and of a ratio, as a type.
template <class A, class B>
using ProductOf = decltype(A() * B());
template <class A, class B>
using QuotientOf = decltype(A() / B());

// Base quantities, and what geometry makes of them.
using Length = PhysicalQuantity<Unit{.metre = 1}>;
using Area = ProductOf<Length, Length>;
using Duration = PhysicalQuantity<Unit{.second = 1}>;
using Rate = QuotientOf<double, Duration>;  ///< 1/s: photons, say
using SolidAngle = PhysicalQuantity<Unit{.steradian = 1}>;
using Wavelength = PhysicalQuantity<Unit{.nanometre = 1}>;
using Temperature = PhysicalQuantity<Unit{.kelvin = 1}>;

// Radiant quantities. Source: ISO 80000-7:2019; CIE S 017:2020.
using RadiantFlux = PhysicalQuantity<Unit{.watt = 1}>;         ///< W
using RadiantEnergy = ProductOf<RadiantFlux, Duration>;        ///< J = W s
using RadiantIntensity = QuotientOf<RadiantFlux, SolidAngle>;  ///< W/sr
using Irradiance = QuotientOf<RadiantFlux, Area>;              ///< W/m^2
using RadiantExitance = Irradiance;                            ///< W/m^2, leaving a surface
using RadiantExposure = ProductOf<Irradiance, Duration>;       ///< J/m^2
using Radiance = QuotientOf<Irradiance, SolidAngle>;           ///< W/(m^2 sr)

// Their densities over wavelength.
using SpectralFlux = QuotientOf<RadiantFlux, Wavelength>;            ///< W/nm
using SpectralEnergy = QuotientOf<RadiantEnergy, Wavelength>;        ///< J/nm
using SpectralIntensity = QuotientOf<RadiantIntensity, Wavelength>;  ///< W/(sr nm)
using SpectralIrradiance = QuotientOf<Irradiance, Wavelength>;       ///< W/(m^2 nm)
using SpectralExitance = SpectralIrradiance;                         ///< W/(m^2 nm)
using SpectralRadiance = QuotientOf<Radiance, Wavelength>;           ///< W/(m^2 sr nm)

// Luminous quantities: weighted with what the eye sees.
using LuminousFlux = PhysicalQuantity<Unit{.lumen = 1}>;         ///< lm
using LuminousEnergy = ProductOf<LuminousFlux, Duration>;        ///< lm s
using LuminousIntensity = QuotientOf<LuminousFlux, SolidAngle>;  ///< cd = lm/sr
using Illuminance = QuotientOf<LuminousFlux, Area>;              ///< lx = lm/m^2
using LuminousExitance = Illuminance;                            ///< lm/m^2, leaving a surface
using LuminousExposure = ProductOf<Illuminance, Duration>;       ///< lx s
using Luminance = QuotientOf<Illuminance, SolidAngle>;           ///< cd/m^2
using LuminousEfficacy = QuotientOf<LuminousFlux, RadiantFlux>;  ///< lm/W

// One of each unit, to write quantities with: 3 * kWatt / kSquareMetre.
inline constexpr Length kMetre{1};
inline constexpr Area kSquareMetre{1};
inline constexpr Duration kSecond{1};
inline constexpr SolidAngle kSteradian{1};
inline constexpr Wavelength kNanometre{1};
inline constexpr Temperature kKelvin{1};
inline constexpr RadiantFlux kWatt{1};
inline constexpr RadiantEnergy kJoule{1};
inline constexpr LuminousFlux kLumen{1};
inline constexpr LuminousIntensity kCandela{1};
inline constexpr Illuminance kLux{1};

}  // namespace spectile
