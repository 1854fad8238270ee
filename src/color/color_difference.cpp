// CIELAB and CIEDE2000, in double, one pair of colours at a time and over batches.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <spectile/color/color_difference.hpp>

#include "src/base/statistics.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

// CIE 015:2018: (6/29)^3, up to where CIELAB is straight, and (29/3)^3, the slope of lightness there. As
// rationals, both pieces meet at L* = 8; the decimals 0.008856 and 903.3 of older texts leave a gap.
constexpr double kEpsilon = 216.0 / 24389.0;
constexpr double kKappa = 24389.0 / 27.0;

// CIE 142-2001: chroma's weights turn over around 25; its seventh power is 6103515625.
constexpr double kTurnoverChroma = 25.0;

double seventh_power(double v) {
  const double cube = v * v * v;
  return cube * cube * v;
}

/// sqrt(c^7 / (c^7 + 25^7)), from 0 for greys to 1 for vivid colours.
double vividness(double chroma) {
  const double c7 = seventh_power(chroma);
  return std::sqrt(c7 / (c7 + seventh_power(kTurnoverChroma)));
}

double radians(double degrees) {
  return degrees * (std::numbers::pi / 180.0);
}

/// Lightness of a ratio to the white. By itself, and not as 116 f - 16, so that it is exactly 0 for 0.
double lightness(double ratio) {
  return ratio > kEpsilon ? 116.0 * std::cbrt(ratio) - 16.0 : kKappa * ratio;
}

/// CIE 015's f: the cube root and, up to kEpsilon, its straight continuation.
double compressed(double ratio) {
  return ratio > kEpsilon ? std::cbrt(ratio) : (kKappa * ratio + 16.0) / 116.0;
}

/// A colour with a* stretched near the grey axis: the primed quantities of the source.
struct Polar {
  double a, b, chroma;
  double hue;  // degrees from 0 to 360; means nothing without chroma
};

Polar polar(const Lab& color, double stretch) {
  Polar p{stretch * color.a, color.b, 0, 0};
  p.chroma = std::sqrt(p.a * p.a + p.b * p.b);
  p.hue = std::atan2(p.b, p.a) * (180.0 / std::numbers::pi);
  if (p.hue < 0) p.hue += 360.0;
  return p;
}

/// Exactly half a turn apart. Told by the coordinates: the difference of two rounded angles may come out
/// above 180, and the formula jumps there.
bool opposite(const Polar& p, const Polar& q) {
  return p.a * q.b - p.b * q.a == 0 && p.a * q.a + p.b * q.b < 0;
}

struct Hues {
  double difference;  // degrees, the short way round, -180 to 180
  double mean;        // degrees
};

/// The source's equations 10 and 14, without their cases for colours that have no chroma: the hue difference
/// counts with the root of both chromas, then 0, and the mean hue only with the hue difference.
Hues compare_hues(const Polar& p, const Polar& q) {
  const double sum = p.hue + q.hue;
  const double difference = q.hue - p.hue;
  if (!(std::abs(difference) > 180.0) || opposite(p, q)) return {difference, sum / 2};
  return {difference > 0 ? difference - 360.0 : difference + 360.0,
          (sum < 360.0 ? sum + 360.0 : sum - 360.0) / 2};
}

/// T: how much hues weigh around the hue circle. The source's equation 15.
double hue_weight(double hue) {
  return 1.0 - 0.17 * std::cos(radians(hue - 30.0)) + 0.24 * std::cos(radians(2.0 * hue)) +
         0.32 * std::cos(radians(3.0 * hue + 6.0)) - 0.20 * std::cos(radians(4.0 * hue - 63.0));
}

/// R_T: the tilt of the ellipses of equal difference among blues. The source's equations 16, 17 and 21.
double rotation(double hue, double chroma) {
  const double from_blue = (hue - 275.0) / 25.0;
  const double angle = 30.0 * std::exp(-(from_blue * from_blue));
  return -std::sin(radians(2.0 * angle)) * (2.0 * vividness(chroma));
}

}  // namespace

Lab xyz_to_lab(const std::array<double, 3>& xyz, const std::array<double, 3>& white) {
  const double fx = compressed(xyz[0] / white[0]);
  const double fy = compressed(xyz[1] / white[1]);
  const double fz = compressed(xyz[2] / white[2]);
  return {lightness(xyz[1] / white[1]), 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

double ciede2000(const Lab& reference, const Lab& sample) {
  // The source's equations 2 to 7: chroma and hue with a* stretched by up to a half where colours are grey.
  const double plain_chroma = (std::sqrt(reference.a * reference.a + reference.b * reference.b) +
                               std::sqrt(sample.a * sample.a + sample.b * sample.b)) /
                              2;
  const double stretch = 1.0 + 0.5 * (1.0 - vividness(plain_chroma));
  const Polar p = polar(reference, stretch);
  const Polar q = polar(sample, stretch);
  const Hues hues = compare_hues(p, q);

  // Equations 8 to 13: differences and means.
  const double dl = sample.l - reference.l;
  const double dc = q.chroma - p.chroma;
  const double dh = 2.0 * std::sqrt(p.chroma * q.chroma) * std::sin(radians(hues.difference) / 2);
  const double chroma = (p.chroma + q.chroma) / 2;
  const double from_grey = (reference.l + sample.l) / 2 - 50.0;
  const double from_grey2 = from_grey * from_grey;

  // Equations 18 to 20 and 22: each difference in units of its weight, and their sum.
  const double l = dl / (1.0 + 0.015 * from_grey2 / std::sqrt(20.0 + from_grey2));
  const double c = dc / (1.0 + 0.045 * chroma);
  const double h = dh / (1.0 + 0.015 * chroma * hue_weight(hues.mean));
  // Not negative: |R_T| is at most 2 sin 60 degrees, which is below 2.
  return std::sqrt(l * l + c * c + h * h + rotation(hues.mean, chroma) * (c * h));
}

Result<void> ciede2000(ColorView xyz_a, ColorView xyz_b, const std::array<double, 3>& white,
                       LanesSpan difference, const Execution& execution) {
  SPECTILE_TRY(shape::same_lanes(xyz_a.lanes, xyz_b.lanes));
  SPECTILE_TRY(shape::same_lanes(xyz_a.lanes, difference.lanes));
  SPECTILE_TRY(shape::aligned(xyz_a));
  SPECTILE_TRY(shape::aligned(xyz_b));
  SPECTILE_TRY(shape::aligned(difference.data));
  for (const double component : white) {
    if (!std::isfinite(component) || !(component > 0)) {
      return make_error(ErrorCode::kBadArgument, "the white {}, {}, {} is not finite and above 0", white[0],
                        white[1], white[2]);
    }
  }
  tiles::for_blocks(blocks_for(difference.lanes), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t end = std::min(difference.lanes, (first + count) * kLanesPerBlock);
    for (std::size_t i = first * kLanesPerBlock; i < end; ++i) {
      const Lab a = xyz_to_lab({xyz_a.c[0][i], xyz_a.c[1][i], xyz_a.c[2][i]}, white);
      const Lab b = xyz_to_lab({xyz_b.c[0][i], xyz_b.c[1][i], xyz_b.c[2][i]}, white);
      difference.data[i] = static_cast<float>(ciede2000(a, b));
    }
  });
  return {};
}

ColorError summarize(std::vector<double> differences) {
  if (differences.empty()) return {};
  std::sort(differences.begin(), differences.end());
  ColorError out;
  for (const double d : differences) out.mean += d / static_cast<double>(differences.size());
  out.percentile95 = percentile(differences, 95);
  out.maximum = differences.back();
  return out;
}

}  // namespace spectile
