// Layers, views, parts and channel maps: the choice among what a spectral image holds.
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/image/channel_map.hpp>

#include "tests/io/channels/spectral_files.hpp"

namespace spectile::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using ChannelChoices = SpectralFiles;

TEST_F(ChannelChoices, MapsSayWhatNamesDoNot) {
  Picture picture = blank(2, 2);
  picture.add("band1_red", Imf::HALF, [](int, int) { return 0.25; });
  picture.add("band2_green", Imf::HALF, [](int, int) { return 0.5; });
  picture.add("band3_blue", Imf::HALF, [](int, int) { return 1; });
  write_scanlines(in_, picture);
  EXPECT_THAT(error_of(), HasSubstr("channel map"));
  write_text(
      folder_ / "edges.csv",
      "channel,lower,upper\n# of the camera\nband1_red,600,700\n\nband2_green,500,600\nband3_blue,400,500\n");
  write_text(folder_ / "centres.csv", "band3_blue, 450\nband2_green, 550\r\nband1_red, 650\n");
  write_text(folder_ / "bom.csv",
             "\xEF\xBB\xBF"
             "band3_blue;450\rband2_green;550\rband1_red;650\r");
  write_text(folder_ / "tabs.tsv", "band1_red\t600\t700\nband2_green\t500\t600\nband3_blue\t400\t500");
  for (const char* map : {"edges.csv", "centres.csv", "bom.csv", "tabs.tsv"}) {
    ProjectImageOptions options = xyz();
    options.channels.map = *load_channel_map(folder_ / map);
    const ImageReport report = project(in_, options);
    EXPECT_THAT(report.notes, ElementsAre(HasSubstr("mapped channels are taken for light")));
    expect_pixel(light_of({{400, 500}, {500, 600}, {600, 700}}, {1, 0.5, 0.25}));
  }
  ProjectImageOptions options = xyz();
  options.channels.map = {{"band4", {700, 710, 720}}};
  EXPECT_THAT(error_of(options), HasSubstr("has no channel \"band4\" of the channel map; it has band1_red"));
}

TEST_F(ChannelChoices, FaultsOfMapsHaveTheirLines) {
  const std::pair<const char*, const char*> maps[] = {
      {"a,500\na,510\n", "line 2: channel \"a\" again"},
      {"a,500\nb\n", "line 2: is neither"},
      {"a,600,500\n", "line 1, column 7: the upper edge"},
      {"a,500\nb,510,520\n", "wavelengths and edges"},
      {"", "names no channel"},
      {"a,500,510\nb,505,515\n", "overlap"},
      {"a,500\nb,-3\n", "line 2, column 3: \"-3\" is not a wavelength"},
      {"a,500,510,520\n", "line 1: is neither"},
      {"a,500\n,510\n", "line 2: is neither"},
      {"a,500\nb,nan\n", "line 2, column 3: \"nan\""},
      {"\x01,500\n", "this is no text"}};
  for (const auto& [text, want] : maps) {
    write_text(folder_ / "map.csv", text);
    const auto map = load_channel_map(folder_ / "map.csv");
    ASSERT_FALSE(map) << text;
    EXPECT_THAT(map.error().message, HasSubstr(want)) << text;
  }
  EXPECT_FALSE(load_channel_map(folder_ / "none.csv"));
}

TEST_F(ChannelChoices, LayersAreChosenByName) {
  Picture picture = blank(2, 2);
  add_rgb_noise(picture, Imf::HALF);
  add_even(picture, "diffuse.", 0.5);
  write_scanlines(in_, picture);
  const ImageReport only = project(in_);
  EXPECT_THAT(only.notes, ElementsAre("layer \"diffuse\", the only one with spectra, is taken"));
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);

  add_even(picture, "specular.", 0.25);
  write_scanlines(in_, picture);
  EXPECT_THAT(error_of(), HasSubstr("several layers, of which --layer states one: diffuse; specular"));
  ProjectImageOptions options = xyz();
  options.channels.layer = "specular";
  const ImageReport report = project(in_, options);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("left out: 31 bands of emission, layer \"diffuse\"")));
  EXPECT_NEAR(luminance_at_origin(out_), 0.25, 1e-6);
  options.channels.layer = "glossy";
  EXPECT_THAT(error_of(options), HasSubstr("layer \"diffuse\""));

  // Plain channels come first, and a colour takes no spectra along.
  add_even(picture, "", 0.75);
  write_scanlines(in_, picture);
  project(in_);
  EXPECT_NEAR(luminance_at_origin(out_), 0.75, 1e-6);
  EXPECT_EQ(read_picture(out_).planes.size(), 3U);
}

TEST_F(ChannelChoices, ViewsAreChosenByName) {
  Picture picture = blank(2, 2);
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  add_even(picture, "", 0.5);
  add_even(picture, "right.", 0.25);
  write_scanlines(in_, picture);
  const ImageReport report = project(in_);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("left out: 31 bands of emission, view \"right\"")));
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);
  EXPECT_EQ(read_picture(out_).planes.size(), 3U);
  ProjectImageOptions options = xyz();
  options.channels.view = "right";
  project(in_, options);
  EXPECT_NEAR(luminance_at_origin(out_), 0.25, 1e-6);
  options.channels.view = "centre";
  EXPECT_THAT(error_of(options), HasSubstr("view \"left\""));
}

TEST_F(ChannelChoices, PartsAreChosenByNameOrNumber) {
  Picture beauty = blank(2, 2);
  add_rgb_noise(beauty, Imf::HALF);
  Picture one = blank(2, 2);
  Picture other = blank(2, 2);
  add_even(one, "", 0.5);
  add_even(other, "", 0.25);
  Picture* const parts[] = {&beauty, &one, &other};
  const char* const names[] = {"beauty", "spectral.left", "spectral.right"};
  std::vector<Imf::Header> headers;
  for (int i = 0; i < 3; ++i) {
    parts[i]->header.setName(names[i]);
    parts[i]->header.setType("scanlineimage");
    headers.push_back(parts[i]->header);
  }
  {
    Imf::MultiPartOutputFile file(in_.c_str(), headers.data(), 3);
    for (int i = 0; i < 3; ++i) {
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(parts[i]->frame_buffer());
      part.writePixels(2);
    }
  }
  const ImageReport first = project(in_);
  EXPECT_THAT(first.notes, ElementsAre("1 other part of the file is left out: \"beauty\"",
                                       HasSubstr("left out: 31 bands of emission, part \"spectral.right\"")));
  EXPECT_NEAR(luminance_at_origin(out_), 0.5, 1e-6);
  for (const char* part : {"spectral.right", "2"}) {
    ProjectImageOptions options = xyz();
    options.channels.part = part;
    project(in_, options);
    EXPECT_NEAR(luminance_at_origin(out_), 0.25, 1e-6) << part;
  }
  ProjectImageOptions options = xyz();
  options.channels.part = "3";
  EXPECT_THAT(error_of(options), HasSubstr("0 \"beauty\", 1 \"spectral.left\""));
}

}  // namespace
}  // namespace spectile::test
