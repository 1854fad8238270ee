// Laws of the film, for drawn samples: sums do not know in which order or company they were made, the scale
// goes through, and what is not negative stays so.
#include "tests/film/film_support.hpp"
#include "tests/support/drawn_inputs.hpp"

namespace spectile::test {
namespace {

/// A film of wavelengths with every colour and the spectrum.
FilmOptions drawn_film() {
  FilmOptions o = small_film();
  o.xyz = drawn_observer();
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 30);
  o.statistics = PixelStatistics::kVariance;
  if (*rc::gen::inRange(0, 3) == 0) {
    o.placement = SamplePlacement::kSplat;
    o.filter = *PixelFilter::gaussian(1.5, 1.25, 0.5);  // nowhere below 0
  }
  return o;
}

const std::vector<FilmLayer>& layers() {
  static const std::vector<FilmLayer> all = {FilmLayer::kXyz,    FilmLayer::kLuminance,
                                             FilmLayer::kSensor, FilmLayer::kSpectrum,
                                             FilmLayer::kWeight, FilmLayer::kVariance};
  return all;
}

Film fed(const FilmOptions& options, const FilmSamples& samples) {
  Film film = *Film::create(options);
  RC_ASSERT(bool(film.add(samples.wavelengths(), {*rc::gen::element(1, 2)})));
  return film;
}

RC_GTEST_PROP(FilmScaling, PermutedSamplesGiveTheSameBits, ()) {
  const FilmOptions o = drawn_film();
  const std::size_t n = drawn_lanes();
  const FilmSamples samples = random_samples(n, *rc::gen::arbitrary<std::uint32_t>());
  const Film straight = fed(o, samples);
  const Film crossed = fed(o, samples.permuted(drawn_order(n)));
  RC_ASSERT(crossed.same_contents(straight));
  for (const FilmLayer layer : layers()) {
    const auto a = developed(straight, layer);
    RC_ASSERT(bool(same_bits(developed(crossed, layer).data(), a.data(), a.size())));
  }
}

RC_GTEST_PROP(FilmScaling, TheFilmOfAUnionIsTheMergeOfTheFilms, ()) {
  const FilmOptions o = drawn_film();
  const std::size_t n = drawn_lanes();
  const FilmSamples samples = random_samples(n, *rc::gen::arbitrary<std::uint32_t>());
  const std::size_t first = *rc::gen::inRange<std::size_t>(0, n + 1);
  const Film both = fed(o, samples);
  Film merged = *Film::create(o);
  Film other = *Film::create(o);
  RC_ASSERT(bool(merged.add(samples.wavelengths(0, first))));
  RC_ASSERT(bool(other.add(samples.wavelengths(first, n - first))));
  const bool turned = *rc::gen::arbitrary<bool>();
  if (turned) std::swap(merged, other);
  RC_ASSERT(bool(merged.merge(other)));
  RC_ASSERT(merged.same_contents(both));
  RC_ASSERT(merged.stats().accepted == both.stats().accepted);
  RC_ASSERT(merged.stats().rejected == both.stats().rejected);
}

RC_GTEST_PROP(FilmScaling, BandSamplesObeyTheSameLaws, ()) {
  FilmOptions o = small_film();
  o.input = FilmInput::kBands;
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 30);
  const std::size_t n = drawn_lanes();
  const auto order = drawn_order(n);
  BandBatch samples(10, n);
  BandBatch crossed(10, n);
  ArbitraryFloat wild(drawn_random());
  GridFloats place(drawn_random(), 0, 20, 16);
  for (std::size_t i = 0; i < n; ++i) {
    samples.put(i, place(), place(), std::abs(place()));
    for (std::size_t b = 0; b < 10; ++b) samples.radiance(b, i) = i % 5 == 0 ? wild() : place();
  }
  for (std::size_t i = 0; i < n; ++i) {
    crossed.put(i, samples.x[order[i]], samples.y[order[i]], samples.weight[order[i]]);
    for (std::size_t b = 0; b < 10; ++b) crossed.radiance(b, i) = samples.radiance(b, order[i]);
  }
  Film straight = *Film::create(o);
  Film other = *Film::create(o);
  Film twice = *Film::create(o);
  RC_ASSERT(bool(straight.add(samples.samples())));
  RC_ASSERT(bool(other.add(crossed.samples())));
  RC_ASSERT(other.same_contents(straight));
  RC_ASSERT(bool(twice.add(samples.samples())));
  RC_ASSERT(bool(twice.add(crossed.samples())));
  RC_ASSERT(bool(other.merge(straight)));
  RC_ASSERT(other.same_contents(twice));
}

/// The samples with radiance times a power of two.
FilmSamples scaled(const FilmSamples& from, float factor) {
  FilmSamples out = from;
  for (std::size_t k = 0; k < FilmSamples::kCount; ++k) {
    for (std::size_t i = 0; i < from.size(); ++i) out.radiance(k, i) *= factor;
  }
  return out;
}

/// Samples of ordinary radiance, densities and wavelengths, none of which is refused.
FilmSamples drawn_samples(std::size_t n) {
  FilmSamples out(n);
  std::mt19937 random = drawn_random();
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < n; ++i) {
    out.put(i, 20 * unit(random) * (1 - 0x1p-20F), 20 * unit(random) * (1 - 0x1p-20F), unit(random));
    for (std::size_t k = 0; k < FilmSamples::kCount; ++k) {
      out.lambda(k, i) = 350 + 490 * unit(random);
      out.radiance(k, i) = 4 * unit(random);
      out.density(k, i) = 0.001F + 0.003F * unit(random);
    }
  }
  return out;
}

/// True if a layer of `scaled` is exactly a factor times that of `plain`.
bool times_exactly(const Film& plain, const Film& times, FilmLayer layer, float factor) {
  const auto a = developed(plain, layer);
  const auto b = developed(times, layer);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!same_bits(b[i], factor * a[i])) return false;
  }
  return true;
}

RC_GTEST_PROP(FilmScaling, RadianceAndRangeTimesAPowerOfTwoScaleThePictureExactly, ()) {
  // The grid moves along, so each count of its steps is the same: also where contributions are rounded to it.
  FilmOptions o = drawn_film();
  o.statistics = PixelStatistics::kNone;
  const FilmSamples samples = drawn_samples(drawn_lanes());
  const int power = *rc::gen::inRange(-40, 41);
  const Film plain = fed(o, samples);
  o.range += power;
  const Film times = fed(o, scaled(samples, std::ldexp(1.0F, power)));
  RC_ASSERT(times.stats().accepted == samples.size());
  for (const FilmLayer layer :
       {FilmLayer::kXyz, FilmLayer::kLuminance, FilmLayer::kSensor, FilmLayer::kSpectrum}) {
    RC_ASSERT(times_exactly(plain, times, layer, std::ldexp(1.0F, power)));
  }
  RC_ASSERT(times_exactly(plain, times, FilmLayer::kWeight, 1));
}

RC_GTEST_PROP(FilmScaling, OneSampleAPixelScalesWithItsRadianceExactly, ()) {
  // Contributions are exact down to 2^(range - 51), 2^-35 here, which is 3e-11. The curves' least positive
  // value at eighths of a nanometre is above 5e-8; times radiance over density, at least 400, a quarter for
  // the four wavelengths, 1/107 and 2^-6 leave above 5e-10.
  FilmOptions o = small_film();
  o.range = 16;
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  const std::size_t n = std::min<std::size_t>(drawn_lanes(), 400);
  FilmSamples samples(n);
  GridFloats radiance(drawn_random(), 1, 4, 16);
  GridFloats lambda(drawn_random(), 360, 830, 3);
  for (std::size_t i = 0; i < n; ++i) {
    samples.put(i, static_cast<float>(i % 20) + 0.5F, static_cast<float>(i / 20) + 0.5F, 1);
    for (std::size_t k = 0; k < FilmSamples::kCount; ++k) {
      samples.radiance(k, i) = radiance();
      samples.lambda(k, i) = lambda();
    }
  }
  const float factor = std::ldexp(1.0F, *rc::gen::inRange(-6, 7));
  const Film plain = fed(o, samples);
  const Film times = fed(o, scaled(samples, factor));
  for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kLuminance, FilmLayer::kSensor}) {
    RC_ASSERT(times_exactly(plain, times, layer, factor));
  }
}

RC_GTEST_PROP(FilmScaling, SamplesThatAreNotNegativeMakeNoNegativePixel, ()) {
  const FilmOptions o = drawn_film();
  FilmSamples samples = drawn_samples(drawn_lanes());
  ArbitraryFloat wild(drawn_random());
  std::mt19937 random = drawn_random();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t k = 0; k < FilmSamples::kCount; ++k) {
      const float v = std::abs(wild());
      samples.radiance(k, i) = v <= 1e6F ? v : 0.0F;
      // Where the curves come down to 0, from either side, and where z does, at 650 nm.
      const float ends[] = {360, 830, 649, 650, 399, 505};
      if (random() % 2 == 0)
        samples.lambda(k, i) = ends[random() % 6] + static_cast<float>(random() % 4097) * 0x1p-12F;
    }
  }
  const Film film = fed(o, samples);
  RC_ASSERT(film.stats().accepted == samples.size());
  for (const FilmLayer layer : layers()) {
    const auto planes = developed(film, layer);
    RC_ASSERT(std::none_of(planes.begin(), planes.end(), [](float v) { return !(v >= 0); }));
  }
}

}  // namespace
}  // namespace spectile::test
