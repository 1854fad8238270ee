// Films against their documentation in plain double: colours, spectra, weights, counts and variance.
#include <algorithm>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

/// Samples of K wavelengths at an odd address.
struct Batch {
  Batch(std::size_t count, std::size_t samples, std::uint32_t seed)
      : k(count), n(samples), stride(samples + 3) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const std::size_t odd = seed % 5;
    for (auto* v : {&x, &y, &weight}) v->resize(n + odd);
    for (auto* v : {&radiance, &lambda, &density}) v->resize(k * stride + odd);
    const float edges[] = {360, 830, 359.99997F, 830.00006F, 400, 450, 500, 700, 100, 1e6F, -5};
    for (std::size_t i = 0; i < n; ++i) {
      x[i + odd] = 13 * unit(random);
      y[i + odd] = 7 * unit(random);
      weight[i + odd] = unit(random);
      for (std::size_t j = 0; j < k; ++j) {
        lambda[j * stride + i + odd] = random() % 6 == 0 ? edges[random() % 11] : 350 + 490 * unit(random);
        density[j * stride + i + odd] = random() % 9 == 0 ? 0.0F : 0.0005F + 0.01F * unit(random);
        radiance[j * stride + i + odd] = 10 * unit(random);
      }
    }
    first = odd;
  }
  WavelengthSamples samples() const {
    const auto rows = [&](const std::vector<float>& v) { return RowsView{v.data() + first, k, stride}; };
    const auto part = [&](const std::vector<float>& v) { return std::span(v).subspan(first, n); };
    return {part(x), part(y), part(weight), rows(radiance), rows(lambda), rows(density)};
  }
  std::size_t k, n, stride, first = 0;
  std::vector<float> x, y, weight, radiance, lambda, density;
};

/// The pixels according to the documentation.
struct Pixel {
  double weight = 0, count = 0, squares = 0;
  std::array<double, 3> color{}, magnitude{};
  std::vector<double> band, band_weight;
};

double row(const std::vector<float>& v, const Batch& b, std::size_t j, std::size_t i) {
  return static_cast<double>(v[j * b.stride + i + b.first]);
}

/// A curve as films keep it: linear between whole nanometres.
double at_nanometres(const Spectrum& curve, double lambda) {
  const double low = std::min(std::floor(lambda), 829.0);
  return curve(low) + (lambda - low) * (curve(low + 1) - curve(low));
}

void add_to(Pixel& p, const Batch& b, std::size_t i, double w, const Sensor& sensor, const Bands& bands) {
  p.weight += w;
  ++p.count;
  p.band.resize(bands.count());
  p.band_weight.resize(bands.count());
  for (std::size_t j = 0; j < b.k; ++j) {
    const double pdf = row(b.density, b, j, i);
    if (pdf == 0) continue;
    const double lambda = row(b.lambda, b, j, i);
    const double r = row(b.radiance, b, j, i);
    for (std::size_t c = 0; c < 3 && lambda >= 360 && lambda <= 830; ++c) {
      const double v = w * sensor.factors()[c] * at_nanometres(sensor.curves()[c], lambda) * r / pdf /
                       static_cast<double>(b.k);
      p.color[c] += v;
      p.magnitude[c] += std::abs(v);
    }
    for (std::size_t n = 0; n < bands.count(); ++n) {
      if (lambda < bands[n].lower_nm || lambda >= bands[n].upper_nm) continue;
      p.band[n] += w * r / pdf;
      p.band_weight[n] += w / pdf;
    }
  }
}

void expect_film(const FilmOptions& o, const Batch& b) {
  Film film = *Film::create(o);
  ASSERT_TRUE(film.add(b.samples()));
  EXPECT_EQ(film.stats().accepted, b.n);
  const PixelWindow w = film.window();
  const Sensor observer = *Sensor::named("cie1931");
  for (std::size_t c = 0; c < 1 + o.sensors.size(); ++c) {
    if (c == 0 && !o.xyz) continue;
    const Sensor& sensor = c == 0 ? observer : o.sensors[c - 1].sensor;
    std::vector<Pixel> pixels(static_cast<std::size_t>(w.width() * w.height()));
    for (std::size_t i = 0; i < b.n; ++i) {
      const double x = static_cast<double>(b.x[i + b.first]);
      const double y = static_cast<double>(b.y[i + b.first]);
      for (int py = w.y0; py < w.y1; ++py) {
        for (int px = w.x0; px < w.x1; ++px) {
          const bool here = px == static_cast<int>(x) && py == static_cast<int>(y);
          const double f = o.placement == SamplePlacement::kSplat ? o.filter(px + 0.5 - x, py + 0.5 - y)
                                                                  : (here ? 1.0 : 0.0);
          if (f == 0) continue;
          add_to(pixels[static_cast<std::size_t>((py - w.y0) * w.width() + px - w.x0)], b, i,
                 f * static_cast<double>(b.weight[i + b.first]), sensor, o.bands);
        }
      }
    }
    auto color =
        *FilmDevelopment::create(film, c == 0 ? FilmLayer::kXyz : FilmLayer::kSensor, c == 0 ? 0 : c - 1);
    auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
    ASSERT_TRUE(color.update());
    ASSERT_TRUE(weight.update());
    const double bound = static_cast<double>(b.k + 12) * 0x1p-24;
    // A splatted weight is within 1e-6 of the filter's peak.
    const double off = o.placement == SamplePlacement::kSplat ? 3e-6 : 0;
    for (int y = w.y0; y < w.y1; ++y) {
      for (int x = w.x0; x < w.x1; ++x) {
        const Pixel& p = pixels[static_cast<std::size_t>((y - w.y0) * w.width() + x - w.x0)];
        ASSERT_NEAR(weight.at(0, x, y), p.weight, p.weight * 1e-7 + off * p.count);
        if (p.weight < 0.1) continue;
        for (std::size_t j = 0; j < 3; ++j) {
          ASSERT_NEAR(color.at(j, x, y), p.color[j] / p.weight,
                      bound * p.magnitude[j] / p.weight + 1e3 * off * p.count / p.weight)
              << "K " << b.k << " n " << b.n << " colour " << c << " " << j;
        }
      }
    }
    if (!o.spectral) continue;
    auto spectrum = *FilmDevelopment::create(film, FilmLayer::kSpectrum);
    ASSERT_TRUE(spectrum.update());
    for (int y = w.y0; y < w.y1; ++y) {
      for (int x = w.x0; x < w.x1; ++x) {
        const Pixel& p = pixels[static_cast<std::size_t>((y - w.y0) * w.width() + x - w.x0)];
        for (std::size_t n = 0; n < p.band.size(); ++n) {
          const double want = p.band_weight[n] == 0 ? 0 : p.band[n] / p.band_weight[n];
          if (o.placement == SamplePlacement::kSplat && p.weight < 0.1) continue;
          ASSERT_NEAR(
              spectrum.at(n, x, y), want,
              want * 1e-6 + (off > 0 && p.band_weight[n] > 0 ? 1e4 * off * p.count / p.band_weight[n] : 0))
              << "band " << n;
        }
      }
    }
  }
}

std::vector<Bands> kinds_of_bands() {
  std::vector<Band> gaps = {{370, 371, 380}, {400, 410, 450}, {500, 500.5, 700}, {829, 829.5, 830}};
  std::vector<Band> narrow;
  for (int i = 0; i < 300; ++i) narrow.push_back({450 + i * 0.5, 450.1 + i * 0.5, 450.25 + i * 0.5});
  return {*Bands::from_list(gaps), *Bands::from_list(narrow), *Bands::from_list({{1, 500, 5000}}),
          *Bands::uniform(360, 830, 1), *Bands::from_list({{359, 400, 830}, {830, 900, 1e7}})};
}

TEST(FilmDevelop, AnyNumberOfWavelengthsAndSamples) {
  const auto bands = kinds_of_bands();
  FilmOptions o;
  o.width = 13;
  o.height = 7;
  o.spectral = true;
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  o.sensors.push_back({"cie1931", *Sensor::named("cie1931")});
  std::uint32_t seed = 0;
  for (const std::size_t k : {1U, 2U, 3U, 4U, 5U, 8U, 9U, 63U, 64U}) {
    for (const std::size_t n : {1U, 63U, 64U, 65U, 1023U, 1025U}) {
      o.bands = bands[seed % bands.size()];
      o.xyz.reset();
      if (seed % 3 != 0) o.xyz = Observer::kCie1931;
      if (n > 100 && k > 9 && seed % 2 == 0) {
        ++seed;
        continue;
      }
      ASSERT_NO_FATAL_FAILURE(expect_film(o, Batch(k, n, seed++)));
    }
  }
}

TEST(FilmDevelop, SplattedOverAsymmetricFilters) {
  FilmOptions o;
  o.width = 13;
  o.height = 7;
  o.placement = SamplePlacement::kSplat;
  o.spectral = true;
  o.bands = kinds_of_bands()[0];
  for (const char* filter : {"triangle:2x0.6", "gaussian:1.5x3:0.7", "box:0.3x4"}) {
    o.filter = *PixelFilter::parse(filter);
    Batch b(4, 300, 7);
    Film film = *Film::create(o);
    // Those that reach no pixel are of no interest here.
    for (std::size_t i = 0; i < b.n; ++i) {
      if (o.filter.radius_x() < 0.5) b.x[i + b.first] = std::floor(b.x[i + b.first]) + 0.4F;
    }
    ASSERT_NO_FATAL_FAILURE(expect_film(o, b)) << filter;
  }
}

TEST(FilmDevelop, VarianceOfWeightedAndSplattedSamples) {
  for (const bool splat : {false, true}) {
    for (const float scale : {1.0F, 1e-3F, 1e-6F, 1e-8F, 100.0F}) {
      FilmOptions o = small_film();
      o.input = FilmInput::kBands;
      o.bands = *Bands::uniform(360, 830, 470);
      o.statistics = PixelStatistics::kVariance;
      if (splat) o.placement = SamplePlacement::kSplat;
      if (splat) o.filter = *PixelFilter::triangle(2, 1.5);
      Film film = *Film::create(o);
      BandBatch b(1, 400);
      std::mt19937 random(8);
      std::uniform_real_distribution<float> unit(0, 1);
      for (std::size_t i = 0; i < 400; ++i) {
        b.put(i, 5 + unit(random), 6 + unit(random), scale * (0.1F + unit(random)));
        b.radiance(0, i) = 1 + 3 * unit(random);
      }
      ASSERT_TRUE(film.add(b.samples()));
      auto variance = *FilmDevelopment::create(film, FilmLayer::kVariance);
      ASSERT_TRUE(variance.update());
      for (const auto& [px, py] : {std::pair{5, 6}, std::pair{6, 6}}) {
        if (!splat && px != 5) continue;
        long double w1 = 0, w2 = 0, wy = 0, wyy = 0;
        for (std::size_t i = 0; i < 400; ++i) {
          const double f =
              splat ? o.filter(px + 0.5 - static_cast<double>(b.x[i]), py + 0.5 - static_cast<double>(b.y[i]))
                    : 1;
          const long double w = static_cast<long double>(b.weight[i]) * static_cast<long double>(f);
          w1 += w;
          w2 += w * w;
          wy += w * static_cast<long double>(b.radiance(0, i));
        }
        for (std::size_t i = 0; i < 400; ++i) {
          const double f =
              splat ? o.filter(px + 0.5 - static_cast<double>(b.x[i]), py + 0.5 - static_cast<double>(b.y[i]))
                    : 1;
          const long double d = static_cast<long double>(b.radiance(0, i)) - wy / w1;
          wyy += static_cast<long double>(b.weight[i]) * static_cast<long double>(f) * d * d;
        }
        const long double share = w2 / (w1 * w1);
        const auto want = static_cast<double>(wyy / w1 * share / (1 - share));
        EXPECT_NEAR(variance.at(0, px, py) / want, 1, 1e-4)
            << "weights of " << scale << (splat ? " splatted" : "");
      }
    }
  }
}

TEST(FilmDevelop, ConstantSamplesHaveNoVariance) {
  for (const float w : {1.0F, 0.3F, 0.7F, 1e-3F}) {
    for (const float v : {1.0F, 0.1F, 123.456F, 1e-5F}) {
      FilmOptions o = small_film();
      o.input = FilmInput::kBands;
      o.bands = *Bands::uniform(360, 830, 470);
      o.statistics = PixelStatistics::kVariance;
      Film film = *Film::create(o);
      BandBatch b(1, 100);
      for (std::size_t i = 0; i < 100; ++i) {
        b.put(i, 5.5F, 5.5F, w);
        b.radiance(0, i) = v;
      }
      ASSERT_TRUE(film.add(b.samples()));
      const float got = developed(film, FilmLayer::kVariance)[5 * 20 + 5];
      EXPECT_GE(got, 0);
      // The standard error of a pixel that does not vary: nothing next to a float's last digits.
      EXPECT_LE(std::sqrt(got), 1e-7F * v) << "weight " << w << " value " << v;
    }
  }
}

}  // namespace
}  // namespace spectile::test
