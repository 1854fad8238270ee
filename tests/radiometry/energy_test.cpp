// Laws of light, for drawn inputs: reflectances give no energy, white takes none, more light is never darker,
// and nothing is darker than black.
#include <spectile/color/color_difference.hpp>

#include "tests/support/drawn_inputs.hpp"

namespace spectile::test {
namespace {

constexpr Method kBounded[] = {Method::kSmitsExact, Method::kMallett, Method::kSigmoid};

/// The light in every lane.
SampledSpectra lit(const Bands& bands, const std::string& light, std::size_t lanes) {
  return *SampledSpectra::broadcast(bands, lanes, illuminant(light)->average_over(bands));
}

SampledSpectra product_of(const SampledSpectra& a, const SampledSpectra& b) {
  auto out = *SampledSpectra::create(a.axis(), a.lanes());
  RC_ASSERT(bool(multiply(a.view(), b.view(), out.span(), drawn_execution())));
  return out;
}

/// True if no component of any lane is smaller in `more`.
bool none_smaller(const ColorLanes& more, const ColorLanes& less) {
  for (std::size_t i = 0; i < less.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(more.at(i, k) >= less.at(i, k))) return false;
    }
  }
  return true;
}

/// Least and greatest sample.
std::pair<float, float> extremes(const SampledSpectra& spectra) {
  float least = kInf;
  float greatest = -kInf;
  for (std::size_t i = 0; i < spectra.lanes(); ++i) {
    for (std::size_t b = 0; b < spectra.axis().count(); ++b) {
      const float v = spectra.at(i, b);
      least = std::isnan(v) ? -kInf : std::min(least, v);
      greatest = std::max(greatest, v);
    }
  }
  return {least, greatest};
}

/// Colours of the cube, many of them on its faces, edges and grey diagonal.
ColorLanes drawn_cube(std::size_t lanes) {
  GridFloats step(drawn_random(), 0, 1, 24);
  std::mt19937 random = drawn_random();
  auto rgb = drawn_colors(lanes, [&] {
    const std::uint32_t kind = random() % 6;
    return kind == 0 ? 0.0F : kind == 1 ? 1.0F : step();
  });
  for (std::size_t i = 0; i < lanes; i += 7) rgb.at(i, 1) = rgb.at(i, 2) = rgb.at(i, 0);
  return rgb;
}

RC_GTEST_PROP(EnergyConservation, ReflectancesOfTheCubeAreFromZeroToOne, ()) {
  const auto& upsampler =
      upsampler_for(drawn_exact(), Quantity::kReflectance, drawn_bands(), drawn_negative());
  const auto [least, greatest] = extremes(upsampled(upsampler, drawn_cube(drawn_lanes())));
  // Mallett's spectra touch 0 to 1e-7 where negative samples are kept.
  RC_ASSERT(least >= (upsampler.lowest() < 0 ? -1e-7F : 0.0F));
  RC_ASSERT(greatest <= 1.0F);
}

RC_GTEST_PROP(EnergyConservation, NoBounceGainsLuminanceUnderAnyLight, ()) {
  // Exactly: a rounded product with what is not above 1 is not above the other factor, and neither are
  // rounded sums of such.
  const Bands bands = drawn_bands();
  const std::size_t lanes = drawn_lanes();
  const Projector projector = *Projector::emissive(bands, drawn_observer());
  const std::string name = drawn_light();
  const SampledSpectra light = lit(bands, name, lanes);
  SampledSpectra carried = lit(bands, name, lanes);
  const int bounces = *rc::gen::inRange(1, 6);
  std::vector<ColorLanes> alone;
  ColorLanes before = projected(projector, light);
  for (int bounce = 0; bounce < bounces; ++bounce) {
    const auto& upsampler = upsampler_for(drawn_exact(), Quantity::kReflectance, bands);
    const auto reflectance = upsampled(upsampler, drawn_cube(lanes));
    alone.push_back(projected(projector, product_of(reflectance, light)));
    carried = product_of(carried, reflectance);
    ColorLanes now = projected(projector, carried);
    RC_ASSERT(none_smaller(before, now));
    before = std::move(now);
  }
  // Also no more than any one of the reflectances alone gives.
  for (const ColorLanes& one : alone) RC_ASSERT(none_smaller(one, before));
}

RC_GTEST_PROP(EnergyConservation, WhiteTakesNothingHoweverOftenItIsMet, ()) {
  const Bands bands = drawn_bands();
  const std::size_t lanes = drawn_lanes();
  const auto light = lit(bands, drawn_light(), lanes);
  const auto one = each_component(*ColorLanes::create(lanes), [](float) { return 1.0F; });
  for (const Method method : kBounded) {
    const auto white = upsampled(upsampler_for(method, Quantity::kReflectance, bands), one);
    RC_ASSERT(same_lanes(product_of(product_of(light, white), white), light));
  }
}

RC_GTEST_PROP(EnergyConservation, WhiteHasTheWhitesColourUnderEveryLight, ()) {
  const Bands bands = drawn_bands();
  const Projector projector = drawn_projector(bands);
  const std::size_t lanes = drawn_lanes();
  const auto one = each_component(*ColorLanes::create(lanes), [](float) { return 1.0F; });
  const auto xyz = projected(projector, *SampledSpectra::constant(bands, lanes, 1));
  const auto white = projector.white();
  constexpr Matrix3 kSame = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double runs = (static_cast<double>(bands.count()) / 8 + 11) * kU;
  Worst worst;
  for (const Method method : kBounded) {
    const auto& upsampler = upsampler_for(method, Quantity::kReflectance, bands);
    const auto relighter = *Relighter::create(upsampler, projector, kSame);
    auto relit = *ColorLanes::create(lanes);
    RC_ASSERT(bool(relight(relighter, one.view(), relit.span(), drawn_execution())));
    for (std::size_t i = 0; i < lanes; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        worst.add(std::abs(xyz.at(i, k) - white[k]), runs * white[k]);
        // A folded table entry rounded, and three of them summed for mallett; the sigmoid goes the long way.
        const double direct = method == Method::kSigmoid ? runs + kU : 4 * kU * kHigherOrders;
        worst.add(std::abs(relit.at(i, k) - white[k]), direct * white[k]);
      }
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
  RC_ASSERT(std::abs(white[1] - 1) <= 1e-12);
}

/// Greys in two batches, the second's not below the first's; often neighbours.
std::pair<ColorLanes, ColorLanes> drawn_greys(std::size_t lanes) {
  GridFloats step(drawn_random(), 0, 1, 24);
  std::mt19937 random = drawn_random();
  auto dark = *ColorLanes::create(lanes);
  auto light = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    const float a = step();
    const float b = random() % 2 == 0 ? std::min(1.0F, std::nextafter(a, kInf)) : step();
    for (std::size_t k = 0; k < 3; ++k) dark.at(i, k) = std::min(a, b);
    for (std::size_t k = 0; k < 3; ++k) light.at(i, k) = std::max(a, b);
  }
  return {std::move(dark), std::move(light)};
}

RC_GTEST_PROP(EnergyConservation, LighterGreysHaveNoSmallerSamplesInMixtures, ()) {
  const auto& upsampler = upsampler_for(drawn_mixture(), drawn_quantity(), drawn_bands());
  const auto [dark, light] = drawn_greys(drawn_lanes());
  const auto low = upsampled(upsampler, dark);
  const auto high = upsampled(upsampler, light);
  float fall = 0;
  for (std::size_t i = 0; i < low.lanes(); ++i) {
    for (std::size_t b = 0; b < low.axis().count(); ++b) fall = std::max(fall, low.at(i, b) - high.at(i, b));
  }
  RC_ASSERT(fall == 0.0F);
}

RC_GTEST_PROP(EnergyConservation, LighterGreysHaveNoSmallerSamplesButRoundingInSigmoids, ()) {
  const Quantity quantity = drawn_quantity();
  const auto& upsampler = upsampler_for(Method::kSigmoid, quantity, drawn_bands());
  const auto [dark, light] = drawn_greys(drawn_lanes());
  const auto low = upsampled(upsampler, dark);
  const auto high = upsampled(upsampler, light);
  // Of a grey z: x = (z - 1/2) / sqrt(z (1 - z)) is off by 4 u, which moves the sample by x / (2 (1 +
  // x^2)^1.5)
  // <= 0.193 of that; its evaluation by 2^-23. With a scale the sample is 1/2, z off by 2 u of that, and two
  // products follow.
  constexpr double kShape = (4 * 0.193 + 2) * kU * kHigherOrders;
  Worst worst;
  for (std::size_t i = 0; i < low.lanes(); ++i) {
    for (std::size_t b = 0; b < low.axis().count(); ++b) {
      const double fall = std::max(0.0, double(low.at(i, b)) - high.at(i, b));
      const double scaled = 2 * ((kShape + kU) / 0.5 + 2 * kU) * low.at(i, b);
      worst.add(fall, quantity == Quantity::kReflectance ? 2 * kShape : scaled);
    }
  }
  RC_ASSERT(worst.ratio() <= 1.0);
}

RC_GTEST_PROP(EnergyConservation, LargerColoursHaveNoLessLuminance, ()) {
  const auto& upsampler = upsampler_for(drawn_exact(), Quantity::kReflectance, drawn_bands());
  const std::size_t lanes = drawn_lanes();
  const auto dark = drawn_colors(lanes, GridFloats(drawn_random(), 0, 1, 24));
  const auto other = drawn_colors(lanes, GridFloats(drawn_random(), 0, 1, 24));
  auto light = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) light.at(i, k) = std::max(dark.at(i, k), other.at(i, k));
  }
  const auto projector = *Projector::reflective(upsampler.bands(), *illuminant("D65"));
  const auto low = projected(projector, upsampled(upsampler, dark));
  const auto high = projected(projector, upsampled(upsampler, light));
  double fall = 0;
  // The weights of R, G and B in Y are not negative and sum to 1, and each colour is within 1e-6 of its own.
  for (std::size_t i = 0; i < lanes; ++i) fall = std::max(fall, double(low.at(i, 1)) - high.at(i, 1));
  RC_ASSERT(fall <= 2e-6);
}

RC_GTEST_PROP(EnergyConservation, MoreInEveryBandIsNoDarker, ()) {
  // Exactly, of any sign: products with what is not negative, and sums, round to no less where they are no
  // less.
  const Bands bands = drawn_bands();
  const Projector projector = drawn_projector(bands);
  const std::size_t lanes = drawn_lanes();
  auto less = drawn_spectra(bands, lanes, GridFloats(drawn_random(), -4, 16, 20));
  std::mt19937 random = drawn_random();
  const auto more = batch_of(bands, lanes, [&](std::size_t i, std::size_t b) {
    const float v = less.at(i, b);
    return random() % 3 == 0 ? std::nextafter(v, kInf) : random() % 2 == 0 ? v : v + 0x1p-20F;
  });
  const auto dark = projected(projector, less);
  const auto light = projected(projector, more);
  RC_ASSERT(none_smaller(light, dark));
  auto y = *ScalarLanes::create(lanes);
  RC_ASSERT(bool(luminance(projector, more.view(), y.span(), drawn_execution())));
  bool same = true;
  for (std::size_t i = 0; i < lanes; ++i) same = same && same_bits(y[i], light.at(i, 1));
  RC_ASSERT(same);
}

RC_GTEST_PROP(EnergyConservation, SpectraThatAreNotNegativeHaveNoNegativeColour, ()) {
  const Bands bands = drawn_bands();
  const Projector projector = drawn_projector(bands);
  ArbitraryFloat wild(drawn_random());
  const auto spectra = drawn_spectra(bands, drawn_lanes(), [&] {
    const float v = std::abs(wild());
    return v <= kMost ? v : 0.0F;
  });
  const auto xyz = projected(projector, spectra);
  RC_ASSERT(none_smaller(xyz, *ColorLanes::create(xyz.lanes())));
}

RC_GTEST_PROP(EnergyConservation, GreysRiseInLightnessAndInDistance, ()) {
  // Of a white that is 1 throughout, so that greys have no chroma at all. Their difference is the lightness'
  // over 1 + 0.015 t^2 / sqrt(20 + t^2), t being the mean less 50, whose slope is below 0.0164: a light that
  // goes away on one side always gets farther.
  const std::size_t lanes = drawn_lanes();
  std::mt19937 random = drawn_random();
  std::uniform_int_distribution<int> level(0, 1 << 20);
  ColorLanes grey[3] = {*ColorLanes::create(lanes), *ColorLanes::create(lanes), *ColorLanes::create(lanes)};
  bool rises = true;
  for (std::size_t i = 0; i < lanes; ++i) {
    int at[3] = {level(random), level(random), level(random)};
    if (i % 2 == 0) at[2] = at[1] + 1;  // neighbours
    std::sort(std::begin(at), std::end(at));
    Lab lab[3];
    for (std::size_t g = 0; g < 3; ++g) {
      const float value = static_cast<float>(at[g]) * 0x1p-20F;
      for (std::size_t k = 0; k < 3; ++k) grey[g].at(i, k) = value;
      lab[g] = xyz_to_lab({value, value, value}, {1, 1, 1});
      rises = rises && lab[g].a == 0 && lab[g].b == 0;
      if (g > 0) rises = rises && (at[g] > at[g - 1] ? lab[g].l > lab[g - 1].l : lab[g].l == lab[g - 1].l);
    }
  }
  RC_ASSERT(rises);
  auto near = *ScalarLanes::create(lanes);
  auto far = *ScalarLanes::create(lanes);
  RC_ASSERT(bool(ciede2000(grey[0].view(), grey[1].view(), {1, 1, 1}, near.span(), drawn_execution())));
  RC_ASSERT(bool(ciede2000(grey[0].view(), grey[2].view(), {1, 1, 1}, far.span(), drawn_execution())));
  bool farther = true;
  for (std::size_t i = 0; i < lanes; ++i) farther = farther && near[i] >= 0 && far[i] >= near[i];
  RC_ASSERT(farther);
}

}  // namespace
}  // namespace spectile::test
