// Spectral images from memory are files as the tool's own: channels, attributes, preview, plan.
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <map>

#include "tests/io/write/written_spectra.hpp"

namespace spectile {
namespace {

using test::write_image;
using testing::ElementsAre;
using testing::HasSubstr;

/// An attribute's bytes by its name.
std::map<std::string, std::string> attributes_of(const std::string& path) {
  const Imf::Header header = test::read_picture(path).header;
  std::map<std::string, std::string> out;
  for (auto it = header.begin(); it != header.end(); ++it) {
    out[it.name()] = test::attribute_bytes(it.attribute());
  }
  return out;
}

class SpectralImageLayout : public testing::Test {
 protected:
  const test::TempFolder folder_;
  const std::string out_ = folder_ / "out.exr";
  const Bands bands_ = *Bands::parse("400:700:25");
};

TEST_F(SpectralImageLayout, IsThatOfUpsampledImages) {
  test::Picture picture = test::blank(70, 33);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder_ / "in.exr", picture);
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
    for (const bool tiled : {false, true}) {
      SCOPED_TRACE(fmt::format("{}, tiled {}", to_string(quantity), tiled));
      UpsampleImageOptions up;
      up.bands = bands_;
      up.quantity = quantity;
      up.pixel = SampleType::kFloat;
      if (tiled) up.tile = {32, 64};
      ASSERT_TRUE(upsample_image(folder_ / "in.exr", folder_ / "up.exr", up));
      SpectralImageOptions options = test::as_floats();
      options.quantity = quantity;
      options.tile = up.tile;
      options.preview = true;
      ASSERT_TRUE(write_image(out_, test::read_spectra(folder_ / "up.exr"), 70, 33, options));

      test::Picture made = test::read_picture(folder_ / "up.exr");
      test::Picture written = test::read_picture(out_);
      for (const char* name : {"R", "G", "B"}) {
        // A texture's own colours, halves there.
        EXPECT_EQ(made.planes.erase(name), 1U);
        EXPECT_EQ(written.planes.erase(name), 1U);
      }
      EXPECT_TRUE(made.planes == written.planes);

      auto expected = attributes_of(folder_ / "up.exr");
      auto got = attributes_of(out_);
      for (const char* name : {"spectileMethod", "spectileLight", "spectileObserver", "spectileSettings"}) {
        EXPECT_EQ(expected.erase(name), 1U) << name << " says how spectra were made of colours";
      }
      EXPECT_EQ(got.erase("colorInteropID"), 1U);
      expected.erase("channels");
      got.erase("channels");
      EXPECT_EQ(got, expected);
    }
  }
}

TEST_F(SpectralImageLayout, KeepsTheRulesOfTheLayout) {
  const auto spectra = test::noise_spectra(bands_, 20, 20);
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
    SpectralImageOptions options;
    options.quantity = quantity;
    options.preview = true;
    ASSERT_TRUE(write_image(out_, spectra, 20, 20, options));
    const auto findings = validate_image(out_);
    ASSERT_TRUE(findings) << findings.error().message;
    for (const LayoutFinding& finding : *findings) ADD_FAILURE() << finding.rule << ": " << finding.detail;
    const auto info = inspect_image(out_);
    ASSERT_TRUE(info);
    EXPECT_EQ(info->bands, bands_);
    EXPECT_EQ(info->quantity, quantity);
    EXPECT_TRUE(info->notes.empty());
  }
}

TEST_F(SpectralImageLayout, PreviewIsTheColourThatProjectMakes) {
  const auto spectra = test::noise_spectra(bands_, 70, 9);
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
    SpectralImageOptions options = test::as_floats();
    options.quantity = quantity;
    options.preview = true;
    ASSERT_TRUE(write_image(out_, spectra, 70, 9, options));
    ProjectImageOptions project;
    project.pixel = SampleType::kFloat;
    ASSERT_TRUE(project_image(out_, folder_ / "rgb.exr", project));
    const test::Picture written = test::read_picture(out_);
    const test::Picture projected = test::read_picture(folder_ / "rgb.exr");
    for (const char* name : {"R", "G", "B"}) {
      EXPECT_TRUE(written.planes.at(name) == projected.planes.at(name)) << name;
    }
    EXPECT_EQ(test::read_picture(out_).header.typedAttribute<Imf::StringAttribute>("colorInteropID").value(),
              "lin_rec709_scene");
  }
}

TEST_F(SpectralImageLayout, PerfectDiffuserIsPreviewedWhite) {
  const auto white = *SampledSpectra::constant(bands_, 3, 1.0F);
  SpectralImageOptions options;
  options.preview = true;
  ASSERT_TRUE(write_image(out_, white, 3, 1, options));
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(test::read_picture(out_).at(name, 2, 0), 1) << name;
}

TEST_F(SpectralImageLayout, PreviewOfHugeSpectraStaysFinite) {
  const auto huge = *SampledSpectra::constant(bands_, 3, test::kMost);
  SpectralImageOptions options = test::as_floats();
  options.preview = true;
  ASSERT_TRUE(write_image(out_, huge, 3, 1, options));
  for (const char* name : {"R", "G", "B"}) {
    EXPECT_TRUE(std::isfinite(test::read_picture(out_).at(name, 1, 0))) << name;
  }
  EXPECT_TRUE(test::same_lanes(test::read_spectra(out_), huge));
}

TEST_F(SpectralImageLayout, LightHasTheUnitsAskedFor) {
  const auto spectra = test::noise_spectra(bands_, 4, 3);
  SpectralImageOptions options;
  options.quantity = Quantity::kIlluminant;
  const auto units = [&] {
    return test::read_picture(out_).header.typedAttribute<Imf::StringAttribute>("emissiveUnits").value();
  };
  ASSERT_TRUE(write_image(out_, spectra, 4, 3, options));
  EXPECT_EQ(units(), "W.m^-2.sr^-1");
  options.units = "W.m^-2.sr^-1.nm^-1";
  ASSERT_TRUE(write_image(out_, spectra, 4, 3, options));
  EXPECT_EQ(units(), "W.m^-2.sr^-1.nm^-1");
  EXPECT_FALSE(attributes_of(out_).contains("colorInteropID")) << "without a preview there is no colour";
}

TEST_F(SpectralImageLayout, PlannedBandsCarryTheirPlan) {
  PlannerOptions planner;
  planner.lights.push_back(*find_light("D65"));
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") planner.reflectances.push_back(*named_spectrum(info.name));
  }
  planner.bands = 6;
  planner.folds = 0;
  const Bands planned = *planned_bands(*make_plan(planner));
  SpectralImageOptions options = test::as_floats();
  options.preview = true;
  const auto spectra = test::noise_spectra(planned, 9, 4);
  ASSERT_TRUE(write_image(out_, spectra, 9, 4, options));
  EXPECT_EQ(SpectralTexture::open(out_)->bands(), planned);
  EXPECT_TRUE(test::same_lanes(test::read_spectra(out_), spectra));
}

TEST_F(SpectralImageLayout, EdgesThatNamesDoNotHoldAreNoted) {
  const Bands gaps = *Bands::from_list({{400, 410, 420}, {500, 510, 520}});
  const auto report = write_image(out_, test::noise_spectra(gaps, 4, 3), 4, 3);
  ASSERT_TRUE(report);
  EXPECT_THAT(report->notes, ElementsAre(HasSubstr("the layout names centres")));
}

}  // namespace
}  // namespace spectile
