// Averages of images that are parts of a frame, of files of several parts, and of what names objects.
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "tests/io/average/average_files.hpp"

namespace spectile {
namespace {

using test::kPlain;
using test::weighted;
using testing::ElementsAre;
using testing::HasSubstr;

class AverageWindows : public test::AverageFiles {
 protected:
  /// The part of a frame of 60 x 50, at 10, 20, that lies in x0..x1, y0..y1: R is `value`, id names the
  /// picture and its place.
  test::Picture part(int x0, int y0, int x1, int y1, double value, Imf::PixelType type = Imf::FLOAT) {
    test::Picture picture = test::blank(x1 - x0 + 1, y1 - y0 + 1, {x0, y0});
    picture.header.displayWindow() = {{10, 20}, {69, 69}};
    picture.add("R", type, [=](int x, int y) { return value + 100 * (x + x0) + y + y0; });
    picture.add("id", Imf::UINT, [=](int, int) { return value; });
    return picture;
  }
  static double ramp(int x, int y, double value) { return value + 100 * x + y; }

  /// A file of a part for each picture.
  std::string write_parts(const std::string& name,
                          std::vector<std::pair<std::string, test::Picture>> pictures) {
    std::vector<Imf::Header> headers;
    for (auto& [part_name, picture] : pictures) {
      picture.header.setName(part_name);
      picture.header.setType("scanlineimage");
      headers.push_back(picture.header);
    }
    Imf::MultiPartOutputFile file((folder_ / name).c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      Imf::OutputPart out(file, static_cast<int>(i));
      out.setFrameBuffer(pictures[i].second.frame_buffer());
      out.writePixels(pictures[i].second.height());
    }
    return folder_ / name;
  }
};

TEST_F(AverageWindows, HalvesOfAFrameArePutTogether) {
  for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF}) {
    const std::string left = write("left.exr", part(10, 20, 39, 69, 1, type));
    const std::string right = write("right.exr", part(40, 20, 69, 69, 2, type));
    const test::Picture out = average({left, right});
    EXPECT_EQ(out.header.dataWindow(), Imath::Box2i({10, 20}, {69, 69}));
    const test::Picture a = test::read_picture(left);
    const test::Picture b = test::read_picture(right);
    for (int y = 0; y < 50; ++y) {
      for (int x = 0; x < 60; ++x) {
        ASSERT_EQ(out.at("R", x, y), x < 30 ? a.at("R", x, y) : b.at("R", x - 30, y)) << x << " " << y;
        ASSERT_EQ(out.at("id", x, y), x < 30 ? 1 : 2);
      }
    }
    EXPECT_THAT(report_.notes,
                ElementsAre(HasSubstr("id names objects"), HasSubstr("put together to 10,20 to 69,69")));
  }
}

TEST_F(AverageWindows, OverlapsAreAveragesByWeightAndGapsAreBlack) {
  const std::string a = write("a.exr", part(12, 22, 41, 59, 0));
  const std::string b = write("b.exr", part(30, 30, 60, 64, 10));
  const std::string c = write("c.exr", part(35, 25, 38, 66, 1000));
  for (const int threads : {1, 3}) {
    AverageOptions options = weighted({1, 3, 0});
    options.threads = threads;
    const test::Picture out = average({a, b, c}, options);
    EXPECT_EQ(out.header.dataWindow(), Imath::Box2i({12, 22}, {60, 66}));
    std::uint64_t gaps = 0;
    for (int y = 22; y <= 66; ++y) {
      for (int x = 12; x <= 60; ++x) {
        const bool in_a = x <= 41 && y <= 59;
        const bool in_b = x >= 30 && y >= 30 && y <= 64;
        const double offset = in_a && in_b ? 7.5 : in_b ? 10 : 0;
        gaps += in_a || in_b ? 0 : 1;
        ASSERT_EQ(out.at("R", x - 12, y - 22), in_a || in_b ? ramp(x, y, offset) : 0) << x << " " << y;
        ASSERT_EQ(out.at("id", x - 12, y - 22), in_a ? 0 : in_b ? 10 : 0);
      }
    }
    EXPECT_THAT(report_.notes.back(), HasSubstr(std::to_string(gaps) + " pixels are in no image: 0"));
  }
}

TEST_F(AverageWindows, NumbersThatAreNoneAreCountedFromTheirOwnCorner) {
  test::Picture bad = part(40, 30, 69, 69, 2);
  bad.planes.at("R").set(bad.index(3, 4), std::nan(""));
  const std::string a = write("a.exr", part(10, 20, 60, 69, 1));
  const std::string b = write("b.exr", bad);
  expect_error({a, b}, kPlain, ErrorCode::kNonFinite, {"b.exr: 1 non-finite pixel, the first at 3,4"});
  AverageOptions zero;
  zero.nonfinite = NonFinite::kZero;
  EXPECT_EQ(average({a, b}, zero).at("R", 33, 14), ramp(43, 34, 1));
}

TEST_F(AverageWindows, IntegersAreTheFirstOnes) {
  test::Picture other = render(1);
  other.planes.at("id").set(other.index(30, 25), 77);
  const std::string a = write("a.exr", render(0));
  const std::string b = write("b.exr", other);
  EXPECT_EQ(average({a, b}).planes.at("id"), render(0).planes.at("id"));
  EXPECT_THAT(report_.notes,
              ElementsAre(HasSubstr("id names objects and is not averaged: it is that of " + a)));
  EXPECT_EQ(average({a, b}, weighted({0, 1})).planes.at("id"), other.planes.at("id"));
}

TEST_F(AverageWindows, CryptomatteIsTheFirstOnes) {
  const auto seeded = [&](int seed) {
    test::Picture picture = render(seed);
    picture.header.insert("cryptomatte/1a2b3c4/name", Imf::StringAttribute("View.Objects"));
    int c = 0;
    for (const char* name : {"View.Objects00.R", "View.Objects00.G", "View.Objects01.r", "View.Objects.R"}) {
      ++c;
      picture.add(name, Imf::FLOAT, [=](int x, int y) { return 1e10 * test::noise(x, y, 50 * seed + c); });
    }
    return picture;
  };
  const test::Picture first = seeded(1);
  AverageOptions half;
  half.stored = SampleType::kHalf;
  const test::Picture out = average({write("a.exr", first), write("b.exr", seeded(2))}, half);
  for (const char* name : {"View.Objects00.R", "View.Objects00.G", "View.Objects01.r"}) {
    EXPECT_EQ(out.planes.at(name), first.planes.at(name)) << name << " is neither averaged nor made half";
  }
  EXPECT_NE(out.planes.at("View.Objects.R"), first.planes.at("View.Objects.R"));
  EXPECT_THAT(report_.notes.at(0),
              HasSubstr("View.Objects00.G, View.Objects00.R, View.Objects01.r, id name"));
}

TEST_F(AverageWindows, PartsOfTheSameNameAreAveraged) {
  const auto beauty_of = [&](double value) { return part(10, 20, 69, 69, value); };
  const auto depth = [&](double value) {
    test::Picture picture = test::blank(7, 5, {12, 22});
    picture.header.displayWindow() = {{10, 20}, {69, 69}};
    picture.add("Z", Imf::HALF, [=](int x, int y) { return value + x + y; });
    picture.header.compression() = Imf::PIZ_COMPRESSION;
    picture.header.insert("owner", Imf::StringAttribute("depth"));
    return picture;
  };
  const std::string a = write_parts("a.exr", {{"beauty", beauty_of(1)}, {"depth", depth(10)}});
  const std::string b = write_parts("b.exr", {{"depth", depth(20)}, {"beauty", beauty_of(2)}});
  for (const CompressionKind kind : {CompressionKind::kZip, CompressionKind::kPiz, CompressionKind::kDwaa}) {
    AverageOptions options;
    options.compression = {kind, -1};
    options.threads = 2;
    const test::Picture beauty = average({a, b}, options);
    const test::Picture z = test::read_picture(folder_ / "out.exr", 1);
    EXPECT_EQ(beauty.header.name(), "beauty");
    EXPECT_EQ(z.header.name(), "depth");
    EXPECT_EQ(z.header.typedAttribute<Imf::StringAttribute>("owner").value(), "depth");
    EXPECT_THAT(report_.notes.at(0), HasSubstr("part \"beauty\": id names objects"));
    if (kind == CompressionKind::kDwaa) continue;
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 7; ++x) {
        EXPECT_EQ(z.at("Z", x, y), 15 + x + y);
        EXPECT_EQ(beauty.at("R", x, y), ramp(x + 10, y + 20, 1.5));
      }
    }
  }
  const std::string c = write_parts("c.exr", {{"beauty", beauty_of(1)}, {"normals", depth(10)}});
  expect_error({a, c}, kPlain, ErrorCode::kBadFile, {"c.exr: has no part \"depth\"", "a.exr has one"});
}

}  // namespace
}  // namespace spectile
