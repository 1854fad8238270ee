// Every command that reads colours says which guess it made: of the space, the channels, layers, views, parts
// and alpha.
#include <OpenEXR/ImfStringAttribute.h>

#include "tests/cli/guesses/guesses.hpp"

namespace spectile::test {
namespace {

class ColorGuesses : public Guesses {
 protected:
  std::vector<Arguments> all() const {
    return {{"upsample", in_, "-o", out_},
            {"relight", in_, "-o", out_, "--illuminant", "A"},
            {"verify", in_},
            plan("D65", {"--texture", in_})};
  }
  std::vector<Arguments> first(std::size_t count) const {
    std::vector<Arguments> out = all();
    out.resize(count);
    return out;
  }
};

Picture with_views() {
  Picture picture = constant({"R", "G", "B", "right.R", "right.G", "right.B"});
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  return picture;
}

/// Alpha of 0, one half and 1.
Picture with_alpha() {
  Picture picture = constant({"R", "G", "B"}, 0.25);
  picture.add("A", Imf::FLOAT, [](int x, int) { return std::min(0.5 * x, 1.0); });
  return picture;
}

TEST_F(ColorGuesses, AreSaidByEveryCommand) {
  const Guess guesses[] = {
      {"untagged",
       [] {
         return constant({"R", "G", "B"});
       },
       {"linear Rec.709 assumed, as the file names no"}},
      {"tag unknown",
       [] {
         Picture picture = constant({"R", "G", "B"});
         picture.header.insert("colorInteropID", Imf::StringAttribute("unknown"));
         return picture;
       },
       {"linear Rec.709 assumed, as the file names no"}},
      {"only layer",
       [] {
         return constant({"diffuse.R", "diffuse.G", "diffuse.B"});
       },
       {"layer \"diffuse\", the only one with colours, is taken"}},
      {"main layer of several",
       [] {
         return constant({"rgba.R", "rgba.G", "rgba.B", "diffuse.R", "diffuse.G", "diffuse.B"});
       },
       {"layer \"rgba\" is taken"}},
      {"Blender's main layer",
       [] {
         return constant({"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"});
       },
       {"layer \"ViewLayer.Combined\", the only one with colours, is taken"}},
      {"layer without a name",
       [] {
         return constant({".R", ".G", ".B"});
       },
       {"channels .R, .G, .B are taken for R, G, B"}},
      {"lower case",
       [] {
         return constant({"r", "g", "b"});
       },
       {"channels r, g, b are taken for R, G, B"}},
      {"words",
       [] {
         return constant({"Red", "Green", "Blue"});
       },
       {"channels Red, Green, Blue are taken for R, G, B"}},
      {"words of a layer",
       [] {
         return constant({"uv.red", "uv.green", "uv.blue"});
       },
       {"layer \"uv\", the only one with colours, is taken", "channels uv.red, uv.green, uv.blue are taken"}},
      {"XYZ",
       [] {
         return constant({"X", "Y", "Z"});
       },
       {"channels X, Y, Z are taken for CIE XYZ under D65"}},
      {"luminance", [] { return constant({"Y"}); }, {"channel Y alone is taken for grey"}},
      {"integers",
       [] {
         return constant({"R", "G", "B"}, 1, Imf::UINT);
       },
       {"channels R, G, B are integers: 1 is white"}},
      {"other view", with_views, {"left out: view right (see --view)"}},
      {"bare srgb",
       [] {
         return constant({"R", "G", "B"});
       },
       {"input space srgb is taken as linear Rec.709"},
       {"--input-space", "srgb"}},
      {"layer in the place of the preview",
       [] {
         return constant({"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B"});
       },
       {"channel \"R\" gives way to the preview of layer \"diffuse\""},
       {"--layer", "diffuse"}}};
  for (const Guess& guess : guesses) expect_said(guess, all());
  expect_silence(all()[0]);
}

TEST_F(ColorGuesses, PartsLeftOutAreNamedByEveryCommand) {
  Picture one = constant({"R", "G", "B"});
  Picture two = constant({"R", "G", "B"}, 0.25);
  Picture three = constant({"Z"}, 0.25);
  write_parts(in_, {{"beauty", &one}, {"fill", &two}});
  for (const Arguments& command : all())
    expect_said("part", command, {"1 other part of the file is left out: \"fill\""});
  write_parts(in_, {{"depth", &three}, {"beauty", &one}, {"fill", &two}});
  for (const Arguments& command : all())
    expect_said("parts", command, {"2 other parts of the file are left out: \"depth\", \"fill\""});
}

TEST_F(ColorGuesses, OfAlphaAreSaidWhereTheyMatter) {
  const std::string assumed =
      "colour is taken as premultiplied by alpha, which is between 0 and 1 in 4 pixels";
  expect_said({"premultiplied", with_alpha, {assumed, "--alpha straight or ignore"}, {"--method", "sigmoid"}},
              first(3));
  // Stated, or of no consequence.
  for (const Arguments& more : {Arguments{"--method", "sigmoid", "--alpha", "premultiplied"},
                                {"--method", "sigmoid", "--alpha", "straight"},
                                {"--method", "smits"}}) {
    for (Arguments command : first(3)) {
      command.insert(command.end(), more.begin(), more.end());
      const Outcome outcome = run_tool(command);
      EXPECT_EQ(outcome.exit, 0) << outcome;
      EXPECT_THAT(outcome.out, testing::Not(testing::HasSubstr("premultiplied by alpha"))) << command[0];
    }
  }
  const auto flame = [] {
    Picture picture = with_alpha();
    picture.planes.clear();
    for (const char* name : {"R", "G", "B"}) picture.add(name, Imf::FLOAT, [](int, int) { return 0.75; });
    picture.add("A", Imf::FLOAT, [](int, int) { return 0.5; });
    return picture;
  };
  expect_said({"light above alpha", flame, {"16 pixels are brighter than alpha"}, {"--method", "sigmoid"}},
              first(3));
  expect_said({"planned", with_alpha, {"planned for as they are stored, whatever their alpha"}},
              {all().back()});
  const auto stated = [] {
    Picture picture = constant({"R", "G", "B"});
    picture.header.insert("colorInteropID", Imf::StringAttribute("lin_ap1_scene"));
    return picture;
  };
  expect_said({"stated",
               stated,
               {"taken as linear Rec.2020, as --input-space states; the file says ACEScg"},
               {"--input-space", "rec2020"}},
              all());
  expect_said({"mask", with_alpha, {"4 pixels of alpha 0 with a colour"}, {"--mask", "alpha"}}, first(1));
  const std::string mask = folder_ / "mask.exr";
  Picture rgba = constant({"R", "G", "B", "A"}, 1);
  write_scanlines(mask, rgba);
  expect_said({"channel of the mask",
               [] {
                 return constant({"R", "G", "B"});
               },
               {"channel A of " + mask + " is taken for the mask"},
               {"--mask", mask}},
              first(1));
  expect_said({"mask without alpha",
               [] {
                 return constant({"R", "G", "B"});
               },
               {"there is no alpha, so that --mask alpha masks nothing"},
               {"--mask", "alpha"}},
              first(1));
}

TEST_F(ColorGuesses, OfWhatIsWrittenAreSaid) {
  const auto subsampled = [] {
    Picture picture = constant({"R", "G", "B"});
    picture.header.channels().insert("fog", Imf::Channel(Imf::HALF, 2, 2));
    return picture;
  };
  // A frame buffer without the channel leaves it 0.
  expect_said({"subsampled", subsampled, {"channel \"fog\" is left out: it is subsampled 2 x 2"}}, all());
  expect_said({"region",
               [] {
                 return constant({"R", "G", "B"});
               },
               {"the region 2,2,9,9 is limited to 2,2,3,3: the data window is 0,0,3,3"},
               {"--region", "2,2,9,9"}},
              first(2));
  const auto cropped = [] {
    Picture picture = constant({"R", "G", "B"});
    picture.header.displayWindow() = {{0, 0}, {7, 3}};
    return picture;
  };
  expect_said(
      {"levels", cropped, {"mip levels are of the display window, 0,0 to 7,3; 16 pixels"}, {"--mipmap"}},
      first(2));
  const auto ids = [] {
    Picture picture = constant({"R", "G", "B"});
    picture.add("id", Imf::UINT, [](int x, int) { return x; });
    return picture;
  };
  expect_said({"ids in levels", ids, {"id names objects: mip levels take the nearest pixel's"}, {"--mipmap"}},
              first(2));
  const auto hashed = [] {
    Picture picture = constant({"R", "G", "B"});
    picture.header.insert("oiio:SHA-1", Imf::StringAttribute("0123"));
    return picture;
  };
  expect_said({"attributes", hashed, {"attributes left out", "oiio:SHA-1"}}, first(2));
}

TEST_F(ColorGuesses, InformationSaysThemInItsOwnWords) {
  const std::pair<Picture, std::string> cases[] = {
      {constant({"R", "G", "B"}), "linear Rec.709 (assumed)"},
      {constant({"X", "Y", "Z"}), "CIE XYZ (D65)"},
      {constant({"uv.red", "uv.green", "uv.blue"}), "colour uv.red, uv.green, uv.blue"},
      {constant({"Y"}), "colour Y"}};
  for (auto [picture, words] : cases) {
    write_scanlines(in_, picture);
    EXPECT_THAT(run_tool({"info", in_}).out, testing::HasSubstr(words));
    EXPECT_THAT(run_tool({"info", in_, "--json"}).out, testing::HasSubstr(words));
  }
}

}  // namespace
}  // namespace spectile::test
