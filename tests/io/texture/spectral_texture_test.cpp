// A texture gives the spectra of a region at the wavelengths asked for, the same from both forms.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/spectral_texture.hpp>

#include "src/spectra/sigmoid_functions.hpp"
#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile {
namespace {

using test::Kind;

std::vector<double> centres_of(const Bands& bands) {
  std::vector<double> out;
  for (const Band& band : bands.list()) out.push_back(band.centre_nm);
  return out;
}

/// The channel of a wavelength with at most one decimal.
std::string channel_of(Quantity quantity, double nm) {
  const char* const kind = quantity == Quantity::kIlluminant ? "S0" : "T";
  return fmt::format("{}.{},{}00000nm", kind, std::floor(nm), std::round(10 * std::fmod(nm, 1)));
}

class Texture : public testing::TestWithParam<Kind> {
 protected:
  static constexpr int kWidth = 130;
  static constexpr int kHeight = 7;
  static constexpr PixelWindow kWhole = {0, 0, kWidth, kHeight};

  Texture() : bands_(*Bands::uniform(400, 700, 15)) {
    UpsampleImageOptions options = test::options_of(GetParam());
    options.bands = bands_;
    test::Picture picture = test::every_color(kWidth, kHeight, {-3, 8});
    test::write_scanlines(folder_ / "in.exr", picture);
    test::upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "compact.exr", options);
    test::upsample_to(Store::kSpectra, folder_ / "in.exr", folder_ / "half.exr", options);
    options.pixel = SampleType::kFloat;
    test::upsample_to(Store::kSpectra, folder_ / "in.exr", folder_ / "full.exr", options);
  }

  SpectralTexture open(const std::string& name, int threads = 0) const {
    auto texture = SpectralTexture::open(folder_ / name, threads);
    EXPECT_TRUE(texture) << texture.error().message;
    return *texture;
  }
  static SampledSpectra evaluate(const SpectralTexture& texture, const PixelWindow& region,
                                 const std::vector<double>& wavelengths_nm) {
    auto spectra = texture.evaluate(region, wavelengths_nm);
    EXPECT_TRUE(spectra) << spectra.error().message;
    return *std::move(spectra);
  }

  const test::TempFolder folder_;
  const Bands bands_;
};

INSTANTIATE_TEST_SUITE_P(Kinds, Texture, testing::ValuesIn(test::all_kinds()), test::kind_name);

TEST_P(Texture, SaysWhatItHolds) {
  for (const bool compact : {false, true}) {
    const SpectralTexture texture = open(compact ? "compact.exr" : "full.exr");
    EXPECT_EQ(texture.width(), kWidth);
    EXPECT_EQ(texture.height(), kHeight);
    EXPECT_EQ(texture.compact(), compact);
    EXPECT_EQ(texture.bands(), bands_);
    // A full image's channels do not tell unbounded ones from reflectances.
    const bool told = compact || GetParam().quantity != Quantity::kUnbounded;
    EXPECT_EQ(texture.quantity(), told ? GetParam().quantity : Quantity::kReflectance);
  }
}

TEST_P(Texture, BothFormsAgreeAtTheCentresToTheBit) {
  const test::Picture stored = test::read_picture(folder_ / "full.exr");
  const SampledSpectra full = evaluate(open("full.exr"), kWhole, centres_of(bands_));
  const SampledSpectra compact = evaluate(open("compact.exr"), kWhole, centres_of(bands_));
  const SampledSpectra halves = evaluate(open("half.exr"), kWhole, centres_of(bands_));
  EXPECT_EQ(full.axis(), bands_);
  EXPECT_TRUE(test::same_lanes(compact, full));
  for (std::size_t b = 0; b < bands_.count(); ++b) {
    const test::Plane& plane = stored.planes.at(channel_of(GetParam().quantity, bands_[b].centre_nm));
    for (std::size_t i = 0; i < full.lanes(); ++i) {
      ASSERT_EQ(full.at(i, b), static_cast<float>(plane.at(i)));
      const float limited = std::clamp(compact.at(i, b), -65504.0F, 65504.0F);
      ASSERT_EQ(halves.at(i, b), static_cast<float>(half(limited)));
    }
  }
}

TEST_P(Texture, BetweenCentresFullImagesAreLinear) {
  const SampledSpectra own = evaluate(open("full.exr"), kWhole, centres_of(bands_));
  // 407.5 to 692.5 nm by 15.
  const std::vector<double> wavelengths = {410, 418.75, 430.25, 430.5, 437.5, 437.6, 691};
  const SampledSpectra between = evaluate(open("full.exr"), kWhole, wavelengths);
  for (std::size_t w = 0; w < wavelengths.size(); ++w) {
    const double place = (wavelengths[w] - 407.5) / 15;
    const auto b = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(b);
    for (std::size_t i = 0; i < own.lanes(); ++i) {
      const double first = static_cast<double>(own.at(i, b));
      const double next = static_cast<double>(own.at(i, std::min<std::size_t>(b + 1, 19)));
      EXPECT_NEAR(between.at(i, w), (1 - t) * first + t * next, 2e-7 * (std::abs(first) + std::abs(next)));
    }
  }
}

TEST_P(Texture, BeyondTheCentresTheEndsGoOn) {
  for (const char* name : {"full.exr", "compact.exr"}) {
    const SpectralTexture texture = open(name);
    const SampledSpectra ends = evaluate(texture, kWhole, {407.5, 692.5});
    const SampledSpectra beyond = evaluate(texture, kWhole, {1, 380, 407.25, 692.75, 830, 1e6});
    for (std::size_t i = 0; i < ends.lanes(); ++i) {
      for (std::size_t w = 0; w < 6; ++w) ASSERT_EQ(beyond.at(i, w), ends.at(i, w / 3)) << name;
    }
  }
}

TEST_P(Texture, BetweenCentresCompactImagesFollowTheirMethod) {
  const SampledSpectra own = evaluate(open("compact.exr"), kWhole, {497.5, 512.5});
  const SampledSpectra between = evaluate(open("compact.exr"), kWhole, {500});
  const test::Picture c = test::read_picture(folder_ / "compact.exr");
  const bool sigmoid = is_sigmoid(GetParam().method);
  for (std::size_t i = 0; i < own.lanes(); ++i) {
    const auto at = [&](const char* name) { return c.planes.at(name).at(i); };
    const double first = static_cast<double>(own.at(i, 0));
    const double next = static_cast<double>(own.at(i, 1));
    double want = (5 * first + next) / 6;
    double bound = 1e-6 * (std::abs(first) + std::abs(next));
    if (sigmoid) {
      const SigmoidFunctions& functions = SigmoidFunctions::of(
          GetParam().method == Method::kSigmoid ? std::nullopt : std::optional(Observer::kCie1931));
      const double scale = c.planes.contains("spectile.scale") ? at("spectile.scale") : 1;
      // The white of a light is linear in between; at the centres it is what sample over scale and sigmoid
      // is.
      const auto shape = [&](double nm) {
        const auto [p, q] = functions.at(nm);
        const double x = at("spectile.c0") * p + at("spectile.c1") * q + at("spectile.c2");
        return 0.5 + x / (2 * std::sqrt(1 + x * x));
      };
      if (scale == 0 || shape(497.5) < 1e-3 || shape(512.5) < 1e-3) continue;
      const double white = (5 * first / shape(497.5) + next / shape(512.5)) / (6 * scale);
      want = scale * white * shape(500);
      bound = std::abs(scale) * 1e-4;
    } else if (first <= 0 || next <= 0) {
      continue;  // limited to 0, which the mixture in between need not be
    }
    EXPECT_NEAR(between.at(i, 0), want, bound) << i;
  }
}

TEST_P(Texture, RegionsAreCutFromTheWhole) {
  const std::vector<double> wavelengths = {390, 407.5, 500, 617.5, 650, 651, 700};
  for (const char* name : {"full.exr", "half.exr", "compact.exr"}) {
    for (const int threads : {1, 2}) {
      const SpectralTexture texture = open(name, threads);
      const SampledSpectra whole = evaluate(texture, kWhole, wavelengths);
      for (const PixelWindow& r :
           {PixelWindow{0, 0, 1, 1}, PixelWindow{kWidth - 1, kHeight - 1, kWidth, kHeight},
            PixelWindow{0, 3, kWidth, 4}, PixelWindow{63, 0, 65, kHeight},
            PixelWindow{kWidth - 1, 0, kWidth, kHeight}, PixelWindow{5, 2, 102, 6},
            PixelWindow{64, 1, 128, 3}}) {
        const SampledSpectra part = evaluate(texture, r, wavelengths);
        ASSERT_EQ(part.lanes(), static_cast<std::size_t>(r.width() * r.height()));
        const auto source = [&](std::size_t lane, std::size_t band) {
          const auto x = static_cast<std::size_t>(r.x0) + lane % static_cast<std::size_t>(r.width());
          const auto y = static_cast<std::size_t>(r.y0) + lane / static_cast<std::size_t>(r.width());
          return whole.at(y * kWidth + x, band);
        };
        EXPECT_TRUE(test::same_lanes(part, test::batch_of(part.axis(), part.lanes(), source)))
            << fmt::format("{} {} x {} at {},{}", name, r.width(), r.height(), r.x0, r.y0);
      }
    }
  }
}

TEST_P(Texture, OneWavelengthIsThatOfMany) {
  std::vector<double> many;
  for (int i = 0; i < 900; ++i) many.push_back(350 + 0.5 * i);
  for (const char* name : {"full.exr", "compact.exr"}) {
    const SpectralTexture texture = open(name);
    const PixelWindow line = {7, 4, 77, 5};
    const SampledSpectra all = evaluate(texture, line, many);
    for (const std::size_t w : {0U, 115U, 130U, 300U, 301U, 899U}) {
      const SampledSpectra one = evaluate(texture, line, {many[w]});
      EXPECT_EQ((*one.axis().bands())[0].centre_nm, many[w]);
      for (std::size_t i = 0; i < one.lanes(); ++i)
        ASSERT_TRUE(test::same_bits(one.at(i, 0), all.at(i, w))) << w;
    }
  }
}

TEST_P(Texture, BatchOfTheCallersGetsTheSamplesAtItsBandsCentres) {
  const SpectralTexture texture = open("compact.exr");
  const Bands bands = *Bands::parse("450:650:12.5");
  const PixelWindow region = {1, 1, 51, 4};
  const SampledSpectra want = evaluate(texture, region, centres_of(bands));
  SampledSpectra got = *SampledSpectra::constant(bands, 150, 7);
  ASSERT_TRUE(texture.evaluate(region, got.span()));
  EXPECT_TRUE(test::same_lanes(got, want));
  // The last block's padding is 0.
  for (std::size_t b = 0; b < bands.count(); ++b)
    EXPECT_EQ(got.view().data[(2 * bands.count() + b) * 64 + 63], 0);
}

}  // namespace
}  // namespace spectile
