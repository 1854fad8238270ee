// Reflected and emitted light of one file in one picture, and luminance in cd/m2.
#include <spectile/spectra/named_spectra.hpp>

#include "tests/io/channels/spectral_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

class BothQuantities : public SpectralFiles {
 protected:
  /// Reflectances that rise over 31 bands of 10 nm, and emission that falls over 16 of 20 nm.
  static Picture sample(const std::string& prefix = "") {
    Picture picture = blank(70, 2);
    add(picture, prefix);
    return picture;
  }
  static void add(Picture& picture, const std::string& prefix) {
    for (int i = 0; i < 31; ++i) {
      picture.add(fmt::format("{}T.{},000000nm", prefix, 400 + 10 * i), Imf::FLOAT,
                  [=](int x, int y) { return (i + 1) / 32.0 * (x % 5 + y) / 6; });
    }
    for (int i = 0; i < 16; ++i) {
      picture.add(fmt::format("{}S0.{},000000nm", prefix, 400 + 20 * i), Imf::FLOAT,
                  [=](int x, int y) { return (16 - i) / 16.0 * (x % 7 + 2 * y); });
    }
  }
  Picture projected(const ProjectImageOptions& options) {
    project(in_, options);
    return read_picture(out_);
  }
  static ProjectImageOptions of(ColorTarget target, Quantity quantity) {
    ProjectImageOptions options = xyz();
    options.target = target;
    options.quantity = quantity;
    if (quantity == Quantity::kReflectance) options.light = *illuminant("A");
    return options;
  }
};

TEST_F(BothQuantities, AreTheSumOfEach) {
  Picture picture = sample();
  write_scanlines(in_, picture);
  for (const auto& [target, names] :
       {std::pair(ColorTarget::kSrgb, "RGB"), std::pair(ColorTarget::kXyz, "XYZ"),
        std::pair(ColorTarget::kLuminance, "Y")}) {
    const Picture reflected = projected(of(target, Quantity::kReflectance));
    const Picture emitted = projected(of(target, Quantity::kIlluminant));
    for (const double scale : {1.0, 0.25}) {
      ProjectImageOptions options = of(target, Quantity::kReflectance);
      options.emission = scale;
      const ImageReport report = project(in_, options);
      EXPECT_THAT(report.notes, Contains(HasSubstr("reflected and emitted light are added")));
      EXPECT_THAT(report.notes, Not(Contains(HasSubstr("left out"))));
      const Picture both = read_picture(out_);
      for (const char* name = names; *name != '\0'; ++name) {
        const std::string channel(1, *name);
        for (std::size_t i = 0; i < both.pixels(); ++i) {
          const double want = reflected.planes.at(channel).at(i) + scale * emitted.planes.at(channel).at(i);
          ASSERT_NEAR(both.planes.at(channel).at(i), want, 1e-5 * (1 + std::abs(want)))
              << channel << " " << i;
        }
      }
      EXPECT_EQ(both.planes.size(), std::string(names).size()) << "no spectra are left";
    }
  }
}

TEST_F(BothQuantities, HaveOneScale) {
  // Half the light back, and a quarter of 1 emitted: Y is 0.75 whatever the illuminant.
  Picture picture = blank(2, 2);
  add_even(picture, "", 0.5, "T");
  add_even(picture, "", 0.25, "S0");
  ProjectImageOptions options = of(ColorTarget::kLuminance, Quantity::kReflectance);
  options.emission = 1;
  project(picture, options);
  EXPECT_NEAR(luminance_at_origin(out_), 0.75, 1e-6);
}

TEST_F(BothQuantities, AreOfOneLayer) {
  Picture picture = sample("left.");
  add(picture, "right.");
  write_scanlines(in_, picture);
  ProjectImageOptions options = of(ColorTarget::kXyz, Quantity::kReflectance);
  options.emission = 1;
  EXPECT_THAT(error_of(options), HasSubstr("several layers"));
  options.channels.layer = "right";
  EXPECT_THAT(project(in_, options).notes,
              Contains(HasSubstr("left out: 31 bands of reflectance, layer \"left\"")));
}

TEST_F(BothQuantities, AreBothNeeded) {
  ProjectImageOptions options = xyz();
  options.emission = 1;
  for (const char* kind : {"T", "S0"}) {
    Picture picture = blank(2, 2);
    add_even(picture, "", 0.5, kind);
    write_scanlines(in_, picture);
    EXPECT_THAT(error_of(options),
                HasSubstr(kind[0] == 'T' ? "31 bands of reflectance alone" : "31 bands of emission alone"));
  }
  Picture picture = sample();
  write_scanlines(in_, picture);
  options.adaptation = Adaptation::kBradford;
  EXPECT_THAT(error_of(options), HasSubstr("not adapted"));
}

TEST_F(BothQuantities, PhotometricLightIsInCandelas) {
  // 0.125 W / (m2 sr nm) from 395 to 705 nm, and a laser line's nanometre at 555 nm.
  Picture picture = blank(2, 2);
  add_even(picture, "", 0.125);
  ProjectImageOptions options = xyz();
  options.photometric = true;
  EXPECT_THAT(project(picture, options).notes, Contains(HasSubstr("cd/m2")));
  const double nm = integral(395, 705, [](double at) { return matching(1, at); });
  EXPECT_NEAR(luminance_at_origin(out_), 0.125 * 683 * nm, 0.125 * 683 * nm * 2e-6);

  Picture line = blank(2, 2);
  line.add("S0.555,000000nm", Imf::FLOAT, [](int, int) { return 2.0; });
  project(line, options);
  EXPECT_NEAR(luminance_at_origin(out_), 2 * 683 * 1.0, 2 * 683 * 1e-4) << "the band is one nanometre wide";

  options.observer = Observer::kCie1964;
  EXPECT_THAT(error_of(options), HasSubstr("1931"));
  Picture reflectance = blank(2, 2);
  add_even(reflectance, "", 0.5, "T");
  write_scanlines(in_, reflectance);
  options.observer = Observer::kCie1931;
  EXPECT_THAT(error_of(options), HasSubstr("reflectances"));
}

}  // namespace
}  // namespace spectile::test
