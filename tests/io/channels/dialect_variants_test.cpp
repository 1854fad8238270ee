// Spectral images a little different from what programs write: names out of order, in other units, in layers
// of views; the colours are those of the tests' own integrals.
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>

#include <spectile/image/channel_map.hpp>

#include "tests/io/channels/spectral_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

class DialectVariants : public SpectralFiles {
 protected:
  /// Bands whose value depends on their place.
  struct Spectrum {
    std::vector<std::pair<double, double>> bands;
    std::vector<double> values;
    double add(double lower, double upper) {
      bands.emplace_back(lower, upper);
      values.push_back(0.25 + 0.125 * static_cast<double>(values.size() % 4));
      return values.back();
    }
  };
  static void put(Picture& picture, const std::string& name, double value) {
    picture.add(name, Imf::FLOAT, [=](int, int) { return value; });
  }
};

TEST_F(DialectVariants, RangesMayHaveGapsAndDecimalCommas) {
  Picture picture = blank(2, 2);
  Spectrum s;
  for (int nm = 400; nm < 700; nm += 50) {
    const double lower = nm + 0.5;
    const double upper = nm + (nm == 500 ? 20.25 : 50.5);
    std::string name = fmt::format("{:.2f}-{:.2f}nm", lower, upper);
    std::ranges::replace(name, '.', ',');
    put(picture, name, s.add(lower, upper));
  }
  project(picture);
  expect_pixel(light_of(s.bands, s.values));
}

TEST_F(DialectVariants, RangesAreOrderedByNumber) {
  // As names 1000 comes before 900.
  Picture picture = blank(2, 2);
  Spectrum s;
  for (int nm = 380; nm < 1100; nm += 60)
    put(picture, fmt::format("{}-{}nm", nm, nm + 60), s.add(nm, nm + 60));
  EXPECT_EQ(project(picture).bands, 12U);
  expect_pixel(light_of(s.bands, s.values));
}

TEST_F(DialectVariants, LowerEdgesMayBeIntegersAndUneven) {
  Picture picture = blank(2, 2);
  Spectrum s;
  const double edges[] = {390, 420, 480, 500, 575, 640, 705};  // the last as wide as the one before
  for (std::size_t i = 0; i + 1 < std::size(edges); ++i)
    put(picture, fmt::format("glossy.wavelength{}", edges[i]), s.add(edges[i], edges[i + 1]));
  const ImageReport report = project(picture);
  EXPECT_THAT(report.notes, Contains(HasSubstr("layer \"glossy\", the only one with spectra")));
  EXPECT_THAT(report.notes, Contains(HasSubstr("are lower edges")));
  expect_pixel(light_of(s.bands, s.values));
}

TEST_F(DialectVariants, AttributesMayDescendAndBeFloats) {
  Picture picture = blank(2, 2);
  Spectrum s;
  for (int i = 0; i < 16; ++i) {
    const double centre = 700 - 20 * i;
    const std::string name = fmt::format("wl{}", i);
    put(picture, name, s.add(centre - 10, centre + 10));
    picture.header.insert(name + ".wavelength", Imf::FloatAttribute(static_cast<float>(centre * 1e-9)));
  }
  project(picture);
  expect_pixel(light_of(s.bands, s.values), 2e-5);
}

TEST_F(DialectVariants, LayoutMayBeInOtherUnits) {
  const auto um = [](double nm) { return fmt::format("S0.{:.3f}um", nm * 1e-3); };
  const auto metres = [](double nm) { return fmt::format("S0.{:.2f}e-7m", nm * 1e-2); };
  const auto terahertz = [](double nm) { return fmt::format("S0.{:.9f}THz", 299792.458 / nm); };
  for (const auto& name : {std::function<std::string(double)>(um), {metres}, {terahertz}}) {
    Picture picture = blank(2, 2);
    Spectrum s;
    for (int nm = 400; nm <= 700; nm += 20) put(picture, name(nm), s.add(nm - 10, nm + 10));
    EXPECT_EQ(project(picture).quantity, Quantity::kIlluminant);
    expect_pixel(light_of(s.bands, s.values), 1e-5);
  }
}

TEST_F(DialectVariants, LayersOfViewsAreTold) {
  Picture picture = blank(2, 2);
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  add_even(picture, "diffuse.", 0.5);
  add_even(picture, "diffuse.right.", 0.25);
  write_scanlines(in_, picture);
  const ImageReport report = project(in_);
  EXPECT_THAT(report.notes, Contains("layer \"diffuse\", the only one with spectra, is taken"));
  EXPECT_THAT(report.notes,
              Contains(HasSubstr("left out: 31 bands of emission, layer \"diffuse\", view \"right\"")));
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);
  ProjectImageOptions options = xyz();
  options.channels.view = "right";
  project(in_, options);
  EXPECT_NEAR(luminance_at_origin(out_), 0.25, 1e-6);
}

TEST_F(DialectVariants, PartsMayBeViews) {
  Picture left = blank(2, 2);
  Picture right = blank(2, 2);
  add_even(left, "", 0.5);
  add_even(right, "", 0.25);
  std::vector<Imf::Header> headers;
  for (Picture* const picture : {&left, &right}) {
    picture->header.setName(picture == &left ? "L" : "R");
    picture->header.setView(picture == &left ? "left" : "right");
    picture->header.setType("scanlineimage");
    headers.push_back(picture->header);
  }
  {
    Imf::MultiPartOutputFile file(in_.c_str(), headers.data(), 2);
    int i = 0;
    for (Picture* const picture : {&left, &right}) {
      Imf::OutputPart part(file, i++);
      part.setFrameBuffer(picture->frame_buffer());
      part.writePixels(2);
    }
  }
  EXPECT_THAT(project(in_).notes,
              Contains(HasSubstr("left out: 31 bands of emission, part \"R\", view \"right\"")));
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);
  ProjectImageOptions options = xyz();
  options.channels.view = "right";
  project(in_, options);
  EXPECT_NEAR(luminance_at_origin(out_), 0.25, 1e-6);
}

TEST_F(DialectVariants, ReradiationMayBeInOtherUnitsAndLayers) {
  // All of the light of 400 to 440 nm comes back from 560 to 600 nm.
  for (const char* const form : {"paper.T.{}nm.{}nm", "T.{}e-9m.{}e-9m"}) {
    const std::string text = form;
    const std::string prefix = text.starts_with("paper.") ? "paper." : "";
    Picture picture = blank(2, 2);
    for (int nm = 420; nm <= 700; nm += 40)
      put(picture, fmt::format("{}T.{}nm", prefix, nm), nm == 420 ? 0 : 0.5);
    put(picture, fmt::format(fmt::runtime(text), 420, 580), 1);
    const MeasuredSpectrum d65 = *illuminant("D65");
    const auto at = [&](double nm) { return d65.at(nm); };
    Xyz want{};
    double unit = 0;
    for (int nm = 420; nm <= 700; nm += 40) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double w = integral(nm - 20, nm + 20, [&](double x) { return at(x) * matching(k, x); });
        want[k] += nm == 420 ? 0 : 0.5 * w;
        if (k == 1) unit += w;
      }
    }
    const double absorbed = integral(400, 440, at) / 40;
    for (std::size_t k = 0; k < 3; ++k)
      want[k] = (want[k] + absorbed * integral(560, 600, [&](double x) { return matching(k, x); })) / unit;
    project(picture);
    expect_pixel(want, 2e-5);
    EXPECT_EQ(read_picture(out_).planes.size(), 3U);
    EXPECT_THAT(inspect_image(in_)->contents,
                Contains(HasSubstr("8 bands of reflectance with re-radiation")));
  }
}

TEST_F(DialectVariants, MapsMayHaveAByteOrderMarkAndOtherNames) {
  Picture picture = blank(2, 2);
  for (const char* name : {"VIS-1", "band 2", "NIR.a"}) put(picture, name, 0.5);
  write_text(folder_ / "map.csv", "\xEF\xBB\xBFVIS-1,400,500\r\nband 2,500,600\r\nNIR.a,600,700\r\n");
  ProjectImageOptions options = xyz();
  const auto map = load_channel_map(folder_ / "map.csv");
  ASSERT_TRUE(map) << map.error().message;
  options.channels.map = *map;
  project(picture, options);
  expect_pixel(light_of({{400, 700}}, {0.5}));
}

}  // namespace
}  // namespace spectile::test
