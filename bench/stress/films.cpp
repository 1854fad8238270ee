// Films under stress: counts, cancellation, any samples.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <spectile/film/film.hpp>

#include "bench/operations/operation.hpp"
#include "bench/stress/stress.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// A film of one pixel a lane that keeps spectra, so that a sample is what was added.
Result<Film> make_film(int width, int height, const Bands& bands, bool negative_weights) {
  FilmOptions o;
  o.width = width;
  o.height = height;
  SPECTILE_ASSIGN(o.filter, PixelFilter::box());
  o.input = FilmInput::kBands;
  o.bands = bands;
  o.spectral = true;
  o.negative_weights = negative_weights;
  return Film::create(o);
}

Result<FilmDevelopment> develop(const Film& film, FilmLayer layer) {
  SPECTILE_ASSIGN(auto out, FilmDevelopment::create(film, layer));
  SPECTILE_TRY(out.update({1}));
  return out;
}

}  // namespace

/// 2^24 + 1 additions of 1: float stops counting at 2^24.
Result<StressResult> stress_film_counts(const StressSettings& /*settings*/) {
  StressResult out = stress_heading("2^24 + 1 samples of 1 in one pixel", "exact", 0);
  SPECTILE_ASSIGN(const auto bands, Bands::uniform(400, 700, 100));
  SPECTILE_ASSIGN(auto film, make_film(1, 1, bands, false));
  constexpr std::size_t kPart = 65281;  // 2^24 + 1 = 257 * 65281
  const std::vector<float> at(kPart, 0.5F);
  const std::vector<float> ones(3 * kPart, 1.0F);
  for (int i = 0; i < 257; ++i) SPECTILE_TRY(film.add(BandSamples{at, at, {}, {ones.data(), 3, kPart}}));
  SPECTILE_ASSIGN(const auto weight, develop(film, FilmLayer::kWeight));
  SPECTILE_ASSIGN(const auto spectrum, develop(film, FilmLayer::kSpectrum));
  // 2^24 + 1 lies halfway between two floats; the even one is 2^24.
  add_case(out, std::abs(static_cast<double>(weight.at(0, 0, 0)) - 0x1p24), "the sum of weights");
  add_case(out, std::abs(static_cast<double>(film.stats().accepted) - 16777217.0), "the count");
  for (std::size_t b = 0; b < 3; ++b) {
    add_case(out, std::abs(static_cast<double>(spectrum.at(b, 0, 0)) - 1.0), "the mean");
  }
  return out;
}

/// Large values that undo each other around small ones that must be left.
Result<StressResult> stress_film_cancellation(const StressSettings& settings) {
  StressResult out =
      stress_heading("values to 2^31 and their opposites around multiples of 2^-19", "u of the mean", 1.001);
  SPECTILE_ASSIGN(const auto bands, Bands::uniform(400, 700, 300));
  constexpr int kSide = 64;
  constexpr std::size_t kPixels = std::size_t{kSide} * kSide;
  SPECTILE_ASSIGN(auto film, make_film(kSide, kSide, bands, false));
  Random random(settings.seed);
  std::vector<float> x(kPixels), y(kPixels), value(kPixels);
  std::vector<double> sum(kPixels, 0.0);
  std::vector<float> large(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) {
    x[i] = static_cast<float>(i % kSide) + 0.5F;
    const std::size_t line = i / kSide;
    y[i] = static_cast<float>(line) + 0.5F;
    large[i] = std::ldexp(uniform(random, 1.0F, 2.0F), static_cast<int>(random() % 30));
  }
  const auto add = [&]() { return film.add(BandSamples{x, y, {}, {value.data(), 1, kPixels}}); };
  const int rounds = 16;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < kPixels; ++i) value[i] = large[i];
    SPECTILE_TRY(add());
    for (std::size_t i = 0; i < kPixels; ++i) {
      const auto steps = static_cast<float>(static_cast<std::int32_t>(random() % 0x1000000) - 0x800000);
      value[i] = steps * 0x1p-19F;
      sum[i] += static_cast<double>(value[i]);
    }
    SPECTILE_TRY(add());
    for (std::size_t i = 0; i < kPixels; ++i) value[i] = -large[i];
    SPECTILE_TRY(add());
  }
  SPECTILE_ASSIGN(const auto spectrum, develop(film, FilmLayer::kSpectrum));
  for (std::size_t i = 0; i < kPixels; ++i) {
    const double reference = sum[i] / (3.0 * rounds);
    const auto found =
        static_cast<double>(spectrum.at(0, static_cast<int>(i % kSide), static_cast<int>(i / kSide)));
    const double error = reference == 0 ? std::abs(found) * 0x1p100
                                        : std::abs(found - reference) / std::abs(reference) * 0x1p24;
    add_case(out, error, fmt::format("a pixel whose samples sum to {:.9g}", sum[i]));
  }
  return out;
}

/// Whatever is added, every sample is counted and no pixel is anything but a number.
Result<StressResult> stress_film_samples(const StressSettings& settings) {
  StressResult out =
      stress_heading("all bit patterns as position, weight and radiance", "not counted, or not finite", 0);
  SPECTILE_ASSIGN(const auto bands, Bands::uniform(400, 700, 100));
  constexpr int kSide = 16;
  Random random(settings.seed);
  const std::size_t n = std::max<std::size_t>(4096, settings.samples / 8);
  for (const bool negative : {false, true}) {
    SPECTILE_ASSIGN(auto film, make_film(kSide, kSide, bands, negative));
    std::vector<float> x(n), y(n), weight(n), radiance(3 * n);
    const auto any = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(random() >> 32U)); };
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = i % 7 == 0 ? any() : uniform(random, -1.0F, 17.0F);
      y[i] = i % 11 == 0 ? any() : uniform(random, -1.0F, 17.0F);
      weight[i] = i % 5 == 0 ? any() : uniform(random, 0.0F, 2.0F);
    }
    for (std::size_t i = 0; i < 3 * n; ++i) radiance[i] = i % 3 == 0 ? uniform(random, 0.0F, 1.0F) : any();
    SPECTILE_TRY(film.add(BandSamples{x, y, weight, {radiance.data(), 3, n}}));
    const FilmStats stats = film.stats();
    const std::uint64_t counted = stats.accepted + stats.rejected.total();
    add_case(out, std::abs(static_cast<double>(counted) - static_cast<double>(n)), "samples counted");
    for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kSpectrum, FilmLayer::kWeight}) {
      SPECTILE_ASSIGN(const auto picture, develop(film, layer));
      for (std::size_t p = 0; p < picture.planes(); ++p) {
        for (int i = 0; i < kSide * kSide; ++i) {
          add_case(out, std::isfinite(picture.at(p, i % kSide, i / kSide)) ? 0 : kBeyond, "a pixel");
        }
      }
    }
    out.cases += n;
  }
  return out;
}

}  // namespace spectile::measure
