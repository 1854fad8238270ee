// Images that make no average, what stops one, and what an average carries.
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "tests/io/average/average_files.hpp"

namespace spectile {
namespace {

using AverageErrors = test::AverageFiles;
using test::kPlain;
using test::weighted;

TEST_F(AverageErrors, ThatDifferAreNamedWithWhatDiffers) {
  const std::string a = write("a.exr", render(0));
  const auto differs = [&](const std::string& name, test::Picture picture, const std::string& what) {
    const std::string other = write(name, std::move(picture));
    expect_error({a, a, other}, kPlain, ErrorCode::kBadFile, {other + ": " + what, a});
  };
  test::Picture wider = test::blank(38, 41);
  test::add_rgb_noise(wider, Imf::FLOAT);
  differs("wide.exr", wider, "its display window is 0,0 to 37,40, but ");
  differs("moved.exr", render(0, Imf::FLOAT, {1, 0}), "its display window is 1,0 to 37,40, but ");
  test::Picture shown = render(0);
  shown.header.displayWindow().max.x = 99;
  differs("shown.exr", shown, "its display window is 0,0 to 99,40, but ");
  test::Picture more = render(0);
  more.add("Z", Imf::FLOAT, [](int, int) { return 1; });
  differs("more.exr", more, "has a channel \"Z\", but ");
  test::Picture fewer = test::blank(37, 41);
  test::add_rgb_noise(fewer, Imf::FLOAT);
  differs("fewer.exr", fewer, "has no channel \"S0.402,500000nm\", but ");
  test::Picture typed = render(0);
  typed.add("id", Imf::FLOAT, [](int, int) { return 1; });
  differs("typed.exr", typed, "channel \"id\" is float, but that of ");
}

TEST_F(AverageErrors, ThatCannotBeAveragedAreErrors) {
  const std::string a = write("a.exr", render(0));
  expect_error({}, kPlain, ErrorCode::kBadArgument, {"no images"});
  expect_error({a, a}, weighted({1, 2, 3}), ErrorCode::kBadArgument, {"3 weights for 2 images"});
  expect_error({a, a}, weighted({0, 0}), ErrorCode::kBadArgument, {"all weights are 0"});
  expect_error({a, a}, weighted({1, -2}), ErrorCode::kBadArgument, {"weight -2"});
  expect_error({a, folder_ / "none.exr"}, kPlain, ErrorCode::kBadFile, {"none.exr"});
  test::write_text(folder_ / "text.exr", "no image");
  expect_error({a, folder_ / "text.exr"}, kPlain, ErrorCode::kBadFile, {"text.exr: not an OpenEXR file"});
  const std::string bytes = test::file_bytes(a);
  test::write_text(folder_ / "short.exr", bytes.substr(0, bytes.size() * 2 / 3));
  expect_error({a, folder_ / "short.exr"}, kPlain, ErrorCode::kBadFile, {"short.exr: "});
  const auto itself = average_images(std::vector<std::string>{folder_ / "text.exr", a}, a);
  ASSERT_FALSE(itself);
  EXPECT_EQ(itself.error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(test::file_bytes(a), bytes);

  test::Picture chroma = test::blank(8, 8);
  chroma.add("Y", Imf::HALF, [](int, int) { return 1; });
  chroma.header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  std::vector<half> quarter(16);
  {
    Imf::OutputFile file((folder_ / "chroma.exr").c_str(), chroma.header);
    Imf::FrameBuffer frame = chroma.frame_buffer();
    frame.insert("RY", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(quarter.data()), 2, 8, 2, 2));
    file.setFrameBuffer(frame);
    file.writePixels(8);
  }
  expect_error({folder_ / "chroma.exr"}, kPlain, ErrorCode::kBadFile,
               {"chroma.exr: channel \"RY\" is subsampled 2 x 2"});
}

TEST_F(AverageErrors, PartsAreAsManyAsTheFirstOnes) {
  test::Picture picture = render(0);
  std::vector<Imf::Header> headers(2, picture.header);
  for (std::size_t i = 0; i < 2; ++i) {
    headers[i].setName(i == 0 ? "left" : "right");
    headers[i].setType("scanlineimage");
  }
  {
    Imf::MultiPartOutputFile file((folder_ / "parts.exr").c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(picture.frame_buffer());
      part.writePixels(picture.height());
    }
  }
  expect_error({write("a.exr", picture), folder_ / "parts.exr"}, kPlain, ErrorCode::kBadFile,
               {"parts.exr: has 2 parts, but ", "a.exr has 1"});
}

TEST_F(AverageErrors, CarryTheFirstOnesAttributesAndTheirOwn) {
  test::Picture first = render(0);
  first.header.insert("owner", Imf::StringAttribute("me"));
  first.header.insert("spectileAverage", Imf::StringAttribute("an older one"));
  test::Picture second = render(1);
  second.header.insert("owner", Imf::StringAttribute("you"));
  const test::Picture out = average({write("a.exr", first), write("b.exr", second)}, weighted({64, 0.5}));
  EXPECT_EQ(out.header.typedAttribute<Imf::StringAttribute>("owner").value(), "me");
  EXPECT_EQ(out.header.typedAttribute<Imf::StringAttribute>("spectileAverage").value(),
            "2 images, weights' sum 64.5");
}

TEST_F(AverageErrors, StopWhenAskedTo) {
  AverageOptions options;
  options.progress = [](const Progress&) { return false; };
  expect_error(renders(3), options, ErrorCode::kCancelled, {});
}

}  // namespace
}  // namespace spectile
