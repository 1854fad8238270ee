// Coefficients expand to the spectra that upsampling writes directly, and to those of other bands.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>

#include "src/spectra/sigmoid_functions.hpp"
#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile {
namespace {

using test::Kind;
using testing::HasSubstr;

class Expand : public testing::TestWithParam<Kind> {
 protected:
  /// Writes in.exr and compact.exr.
  void make(test::Picture picture, const UpsampleImageOptions& options) {
    test::write_scanlines(in_, picture);
    test::upsample_to(Store::kCoefficients, in_, compact_, options);
  }

  /// Upsamples directly and expands, with the options' pixel, threads and tiles, and compares all there is.
  void expect_same(const UpsampleImageOptions& options, const std::string& what) {
    ExpandImageOptions expand;
    static_cast<ImageOptions&>(expand) = options;
    const auto direct = upsample_image(in_, folder_ / "direct.exr", options);
    const auto expanded = expand_image(compact_, out_, expand);
    ASSERT_TRUE(direct) << what << ": " << direct.error().message;
    ASSERT_TRUE(expanded) << what << ": " << expanded.error().message;
    EXPECT_EQ(expanded->clamped_pixels, direct->clamped_pixels) << what;
    EXPECT_EQ(expanded->bands, direct->bands) << what;
    EXPECT_EQ(expanded->quantity, direct->quantity) << what;
    EXPECT_EQ(expanded->nonfinite_pixels, 0U) << what;
    limited_ += expanded->clamped_pixels;
    const test::Picture want = test::read_picture(folder_ / "direct.exr");
    const test::Picture got = test::read_picture(out_);
    EXPECT_TRUE(got.planes == want.planes) << what;
    EXPECT_EQ(attributes(got.header), attributes(want.header)) << what;
  }

  /// Name and bytes of all but the channels, which are compared with the planes, and the settings.
  static std::map<std::string, std::string> attributes(const Imf::Header& header) {
    std::map<std::string, std::string> out;
    for (auto it = header.begin(); it != header.end(); ++it)
      out[it.name()] = test::attribute_bytes(it.attribute());
    out.erase("channels");
    out.erase("spectileSettings");  // say how each was made, not what it holds
    return out;
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string compact_ = folder_ / "compact.exr";
  const std::string out_ = folder_ / "out.exr";
  std::uint64_t limited_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Kinds, Expand, testing::ValuesIn(test::all_kinds()), test::kind_name);

TEST_P(Expand, GivesTheBitsOfUpsamplingDirectly) {
  for (const auto& [width, height] : {std::pair(67, 5), std::pair(1, 1), std::pair(130, 3)}) {
    UpsampleImageOptions options = test::options_of(GetParam());
    make(test::every_color(width, height), options);
    for (const SampleType pixel : {SampleType::kHalf, SampleType::kFloat}) {
      for (const auto& [threads, tile] : {std::pair(1, 64), std::pair(2, 65536), std::pair(3, 128)}) {
        options.pixel = pixel;
        options.threads = threads;
        options.tile_lanes = static_cast<std::size_t>(tile);
        expect_same(options, fmt::format("{} x {}, {}, {} threads, tiles of {}", width, height,
                                         pixel == SampleType::kHalf ? "half" : "float", threads, tile));
      }
    }
  }
  // The test has pixels that a half cannot hold, but for reflectances of sigmoids, which end at 1.
  const bool ends = is_sigmoid(GetParam().method) && GetParam().quantity == Quantity::kReflectance;
  EXPECT_EQ(limited_ == 0, ends);
}

TEST_P(Expand, GivesTheBitsForWideColoursAndKeptNegatives) {
  test::Picture picture = test::every_color(67, 5);
  picture.header.insert("colorInteropID", Imf::StringAttribute("lin_rec2020_scene"));
  UpsampleImageOptions options = test::options_of(GetParam());
  for (const NegativeInput negative : {NegativeInput::kClip, NegativeInput::kKeep}) {
    options.negative = negative;
    make(picture, options);
    for (const SampleType pixel : {SampleType::kHalf, SampleType::kFloat}) {
      options.pixel = pixel;
      expect_same(options, negative == NegativeInput::kKeep ? "kept" : "clipped");
    }
  }
}

TEST_P(Expand, PixelsLimitedInHalfAreThoseWithALargerSampleInFloat) {
  UpsampleImageOptions options = test::options_of(GetParam());
  options.negative = NegativeInput::kKeep;
  test::Picture picture = test::every_color(67, 5);
  for (const char* name : {"R", "G", "B"})
    picture.planes.at(name).set(picture.index(2, 3), name[0] == 'R' ? 0 : -9e4);
  make(picture, options);
  ExpandImageOptions expand;
  const auto half = expand_image(compact_, folder_ / "half.exr", expand);
  expand.pixel = SampleType::kFloat;
  const auto full = expand_image(compact_, out_, expand);
  ASSERT_TRUE(half);
  ASSERT_TRUE(full);
  const test::Picture out = test::read_picture(out_);
  double least = 0;
  std::uint64_t limited = 0;
  for (std::size_t i = 0; i < out.pixels(); ++i) {
    bool beyond = false;
    for (const auto& [name, plane] : out.planes) {
      if (!name.ends_with("nm")) continue;
      least = std::min(least, plane.at(i));
      beyond = beyond || std::abs(plane.at(i)) > 65504;
    }
    limited += beyond ? 1 : 0;
  }
  EXPECT_EQ(half->clamped_pixels, limited);
  EXPECT_EQ(full->clamped_pixels, 0U);
  // Kept negatives are there to be limited; a sigmoid has none.
  EXPECT_EQ(least < -65504, !is_sigmoid(GetParam().method));
}

TEST_P(Expand, GivesTheBitsForAnotherLightOrObserver) {
  const Method method = GetParam().method;
  // The published bases take neither, and mallett has none for the other observer.
  const bool takes_light = method != Method::kSmits && method != Method::kSmits1999;
  const bool takes_observer = takes_light && method != Method::kMallett;
  UpsampleImageOptions options = test::options_of(GetParam());
  options.bands = Bands();
  if (takes_light) options.light = NamedLight{"my lamp", *illuminant("D50")};
  make(test::every_color(33, 4), options);
  expect_same(options, "D50");
  EXPECT_EQ(test::text_of(test::read_picture(out_).header, "spectileLight"), takes_light ? "my lamp" : "D65");
  options.light.reset();
  if (takes_observer) options.observer = Observer::kCie1964;
  make(test::every_color(33, 4), options);
  expect_same(options, "10 degrees");
}

class ExpandMixtures : public Expand {};
class ExpandSigmoids : public Expand {};
INSTANTIATE_TEST_SUITE_P(Kinds, ExpandMixtures, testing::ValuesIn(test::kinds_that(true)), test::kind_name);
INSTANTIATE_TEST_SUITE_P(Kinds, ExpandSigmoids, testing::ValuesIn(test::kinds_that(false)), test::kind_name);

TEST_P(ExpandMixtures, ForOtherBandsAreThoseOfUpsamplingToThem) {
  UpsampleImageOptions options = test::options_of(GetParam());
  options.bands = Bands();
  // Where colours out of gamut are moved to depends on the luminance that the bands see.
  options.out_of_gamut = GamutPolicy::kKeep;
  make(test::every_color(67, 5), options);
  options.bands = *Bands::uniform(390, 720, 15);
  ExpandImageOptions expand;
  expand.bands = options.bands;
  ASSERT_TRUE(upsample_image(in_, folder_ / "direct.exr", options));
  const auto report = expand_image(compact_, out_, expand);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->bands, 22U);
  EXPECT_TRUE(test::read_picture(out_).planes == test::read_picture(folder_ / "direct.exr").planes);
}

/// A sample, and how far one in float may be from it.
struct Sample {
  double value;
  double bound;
};

/// The recorded convention, in double: sample = 1/2 + x / (2 sqrt(1 + x^2)), x = c0 p + c1 q + c2.
Sample sigmoid(const test::Picture& compact, int x, int y, double nm, const SigmoidFunctions& functions) {
  const auto [p, q] = functions.at(nm);
  const double of[] = {compact.at("spectile.c0", x, y) * p, compact.at("spectile.c1", x, y) * q,
                       compact.at("spectile.c2", x, y)};
  const double argument = of[0] + of[1] + of[2];
  const double terms = std::abs(of[0]) + std::abs(of[1]) + std::abs(of[2]);
  const double scale = compact.planes.contains("spectile.scale") ? compact.at("spectile.scale", x, y) : 1;
  // Three roundings of the argument's terms, where the slope is 1/2 at most, and some of the result.
  return {scale * (0.5 + argument / (2 * std::sqrt(1 + argument * argument))),
          std::abs(scale) * (1e-6 + 0x1.8p-24 * terms)};
}

TEST_P(ExpandSigmoids, ForOtherBandsFollowTheRecordedConvention) {
  UpsampleImageOptions options = test::options_of(GetParam());
  make(test::every_color(67, 5), options);
  ExpandImageOptions expand;
  expand.bands = *Bands::parse("380,405,431.5,550,640.25,695,720,790");
  expand.pixel = SampleType::kFloat;
  const auto report = expand_image(compact_, out_, expand);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->notes, testing::ElementsAre(HasSubstr("beyond 409.375 to 690.625 nm")));
  // Light of luminance 1 over the bands that the coefficients were made for.
  const MeasuredSpectrum light = *illuminant("D65");
  const Projector projector = *Projector::emissive(options.bands);
  double luminance = 0;
  for (std::size_t b = 0; b < options.bands.count(); ++b) {
    const Band& band = options.bands[b];
    luminance += projector.weights()[b][1] * light.integral(band.lower_nm, band.upper_nm) / band.width_nm();
  }
  const test::Picture compact = test::read_picture(compact_);
  const test::Picture out = test::read_picture(out_);
  const bool emits = GetParam().quantity == Quantity::kIlluminant;
  const SigmoidFunctions& functions = SigmoidFunctions::of(
      GetParam().method == Method::kSigmoid ? std::nullopt : std::optional(Observer::kCie1931));
  for (const Band& band : expand.bands->list()) {
    const std::string channel = fmt::format("{}.{},{:06.0f}nm", emits ? "S0" : "T",
                                            std::floor(band.centre_nm), std::fmod(band.centre_nm, 1) * 1e6);
    ASSERT_TRUE(out.planes.contains(channel)) << channel;
    const double nm = std::clamp(band.centre_nm, 409.375, 690.625);
    const double white =
        emits ? light.integral(band.lower_nm, band.upper_nm) / band.width_nm() / luminance : 1;
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 67; ++x) {
        const Sample want = sigmoid(compact, x, y, nm, functions);
        EXPECT_NEAR(out.at(channel, x, y), white * want.value, white * want.bound + 1e-30)
            << channel << " " << x;
      }
    }
  }
}

TEST_P(Expand, ItsOwnBandsAskedForByNameChangeNothing) {
  UpsampleImageOptions options = test::options_of(GetParam());
  make(test::every_color(67, 5), options);
  ExpandImageOptions expand;
  ASSERT_TRUE(expand_image(compact_, out_, expand));
  expand.bands = options.bands;
  ASSERT_TRUE(expand_image(compact_, folder_ / "named.exr", expand));
  EXPECT_TRUE(test::read_picture(folder_ / "named.exr").planes == test::read_picture(out_).planes);
}

TEST(ExpandBands, OtherBandsThatAMethodCannotMakeAreTheCallersError) {
  const test::TempFolder folder;
  test::Picture picture = test::every_color(4, 4);
  test::write_scanlines(folder / "in.exr", picture);
  test::upsample_to(Store::kCoefficients, folder / "in.exr", folder / "compact.exr",
                    test::options_of({Method::kMallett, Quantity::kReflectance}));
  ExpandImageOptions expand;
  expand.bands = *Bands::parse("500,600");
  const auto report = expand_image(folder / "compact.exr", folder / "out.exr", expand);
  EXPECT_EQ(test::code_of(report), test::code(ErrorCode::kBadArgument));
  EXPECT_THAT(folder.names(), testing::ElementsAre("compact.exr", "in.exr"));
}

}  // namespace
}  // namespace spectile
