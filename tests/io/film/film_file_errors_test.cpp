// Partial films that are damaged, or are none: a clear error each, or a film that can be used, never a crash.
#include <OpenEXR/ImfStringAttribute.h>

#include <random>
#include <spectile/image/film_file.hpp>

#include "tests/film/film_support.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

/// A film with everything that a film can keep, in a file.
std::string saved_film(const TempFolder& folder, bool bands = false) {
  FilmOptions o = small_film();
  o.width = 40;
  o.crop = PixelWindow{3, 2, 38, 19};
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 100);
  o.statistics = PixelStatistics::kVariance;
  o.input = bands ? FilmInput::kBands : FilmInput::kWavelengths;
  o.placement = SamplePlacement::kSplat;
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  Film film = *Film::create(o);
  if (bands) {
    BandBatch b(3, 200);
    for (std::size_t i = 0; i < 200; ++i) b.put(i, static_cast<float>(i % 40), static_cast<float>(i % 19), 1);
    EXPECT_TRUE(film.add(b.samples()));
  } else {
    EXPECT_TRUE(film.add(random_samples(500, 4, 40).wavelengths()));
  }
  EXPECT_TRUE(save_film(film, folder / "film.exr", "note"));
  return folder / "film.exr";
}

/// Loads; what comes is an error with a sentence, or a film that everything can be done with.
bool loads(const std::string& path) {
  auto loaded = load_film(path);
  if (!loaded) {
    EXPECT_EQ(loaded.error().code, ErrorCode::kBadFile) << loaded.error().message;
    EXPECT_NE(loaded.error().message.find(path), std::string::npos) << loaded.error().message;
    return false;
  }
  Film& film = loaded->film;
  for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kSpectrum, FilmLayer::kWeight,
                                FilmLayer::kVariance, FilmLayer::kCount, FilmLayer::kSensor}) {
    auto d = FilmDevelopment::create(film, layer);
    if (d) static_cast<void>(d->update());
  }
  static_cast<void>(film.add(random_samples(50, 5).wavelengths()));
  return true;
}

TEST(FilmFileErrors, CutAnywhere) {
  const TempFolder folder;
  const std::string bytes = file_bytes(saved_film(folder));
  std::mt19937 random(1);
  for (int i = 0; i < 150; ++i) {
    const std::size_t length = i < 40 ? static_cast<std::size_t>(i) : random() % bytes.size();
    write_text(folder / "cut.exr", bytes.substr(0, length));
    EXPECT_FALSE(loads(folder / "cut.exr")) << length << " of " << bytes.size();
  }
}

TEST(FilmFileErrors, BytesChangedAnywhere) {
  const TempFolder folder;
  const std::string bytes = file_bytes(saved_film(folder));
  std::mt19937 random(2);
  for (int i = 0; i < 400; ++i) {
    std::string changed = bytes;
    const int count = 1 + i % 4;
    for (int k = 0; k < count; ++k) {
      const std::size_t range = i % 2 == 0 ? changed.size() : std::min<std::size_t>(changed.size(), 6000);
      changed[random() % range] = static_cast<char>(random());
    }
    write_text(folder / "changed.exr", changed);
    loads(folder / "changed.exr");
  }
}

TEST(FilmFileErrors, LimbsOfAnyBits) {
  // Sums that no film can have come to: an error, or numbers; no arithmetic beyond the ends of integers.
  for (const bool bands : {false, true}) {
    const TempFolder folder;
    Picture good = read_picture(saved_film(folder, bands));
    std::mt19937 random(3);
    for (int i = 0; i < 60; ++i) {
      Picture bad = good;
      for (auto& [name, plane] : bad.planes) {
        if (plane.type != Imf::UINT || (i > 20 && random() % 8 != 0)) continue;
        const bool high = name.ends_with(".hi");
        const std::uint32_t values[] = {high ? 0x7FFFFFFFU : 0xFFFFFFFFU, high ? 0x80000000U : 0U,
                                        0xFFFFFFFFU, static_cast<std::uint32_t>(random())};
        for (std::size_t p = 0; p < bad.pixels(); ++p) {
          const std::uint32_t v = i == 0 ? values[0] : i == 1 ? values[1] : values[random() % 4];
          std::memcpy(plane.bytes.data() + 4 * p, &v, 4);
        }
      }
      write_scanlines(folder / "bad.exr", bad);
      loads(folder / "bad.exr");
    }
  }
}

TEST(FilmFileErrors, AttributesMissingOrChangedAreNamed) {
  const TempFolder folder;
  Picture good = read_picture(saved_film(folder));
  std::vector<std::string> names;
  for (auto it = good.header.begin(); it != good.header.end(); ++it) {
    const std::string name = it.name();
    if (name.starts_with("spectileFilm")) names.push_back(name);
  }
  EXPECT_GE(names.size(), 15U);
  for (const std::string& name : names) {
    Picture bad = good;
    bad.header = without(good.header, name);
    write_scanlines(folder / "bad.exr", bad);
    // Films of earlier versions have no checksum.
    EXPECT_EQ(loads(folder / "bad.exr"), name == "spectileFilmChecksum") << name << " missing";
    for (const char* text : {"", "?", "-1", "nan", "1e400", "99999999999999999999", "1 2 3 4 5", "0 0 0 0",
                             "-1 -1 5 5", "inf", " 1", "1 ", "0 0 2147483647 2147483647", "4294967295"}) {
      if (name == "spectileFilmProgress") continue;
      bad = good;
      bad.header.insert(name, Imf::StringAttribute(text));
      write_scanlines(folder / "bad.exr", bad);
      const bool fine = loads(folder / "bad.exr");
      // A sensor's name and a maximum may be other ones.
      if (name != "spectileFilmResponse0" && name != "spectileFilmResponse1" &&
          name != "spectileFilmMaximum") {
        EXPECT_FALSE(fine) << name << " = \"" << text << '"';
      }
    }
  }
}

TEST(FilmFileErrors, HugeCountsAreTakenOrRefusedButDoNotOverflow) {
  const TempFolder folder;
  Picture bad = read_picture(saved_film(folder));
  const std::string most = "18446744073709551615";
  bad.header.insert("spectileFilmCounts", Imf::StringAttribute(most + " " + most + " 0 0 0 0"));
  write_scanlines(folder / "bad.exr", bad);
  loads(folder / "bad.exr");
}

TEST(FilmFileErrors, ChannelsMissingOrOfOtherKinds) {
  const TempFolder folder;
  const Picture good = read_picture(saved_film(folder));
  for (const auto& [name, plane] : good.planes) {
    if (plane.type != Imf::UINT) continue;
    Picture bad = good;
    bad.planes.erase(name);
    bad.header.channels() = Imf::ChannelList();
    for (const auto& [other, p] : bad.planes) bad.header.channels().insert(other, Imf::Channel(p.type));
    write_scanlines(folder / "bad.exr", bad);
    // Films of earlier versions have no checksum.
    EXPECT_EQ(loads(folder / "bad.exr"), name == "spectileFilmChecksum") << name << " missing";
    bad = good;
    bad.planes[name].type = Imf::FLOAT;
    bad.header.channels()[name].type = Imf::FLOAT;
    write_scanlines(folder / "bad.exr", bad);
    EXPECT_FALSE(loads(folder / "bad.exr")) << name << " of floats";
  }
}

TEST(FilmFileErrors, WindowsThatAreNotTheFilms) {
  const TempFolder folder;
  const Picture good = read_picture(saved_film(folder));
  const auto with = [&](Imath::Box2i data, Imath::Box2i display) {
    Picture bad = good;
    const Imath::Box2i was = bad.header.dataWindow();
    bad.header.dataWindow() = data;
    bad.header.displayWindow() = display;
    if (was.size() == data.size()) {
      write_scanlines(folder / "bad.exr", bad);
    } else {
      for (auto& [name, plane] : bad.planes) {
        plane.bytes.assign(bad.pixels() * Plane::sample_bytes(plane.type), 1);
      }
      write_scanlines(folder / "bad.exr", bad);
    }
    return loads(folder / "bad.exr");
  };
  const Imath::Box2i data = good.header.dataWindow();
  const Imath::Box2i display = good.header.displayWindow();
  EXPECT_TRUE(with(data, display));
  const auto moved = [&](int x, int y) {
    return Imath::Box2i(data.min + Imath::V2i(x, y), data.max + Imath::V2i(x, y));
  };
  EXPECT_FALSE(with(moved(1, 0), display));
  EXPECT_FALSE(with(moved(0, -1), display));
  EXPECT_FALSE(with(moved(-10, 0), display));
  EXPECT_FALSE(with({{0, 0}, {39, 19}}, display));
  EXPECT_FALSE(with(data, {{0, 0}, {20, 19}}));
  EXPECT_FALSE(with(data, {{-5, -5}, {-1, -1}}));
  EXPECT_FALSE(with(data, {{0, 0}, {1 << 20, 1 << 20}}));
  EXPECT_FALSE(with(data, {{-7, -3}, display.max})) << "a display window that does not begin at 0, 0";
}

TEST(FilmFileErrors, OtherImagesAreNoFilms) {
  const TempFolder folder;
  EXPECT_FALSE(loads(folder / "there is none.exr"));
  EXPECT_FALSE(loads(folder.path().string()));
  write_text(folder / "text.exr", "no image");
  EXPECT_FALSE(loads(folder / "text.exr"));
  SPECTILE_NEEDS_IMAGES("damaged");
  for (const char* kind : {"damaged", "rgb", "spectral"}) {
    for (const std::string& path : shared_files(kind)) EXPECT_FALSE(loads(path)) << path;
  }
}

}  // namespace
}  // namespace spectile::test
