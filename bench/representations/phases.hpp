// Phases of wavelengths for moments.
#pragma once

namespace spectile::measure {

/// At 360, 365, ... 830 nm, most of the circle where most is seen; their signs do not matter to a function
/// that is even. Source: the warp published with Peters, Merzbach, Hanika, Dachsbacher, Using Moments to
/// Represent Bounded Signals for Spectral Rendering, ACM Transactions on Graphics 38(4), 2019; here to four
/// decimals.
inline constexpr double kMomentPhases[] = {
    3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1414, 3.1401, 3.1379, 3.1334, 3.1234,
    3.1061, 3.0735, 3.0247, 2.9636, 2.8945, 2.8197, 2.7418, 2.6605, 2.5765, 2.4904, 2.408,  2.3341,
    2.2693, 2.2131, 2.1628, 2.1148, 2.0659, 2.0125, 1.9529, 1.8864, 1.8131, 1.7354, 1.6551, 1.5734,
    1.4908, 1.4075, 1.3238, 1.2397, 1.1554, 1.071,  0.987,  0.903,  0.8191, 0.7355, 0.6533, 0.5739,
    0.4987, 0.4285, 0.3639, 0.305,  0.2519, 0.2053, 0.1654, 0.1314, 0.103,  0.0797, 0.0611, 0.0466,
    0.0354, 0.0271, 0.0211, 0.0167, 0.0135, 0.0111, 0.0095, 0.0084, 0.0076, 0.0069, 0.0064, 0.0059,
    0.0055, 0.0052, 0.0049, 0.0046, 0.0043, 0.0041, 0.0038, 0.0036, 0.0033, 0.0031, 0.0029, 0.0026,
    0.0024, 0.0022, 0.0019, 0.0017, 0.0015, 0.0012, 0.001,  0.0008, 0.0006, 0.0003, -0};

}  // namespace spectile::measure
