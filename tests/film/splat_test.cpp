// Splatting: the filter itself at every distance, its edges, far from the origin, and beyond the range.
#include <algorithm>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

/// A film that keeps as little as it can, splatted, and its weights.
FilmOptions splatted(const PixelFilter& filter, PixelWindow crop, int width, int height) {
  FilmOptions o;
  o.width = width;
  o.height = height;
  o.crop = crop;
  o.placement = SamplePlacement::kSplat;
  o.filter = filter;
  o.input = FilmInput::kBands;
  o.bands = *Bands::uniform(500, 600, 100);
  return o;
}

/// Weights of one sample in a window that starts at (x0, 0), one line high.
std::vector<float> line_of_weights(const PixelFilter& filter, int x0, int pixels, float x) {
  const PixelWindow crop{x0, 0, x0 + pixels, 1};
  Film film = *Film::create(splatted(filter, crop, 1 << 18, 1));
  BandBatch b(1, 1);
  b.put(0, x, 0.5F, 1);
  EXPECT_TRUE(film.add(b.samples()));
  return developed(film, FilmLayer::kWeight);
}

double peak_of(const PixelFilter& f) {
  double out = 0;
  for (double d = 0; d <= f.radius_x(); d += f.radius_x() / 4096) out = std::max(out, std::abs(f.along_x(d)));
  return out;
}

TEST(FilmSplat, WeightsAreTheFiltersWithinAMillionthOfItsPeak) {
  for (const char* text :
       {"box:3", "triangle:2", "triangle:64", "gaussian:1.5:0.5", "gaussian:4:1", "gaussian:4:0.25",
        "gaussian:8:0.2", "gaussian:64:0.5", "gaussian:64:8", "mitchell:2", "mitchell:64:0.333:0.333",
        "mitchell:2:0:0.5", "mitchell:2:1:0", "lanczos:2:2", "lanczos:3:3", "lanczos:4:3", "lanczos:8:8",
        "lanczos:64:64", "lanczos:2:0.5"}) {
    const PixelFilter filter = *PixelFilter::parse(text);
    const double peak = peak_of(filter);
    const int x0 = 100;
    const int half_width = static_cast<int>(filter.radius_x()) + 2;
    double worst = 0;
    for (int i = 0; i < 40; ++i) {
      const float x = static_cast<float>(x0 + half_width) + static_cast<float>(i) / 40 + 0.003F;
      const auto weights = line_of_weights(filter, x0, 2 * half_width, x);
      for (int j = 0; j < 2 * half_width; ++j) {
        const double want = filter.along_x(x0 + j + 0.5 - static_cast<double>(x)) * filter.along_y(0);
        worst = std::max(worst, std::abs(static_cast<double>(weights[static_cast<std::size_t>(j)]) - want));
      }
    }
    EXPECT_LE(worst / peak, 1e-6) << text;
  }
}

TEST(FilmSplat, EdgesAreOpenBelowAndClosedAbove) {
  // A box of radius r reaches from -r, exclusive, to r. All numbers are floats, so distances are exact.
  for (int r = 1; r <= 64 * 8; r += r < 130 ? 1 : 7) {
    const double radius = r / 8.0;
    const PixelFilter box = *PixelFilter::box(radius, 0.5);
    const int half_width = static_cast<int>(radius) + 2;
    const int x0 = 64;
    for (const double off : {radius - std::floor(radius), 0.0, 0.125, 0.5}) {
      const auto x = static_cast<float>(x0 + half_width + 0.5 + off);
      const auto weights = line_of_weights(box, x0, 2 * half_width + 1, x);
      for (int j = 0; j < 2 * half_width + 1; ++j) {
        const double d = x0 + j + 0.5 - static_cast<double>(x);
        ASSERT_EQ(weights[static_cast<std::size_t>(j)], d > -radius && d <= radius ? 1 : 0)
            << "radius " << radius << " distance " << d;
      }
    }
  }
}

TEST(FilmSplat, BoxesOfAnyRadiusAtTheirFarEdge) {
  // Radii that are floats of many bits: a sample exactly the radius before a pixel's centre reaches it.
  std::mt19937 random(4);
  std::uniform_real_distribution<float> radii(0.01F, 16);
  for (int i = 0; i < 400; ++i) {
    const auto radius = static_cast<float>(std::round(radii(random) * 0x1p16F)) * 0x1p-16F;
    if (radius < 0.01F) continue;
    const PixelFilter box = *PixelFilter::box(static_cast<double>(radius), 0.5);
    const float x = 20.5F - radius;
    ASSERT_EQ(20.5F - x, radius);
    EXPECT_EQ(line_of_weights(box, 20, 1, x)[0], 1) << "radius " << radius << ", distance + radius";
    const float y = 20.5F + radius;
    EXPECT_EQ(line_of_weights(box, 20, 1, y)[0], 0) << "radius " << radius << ", distance - radius";
  }
}

TEST(FilmSplat, FarFromTheOriginIsAsNearIt) {
  // At x near 2^16 floats are 2^-8 and more apart: the weights are those at the float positions.
  struct Case {
    const char* filter;
    int x0;
  };
  for (const Case& c :
       {Case{"box:1.3", 70000}, Case{"box:0.7", 131080}, Case{"triangle:1.3", 200000}, Case{"box:2.1", 5000},
        Case{"triangle:0.01", 100000}, Case{"lanczos:2.9:3", 250000}}) {
    const PixelFilter filter = *PixelFilter::parse(c.filter);
    float x = static_cast<float>(c.x0) + 5;
    const float end = x + 1;
    int wrong = 0;
    double worst = 0;
    while (x < end) {
      const auto weights = line_of_weights(filter, c.x0, 11, x);
      for (int j = 0; j < 11; ++j) {
        const double d = c.x0 + j + 0.5 - static_cast<double>(x);
        const double want = filter.along_x(d);
        const double off = std::abs(static_cast<double>(weights[static_cast<std::size_t>(j)]) - want);
        worst = std::max(worst, off);
        wrong += off > 1e-5 ? 1 : 0;
      }
      x = std::nextafter(x, 1e9F);
    }
    EXPECT_EQ(wrong, 0) << c.filter << " at " << c.x0 << ", off by " << worst;
  }
}

TEST(FilmSplat, WideFiltersAtTheCornersOfAnUnalignedCrop) {
  const PixelFilter filter = *PixelFilter::triangle(64, 37.5);
  const PixelWindow crop{13, 7, 45, 24};
  const double corners[][2] = {{0, 0}, {13.1, 7.9}, {44.9, 23.2}, {100, 40}, {13.01, 23.99}, {-20, -15}};
  for (const auto& at : corners) {
    Film film = *Film::create(splatted(filter, crop, 110, 90));
    BandBatch b(1, 1);
    b.put(0, static_cast<float>(at[0]), static_cast<float>(at[1]), 1);
    ASSERT_TRUE(film.add(b.samples()));
    auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
    ASSERT_TRUE(weight.update());
    for (int y = crop.y0; y < crop.y1; ++y) {
      for (int x = crop.x0; x < crop.x1; ++x) {
        const double want =
            filter(x + 0.5 - static_cast<double>(b.x[0]), y + 0.5 - static_cast<double>(b.y[0]));
        ASSERT_NEAR(weight.at(0, x, y), want, 2e-6) << x << " " << y;
      }
    }
  }
}

TEST(FilmSplat, FiltersHigherThanAtTheirCentresAreRefused) {
  // A Mitchell filter with b near 3 is far higher beside its centre than there, and so would be
  // contributions.
  for (const double b : {2.9, 2.9999999}) {
    const auto filter = PixelFilter::mitchell(2, 2, b, -30);
    if (!filter) continue;
    ASSERT_GT(peak_of(*filter), 2);
    const auto film = Film::create(splatted(*filter, {0, 0, 20, 20}, 20, 20));
    ASSERT_FALSE(film);
    EXPECT_EQ(film.error().code, ErrorCode::kBadArgument);
  }
}

TEST(Film, SplattedConstantsStayConstant) {
  for (const char* filter :
       {"box:0.5", "box:1.25", "triangle:2", "gaussian:1.5:0.5", "mitchell:2", "lanczos:3:3"}) {
    FilmOptions o = small_film();
    o.placement = SamplePlacement::kSplat;
    o.filter = *PixelFilter::parse(filter);
    Film film = *Film::create(o);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 20);
    FilmSamples s(20000);
    for (std::size_t i = 0; i < 20000; ++i) s.put(i, unit(random), unit(random), 1);
    for (std::size_t i = 0; i < 20000; ++i) {
      for (std::size_t k = 0; k < 4; ++k) {
        s.lambda(k, i) = s.lambda(k, 0);
        s.radiance(k, i) = s.radiance(k, 0);
      }
    }
    ASSERT_TRUE(film.add(s.wavelengths()));
    EXPECT_EQ(film.stats().rejected.total(), 0U);
    auto xyz = *FilmDevelopment::create(film, FilmLayer::kXyz);
    ASSERT_TRUE(xyz.update());
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        // The ratio of exact sums: each contribution was rounded once.
        ASSERT_NEAR(xyz.at(1, x, y) / xyz.at(1, 10, 10), 1, 1e-6) << filter << " " << x << " " << y;
      }
    }
  }
}

TEST(Film, SplattedWeightsAreTheFilters) {
  FilmOptions o = small_film();
  o.placement = SamplePlacement::kSplat;
  for (const char* text : {"box:1.3x0.7", "triangle:2x1", "gaussian:2:0.6", "mitchell:2", "lanczos:3:2"}) {
    o.filter = *PixelFilter::parse(text);
    Film film = *Film::create(o);
    FilmSamples s(1);
    s.put(0, 9.8F, 10.3F, 1);
    ASSERT_TRUE(film.add(s.wavelengths()));
    auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
    ASSERT_TRUE(weight.update());
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        const double want =
            o.filter(x + 0.5 - static_cast<double>(9.8F), y + 0.5 - static_cast<double>(10.3F));
        ASSERT_NEAR(weight.at(0, x, y), want, 2e-6) << text << " " << x << " " << y;
      }
    }
  }
}

TEST(Film, ABoxOfHalfAPixelIsTheSameSplattedOrNot) {
  FilmOptions o = small_film();
  Film one = *Film::create(o);
  o.placement = SamplePlacement::kSplat;
  Film splat = *Film::create(o);
  const FilmSamples s = random_samples(5000, 9);
  ASSERT_TRUE(one.add(s.wavelengths()));
  ASSERT_TRUE(splat.add(s.wavelengths()));
  EXPECT_EQ(developed(one, FilmLayer::kXyz), developed(splat, FilmLayer::kXyz));
  EXPECT_EQ(one.stats().rejected, splat.stats().rejected);
}

}  // namespace
}  // namespace spectile::test
