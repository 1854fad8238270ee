// Averages of images: the numbers, whatever the files' form.
#include <bit>
#include <cmath>

#include "tests/io/average/average_files.hpp"

namespace spectile {
namespace {

using AverageImages = test::AverageFiles;
using test::kInfinity;
using test::kNan;
using test::weighted;
using testing::HasSubstr;

TEST_F(AverageImages, OfOneImageIsThatImage) {
  test::Picture picture = render(1);
  const float special[] = {-0.0F, 1e-45F, -1.1754942e-38F, 3.4028235e38F, -3.4028235e38F};
  for (std::size_t i = 0; i < std::size(special); ++i) {
    picture.planes.at("G").set(i, static_cast<double>(special[i]));
  }
  for (const double weight : {1.0, 0.3}) {
    const test::Picture out = average({write("a.exr", picture)}, weighted({weight}));
    EXPECT_EQ(out.planes, picture.planes);
  }
  const test::Picture halves = render(1, Imf::HALF);
  EXPECT_EQ(average({write("a.exr", halves)}).planes, halves.planes);
  EXPECT_EQ(report_.width, 37);
  EXPECT_EQ(report_.height, 41);
}

/// long double holds these sums, of 24 bits times weights of 8, exactly.
TEST_F(AverageImages, IsTheExactOneRoundedOnce) {
  const std::vector<double> weights = {64, 128, 3, 0, 17};
  for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF}) {
    std::vector<test::Picture> pictures;
    std::vector<std::string> inputs;
    for (int i = 0; i < 5; ++i) {
      pictures.push_back(render(i, type));
      inputs.push_back(write("in" + std::to_string(i) + ".exr", pictures.back()));
    }
    const test::Picture out = average(inputs, weighted(weights));
    for (const char* name : {"R", "G", "B", "S0.402,500000nm"}) {
      const test::Plane& plane = out.planes.at(name);
      ASSERT_EQ(plane.type, type);
      for (std::size_t p = 0; p < out.pixels(); ++p) {
        long double sum = 0;
        for (std::size_t i = 0; i < 5; ++i)
          sum += weights[i] * static_cast<long double>(pictures[i].planes.at(name).at(p));
        const long double exact = sum / 212;
        const auto own = static_cast<float>(plane.at(p));
        long double ulp = std::nextafter(std::fabs(own), kInfinity) - std::fabs(own);
        if (type == Imf::HALF) ulp = std::max(std::ldexp(1.0L, std::ilogb(own) - 10), 0x1p-24L);
        ASSERT_LE(std::fabs(own - exact), ulp / 2) << name << " " << p;
      }
    }
  }
}

TEST_F(AverageImages, DependsNeitherOnOrderNorThreadsNorACommonFactor) {
  for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF}) {
    const std::vector<std::string> in = renders(4, type);
    AverageOptions options = weighted({0.3, 64, 7, 1e-3});
    options.nonfinite = NonFinite::kZero;
    const auto first = average(in, options).planes;
    options.weights = {0.6, 128, 14, 2e-3};
    for (const int threads : {1, 2, 7}) {
      options.threads = threads;
      EXPECT_EQ(average(in, options).planes, first) << threads << " threads";
    }
    options.weights = {7, 1e-3, 0.3, 64};
    EXPECT_EQ(average({in[2], in[3], in[0], in[1]}, options).planes, first);
    options.weights = {64, 0.3, 1e-3, 7};
    EXPECT_EQ(average({in[1], in[0], in[3], in[2]}, options).planes, first);
  }
}

TEST_F(AverageImages, OfConstantsAndOfHugeOnesStay) {
  std::vector<std::string> inputs;
  for (int i = 0; i < 3; ++i) {
    test::Picture picture = test::blank(9, 70);
    picture.add("Y", Imf::FLOAT, [](int, int) { return 0.1; });
    picture.add("huge", Imf::FLOAT, [](int, int) { return -3e38; });
    picture.add("half", Imf::HALF, [](int, int) { return 65504; });
    inputs.push_back(write("c" + std::to_string(i) + ".exr", picture));
  }
  const test::Picture in = test::read_picture(inputs[0]);
  EXPECT_EQ(average(inputs).planes, in.planes);
  EXPECT_EQ(average(inputs, weighted({0.1, 0.2, 0.7})).planes, in.planes);
}

TEST_F(AverageImages, TakesAnyStorageAndWindow) {
  const std::vector<std::string> plain = renders(3);
  const auto expected = average(plain).planes;
  std::vector<std::string> stored;
  for (int i = 0; i < 3; ++i) {
    test::Picture picture = render(i, Imf::FLOAT, {-7, 12});
    picture.header.compression() = i == 0 ? Imf::PIZ_COMPRESSION : Imf::ZIPS_COMPRESSION;
    if (i == 1) picture.header.lineOrder() = Imf::DECREASING_Y;
    stored.push_back(folder_ / "stored" + std::to_string(i) + ".exr");
    if (i == 2) {
      test::write_tiles(stored.back(), picture, 16, false);
    } else {
      test::write_scanlines(stored.back(), picture);
    }
  }
  for (const CompressionKind kind : {CompressionKind::kNone, CompressionKind::kPiz, CompressionKind::kZip}) {
    AverageOptions options;
    options.compression.kind = kind;
    const test::Picture out = average(stored, options);
    EXPECT_EQ(out.planes, expected);
    EXPECT_EQ(out.header.dataWindow().min, Imath::V2i(-7, 12));
  }
}

TEST_F(AverageImages, OfTallOnesIsThatOfEveryLine) {
  // Several strips, which begin in the middle of the inputs' chunks.
  const auto value = [](int i, int x, int y) { return 8.0 * y + x + i * (1 + y % 5); };
  std::vector<std::string> inputs;
  for (int i = 0; i < 3; ++i) {
    test::Picture picture = test::blank(3, 1100);
    picture.add("Y", Imf::FLOAT, [=](int x, int y) { return value(i, x, y); });
    picture.header.compression() = i == 0 ? Imf::DWAB_COMPRESSION : Imf::PIZ_COMPRESSION;
    picture.add("z", Imf::FLOAT, [=](int x, int y) { return value(i, x, y); });
    if (i == 2) picture.planes.at("z").set(picture.index(2, 1050), kNan);
    inputs.push_back(write("t" + std::to_string(i) + ".exr", picture));
  }
  AverageOptions options;
  for (const int threads : {1, 2, 5}) {
    options.threads = threads;
    options.nonfinite = NonFinite::kStop;
    const auto stopped = average_images(inputs, folder_ / "out.exr", options);
    ASSERT_FALSE(stopped);
    EXPECT_THAT(stopped.error().message, HasSubstr(inputs[2] + ": 1 non-finite pixel, the first at 2,1050"));
    options.nonfinite = NonFinite::kZero;
    const test::Picture out = average(inputs, options);
    for (int y = 0; y < 1100; ++y) {
      for (int x = 0; x < 3; ++x) {
        const double expected = value(1, x, y) - (x == 2 && y == 1050 ? 0.5 * (1 + y % 5) : 0);
        ASSERT_EQ(out.at("z", x, y), expected) << x << "," << y << " with " << threads << " threads";
      }
    }
  }
}

TEST_F(AverageImages, KeepsTheWidestTypeOrTheOneAskedFor) {
  std::vector<std::string> mixed = {write("h.exr", render(1, Imf::HALF)), write("f.exr", render(2))};
  EXPECT_EQ(average(mixed).planes.at("R").type, Imf::FLOAT);
  AverageOptions options;
  options.stored = SampleType::kHalf;
  const test::Picture halves = average(mixed, options);
  EXPECT_EQ(halves.planes.at("R").type, Imf::HALF);
  EXPECT_EQ(halves.planes.at("id").type, Imf::UINT);
  options.stored = SampleType::kFloat;
  EXPECT_EQ(average({mixed[0]}, options).planes.at("R").type, Imf::FLOAT);

  // Just above the middle of two halves, by less than a float can tell.
  test::Picture middle = test::blank(1, 1);
  middle.add("Y", Imf::FLOAT, [](int, int) { return 1 + 0x1p-11; });
  test::Picture above = test::blank(1, 1);
  above.add("Y", Imf::FLOAT, [](int, int) { return 1 + 0x1p-11 + 0x1p-23; });
  options = weighted({1000, 1});
  options.stored = SampleType::kHalf;
  const std::vector<std::string> two = {write("middle.exr", middle), write("above.exr", above)};
  EXPECT_EQ(average(two, options).at("Y", 0, 0), 1 + 0x1p-10);

  options = {};
  test::Picture large = test::blank(4, 1);
  large.add("Y", Imf::FLOAT, [](int x, int) { return x == 1 ? 70000 : x == 2 ? -1e9 : 1; });
  options.stored = SampleType::kHalf;
  const test::Picture limited = average({write("l.exr", large)}, options);
  EXPECT_EQ(limited.at("Y", 1, 0), 65504);
  EXPECT_EQ(limited.at("Y", 2, 0), -65504);
  EXPECT_EQ(report_.clamped_pixels, 2U);
}

TEST_F(AverageImages, OfManyIsThatOfAll) {
  // More than are kept open.
  std::vector<std::string> inputs;
  for (int i = 0; i < 300; ++i) {
    test::Picture picture = test::blank(5, 3);
    picture.add("Y", Imf::HALF, [=](int x, int y) { return i + 300 * (x + 5 * y); });
    inputs.push_back(write("m" + std::to_string(i) + ".exr", picture));
  }
  AverageOptions options;
  options.stored = SampleType::kFloat;
  const test::Picture out = average(inputs, options);
  for (int i = 0; i < 15; ++i) {
    double sum = 0;
    for (int k = 0; k < 300; ++k)
      sum += test::read_picture(inputs[static_cast<std::size_t>(k)]).at("Y", i % 5, i / 5);
    EXPECT_EQ(out.at("Y", i % 5, i / 5), static_cast<double>(static_cast<float>(sum / 300)));
  }
}

TEST_F(AverageImages, NonFiniteSamplesStopOrAreLeftOut) {
  std::vector<std::string> in;
  for (int i = 0; i < 3; ++i) {
    test::Picture picture = test::blank(20, 50);
    for (const char* name : {"R", "G"}) picture.add(name, Imf::FLOAT, [=](int, int) { return 4 << i; });
    if (i > 0) picture.planes.at("R").set(picture.index(7, 33), kNan);
    if (i == 2) {
      picture.planes.at("R").set(picture.index(3, 40), kInfinity);
      picture.planes.at("G").set(picture.index(3, 40), kNan);
    }
    if (i == 1) {
      for (const char* name : {"R", "G"}) picture.planes.at(name).set(picture.index(19, 49), kNan);
    }
    in.push_back(write("n" + std::to_string(i) + ".exr", picture));
  }
  for (const int threads : {1, 2}) {
    AverageOptions options = weighted({1, 2, 5});
    options.threads = threads;
    expect_error(in, options, ErrorCode::kNonFinite, {in[1] + ": 2 non-finite pixels, the first at 7,33"});
    expect_error({in[0], in[2], in[1]}, options, ErrorCode::kNonFinite,
                 {in[2] + ": 2 non-finite pixels, the first at 7,33"});
    options.nonfinite = NonFinite::kZero;
    const test::Picture out = average(in, options);
    EXPECT_EQ(report_.nonfinite_pixels, 3U);
    EXPECT_EQ(out.at("R", 0, 0), (4 + 16 + 80) / 8.0);
    EXPECT_EQ(out.at("R", 7, 33), 4);
    EXPECT_EQ(out.at("G", 7, 33), (4 + 16 + 80) / 8.0);
    EXPECT_EQ(out.at("R", 3, 40), static_cast<double>(20.0F / 3));
    EXPECT_EQ(out.at("R", 19, 49), 14);
    EXPECT_EQ(out.at("G", 19, 49), 14);
  }
}

TEST_F(AverageImages, WhereAllAreMissingIsZero) {
  test::Picture picture = test::blank(2, 1);
  picture.add("Y", Imf::HALF, [](int x, int) { return x == 0 ? -HUGE_VAL : 1; });
  AverageOptions options;
  options.nonfinite = NonFinite::kZero;
  const std::string in = write("y.exr", picture);
  const test::Picture out = average({in, in}, options);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(out.at("Y", 0, 0)), 0U);
  EXPECT_EQ(out.at("Y", 1, 0), 1);
  EXPECT_EQ(report_.nonfinite_pixels, 1U);
}

TEST_F(AverageImages, OfWeightZeroAreNotLookedAt) {
  test::Picture spoilt = render(5);
  for (int i = 0; i < 30; ++i) spoilt.planes.at("R").set(static_cast<std::size_t>(i), kNan);
  spoilt.planes.at("id").set(3, 12345);
  const std::vector<std::string> in = renders(2);
  const auto expected = average(in).planes;
  EXPECT_EQ(average({write("bad.exr", spoilt), in[0], in[1]}, weighted({0, 2, 2})).planes, expected);
}

}  // namespace
}  // namespace spectile
