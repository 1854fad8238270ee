// Laws of colour, for drawn inputs: upsampling, projection and relighting are linear where they say so, take
// each lane by itself, and colours come back from where they went.
#include "src/upsampling/method_rows.hpp"
#include "tests/support/drawn_inputs.hpp"

namespace spectile::test {
namespace {

/// Largest magnitude in a method's table.
double largest_basis(const Upsampler& upsampler) {
  double largest = 0;
  for (std::size_t i = 0; i < 8 * upsampler.bands().count(); ++i) {
    largest = std::max(largest, std::abs(double(UpsamplerAccess::table(upsampler)[i])));
  }
  return largest;
}

/// The sum of the magnitudes of the weights of white, secondary and primary.
double sum_of_weights(const ColorLanes& rgb, std::size_t i) {
  const auto [least, most] = std::minmax({rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)});
  return std::abs(double(least)) + double(most) - double(least);
}

/// The sum of the magnitudes of what a projection adds up.
double size_of(const Projector& projector, const SampledSpectra& spectra, std::size_t i, std::size_t k) {
  double size = 0;
  for (std::size_t b = 0; b < spectra.axis().count(); ++b) {
    size += projector.weights()[b][k] * std::abs(double(spectra.at(i, b)));
  }
  return size;
}

/// Bound of the error of a projection of so many bands, of the sum of magnitudes.
double projection_bound(const Bands& bands) {
  return (static_cast<double>(bands.count()) / 8 + 11) * kU * kHigherOrders;
}

// A sample of a mixture is (w0 white + w1 secondary) + w2 primary: rounded are a weight, its product and at
// most two sums, four roundings. The table's own are the same for both colours.
constexpr double kMixture = 4 * kU * kHigherOrders;

RC_GTEST_PROP(ColorLinearity, MixturesAreHomogeneousWithinTheirRoundings, ()) {
  const auto& upsampler = upsampler_for(drawn_mixture(), drawn_quantity(), drawn_bands(), drawn_negative());
  // Products without rounding: 14 bits by 8.
  const auto rgb = drawn_colors(drawn_lanes(), GridFloats(drawn_random(), -1, 3, 12));
  const auto factor = static_cast<float>(*rc::gen::inRange(1, 256)) * 0.125F;
  const auto plain = upsampled(upsampler, rgb);
  const auto scaled = upsampled(upsampler, each_component(rgb, [&](float v) { return factor * v; }));
  const double largest = largest_basis(upsampler);
  Worst worst;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    const double bound = 2 * kMixture * largest * double(factor) * sum_of_weights(rgb, i);
    for (std::size_t b = 0; b < upsampler.bands().count(); ++b) {
      worst.add(std::abs(scaled.at(i, b) - double(factor) * plain.at(i, b)), bound);
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
}

RC_GTEST_PROP(ColorLinearity, UnboundedSigmoidsAreExactlyHomogeneousForPowersOfTwo, ()) {
  const Quantity quantity = *rc::gen::element(Quantity::kUnbounded, Quantity::kIlluminant);
  const auto& upsampler = upsampler_for(Method::kSigmoid, quantity, drawn_bands());
  const auto rgb = drawn_colors(drawn_lanes(), GridFloats(drawn_random(), 0, 2, 20));
  const float factor = std::ldexp(1.0F, *rc::gen::inRange(-60, 100));
  const auto plain = upsampled(upsampler, rgb);
  const auto scaled = upsampled(upsampler, each_component(rgb, [&](float v) { return factor * v; }));
  const auto want = batch_of(plain.axis(), plain.lanes(),
                             [&](std::size_t i, std::size_t b) { return factor * plain.at(i, b); });
  RC_ASSERT(same_lanes(scaled, want));
}

RC_GTEST_PROP(ColorLinearity, MallettIsAdditiveWithinItsRoundings, ()) {
  const auto& upsampler =
      upsampler_for(Method::kMallett, drawn_quantity(), drawn_bands(), NegativeSamples::kKeep);
  const std::size_t lanes = drawn_lanes();
  const auto x = drawn_colors(lanes, GridFloats(drawn_random(), -1, 3, 20));
  const auto y = drawn_colors(lanes, GridFloats(drawn_random(), -1, 3, 20));
  auto both = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) both.at(i, k) = x.at(i, k) + y.at(i, k);  // exact
  }
  const auto sx = upsampled(upsampler, x);
  const auto sy = upsampled(upsampler, y);
  const auto sum = upsampled(upsampler, both);
  const double largest = largest_basis(upsampler);
  Worst worst;
  for (std::size_t i = 0; i < lanes; ++i) {
    // The error stated for upsampling, three times.
    const double size = sum_of_weights(x, i) + sum_of_weights(y, i) + sum_of_weights(both, i);
    for (std::size_t b = 0; b < upsampler.bands().count(); ++b) {
      worst.add(std::abs(sum.at(i, b) - (double(sx.at(i, b)) + sy.at(i, b))), 6 * kU * largest * size);
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
}

RC_GTEST_PROP(ColorLinearity, ProjectionIsAdditiveUnderEveryLight, ()) {
  const Bands bands = drawn_bands();
  const Projector projector = drawn_projector(bands);
  const std::size_t lanes = drawn_lanes();
  const auto x = drawn_spectra(bands, lanes, GridFloats(drawn_random(), -2, 4, 20));
  const auto y = drawn_spectra(bands, lanes, GridFloats(drawn_random(), -2, 4, 20));
  auto both = *SampledSpectra::create(bands, lanes);
  RC_ASSERT(bool(add(x.view(), y.view(), both.span())));  // exact
  const ColorLanes of[3] = {projected(projector, x), projected(projector, y), projected(projector, both)};
  Worst worst;
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double size =
          size_of(projector, x, i, k) + size_of(projector, y, i, k) + size_of(projector, both, i, k);
      worst.add(std::abs(of[2].at(i, k) - (double(of[0].at(i, k)) + of[1].at(i, k))),
                projection_bound(bands) * size);
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
}

RC_GTEST_PROP(ColorLinearity, RelightingOfMixturesIsHomogeneousWithinItsRoundings, ()) {
  const Bands bands = drawn_bands();
  const auto& upsampler = upsampler_for(drawn_mixture(), Quantity::kUnbounded, bands);
  const Projector projector = drawn_projector(bands);
  const auto relighter = *Relighter::create(upsampler, projector, projector.xyz_to_srgb());
  const auto rgb = drawn_colors(drawn_lanes(), GridFloats(drawn_random(), -1, 3, 12));
  const auto factor = static_cast<float>(*rc::gen::inRange(1, 256)) * 0.125F;
  const auto more = each_component(rgb, [&](float v) { return factor * v; });
  auto plain = *ColorLanes::create(rgb.lanes());
  auto scaled = *ColorLanes::create(rgb.lanes());
  RC_ASSERT(bool(relight(relighter, rgb.view(), plain.span(), drawn_execution())));
  RC_ASSERT(bool(relight(relighter, more.view(), scaled.span(), drawn_execution())));
  const bool three =
      upsampler.method() == Method::kMallett;  // columns, of red, green and blue, with no weights
  Worst worst;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = std::span(RelighterAccess::table(relighter) + 8 * k, 8);
      double size = 0;
      for (std::size_t j = 0; three && j < 3; ++j) size += std::abs(double(rgb.at(i, j)) * row[4 + j]);
      double largest = 0;
      for (const float v : row) largest = std::max(largest, std::abs(double(v)));
      if (!three) size = sum_of_weights(rgb, i) * largest;
      worst.add(std::abs(scaled.at(i, k) - double(factor) * plain.at(i, k)), 2 * kMixture * factor * size);
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
}

RC_GTEST_PROP(ColorLinearity, PermutedColoursGivePermutedSpectraAndRelitColours, ()) {
  const Bands bands = drawn_bands();
  const Method method = drawn_method();
  const Quantity quantity = drawn_quantity();
  const auto& upsampler = upsampler_for(method, quantity, bands, drawn_negative());
  const std::size_t lanes = drawn_lanes();
  const auto order = drawn_order(lanes);
  // The sigmoid's colours that are hard to find are searched together, in lanes of their own.
  const bool wild = lanes < 20 && *rc::gen::arbitrary<bool>();
  const auto rgb = wild ? drawn_colors(lanes, ArbitraryFloat(drawn_random()))
                        : drawn_colors(lanes, GridFloats(drawn_random(), 0, 1, 20));
  const auto mixed = permuted(rgb, order);
  RC_ASSERT(same_lanes(upsampled(upsampler, mixed), permuted(upsampled(upsampler, rgb), order)));
  if (quantity == Quantity::kIlluminant) return;
  const Projector projector = drawn_projector(bands);
  const auto relighter = *Relighter::create(upsampler, projector, projector.xyz_to_srgb());
  auto straight = *ColorLanes::create(lanes);
  auto crossed = *ColorLanes::create(lanes);
  RC_ASSERT(bool(relight(relighter, rgb.view(), straight.span(), drawn_execution())));
  RC_ASSERT(bool(relight(relighter, mixed.view(), crossed.span(), drawn_execution())));
  RC_ASSERT(same_colors(crossed, permuted(straight, order)));
}

RC_GTEST_PROP(ColorLinearity, PermutedSpectraGivePermutedColours, ()) {
  const Bands bands = drawn_bands();
  const Projector projector = drawn_projector(bands);
  const std::size_t lanes = drawn_lanes();
  const auto order = drawn_order(lanes);
  const auto spectra = drawn_spectra(bands, lanes, ArbitraryFloat(drawn_random()));
  RC_ASSERT(same_colors(projected(projector, permuted(spectra, order)),
                        permuted(projected(projector, spectra), order)));
}

RC_GTEST_PROP(ColorLinearity, ExpandedCoefficientsAreTheBitsOfUpsampling, ()) {
  const auto& upsampler = upsampler_for(drawn_method(), drawn_quantity(), drawn_bands(), drawn_negative());
  const std::size_t lanes = drawn_lanes();
  const auto rgb = lanes < 20 ? drawn_colors(lanes, ArbitraryFloat(drawn_random()))
                              : drawn_colors(lanes, GridFloats(drawn_random(), 0, 1, 20));
  auto found = *CoefficientLanes::create(upsampler, lanes);
  auto expanded = *SampledSpectra::create(upsampler.bands(), lanes);
  RC_ASSERT(bool(coefficients(upsampler, rgb.view(), found, drawn_execution())));
  RC_ASSERT(bool(expand(upsampler, found, expanded.span(), StoreHint::kAuto, drawn_execution())));
  RC_ASSERT(same_lanes(expanded, upsampled(upsampler, rgb)));
}

RC_GTEST_PROP(ColorLinearity, ColoursOfTheCubeComeBackFromExactMethods, ()) {
  const auto& upsampler = upsampler_for(drawn_exact(), Quantity::kReflectance, drawn_bands());
  const auto rgb = drawn_colors(drawn_lanes(), GridFloats(drawn_random(), 0, 1, 24));
  const auto projector = *Projector::reflective(upsampler.bands(), *illuminant("D65"));
  const auto xyz = projected(projector, upsampled(upsampler, rgb));
  auto back = *ColorLanes::create(rgb.lanes());
  RC_ASSERT(bool(transform(projector.xyz_to_srgb(), xyz.view(), back.span())));
  Worst worst;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      // The methods' page: 7.2e-7 on its grid, 7e-7 through float sums, and the matrix in float here.
      worst.add(std::abs(double(back.at(i, k)) - rgb.at(i, k)), 1e-6);
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
}

RC_GTEST_PROP(ColorLinearity, XyzAndSrgbComeBackFromEachOtherWithinTheirRoundings, ()) {
  const auto first = drawn_colors(drawn_lanes(), GridFloats(drawn_random(), -4, 16, 16));
  for (const bool from_rgb : {true, false}) {
    auto there = *ColorLanes::create(first.lanes());
    auto back = *ColorLanes::create(first.lanes());
    const auto go = from_rgb ? &srgb_to_xyz : &xyz_to_srgb;
    const auto return_ = from_rgb ? &xyz_to_srgb : &srgb_to_xyz;
    RC_ASSERT(bool(go(first.view(), there.span(), drawn_execution())));
    RC_ASSERT(bool(return_(there.view(), back.span(), drawn_execution())));
    const Matrix3& m = from_rgb ? srgb_to_xyz_matrix() : xyz_to_srgb_matrix();
    const Matrix3& inverse_of_m = from_rgb ? xyz_to_srgb_matrix() : srgb_to_xyz_matrix();
    Worst worst;
    for (std::size_t i = 0; i < first.lanes(); ++i) {
      double size[3] = {};
      for (std::size_t k = 0; k < 9; ++k) size[k / 3] += std::abs(m[k] * double(first.at(i, k % 3)));
      for (std::size_t k = 0; k < 3; ++k) {
        // Each way: a matrix entry, its product and two sums, rounded.
        double bound = 0;
        for (std::size_t j = 0; j < 3; ++j) bound += 8 * kU * std::abs(inverse_of_m[3 * k + j]) * size[j];
        worst.add(std::abs(double(back.at(i, k)) - first.at(i, k)), bound * kHigherOrders);
      }
    }
    RC_ASSERT(worst.ratio() <= 1.0);
  }
}

}  // namespace
}  // namespace spectile::test
