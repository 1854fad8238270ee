// A film fed with the engine's batches holds the very sums of one fed with rows.
#include "src/dispatch/dispatch.hpp"
#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

/// A film with everything that one fed with this can keep.
FilmOptions full_film(FilmInput input, SamplePlacement placement) {
  FilmOptions o;
  o.width = o.height = 40;
  o.input = input;
  o.placement = placement;
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 60);
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  o.statistics = PixelStatistics::kVariance;
  o.maximum_component = 1e5F;
  return o;
}

/// Rows as a batch, its padding filled with what must not count.
SampledSpectra as_batch(const RowsView& rows, std::size_t n, const SpectralAxis& axis) {
  auto out = *SampledSpectra::constant(axis, n, kNan);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < rows.count; ++k) out.at(i, k) = rows.data[k * rows.stride + i];
  }
  return out;
}

class FilmBatches : public testing::TestWithParam<SamplePlacement> {
 protected:
  ~FilmBatches() override { EXPECT_TRUE(dispatch::force("")); }
};

TEST_P(FilmBatches, OfWavelengthsAreTheRows) {
  for (const auto* const table : dispatch::available()) {
    ASSERT_TRUE(dispatch::force(table->name));
    for (const std::size_t n : {1, 63, 64, 65, 1024, 3001}) {
      const FilmSamples s = random_samples(n, 31, 40);
      const WavelengthSamples rows = s.wavelengths();
      const FilmOptions o = full_film(FilmInput::kWavelengths, GetParam());
      Film want = *Film::create(o);
      ASSERT_TRUE(want.add(rows));
      auto w = *SampledWavelengths::create(n, FilmSamples::kCount);
      w.lambda_nm = as_batch(rows.lambda_nm, n, w.axis());
      w.density = as_batch(rows.density, n, w.axis());
      const SampledSpectra radiance = as_batch(rows.radiance, n, w.axis());
      for (const int threads : {1, 4}) {
        Film got = *Film::create(o);
        ASSERT_TRUE(got.add({s.x, s.y, s.weight}, radiance, w, {threads, 64}));
        EXPECT_TRUE(got.same_contents(want)) << table->name << ": " << n << " on " << threads;
        EXPECT_EQ(got.stats().rejected, want.stats().rejected);
      }
      // Two parts of one batch.
      Film got = *Film::create(o);
      const std::size_t half = n / 128 * 64;
      const auto part = [&](std::size_t first, std::size_t count) {
        const auto of = [&](const std::vector<float>& v) { return std::span(v).subspan(first, count); };
        return got.add({of(s.x), of(s.y), of(s.weight)}, radiance.view().range(first, count),
                       w.view().range(first, count));
      };
      ASSERT_TRUE(part(0, half));
      ASSERT_TRUE(part(half, n - half));
      EXPECT_TRUE(got.same_contents(want)) << table->name << ": " << n << " in parts";
    }
  }
}

TEST_P(FilmBatches, OfBandsAreTheRows) {
  for (const auto* const table : dispatch::available()) {
    ASSERT_TRUE(dispatch::force(table->name));
    for (const std::size_t n : {1, 64, 65, 2500}) {
      const FilmSamples s = random_samples(n, 37, 40);
      const FilmOptions o = full_film(FilmInput::kBands, GetParam());
      BandBatch rows(o.bands.count(), n);
      for (std::size_t i = 0; i < n; ++i) {
        rows.put(i, s.x[i], s.y[i], s.weight[i]);
        for (std::size_t b = 0; b < o.bands.count(); ++b)
          rows.radiance(b, i) = static_cast<float>((i * 7 + b) % 23) * s.wavelengths().radiance.data[i];
      }
      Film want = *Film::create(o);
      ASSERT_TRUE(want.add(rows.samples()));
      Film got = *Film::create(o);
      ASSERT_TRUE(got.add({s.x, s.y, s.weight}, as_batch(rows.samples().radiance, n, o.bands)));
      EXPECT_TRUE(got.same_contents(want)) << table->name << ": " << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, FilmBatches,
                         testing::Values(SamplePlacement::kOnePixel, SamplePlacement::kSplat),
                         [](const auto& placement) {
                           return placement.param == SamplePlacement::kSplat ? "splat" : "one_pixel";
                         });

TEST(BatchesForAFilm, ThatDoNotFitAreRefused) {
  const std::vector<float> at(70, 0.5F);
  const SamplePositions positions = {at, at, {}};
  auto w = *SampledWavelengths::create(70, 4);
  Film film = *Film::create(full_film(FilmInput::kWavelengths, SamplePlacement::kOnePixel));
  EXPECT_EQ(film.add(positions, own_batch(70, 3), w).error().code, ErrorCode::kBandsMismatch);
  EXPECT_EQ(film.add(positions, own_batch(69, 4), w).error().code, ErrorCode::kSizeMismatch);
  EXPECT_EQ(film.add({at, {}, {}}, own_batch(70, 4), w).error().code, ErrorCode::kSizeMismatch);
  EXPECT_EQ(film.add(positions, own_batch(70, 4)).error().code, ErrorCode::kBadArgument);
  EXPECT_TRUE(film.add(positions, own_batch(70, 4), w));
  const auto on_bands = *SampledSpectra::create(*Bands::uniform(400, 700, 60), 70);
  EXPECT_EQ(film.add(positions, on_bands, {on_bands, on_bands}).error().code, ErrorCode::kBandsMismatch);

  Film bands = *Film::create(full_film(FilmInput::kBands, SamplePlacement::kOnePixel));
  const auto other = *SampledSpectra::create(*Bands::uniform(390, 690, 60), 70);
  const auto refused = bands.add(positions, other);
  EXPECT_EQ(refused.error().code, ErrorCode::kBandsMismatch);
  EXPECT_EQ(refused.error().message, "the spectra have bands 390:690:60, the film expects bands 400:700:60");
  EXPECT_EQ(bands.add(positions, own_batch(70, 5)).error().message,
            "the spectra have 5 wavelengths of each lane's own, the film expects bands 400:700:60");
  EXPECT_EQ(bands.add(positions, own_batch(70, 4), w).error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace spectile::test
