// Alpha and spectra: premultiplied colours have the premultiplied spectra of the straight ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>
#include <spectile/isa.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/exr_files.hpp"
#include "tests/support/lanes.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 150;
constexpr int kHeight = 9;

/// Alphas of a soft edge, with 0 and 1, and some that are none.
double alpha_at(int x, int y) {
  if (y == 0) return x < 70 ? 0.25 : 1;
  if (x % 10 == 0) return 0;
  if (x % 10 == 1) return 1;
  return x % 10 == 2 ? 0x1p-14 : std::round(test::noise(x, y, 9) * 256) / 256;
}

class Alpha : public testing::Test {
 protected:
  Alpha() {
    up_.method = Method::kSigmoid;
    up_.bands = *Bands::uniform(400, 700, 25);
    up_.pixel = SampleType::kFloat;
    up_.input_space = RgbSpace();  // stated, so that notes are of what is special only
    up_.alpha = AlphaMeaning::kPremultiplied;
  }
  ~Alpha() override { static_cast<void>(force_isa("")); }

  /// A straight colour that is the same for some 70 pixels at a time in the first lines.
  static float straight(int x, int y, int k) {
    if (y < 2) return 0.2F + 0.25F * static_cast<float>(k);
    if (x > 130) return 0;
    return static_cast<float>(test::noise(x, y, k));
  }
  /// The colours times `alpha`, and alpha beside them.
  static test::Picture picture(const std::function<double(int, int)>& alpha) {
    test::Picture out = test::blank(kWidth, kHeight);
    int channel = 0;
    for (const char* name : {"R", "G", "B"}) {
      const int k = channel++;
      out.add(name, Imf::FLOAT, [=](int x, int y) {
        const double a = alpha(x, y) == 0 ? 1 : alpha(x, y);
        return static_cast<float>(straight(x, y, k) * a);
      });
    }
    out.add("A", Imf::FLOAT, [=](int x, int y) { return alpha(x, y); });
    return out;
  }
  test::Picture upsampled(test::Picture in, const UpsampleImageOptions& options,
                          const char* name = "up.exr") {
    test::write_scanlines(folder_ / "in.exr", in);
    const auto report = upsample_image(folder_ / "in.exr", folder_ / name, options);
    EXPECT_TRUE(report) << report.error().message;
    if (report) report_ = *report;
    return test::read_picture(folder_ / name);
  }

  const test::TempFolder folder_;
  UpsampleImageOptions up_;
  ImageReport report_;
};

/// With each method where half the colour has not half the spectrum.
class AlphaOf : public Alpha, public testing::WithParamInterface<Method> {
 protected:
  AlphaOf() { up_.method = GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Methods, AlphaOf,
                         testing::Values(Method::kSigmoid, Method::kSigmoidObserver, Method::kTetrahedral),
                         [](const auto& one) { return test::test_name(std::string(to_string(one.param))); });

/// The opaque picture's coefficients, evaluated in double, times alpha.
TEST_F(Alpha, SigmoidSpectraAreAlphaTimesThoseOfTheStraightColour) {
  UpsampleImageOptions store = up_;
  store.store = Store::kCoefficients;
  const test::Picture c = upsampled(picture([](int, int) { return 1; }), store);
  const test::Picture got = upsampled(picture(alpha_at), up_);
  EXPECT_TRUE(report_.notes.empty());
  for (const Band& band : up_.bands.list()) {
    const std::string name = "T." + std::to_string(band.centre_nm).replace(3, 1, ",") + "nm";
    const double lambda = (band.centre_nm - 550) / 150;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double p = (c.at("spectile.c0", x, y) * lambda + c.at("spectile.c1", x, y)) * lambda +
                         c.at("spectile.c2", x, y);
        const double a = alpha_at(x, y) == 0 ? 1 : alpha_at(x, y);
        // The solver's own tolerance: colours that differ by a rounding have coefficients that differ more.
        ASSERT_NEAR(got.at(name, x, y), a * (0.5 + p / (2 * std::sqrt(1 + p * p))), 2e-4 * a)
            << name << " " << x << " " << y;
      }
    }
  }
}

TEST_P(AlphaOf, SpectraAreAlphaTimesThoseOfTheStraightColour) {
  const test::Picture opaque = upsampled(picture([](int, int) { return 1; }), up_);
  const test::Picture got = upsampled(picture(alpha_at), up_);
  for (const auto& [name, plane] : got.planes) {
    if (!name.starts_with("T.")) continue;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double a = alpha_at(x, y) == 0 ? 1 : alpha_at(x, y);
        ASSERT_NEAR(got.at(name, x, y), a * opaque.at(name, x, y), 2e-4 * a) << name << " " << x << " " << y;
      }
    }
  }
}

TEST_P(AlphaOf, OpaqueColoursAndThoseOfAlphaZeroStayAsTheyAre) {
  const auto ends = [](int x, int y) { return (x + y) % 3 == 0 ? 0 : 1; };
  UpsampleImageOptions ignored = up_;
  ignored.alpha = AlphaMeaning::kIgnored;
  EXPECT_EQ(upsampled(picture(ends), up_).planes, upsampled(picture(ends), ignored).planes);
  const auto none = [](int x, int) { return x % 2 == 0 ? -0.5 : x % 3 == 0 ? 255 : std::nan(""); };
  const auto same = [&] {
    test::Picture out = picture([](int, int) { return 1; });
    out.add("A", Imf::FLOAT, none);
    return out;
  };
  const auto with = upsampled(same(), up_).planes;
  const auto without = upsampled(same(), ignored).planes;
  for (const auto& [name, plane] : with) {
    if (name != "A") {
      EXPECT_EQ(plane, without.at(name)) << name;
    }
  }
}

TEST_F(Alpha, HomogeneousMethodsGiveTheSameBytes) {
  for (const auto& [method, quantity] : {std::pair{Method::kSmitsExact, Quantity::kReflectance},
                                         {Method::kMallett, Quantity::kReflectance},
                                         {Method::kSmits, Quantity::kIlluminant},
                                         {Method::kSigmoid, Quantity::kUnbounded},
                                         {Method::kSigmoid, Quantity::kIlluminant},
                                         {Method::kTetrahedral, Quantity::kUnbounded},
                                         {Method::kTetrahedral, Quantity::kIlluminant}}) {
    UpsampleImageOptions options = up_;
    options.method = method;
    options.quantity = quantity;
    const auto premultiplied = upsampled(picture(alpha_at), options).planes;
    for (const AlphaMeaning meaning : {AlphaMeaning::kStraight, AlphaMeaning::kIgnored}) {
      options.alpha = meaning;
      EXPECT_EQ(upsampled(picture(alpha_at), options).planes, premultiplied);
    }
  }
}

TEST_P(AlphaOf, BitsDependOnNothingElse) {
  for (const SampleType type : {SampleType::kHalf, SampleType::kFloat}) {
    up_.pixel = type;
    const auto expected = upsampled(picture(alpha_at), up_).planes;
    for (const char* isa : {"scalar", "sse4.2", "avx2", "avx512"}) {
      if (!force_isa(isa)) continue;
      for (const bool skip : {true, false}) {
        UpsampleImageOptions options = up_;
        options.skip = skip;
        options.threads = skip ? 1 : 3;
        options.tile = {{16, 4}};
        EXPECT_EQ(upsampled(picture(alpha_at), options).planes, expected) << isa << " skip " << skip;
      }
    }
    ASSERT_TRUE(force_isa(""));
  }
}

TEST_P(AlphaOf, CoefficientsExpandToTheSameSpectra) {
  for (const SampleType type : {SampleType::kHalf, SampleType::kFloat}) {
    up_.pixel = type;
    const auto direct = upsampled(picture(alpha_at), up_, "direct.exr").planes;
    UpsampleImageOptions store = up_;
    store.store = Store::kCoefficients;
    const test::Picture c = upsampled(picture(alpha_at), store, "c.exr");
    EXPECT_EQ(c.at("spectile.scale", 5, 4), alpha_at(5, 4));
    ExpandImageOptions expand;
    expand.pixel = type;
    const auto report = expand_image(folder_ / "c.exr", folder_ / "expanded.exr", expand);
    ASSERT_TRUE(report) << report.error().message;
    const test::Picture expanded = test::read_picture(folder_ / "expanded.exr");
    EXPECT_EQ(expanded.planes, direct);
    EXPECT_TRUE(expanded.header.find("spectileAlpha") != expanded.header.end());
  }
}

TEST_P(AlphaOf, RelightingDoesTheSame) {
  for (const RelightMode mode : {RelightMode::kDirect, RelightMode::kSpectra}) {
    upsampled(picture(alpha_at), up_);
    ProjectImageOptions project;
    const NamedLight light = *find_light("A");
    project.light = light.spectrum;
    project.pixel = SampleType::kFloat;
    ASSERT_TRUE(project_image(folder_ / "up.exr", folder_ / "p.exr", project));
    RelightImageOptions options(light);
    options.method = up_.method;
    options.bands = up_.bands;
    options.pixel = SampleType::kFloat;
    options.mode = mode;
    ASSERT_TRUE(relight_image(folder_ / "in.exr", folder_ / "lit.exr", options));
    const test::Picture lit = test::read_picture(folder_ / "lit.exr");
    const test::Picture projected = test::read_picture(folder_ / "p.exr");
    if (is_sigmoid(up_.method) || mode == RelightMode::kSpectra) {
      EXPECT_EQ(lit.planes, projected.planes);
      continue;
    }
    for (const char* name : {"R", "G", "B"}) {  // folded: as far apart as rounding is
      for (std::size_t i = 0; i < lit.pixels(); ++i)
        ASSERT_NEAR(lit.planes.at(name).at(i), projected.planes.at(name).at(i), 5e-6) << name << " " << i;
    }
  }
}

TEST_P(AlphaOf, ColoursAboveTheirAlphaAreKeptAndCounted) {
  test::Picture flame = test::blank(80, 2);
  for (const char* name : {"R", "G", "B"}) {
    const double c = name[0] == 'R' ? 0.75 : name[0] == 'G' ? 0.5 : 0.125;
    flame.add(name, Imf::HALF, [=](int, int) { return c; });
  }
  flame.add("A", Imf::HALF, [](int x, int) { return x < 10 ? 0.0625 : x < 20 ? 0 : 1; });
  upsampled(flame, up_);
  EXPECT_THAT(report_.notes, testing::ElementsAre(HasSubstr("20 pixels are brighter than alpha")));
  ASSERT_TRUE(project_image(folder_ / "up.exr", folder_ / "p.exr", test::kProject));
  const test::Picture back = test::read_picture(folder_ / "p.exr");
  for (const int x : {0, 15, 40}) {
    EXPECT_NEAR(back.at("R", x, 0), 0.75, 2e-3) << x;
    EXPECT_NEAR(back.at("G", x, 0), 0.5, 2e-3) << x;
    EXPECT_NEAR(back.at("B", x, 0), 0.125, 2e-3) << x;
  }
}

TEST_F(Alpha, ByDefaultNothingBecomesBlack) {
  for (const Method method : {Method::kSmitsExact, Method::kSigmoid, Method::kTetrahedral}) {
    up_.method = method;
    const test::Picture got = upsampled(picture([](int, int) { return 0; }), up_);
    EXPECT_GT(got.at("T.562,500000nm", 3, 3), 0);
    EXPECT_GT(got.at("G", 3, 3), 0);
    EXPECT_EQ(report_.skipped.masked_pixels, 0U);
  }
}

}  // namespace
}  // namespace spectile
