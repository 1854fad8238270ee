// Physical constants, with their units.
#pragma once

#include <numbers>
#include <spectile/units.hpp>

namespace spectile {

// Exact by definition. Source: BIPM, The International System of Units, 9th edition, 2019.
inline constexpr ProductOf<RadiantEnergy, Duration> kPlanckConstant{6.62607015e-34};       ///< J s
inline constexpr QuotientOf<Length, Duration> kSpeedOfLight{299792458.0};                  ///< m/s
inline constexpr QuotientOf<RadiantEnergy, Temperature> kBoltzmannConstant{1.380649e-23};  ///< J/K
inline constexpr RadiantEnergy kElectronvolt{1.602176634e-19};                             ///< J

/// Luminous efficacy at the peak of the luminous efficiency function, 683 lm/W. The SI's K_cd is 683 lm/W,
/// exact, at 540 THz: 555.016 nm in air, where y-bar of CIE 1931 is 0.999998. Dividing by that makes K_m
/// 683.002 lm/W at 555 nm; the field, the CIE among it, uses 683, which is 3e-6 less. Source: CIE 018:2019,
/// The Basis of Physical Photometry, 3rd edition.
inline constexpr LuminousEfficacy kMaxLuminousEfficacy{683.0};

/// The root of x = 5 (1 - exp(-x)), and Wien's constant: a black body is brightest, per unit of wavelength,
/// at this divided by its temperature. 2.897771955e-3 m K.
inline constexpr double kWienRoot = 4.965114231744276303;
inline constexpr auto kWienDisplacement = kPlanckConstant * kSpeedOfLight / kBoltzmannConstant / kWienRoot;

/// 2 pi^5 k^4 / (15 h^3 c^2): 5.670374419e-8 W/(m^2 K^4).
inline constexpr auto kStefanBoltzmann =
    2 * std::numbers::pi * std::numbers::pi * std::numbers::pi * std::numbers::pi * std::numbers::pi / 15 *
    (kBoltzmannConstant / kPlanckConstant) * (kBoltzmannConstant / kPlanckConstant) *
    (kBoltzmannConstant / kPlanckConstant) * kBoltzmannConstant / (kSpeedOfLight * kSpeedOfLight);

}  // namespace spectile
