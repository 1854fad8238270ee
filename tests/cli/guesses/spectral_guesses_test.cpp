// Every command that reads spectra says which guess it made: of the quantity, the bands, layers, views and
// parts; so do the commands that read coefficients and average images.
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "tests/cli/guesses/guesses.hpp"

namespace spectile::test {
namespace {

class SpectralGuesses : public Guesses {
 protected:
  std::vector<Arguments> all() const {
    return {{"project", in_, "-o", out_}, {"verify", in_}, {"info", in_}};
  }
};

Picture mitsuba() {
  Picture picture = blank(4, 4);
  for (int i = 0; i < 16; ++i)
    picture.add(fmt::format("{}.00-{}.00nm", 380 + 25 * i, 405 + 25 * i), Imf::FLOAT,
                [](int, int) { return 1; });
  return picture;
}

Picture indigo() {
  Picture picture = blank(4, 4);
  for (int i = 0; i < 11; ++i)
    picture.add(fmt::format("wavelength{}_25", 400 + 30 * i), Imf::FLOAT, [](int, int) { return 1; });
  return picture;
}

Picture ocean() {
  Picture picture = blank(4, 4);
  for (int i = 0; i < 31; ++i) {
    picture.add(fmt::format("wl{}", i), Imf::FLOAT, [](int, int) { return 1; });
    picture.header.insert(fmt::format("wl{}.wavelength", i), Imf::DoubleAttribute((400 + 10 * i) * 1e-9));
  }
  return picture;
}

Picture stereo() {
  Picture picture = spectral({"S0", "right.S0"});
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  return picture;
}

TEST_F(SpectralGuesses, AreSaidByEveryCommand) {
  const Guess guesses[] = {
      {"Mitsuba 0.6", mitsuba, {"Mitsuba 0.6's channels are taken for light; --quantity reflectance"}},
      {"Indigo",
       indigo,
       {"Indigo's channels are taken for light; --quantity reflectance",
        "Indigo's numbers are lower edges: a band ends where the next one starts"}},
      {"Ocean", ocean, {"Ocean's channels are taken for light; --quantity reflectance"}},
      {"only layer",
       [] { return spectral({"diffuse.S0"}); },
       {"layer \"diffuse\", the only one with spectra, is taken"}},
      {"other layer",
       [] {
         return spectral({"S0", "diffuse.S0"});
       },
       {"left out: 31 bands of emission, layer \"diffuse\""}},
      {"other view", stereo, {"left out: 31 bands of emission, view \"right\""}},
      {"emission beside reflectance",
       [] {
         return spectral({"T", "S0"});
       },
       {"left out: 31 bands of emission"}}};
  for (const Guess& guess : guesses) expect_said(guess, all());
  expect_silence(all()[0]);
}

TEST_F(SpectralGuesses, PartsLeftOutAreNamedByEveryCommand) {
  Picture beauty = constant({"R", "G", "B"});
  Picture one = spectral({"S0"});
  Picture two = spectral({"S0"});
  write_parts(in_, {{"beauty", &beauty}, {"one", &one}, {"two", &two}});
  for (const Arguments& command : all()) {
    expect_said(
        "parts", command,
        {"1 other part of the file is left out: \"beauty\"", "left out: 31 bands of emission, part \"two\""});
  }
}

TEST_F(SpectralGuesses, MapsAreTakenForLight) {
  const std::string map = folder_ / "map.csv";
  write_text(map, "red,600,700\ngreen,500,600\nblue,400,500\n");
  Picture camera = constant({"red", "green", "blue"});
  Picture other = constant({"depth"});
  write_parts(in_, {{"camera", &camera}, {"depth", &other}});
  for (const Arguments& command : {Arguments{"project", in_, "-o", out_}, {"info", in_}}) {
    Arguments with_map = command;
    with_map.insert(with_map.end(), {"--channels", map});
    expect_said("map", with_map,
                {"mapped channels are taken for light; --quantity reflectance states the other",
                 "1 other part of the file is left out: \"depth\""});
  }
}

TEST_F(SpectralGuesses, OfWhatIsWrittenAreSaid) {
  const std::vector<Arguments> project = {all()[0]};
  const auto narrow = [] {
    Picture picture = blank(4, 4);
    for (int nm = 440; nm <= 700; nm += 20)
      picture.add(fmt::format("T.{},0nm", nm), Imf::FLOAT, [](int, int) { return 0.5; });
    return picture;
  };
  expect_said({"narrow bands", narrow, {"the bands miss much of the visible range"}}, project);
  const auto reflectance = [] { return spectral({"T"}); };
  expect_said({"region", reflectance, {"the region 2,2,9,9 is limited to 2,2,3,3"}, {"--region", "2,2,9,9"}},
              project);
  const auto exposed = [] {
    Picture picture = spectral({"S0"});
    picture.header.insert("EV", Imf::FloatAttribute(2));
    return picture;
  };
  expect_said({"attributes", exposed, {"attributes left out", "EV"}}, project);
  const auto cropped = [] {
    Picture picture = spectral({"T"});
    picture.header.displayWindow() = {{0, 0}, {7, 3}};
    return picture;
  };
  expect_said({"levels", cropped, {"mip levels are of the display window"}, {"--mipmap"}}, project);
  const auto subsampled = [] {
    Picture picture = spectral({"T"});
    picture.header.channels().insert("fog", Imf::Channel(Imf::HALF, 2, 2));
    return picture;
  };
  expect_said({"subsampled", subsampled, {"channel \"fog\" is left out: it is subsampled 2 x 2"}}, project);
}

class CoefficientGuesses : public Guesses {};

TEST_F(CoefficientGuesses, AreSaid) {
  Picture picture = constant({"R", "G", "B"});
  picture.header.displayWindow() = {{0, 0}, {7, 3}};
  const std::string rgb = folder_ / "rgb.exr";
  write_scanlines(rgb, picture);
  ASSERT_EQ(run_tool({"upsample", rgb, "-o", in_, "--store", "coefficients", "--method", "sigmoid", "--bands",
                      "450:650:10"})
                .exit,
            0);
  const Arguments expand = {"expand", in_, "-o", out_};
  const auto with = [&](const Arguments& more) {
    Arguments out = expand;
    out.insert(out.end(), more.begin(), more.end());
    return out;
  };
  expect_said("beyond the bands", with({"--bands", "400:700:10"}),
              {"beyond 455 to 645 nm, for which the coefficients were made, spectra keep the value there"});
  expect_said("region", with({"--region", "2,2,9,9"}), {"the region 2,2,9,9 is limited to 2,2,3,3"});
  expect_said("levels", with({"--mipmap"}), {"mip levels are of the display window"});
  Picture compact = read_picture(in_);
  write_parts(in_, {{"picture", &picture}, {"texture", &compact}});
  expect_said("parts", expand, {"1 other part of the file is left out: \"picture\""});
}

class AverageGuesses : public Guesses {};

TEST_F(AverageGuesses, AreSaid) {
  const std::string second = folder_ / "second.exr";
  const Arguments average = {"film", "average", in_, second, "-o", out_};
  const auto expect = [&](const std::string& name, Picture a, Picture b,
                          const std::vector<std::string>& said) {
    write_scanlines(in_, a);
    write_scanlines(second, b);
    expect_said(name, average, said);
  };
  const Picture plain = constant({"R", "G", "B"});
  Picture ids = plain;
  ids.add("id", Imf::UINT, [](int x, int) { return x; });
  expect("ids", ids, ids, {"id names objects and is not averaged: it is that of " + in_});
  const auto window = [](int x) {
    Picture picture = blank(4, 4, {x, 0});
    picture.header.displayWindow() = {{0, 0}, {7, 3}};
    picture.add("Y", Imf::FLOAT, [](int, int) { return 1; });
    return picture;
  };
  expect("windows", window(0), window(4), {"data windows differ: put together to 0,0 to 7,3"});
  expect("gaps", window(0), window(5), {"4 pixels are in no image: 0"});
  Picture tagged = plain;
  tagged.header.insert("colorInteropID", Imf::StringAttribute("lin_rec709_scene"));
  expect("space of the second", tagged, plain,
         {second + " names no colour space; that of the others is assumed"});
  expect("space of the first", plain, tagged,
         {in_ + " names no colour space; that of the others is assumed"});
  Picture hashed = plain;
  hashed.header.insert("oiio:SHA-1", Imf::StringAttribute("0123"));
  expect("attributes", hashed, plain, {"attributes left out", "oiio:SHA-1"});
}

}  // namespace
}  // namespace spectile::test
