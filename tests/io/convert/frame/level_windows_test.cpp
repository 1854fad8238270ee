// Mip levels of images whose data and display windows differ: all levels are of the display window.
#include <gmock/gmock.h>

#include "tests/io/convert/frame/mipmap_support.hpp"

namespace spectile {
namespace {

using test::Picture;
using testing::Contains;
using testing::HasSubstr;

class LevelWindows : public test::Mipmap {
 protected:
  /// The texture in other windows: data at `origin`, the display window as given.
  void show(int width, int height, Imath::V2i origin, Imath::Box2i display) {
    make(width, height);
    picture_ = test::read_picture(in_);
    picture_.header.dataWindow() = {origin, {origin.x + width - 1, origin.y + height - 1}};
    picture_.header.displayWindow() = display;
    test::write_scanlines(in_, picture_);
  }
  /// The picture made without levels, cut and filled up to the display window.
  Picture fitted(const Picture& plain) const {
    const Imath::Box2i to = plain.header.displayWindow();
    const Imath::Box2i from = plain.header.dataWindow();
    Picture out = test::blank(to.max.x - to.min.x + 1, to.max.y - to.min.y + 1, to.min);
    for (const auto& [name, plane] : plain.planes) {
      const test::Plane& samples = plane;
      out.add(name, plane.type, [&](int x, int y) {
        const int u = x + to.min.x - from.min.x;
        const int v = y + to.min.y - from.min.y;
        const bool there = u >= 0 && v >= 0 && u < plain.width() && v < plain.height();
        return there ? samples.at(plain.index(u, v)) : 0.0;
      });
    }
    return out;
  }
  template <class Options, class Function>
  void check_fitted(const std::string& input, Options options, Function convert, double mixing) {
    options.pixel = SampleType::kFloat;
    const auto plain = convert(input, folder_ / "plain.exr", options);
    ASSERT_TRUE(plain) << plain.error().message;
    options.mipmap = true;
    const auto report = convert(input, folder_ / "mip.exr", options);
    ASSERT_TRUE(report) << report.error().message;
    notes_ = report->notes;
    const Picture expected = fitted(test::read_picture(folder_ / "plain.exr"));
    const auto levels = test::read_levels(folder_ / "mip.exr");
    EXPECT_EQ(test::read_picture(folder_ / "mip.exr").header.dataWindow(), picture_.header.displayWindow());
    EXPECT_TRUE(levels[0].planes == expected.planes);
    test::check_averages(levels, expected, mixing);
  }

  Picture picture_ = test::blank(1, 1);
  std::vector<std::string> notes_;
};

TEST_F(LevelWindows, ArePaddedAndCutToTheDisplayWindow) {
  struct Case {
    Imath::V2i origin;
    Imath::Box2i display;
    const char* note;
  };
  for (const Case& one : {Case{{24, 8}, {{0, 0}, {63, 63}}, "3336 pixels outside of the data window are 0"},
                          Case{{-6, -4}, {{0, 0}, {9, 9}}, "660 pixels outside of it are left out"},
                          Case{{-6, 5}, {{-3, -70}, {70, 11}}, "left out"}}) {
    show(40, 19, one.origin, one.display);
    UpsampleImageOptions up;
    up.bands = *Bands::uniform(400, 700, 25);
    for (const Method method : {Method::kSmitsExact, Method::kSigmoid, Method::kTetrahedral}) {
      up.method = method;
      check_fitted(in_, up, &upsample_image, method == Method::kSigmoid ? 0 : test::kMixing);
      EXPECT_THAT(notes_, Contains(HasSubstr(one.note)));
    }
  }
}

TEST_F(LevelWindows, OfEveryConversion) {
  show(40, 19, {24, 8}, {{0, 0}, {63, 40}});
  RelightImageOptions relight(NamedLight{"A", *illuminant("A")});
  relight.method = Method::kSigmoid;
  relight.bands = *Bands::uniform(400, 700, 25);
  check_fitted(in_, relight, &relight_image, 0);
  UpsampleImageOptions up;
  up.bands = *Bands::uniform(400, 700, 25);
  ASSERT_TRUE(upsample_image(in_, folder_ / "s.exr", up));
  check_fitted(folder_ / "s.exr", ProjectImageOptions{}, &project_image, 0);
  for (const Method method : {Method::kSmitsExact, Method::kSigmoid, Method::kTetrahedral}) {
    up.method = method;
    up.store = Store::kCoefficients;
    ASSERT_TRUE(upsample_image(in_, folder_ / "c.exr", up));
    check_fitted(folder_ / "c.exr", ExpandImageOptions{}, &expand_image, test::kMixing);
  }
}

TEST_F(LevelWindows, MasksFollow) {
  show(40, 19, {24, 8}, {{0, 0}, {63, 40}});
  Picture mask = test::blank(40, 19);
  mask.add("A", Imf::FLOAT, [](int x, int y) { return (x / 5 + y / 3) % 2; });
  test::write_scanlines(folder_ / "mask.exr", mask);
  UpsampleImageOptions up;
  up.bands = *Bands::uniform(400, 700, 25);
  up.masking = Masking::kFile;
  up.mask = folder_ / "mask.exr";
  check_fitted(in_, up, &upsample_image, test::kMixing);
}

TEST_F(LevelWindows, BadPixelsAreCountedFromTheDataWindow) {
  show(40, 19, {24, 8}, {{0, 0}, {63, 63}});
  picture_.planes.at("G").set(picture_.index(3, 4), std::nan(""));
  test::write_scanlines(in_, picture_);
  UpsampleImageOptions up;
  up.mipmap = true;
  const auto report = upsample_image(in_, folder_ / "out.exr", up);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("1 non-finite pixel, the first at 3,4"));
}

TEST_F(LevelWindows, ThatDoNotMeetAreRefused) {
  show(40, 19, {100, 100}, {{0, 0}, {63, 63}});
  UpsampleImageOptions up;
  EXPECT_TRUE(upsample_image(in_, folder_ / "out.exr", up));
  up.mipmap = true;
  const auto report = upsample_image(in_, folder_ / "mip.exr", up);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("0,0 to 63,63, which does not go with the data window"));
}

TEST_F(LevelWindows, OfARegionAreOfTheRegion) {
  show(40, 19, {24, 8}, {{0, 0}, {63, 63}});
  UpsampleImageOptions up;
  up.mipmap = true;
  up.region = {30, 10, 40, 20};
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", up));
  const Imf::Header header = test::read_picture(folder_ / "out.exr").header;
  EXPECT_EQ(header.dataWindow(), Imath::Box2i({30, 10}, {39, 19}));
  EXPECT_EQ(header.displayWindow(), header.dataWindow());
}

TEST_F(LevelWindows, CryptomatteIsTheNearestPixels) {
  make(37, 23);
  Picture picture = test::read_picture(in_);
  picture.header.insert("cryptomatte/1a2b3c4/name", Imf::StringAttribute("Objects"));
  picture.add("Objects00.R", Imf::FLOAT, [](int x, int y) { return 1000 * y + x; });
  picture.add("Objects01.G", Imf::HALF, [](int x, int y) { return 30 * y + x; });
  test::write_scanlines(in_, picture);
  UpsampleImageOptions up;
  up.mipmap = true;
  const auto report = upsample_image(in_, folder_ / "out.exr", up);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->notes, Contains(HasSubstr("Objects00.R, Objects01.G, id name objects")));
  for (const Picture& level : test::read_levels(folder_ / "out.exr")) {
    for (int y = 0; y < level.height(); ++y) {
      for (int x = 0; x < level.width(); ++x) {
        const auto from = [](int image, int side, int at) {
          return static_cast<int>(std::floor((at + 0.5) * image / side + 1e-9));
        };
        const int u = from(37, level.width(), x);
        const int v = from(23, level.height(), y);
        EXPECT_EQ(level.at("Objects00.R", x, y), 1000 * v + u);
        EXPECT_EQ(level.at("Objects01.G", x, y), 30 * v + u);
        EXPECT_EQ(level.at("id", x, y), 1000 * v + u);
      }
    }
  }
}

}  // namespace
}  // namespace spectile
