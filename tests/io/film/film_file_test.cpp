// Partial films: what comes back from a file is the film, for every combination of options.
#include <gmock/gmock.h>

#include <random>
#include <spectile/image/film_file.hpp>

#include "tests/film/film_support.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Spectrum triangle_curve(double low, double high) {
  return *PiecewiseLinearSpectrum::from_samples({{low, (low + high) / 2, high}}, {{0.0, 1.0, 0.0}});
}

Sensor custom_sensor() {
  SensorOptions options;
  options.exposure = 2.5;
  return *Sensor::create({triangle_curve(550, 700), triangle_curve(450, 620), triangle_curve(380, 520)},
                         options);
}

/// Samples on bands over nine decades, some of them bad.
BandBatch random_bands(std::size_t bands, std::size_t n, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  BandBatch out(bands, n);
  for (std::size_t i = 0; i < n; ++i) {
    out.put(i, unit(random) * 21 - 0.5F, unit(random) * 21 - 0.5F, unit(random));
    const float size = std::pow(10.0F, 9 * unit(random) - 4);
    for (std::size_t b = 0; b < bands; ++b) out.radiance(b, i) = size * unit(random);
    if (i % 90 == 8) out.radiance(0, i) = kInf;
  }
  return out;
}

void fill(Film& film, std::uint32_t seed) {
  if (film.options().input == FilmInput::kWavelengths) {
    ASSERT_TRUE(film.add(random_samples(1500, seed).wavelengths()));
  } else {
    ASSERT_TRUE(film.add(random_bands(film.options().bands.count(), 1500, seed).samples()));
  }
}

TEST(FilmFile, EveryCombinationOfOptionsComesBack) {
  const TempFolder folder;
  const std::string path = folder / "film.exr";
  const std::string again = folder / "again.exr";
  for (int bits = 0; bits < 2 * 2 * 2 * 3 * 4; ++bits) {
    int rest = bits;
    const auto digit = [&](int base) {
      const int d = rest % base;
      rest /= base;
      return d;
    };
    FilmOptions o = small_film();
    o.input = digit(2) == 1 ? FilmInput::kBands : FilmInput::kWavelengths;
    o.placement = digit(2) == 1 ? SamplePlacement::kSplat : SamplePlacement::kOnePixel;
    if (o.placement == SamplePlacement::kSplat)
      o.filter = *PixelFilter::mitchell(1.3, 0.9, 0.3, 0.123456789012345);
    o.spectral = digit(2) == 1;
    o.statistics = static_cast<PixelStatistics>(digit(3));
    const int colors = digit(4);
    if (colors == 1) o.xyz = Observer::kCie1964;
    if (colors >= 2) o.xyz.reset();
    if (colors == 1 || colors == 2) o.sensors.push_back({"of my own", custom_sensor()});
    if (colors == 3 && (!o.spectral || o.statistics == PixelStatistics::kVariance)) continue;
    o.bands = *Bands::uniform(400, 700, 300.0 / 7);
    if (bits % 2 == 1) o.crop = PixelWindow{2, 3, 19, 18};
    if (bits % 3 == 1) o.maximum_component = 123.456F;
    o.negative_weights = bits % 5 == 1;
    o.range = 30 + bits % 7;
    Film film = *Film::create(o);
    fill(film, static_cast<std::uint32_t>(bits));
    ASSERT_TRUE(save_film(film, path, "at " + std::to_string(bits)));
    ASSERT_TRUE(save_film(film, again, "at " + std::to_string(bits)));
    EXPECT_EQ(bytes_of(path), bytes_of(again));
    auto loaded = load_film(path);
    ASSERT_TRUE(loaded) << bits << " " << loaded.error().message;
    EXPECT_EQ(loaded->progress, "at " + std::to_string(bits));
    if (!film.same_contents(loaded->film)) {
      const auto merged = Film(std::move(loaded->film)).merge(film);
      FAIL() << bits << ": " << (merged ? "other sums" : merged.error().message);
    }
    ASSERT_TRUE(loaded->film.same_contents(film)) << bits;
    EXPECT_EQ(loaded->film.stats().rejected, film.stats().rejected);
    EXPECT_EQ(loaded->film.window(), film.window());
    ASSERT_TRUE(save_film(loaded->film, again, "at " + std::to_string(bits)));
    EXPECT_EQ(bytes_of(path), bytes_of(again)) << bits;
    fill(film, 99);
    fill(loaded->film, 99);
    ASSERT_TRUE(film.same_contents(loaded->film)) << bits;
    ASSERT_TRUE(film.merge(loaded->film));
  }
}

TEST(FilmFile, AnyCompressionKeepsEverySum) {
  const TempFolder folder;
  FilmOptions o = small_film();
  o.spectral = true;
  o.statistics = PixelStatistics::kVariance;
  Film film = *Film::create(o);
  fill(film, 5);
  for (const char* name : {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    ImageOptions options;
    options.compression = *Compression::parse(name);
    const auto report = save_film(film, folder / "film.exr", "", options);
    if (!report) {
      EXPECT_EQ(report.error().code, ErrorCode::kBadArgument) << name << ": " << report.error().message;
      continue;
    }
    const auto loaded = load_film(folder / "film.exr");
    ASSERT_TRUE(loaded) << name << ": " << loaded.error().message;
    EXPECT_TRUE(film.same_contents(loaded->film)) << name;
  }
}

TEST(FilmFile, ProgressIsAnyText) {
  const TempFolder folder;
  Film film = *Film::create(small_film());
  fill(film, 6);
  std::string every_byte;
  for (int c = 1; c < 256; ++c) every_byte.push_back(static_cast<char>(c));
  for (const std::string& text :
       {std::string(), std::string("Grüße, 光\n\"{}\""), every_byte, std::string(1 << 20, 'x')}) {
    const auto report = save_film(film, folder / "film.exr", text);
    ASSERT_TRUE(report) << report.error().message;
    const auto loaded = load_film(folder / "film.exr");
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE(loaded->progress == text) << "of " << text.size() << " bytes " << loaded->progress.size();
  }
  EXPECT_FALSE(save_film(film, folder / "film.exr", std::string("before\0after", 12)));
}

TEST(FilmFile, SensorsOfAnyNameComeBack) {
  const TempFolder folder;
  for (const std::string& name : {std::string("none"), std::string(), std::string("cie1931"),
                                  std::string("a b\n"), std::string("{}")}) {
    FilmOptions o = small_film();
    o.xyz.reset();
    o.sensors.push_back({name, custom_sensor()});
    Film film = *Film::create(o);
    fill(film, 7);
    ASSERT_TRUE(save_film(film, folder / "film.exr"));
    auto loaded = load_film(folder / "film.exr");
    EXPECT_TRUE(loaded) << "\"" << name << "\": " << loaded.error().message;
    if (!loaded) continue;
    EXPECT_TRUE(film.same_contents(loaded->film)) << name;
    EXPECT_TRUE(FilmDevelopment::create(loaded->film, FilmLayer::kSensor)) << name;
  }
}

TEST(FilmFile, SensorsThatSeeLittleOfTheBandsComeBack) {
  const TempFolder folder;
  for (const char* bands :
       {"600:700:50", "830:900:35", "500:501:1", "400:700:300", "380:390:5", "360:830:235"}) {
    FilmOptions o = small_film();
    o.input = FilmInput::kBands;
    o.xyz.reset();
    o.sensors.push_back({"of my own", custom_sensor()});
    o.bands = *Bands::parse(bands);
    auto film = Film::create(o);
    ASSERT_TRUE(film) << bands << ": " << film.error().message;
    fill(*film, 8);
    ASSERT_TRUE(save_film(*film, folder / "film.exr"));
    auto loaded = load_film(folder / "film.exr");
    EXPECT_TRUE(loaded) << bands << ": " << loaded.error().message;
    if (loaded) {
      EXPECT_TRUE(film->same_contents(loaded->film)) << bands;
    }
  }
}

TEST(FilmFile, TheOptionsThatComeBackMakeTheSameFilmOfNamedSensors) {
  const TempFolder folder;
  FilmOptions o = small_film();
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  const Film film = *Film::create(o);
  ASSERT_TRUE(save_film(film, folder / "film.exr"));
  auto loaded = *load_film(folder / "film.exr");
  const auto made = Film::create(loaded.film.options());
  ASSERT_TRUE(made) << made.error().message;
  const auto merged = loaded.film.merge(*made);
  EXPECT_TRUE(merged) << merged.error().message;
}

TEST(FilmFile, EqualFilmsAreEqualFiles) {
  // Weights of 0, and weights that cancel, touch a tile and leave nothing there.
  const TempFolder folder;
  FilmOptions o = small_film();
  o.width = 64;
  o.negative_weights = true;
  Film a = *Film::create(o);
  Film b = *Film::create(o);
  FilmSamples s(3);
  s.put(0, 2, 2, 1);
  s.put(1, 60, 2, 0);
  s.put(2, 2, 3, 0);
  ASSERT_TRUE(a.add(s.wavelengths()));
  s.put(1, 20, 2, 0);
  ASSERT_TRUE(b.add(s.wavelengths()));
  ASSERT_TRUE(a.same_contents(b));
  ASSERT_TRUE(save_film(a, folder / "a.exr"));
  ASSERT_TRUE(save_film(b, folder / "b.exr"));
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
  auto loaded = *load_film(folder / "a.exr");
  ASSERT_TRUE(save_film(loaded.film, folder / "again.exr"));
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "again.exr"));
}

TEST(FilmFile, EmptyFilmsAndSinglePixelsComeBack) {
  const TempFolder folder;
  for (const auto& crop : {PixelWindow{0, 0, 1, 1}, PixelWindow{(1 << 18) - 1, 0, 1 << 18, 1},
                           PixelWindow{1000, 0, 1033, 1}, PixelWindow{0, 0, 1 << 18, 1}}) {
    FilmOptions o;
    o.width = 1 << 18;
    o.height = 1;
    o.crop = crop;
    Film film = *Film::create(o);
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(save_film(film, folder / "film.exr"));
      const auto loaded = load_film(folder / "film.exr");
      ASSERT_TRUE(loaded) << loaded.error().message;
      EXPECT_TRUE(film.same_contents(loaded->film));
      EXPECT_EQ(loaded->film.options().width, o.width);
      FilmSamples s(2);
      s.put(0, static_cast<float>(crop.x0) + 0.25F, 0, 1);
      s.put(1, static_cast<float>(crop.x1) - 0.25F, 0.99F, 1);
      ASSERT_TRUE(film.add(s.wavelengths()));
      EXPECT_EQ(film.stats().rejected.total(), 0U);
    }
  }
}

TEST(FilmFile, ManyBandsComeBack) {
  const TempFolder folder;
  for (const std::size_t count : {300U, 2000U, 4096U}) {
    FilmOptions o = small_film();
    o.spectral = true;
    std::vector<Band> bands;
    for (std::size_t i = 0; i < count; ++i) {
      const double lower = 360 + 470.0 * static_cast<double>(i) / static_cast<double>(count);
      bands.push_back({lower, lower + 0.03, lower + 0.1});
    }
    o.bands = *Bands::from_list(bands);
    Film film = *Film::create(o);
    fill(film, 3);
    const auto report = save_film(film, folder / "film.exr");
    if (count == 4096) {
      // More channels than OpenEXR can count: said, and nothing lost in silence.
      ASSERT_FALSE(report);
      EXPECT_EQ(report.error().code, ErrorCode::kUnavailable);
      EXPECT_THAT(report.error().message, testing::HasSubstr("32767"));
      continue;
    }
    ASSERT_TRUE(report) << count << " bands: " << report.error().message;
    const auto loaded = load_film(folder / "film.exr");
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE(film.same_contents(loaded->film));
  }
}

TEST(FilmFile, SavingWhereOneMayNotIsAnError) {
  const TempFolder folder;
  Film film = *Film::create(small_film());
  fill(film, 1);
  EXPECT_FALSE(save_film(film, folder / "no such folder/film.exr"));
  EXPECT_FALSE(save_film(film, folder.path().string()));
  EXPECT_FALSE(save_film(film, ""));
  const auto full = save_film(film, "/dev/full");
  if (full) ADD_FAILURE() << "a full device";
  std::ofstream(folder / "stands.exr") << "as it was";
  ImageOptions cancelled;
  cancelled.progress = [](const Progress&) { return false; };
  const auto report = save_film(film, folder / "stands.exr", "", cancelled);
  if (!report) {
    EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(bytes_of(folder / "stands.exr"), "as it was");
  }
  EXPECT_THAT(folder.names(), testing::ElementsAre("stands.exr"));
}

}  // namespace
}  // namespace spectile::test
