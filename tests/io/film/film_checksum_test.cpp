// A film's checksum: whatever bit of a file is flipped, the film that is loaded is the one that was saved, or
// none is. Films of versions without a checksum are still loaded, and known as such.
#include <OpenEXR/ImfStringAttribute.h>

#include <random>
#include <spectile/image/film_file.hpp>

#include "tests/film/film_support.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

class FilmChecksums : public testing::Test {
 protected:
  void save(const char* compression) {
    FilmOptions o = small_film();
    o.spectral = true;
    o.bands = *Bands::uniform(400, 700, 100);
    o.statistics = PixelStatistics::kVariance;
    o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
    film_.emplace(*Film::create(o));
    ASSERT_TRUE(film_->add(random_samples(900, 7).wavelengths()));
    ImageOptions options;
    options.compression = *Compression::parse(compression);
    ASSERT_TRUE(save_film(*film_, path_, "note", options));
  }

  TempFolder folder_;
  const std::string path_ = folder_ / "film.exr";
  std::optional<Film> film_;
};

TEST_F(FilmChecksums, FlippedBitsAreNeverTakenForSums) {
  for (const char* compression : {"none", "rle", "zip:1"}) {
    save(compression);
    const std::string bytes = file_bytes(path_);
    std::mt19937 random(3);
    std::size_t refused = 0;
    constexpr int kFlips = 300;
    for (int i = 0; i < kFlips; ++i) {
      std::string damaged = bytes;
      const std::size_t at = random() % damaged.size();
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
      write_text(folder_ / "flipped.exr", damaged);
      const auto loaded = load_film(folder_ / "flipped.exr");
      refused += loaded ? 0 : 1;
      // The preview and padding say nothing of the film, and may differ.
      if (loaded) {
        EXPECT_TRUE(loaded->film.same_contents(*film_)) << compression << " byte " << at;
        EXPECT_EQ(loaded->progress, "note") << compression << " byte " << at;
      }
    }
    EXPECT_GT(refused, 150U) << compression;
  }
}

TEST_F(FilmChecksums, FilmsWithoutOneAreLoadedAndKnown) {
  save("zip:1");
  const auto now = load_film(path_);
  ASSERT_TRUE(now);
  EXPECT_TRUE(now->has_checksum);
  // Uint channels are read as they are; the attribute is taken out.
  Picture picture = read_picture(path_);
  picture.header = without(picture.header, "spectileFilmChecksum");
  write_scanlines(folder_ / "old.exr", picture);
  const auto old = load_film(folder_ / "old.exr");
  ASSERT_TRUE(old) << old.error().message;
  EXPECT_FALSE(old->has_checksum);
  EXPECT_TRUE(old->film.same_contents(*film_));
}

TEST_F(FilmChecksums, TheFirstKindIsStillVerified) {
  save("zip:1");
  // As the version before this one saved it for the same film.
  const std::string first = "xxh3-128 23e6343a41058793630886503ebcd992";
  Picture picture = read_picture(path_);
  picture.header.insert("spectileFilmChecksum", Imf::StringAttribute(first));
  write_scanlines(folder_ / "first.exr", picture);
  const auto loaded = load_film(folder_ / "first.exr");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(loaded->has_checksum);
  EXPECT_TRUE(loaded->film.same_contents(*film_));
  picture.header.insert("spectileFilmChecksum",
                        Imf::StringAttribute(first.substr(0, first.size() - 1) + "3"));
  write_scanlines(folder_ / "first.exr", picture);
  EXPECT_FALSE(load_film(folder_ / "first.exr"));
}

TEST_F(FilmChecksums, AnotherSizeIsRefused) {
  save("zip:1");
  for (const auto& [right, below] : {std::pair{31, 19}, {19, 31}}) {
    Picture picture = read_picture(path_);
    // Within the same tile of 32 x 32, so that the crop alone could tell.
    picture.header.displayWindow().max = {right, below};
    write_scanlines(folder_ / "wider.exr", picture);
    const auto loaded = load_film(folder_ / "wider.exr");
    ASSERT_FALSE(loaded);
    EXPECT_THAT(loaded.error().message, testing::HasSubstr("is damaged"));
  }
}

TEST_F(FilmChecksums, LoadingStopsOnRequest) {
  save("zip:1");
  const auto stopped = load_film(path_, 1, [](const Progress&) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace spectile::test
