// Plans as bands of images: the file carries its plan, and gives its colours back without a side file.
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/spectile.hpp>

#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

Plan plan_of(BandSampling sampling) {
  PlannerOptions o;
  for (const char* name : {"D65", "FL11"}) o.lights.push_back(*find_light(name));
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") o.reflectances.push_back(*named_spectrum(info.name));
  }
  o.bands = 9;
  o.folds = 0;
  o.sampling = sampling;
  return *make_plan(o);
}

/// Of bands that overlap: widened, with weights that still have the white of both lights.
const Plan& plan() {
  static const Plan made = [] {
    Plan out = plan_of(BandSampling::kAverages);
    for (Band& band : out.bands) {
      band.lower_nm -= 12;
      band.upper_nm += 12;
    }
    return out;
  }();
  return made;
}

class PlannedBandsImages : public testing::Test {
 protected:
  void SetUp() override {
    test::Picture picture = test::every_color(70, 33);
    test::write_scanlines(in_, picture);
    options_.bands = *planned_bands(plan());
    options_.pixel = SampleType::kFloat;
  }

  /// Changes an attribute of a file's header and copies its pixels.
  void rewrite(const std::string& from, const std::string& to,
               const std::function<void(Imf::Header&)>& change, const std::string& without = {}) const {
    test::Picture picture = test::read_picture(from);
    if (!without.empty()) picture.planes.erase(without);
    Imf::Header header(picture.header.displayWindow(), picture.header.dataWindow());
    for (auto it = picture.header.begin(); it != picture.header.end(); ++it) {
      const std::string name = it.name();
      if (name.rfind("spectile", 0) == 0) header.insert(it.name(), it.attribute());
    }
    for (auto it = picture.header.channels().begin(); it != picture.header.channels().end(); ++it) {
      if (it.name() != without) header.channels().insert(it.name(), it.channel());
    }
    change(header);
    picture.header = header;
    test::write_scanlines(to, picture);
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string spectral_ = folder_ / "spectral.exr";
  const std::string out_ = folder_ / "out.exr";
  UpsampleImageOptions options_;
};

/// Largest difference of the colours of two files, relative where they are above 1.
double difference(const std::string& a, const std::string& b) {
  const test::Picture p = test::read_picture(a);
  const test::Picture q = test::read_picture(b);
  double most = 0;
  for (const char* name : {"R", "G", "B"}) {
    const test::Plane& x = p.planes.at(name);
    const test::Plane& y = q.planes.at(name);
    const auto count = static_cast<std::size_t>(p.width()) * static_cast<std::size_t>(p.height());
    for (std::size_t i = 0; i < count; ++i)
      most = std::max(most, std::abs(x.at(i) - y.at(i)) / std::max(1.0, std::abs(x.at(i))));
  }
  return most;
}

TEST_F(PlannedBandsImages, HaveAChannelForEachWavelengthAndGiveTheirColoursBack) {
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                              Method::kSigmoidObserver, Method::kTetrahedral}) {
    options_.method = method;
    options_.out_of_gamut = GamutPolicy::kClip;
    const auto made = upsample_image(in_, spectral_, options_);
    ASSERT_TRUE(made) << made.error().message;
    const auto info = inspect_image(spectral_);
    ASSERT_TRUE(info && info->bands);
    EXPECT_EQ(*info->bands, options_.bands);
    ProjectImageOptions project;
    project.pixel = SampleType::kFloat;
    const auto projected = project_image(spectral_, out_, project);
    ASSERT_TRUE(projected) << projected.error().message;
    if (made->out_of_gamut_pixels == 0) {
      EXPECT_LT(difference(in_, out_), 4e-6) << to_string(method);
    }
    EXPECT_EQ(test::read_picture(out_).header.findTypedAttribute<Imf::StringAttribute>("spectilePlan"),
              nullptr);
  }
}

TEST_F(PlannedBandsImages, AreSeenUnderTheirPlansLightsAndNoOthers) {
  ASSERT_TRUE(upsample_image(in_, spectral_, options_));
  ProjectImageOptions project;
  project.light = *illuminant("FL11");
  project.pixel = SampleType::kFloat;
  ASSERT_TRUE(project_image(spectral_, out_, project));
  RelightImageOptions relight({"FL11", *illuminant("FL11")});
  static_cast<MethodOptions&>(relight) = options_;
  const std::string direct = folder_ / "direct.exr";
  const auto relit = relight_image(in_, direct, relight);
  ASSERT_TRUE(relit) << relit.error().message;
  EXPECT_LT(difference(direct, out_), 4e-6);
  project.light = *illuminant("A");
  const auto refused = project_image(spectral_, out_, project);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("only for D65, FL11"));
}

TEST_F(PlannedBandsImages, ExpandFromCoefficientsToTheSameBits) {
  for (const Method method :
       {Method::kSmitsExact, Method::kSigmoid, Method::kSigmoidObserver, Method::kTetrahedral}) {
    options_.method = method;
    const std::string compact = folder_ / "compact.exr";
    ASSERT_TRUE(upsample_image(in_, spectral_, options_));
    options_.store = Store::kCoefficients;
    ASSERT_TRUE(upsample_image(in_, compact, options_));
    options_.store = Store::kSpectra;
    ExpandImageOptions expand;
    expand.pixel = SampleType::kFloat;
    const auto expanded = expand_image(compact, out_, expand);
    ASSERT_TRUE(expanded) << expanded.error().message;
    EXPECT_TRUE(test::read_picture(out_).planes == test::read_picture(spectral_).planes);
    EXPECT_EQ(*inspect_image(out_)->bands, options_.bands);
    // From the usual bands to the plan's.
    UpsampleImageOptions usual = options_;
    usual.bands = Bands();
    usual.store = Store::kCoefficients;
    ASSERT_TRUE(upsample_image(in_, compact, usual));
    expand.bands = options_.bands;
    const auto planned = expand_image(compact, out_, expand);
    ASSERT_TRUE(planned) << planned.error().message;
    EXPECT_EQ(*inspect_image(out_)->bands, options_.bands);
  }
}

TEST_F(PlannedBandsImages, AreTexturesWithTheirPlan) {
  ASSERT_TRUE(upsample_image(in_, spectral_, options_));
  const auto texture = SpectralTexture::open(spectral_);
  ASSERT_TRUE(texture) << texture.error().message;
  EXPECT_EQ(texture->bands(), options_.bands);
  SampledSpectra batch = *SampledSpectra::create(texture->bands(), 70);
  ASSERT_TRUE(texture->evaluate({0, 5, 70, 6}, batch.span()));
  ColorLanes xyz = *ColorLanes::create(70);
  ASSERT_TRUE(
      project(*Projector::reflective(texture->bands(), *illuminant("FL11")), batch.view(), xyz.span()));
}

TEST_F(PlannedBandsImages, AreRefusedWhereThePlanIsDamagedOrDoesNotFit) {
  ASSERT_TRUE(upsample_image(in_, spectral_, options_));
  const std::string bad = folder_ / "bad.exr";
  rewrite(spectral_, bad, [](Imf::Header& h) { h.insert("spectilePlan", Imf::StringAttribute("{\"wave")); });
  const auto damaged = project_image(bad, out_, test::kProject);
  ASSERT_FALSE(damaged);
  EXPECT_THAT(damaged.error().message, HasSubstr("spectilePlan"));
  EXPECT_FALSE(inspect_image(bad));
  EXPECT_FALSE(SpectralTexture::open(bad));
  std::string channel;
  for (const auto& [name, plane] : test::read_picture(spectral_).planes) {
    if (name.rfind("T.", 0) == 0) channel = name;
  }
  rewrite(
      spectral_, bad, [](Imf::Header&) {}, channel);
  const auto fewer = project_image(bad, out_, test::kProject);
  ASSERT_FALSE(fewer);
  EXPECT_THAT(fewer.error().message, HasSubstr("8 bands are not the 9 wavelengths"));
}

TEST_F(PlannedBandsImages, VerifyAgainstTheirOwnTables) {
  ASSERT_TRUE(upsample_image(in_, spectral_, options_));
  for (const std::string& path : {in_, spectral_}) {
    const auto report = verify_image(path, options_);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->ok()) << report->what << " " << report->max_oracle_difference;
  }
}

TEST_F(PlannedBandsImages, AreConvertedWithTheirPlanButNotToOtherBands) {
  ASSERT_TRUE(upsample_image(in_, spectral_, options_));
  ConvertImageOptions options;
  const auto kept = convert_image(spectral_, out_, options);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(*inspect_image(out_)->bands, options_.bands);
  EXPECT_TRUE(test::read_picture(out_).planes == test::read_picture(spectral_).planes);
  options.bands = Bands();
  const auto resampled = convert_image(spectral_, folder_ / "other.exr", options);
  ASSERT_FALSE(resampled);
  EXPECT_EQ(resampled.error().code, ErrorCode::kBadArgument);
  EXPECT_THAT(resampled.error().message, HasSubstr("its bands are planned"));
  options.bands = options_.bands;
  EXPECT_THAT(convert_image(spectral_, folder_ / "other.exr", options).error().message,
              HasSubstr("planned bands are weighed by their plan"));
}

TEST_F(PlannedBandsImages, HoldFilmsToo) {
  ASSERT_TRUE(options_.bands.overlap());
  FilmOptions o;
  o.width = o.height = 2;
  o.input = FilmInput::kBands;
  o.bands = options_.bands;
  o.spectral = true;
  o.xyz = Observer::kCie1931;
  const auto film = Film::create(o);
  ASSERT_TRUE(film);
  const std::string path = folder_ / "film.exr";
  ASSERT_TRUE(save_film(*film, path, {}, {}));
  const auto loaded = load_film(path);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->film.options().bands, o.bands);
  EXPECT_TRUE(loaded->film.same_contents(*film));
  ASSERT_TRUE(write_developed(*film, FilmLayer::kSpectrum, 0, out_, {}));
  EXPECT_EQ(*inspect_image(out_)->bands, o.bands);
}

}  // namespace
}  // namespace spectile
