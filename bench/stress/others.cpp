// Films, averages over bands, weights, matrices and colour differences under stress.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <spectile/color/color_difference.hpp>
#include <spectile/color/rgb_space.hpp>
#include <spectile/film/film.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/upsampling/relight.hpp>

#include "bench/operations/operation.hpp"
#include "bench/stress/stress.hpp"
#include "src/base/errors.hpp"
#include "src/reference/oracle/oracle.hpp"

namespace spectile::measure {
namespace {

constexpr double kBeyond = std::numeric_limits<double>::infinity();

/// Takes note of one case.
void note(StressResult& r, double error, const std::string& what) {
  ++r.cases;
  if (!(error <= r.bound)) ++r.beyond;
  if (r.worst_case.empty() || !(error <= r.worst)) {
    r.worst = error;
    r.worst_case = what;
  }
}

StressResult heading(std::string inputs, std::string unit, double bound) {
  StressResult out;
  out.inputs = std::move(inputs);
  out.unit = std::move(unit);
  out.bound = bound;
  return out;
}

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

/// 2^24 + 1 additions of 1: float stops counting at 2^24.
Result<StressResult> film_counts(const StressSettings& /*settings*/) {
  StressResult out = heading("2^24 + 1 samples of 1 in one pixel", "exact", 0);
  SPECTILE_ASSIGN(const auto bands, Bands::uniform(400, 700, 100));
  SPECTILE_ASSIGN(auto film, make_film(1, 1, bands, false));
  constexpr std::size_t kPart = 65281;  // 2^24 + 1 = 257 * 65281
  const std::vector<float> at(kPart, 0.5F);
  const std::vector<float> ones(3 * kPart, 1.0F);
  for (int i = 0; i < 257; ++i) SPECTILE_TRY(film.add(BandSamples{at, at, {}, {ones.data(), 3, kPart}}));
  SPECTILE_ASSIGN(const auto weight, develop(film, FilmLayer::kWeight));
  SPECTILE_ASSIGN(const auto spectrum, develop(film, FilmLayer::kSpectrum));
  // 2^24 + 1 lies halfway between two floats; the even one is 2^24.
  note(out, std::abs(static_cast<double>(weight.at(0, 0, 0)) - 0x1p24), "the sum of weights");
  note(out, std::abs(static_cast<double>(film.stats().accepted) - 16777217.0), "the count");
  for (std::size_t b = 0; b < 3; ++b) {
    note(out, std::abs(static_cast<double>(spectrum.at(b, 0, 0)) - 1.0), "the mean");
  }
  return out;
}

/// Large values that undo each other around small ones that must be left.
Result<StressResult> film_cancellation(const StressSettings& settings) {
  StressResult out =
      heading("values to 2^31 and their opposites around multiples of 2^-19", "u of the mean", 1.001);
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
    note(out, error, fmt::format("a pixel whose samples sum to {:.9g}", sum[i]));
  }
  return out;
}

/// Whatever is added, every sample is counted and no pixel is anything but a number.
Result<StressResult> film_anything(const StressSettings& settings) {
  StressResult out =
      heading("all bit patterns as position, weight and radiance", "not counted, or not finite", 0);
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
    note(out, std::abs(static_cast<double>(counted) - static_cast<double>(n)), "samples counted");
    for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kSpectrum, FilmLayer::kWeight}) {
      SPECTILE_ASSIGN(const auto picture, develop(film, layer));
      for (std::size_t p = 0; p < picture.planes(); ++p) {
        for (int i = 0; i < kSide * kSide; ++i) {
          note(out, std::isfinite(picture.at(p, i % kSide, i / kSide)) ? 0 : kBeyond, "a pixel");
        }
      }
    }
    out.cases += n;
  }
  return out;
}

/// Averages of spectra over bands: lines of 1 nm, steps, bands of 0.1 to 470 nm.
Result<StressResult> band_averages(const StressSettings& settings) {
  StressResult out = heading("lines of 1 nm, steps, 10^-6 to 10^6; bands of 0.1 to 470 nm",
                             "u of the largest sample", 1.001);
  Random random(settings.seed);
  std::vector<const char*> lists = {"360:830:470", "400:700:5", "380:780:0.1"};
  const int spectra = settings.few_bands ? 20 : 200;
  for (const char* text : lists) {
    SPECTILE_ASSIGN(const auto bands, Bands::parse(text));
    for (int s = 0; s < spectra; ++s) {
      std::vector<double> nm;
      std::vector<double> values;
      const double scale = std::pow(10.0, static_cast<double>(static_cast<int>(random() % 13)) - 6);
      const double line = 380 + static_cast<double>(random() % 4000) * 0.1;
      switch (s % 3) {
        case 0:  // a line of 1 nm
          nm = {300, line - 0.5, line - 0.5, line + 0.5, line + 0.5, 900};
          values = {0, 0, scale, scale, 0, 0};
          break;
        case 1:  // a step
          nm = {300, line, line, 900};
          values = {0.1 * scale, 0.1 * scale, scale, scale};
          break;
        default:
          for (int i = 0; i < 100; ++i) {
            nm.push_back(350 + 5 * i + 0.01 * static_cast<double>(random() % 400));
            values.push_back(scale * static_cast<double>(uniform(random, 0.0F, 1.0F)));
          }
      }
      SPECTILE_ASSIGN(const auto spectrum, MeasuredSpectrum::from_samples(nm, values));
      const std::vector<float> found = spectrum.average_over(bands);
      const double largest = *std::max_element(values.begin(), values.end());
      for (std::size_t b = 0; b < bands.count(); ++b) {
        const double reference = oracle::average(spectrum.wavelengths_nm(), spectrum.values(),
                                                 (bands)[b].lower_nm, (bands)[b].upper_nm);
        note(out, std::abs(static_cast<double>(found[b]) - reference) / (0x1p-24 * largest),
             fmt::format("a spectrum at {} nm over {}", line, text));
      }
    }
  }
  return out;
}

/// Weights of XYZ under lights with lines, on one band and on many.
Result<StressResult> projection_weights(const StressSettings& settings) {
  // The oracle sums at 0.01 nm: that is what it is off by itself.
  StressResult out = heading("lights smooth and with lines, bands of 0.5 to 470 nm", "of Y", 1e-7);
  for (const char* text : {"360:830:470", "400:700:5", "380:780:0.5"}) {
    SPECTILE_ASSIGN(const auto bands, Bands::parse(text));
    for (const char* name : {"D65", "A", "FL11", "HP1", "LED-RGB1"}) {
      if (settings.few_bands && std::string_view(name) != "FL11") continue;
      SPECTILE_ASSIGN(const auto light, illuminant(name));
      SPECTILE_ASSIGN(const auto found, Projector::reflective(bands, light));
      const auto reference = oracle::projection_weights(bands, Observer::kCie1931, &light);
      for (std::size_t b = 0; b < bands.count(); ++b) {
        for (std::size_t k = 0; k < 3; ++k) {
          note(out, std::abs(found.weights()[b][k] - reference[b][k]), fmt::format("{} on {}", name, text));
        }
      }
    }
  }
  return out;
}

/// Matrices near to singular ones: primaries that nearly coincide.
Result<StressResult> near_singular(const StressSettings& settings) {
  StressResult out = heading("primaries as near to each other as 10^-12", "2^-52 of the condition", 16);
  Random random(settings.seed);
  const auto norm = [](const Matrix3& m) {
    double sum = 0;
    for (const double v : m) sum += v * v;
    return std::sqrt(sum);
  };
  for (int i = 0; i < 2000; ++i) {
    Matrix3 m{};
    for (double& v : m) v = static_cast<double>(uniform(random, -1.0F, 1.0F));
    const double apart = std::pow(10.0, -static_cast<double>(random() % 13));
    // The last column is nearly the mean of the others.
    for (std::size_t row = 0; row < 3; ++row) {
      m[3 * row + 2] = 0.5 * (m[3 * row] + m[3 * row + 1]) + apart * m[3 * row + 2];
    }
    if (determinant(m) == 0) continue;
    const Matrix3 inverted = inverse(m);
    const Matrix3 one = product(m, inverted);
    double off = 0;
    for (std::size_t k = 0; k < 9; ++k) off = std::max(off, std::abs(one[k] - (k % 4 == 0 ? 1.0 : 0.0)));
    note(out, off / (0x1p-52 * norm(m) * norm(inverted)), fmt::format("columns {:.0e} apart", apart));
  }
  return out;
}

/// CIEDE2000 of any two colours: never below 0, the same both ways, 0 for the same.
Result<StressResult> differences(const StressSettings& settings) {
  StressResult out = heading("XYZ from 10^-20 to 10^10, negative ones, greys", "broken laws", 0);
  Random random(settings.seed);
  const std::array<double, 3> white = {0.95, 1, 1.09};
  const auto any = [&] {
    std::array<double, 3> xyz{};
    const double scale = std::pow(10.0, static_cast<double>(static_cast<int>(random() % 31)) - 20);
    const bool grey = random() % 4 == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      xyz[k] = scale * (grey ? white[k] : static_cast<double>(uniform(random, -0.1F, 1.0F)));
    }
    return xyz_to_lab(xyz, white);
  };
  for (std::size_t i = 0; i < std::max<std::size_t>(2000, settings.samples / 16); ++i) {
    const Lab a = any();
    const Lab b = any();
    const double there = ciede2000(a, b);
    const double back = ciede2000(b, a);
    const bool good = std::isfinite(there) && there >= 0 && there == back && ciede2000(a, a) == 0;
    note(out, good ? 0 : 1, fmt::format("L*a*b* {:.6g} {:.6g} {:.6g}", a.l, a.b, b.l));
  }
  return out;
}

/// Relighting by a folded table against the long way, within the bound that it states itself.
Result<StressResult> folding(const StressSettings& settings) {
  StressResult out = heading("colours of the cube, to 10^30 and down to 10^-30", "of Relighter::bound()", 1);
  const Bands bands;
  constexpr std::size_t kLanes = 4096;
  Random random(settings.seed);
  for (const Method method : {Method::kSmits, Method::kSmitsExact, Method::kMallett}) {
    SPECTILE_ASSIGN(const auto upsampler, Upsampler::create(method, Quantity::kReflectance, bands));
    for (const char* name : {"D65", "FL11"}) {
      SPECTILE_ASSIGN(const auto light, illuminant(name));
      SPECTILE_ASSIGN(const auto under, Projector::reflective(bands, light));
      SPECTILE_ASSIGN(const auto relighter, Relighter::create(upsampler, under, under.xyz_to_srgb()));
      auto rgb = ColorLanes::create(kLanes);
      auto folded = ColorLanes::create(kLanes);
      auto spectra = SampledSpectra::create(bands, kLanes);
      if (!rgb || !folded || !spectra)
        return make_error(ErrorCode::kOutOfMemory, "no memory for {} colours", kLanes);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const float scale = i % 3 == 0 ? 1.0F : i % 3 == 1 ? 1e30F : 1e-30F;
        for (std::size_t k = 0; k < 3; ++k) rgb->at(i, k) = scale * uniform(random, 0.0F, 1.0F);
      }
      SPECTILE_TRY(relight(relighter, rgb->view(), folded->span(), {1}));
      SPECTILE_TRY(upsample_srgb(upsampler, rgb->view(), spectra->span(), StoreHint::kAuto, {1}));
      for (std::size_t i = 0; i < kLanes; ++i) {
        std::array<double, 3> xyz{};
        for (std::size_t b = 0; b < bands.count(); ++b) {
          for (std::size_t k = 0; k < 3; ++k) {
            xyz[k] += under.weights()[b][k] * static_cast<double>(spectra->at(i, b));
          }
        }
        const auto reference = times(under.xyz_to_srgb(), xyz);
        const double largest = static_cast<double>(std::max({rgb->at(i, 0), rgb->at(i, 1), rgb->at(i, 2)}));
        if (largest == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          const double off = std::abs(static_cast<double>(folded->at(i, k)) - reference[k]) / largest;
          note(out, off / relighter.bound()[k], fmt::format("{} under {}", to_string(method), name));
        }
      }
    }
  }
  return out;
}

}  // namespace

Result<std::vector<StressResult>> stress_others(const StressSettings& settings) {
  struct Part {
    const char* operation;  ///< as its heading calls it
    Result<StressResult> (*run)(const StressSettings&);
  };
  const Part parts[] = {
      {"film: add up", film_counts},          {"film: cancellation", film_cancellation},
      {"film: any sample", film_anything},    {"average over bands", band_averages},
      {"weights of XYZ", projection_weights}, {"inverse of a matrix", near_singular},
      {"laws of CIEDE2000", differences},     {"relight against the long way", folding},
  };
  std::vector<StressResult> out;
  for (const Part& part : parts) {
    if (!is_chosen(part.operation, settings.only)) continue;
    if (settings.stop && settings.stop()) {
      return make_error(ErrorCode::kCancelled, "stopped at {}", part.operation);
    }
    SPECTILE_ASSIGN(auto found, part.run(settings));
    found.operation = part.operation;
    out.push_back(std::move(found));
  }
  return out;
}

}  // namespace spectile::measure
