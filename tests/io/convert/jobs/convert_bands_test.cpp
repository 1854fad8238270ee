// Conversion to other bands: averages are conserved, and colours where new bands subdivide the old ones.
#include <algorithm>

#include "tests/io/convert/jobs/convert_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// 31 bands of 10 nm from 395 to 705 nm, their names without decimals.
Picture even_picture(const char* kind, double scale = 1, Imf::PixelType type = Imf::FLOAT) {
  Picture picture = blank(75, 4);
  for (int b = 0; b < 31; ++b) {
    picture.add(fmt::format("{}.{}nm", kind, 400 + 10 * b), type,
                [=](int x, int y) { return scale * noise(x, y, b); });
  }
  return picture;
}

std::string name_of(const char* kind, double nm) {
  std::string out = fmt::format("{}.{:.6f}nm", kind, nm);
  out[out.rfind('.')] = ',';
  return out;
}

/// The average over a band of samples that are constant over each band, in double.
double average(const Picture& picture, const char* kind, const Band& band, int x, int y, bool held) {
  double sum = 0;
  for (int b = 0; b < 31; ++b) {
    double lower = 395 + 10.0 * b;
    double upper = lower + 10;
    if (held && b == 0) lower = 0;
    if (held && b == 30) upper = 1e6;
    const double part = std::min(upper, band.upper_nm) - std::max(lower, band.lower_nm);
    if (part > 0) sum += part * picture.at(fmt::format("{}.{}nm", kind, 400 + 10 * b), x, y);
  }
  return sum / band.width_nm();
}

class ConvertBands : public ConvertImages {
 protected:
  Picture projected(const std::string& path) const {
    ProjectImageOptions options;
    options.target = ColorTarget::kXyz;
    options.pixel = SampleType::kFloat;
    const auto report = project_image(path, folder_ / "xyz.exr", options);
    EXPECT_TRUE(report) << report.error().message;
    return read_picture(folder_ / "xyz.exr");
  }
};

TEST_F(ConvertBands, SamplesAreAveragesOverTheNewBands) {
  for (const char* kind : {"T", "S0"}) {
    const bool held = kind[0] == 'T';
    Picture picture = even_picture(kind);
    write_scanlines(in_, picture);
    for (const char* text :
         {"395:705:10", "395:705:2.5", "395:705:62", "400:700:7.5", "380:780:5", "300:360:5"}) {
      for (const double scale : {1.0, 3.25}) {
        ConvertImageOptions options;
        options.bands = *Bands::parse(text);
        options.scale = scale;
        const ImageReport report = convert(options);
        EXPECT_EQ(report.bands, options.bands->count());
        const Picture got = output();
        for (const Band& band : options.bands->list()) {
          const std::string name = name_of(kind, band.centre_nm);
          for (int x = 0; x < 75; x += 3) {
            const double want = scale * average(picture, kind, band, x, 2, held);
            EXPECT_NEAR(got.at(name, x, 2), want, 1e-6 * scale) << text << " " << name;
          }
        }
      }
    }
  }
}

TEST_F(ConvertBands, ThatSubdivideTheOldOnesKeepTheColour) {
  for (const char* kind : {"T", "S0"}) {
    Picture picture = even_picture(kind);
    write_scanlines(in_, picture);
    const Picture before = projected(in_);
    for (const char* text : {"395:705:10", "395:705:5", "395:705:2.5", "395:705:0.5"}) {
      ConvertImageOptions options;
      options.bands = *Bands::parse(text);
      EXPECT_THAT(convert(options).notes, testing::Not(Contains(HasSubstr("new bands"))));
      const Picture after = projected(out_);
      for (const char* name : {"X", "Y", "Z"}) {
        for (int x = 0; x < 75; ++x) EXPECT_NEAR(after.at(name, x, 1), before.at(name, x, 1), 2e-6) << text;
      }
    }
  }
}

TEST_F(ConvertBands, WithinOldOnesKeepTheBits) {
  Picture picture = even_picture("T", 1, Imf::HALF);
  ConvertImageOptions options;
  options.bands = *Bands::parse("395:705:2.5");
  convert(picture, options);
  const Picture got = output();
  for (const Band& band : options.bands->list()) {
    const int old = static_cast<int>((band.centre_nm - 395) / 10);
    EXPECT_TRUE(got.planes.at(name_of("T", band.centre_nm)) ==
                picture.planes.at(fmt::format("T.{}nm", 400 + 10 * old)));
  }
}

TEST_F(ConvertBands, BeyondTheOldOnesAreSaid) {
  ConvertImageOptions options;
  options.bands = *Bands::parse("380:400:5");
  Picture light = even_picture("S0");
  EXPECT_THAT(
      convert(light, options).notes,
      Contains("3 of 4 new bands lie, in part or whole, beyond the input's 395 to 705 nm, where light is "
               "0"));
  EXPECT_EQ(output().at("S0.382,500000nm", 3, 1), 0);
  Picture reflectance = even_picture("T");
  EXPECT_THAT(convert(reflectance, options).notes,
              ElementsAre(HasSubstr("where reflectance keeps the nearest band's value")));
  EXPECT_EQ(output().at("T.382,500000nm", 3, 1), reflectance.at("T.400nm", 3, 1));
}

TEST_F(ConvertBands, StokesComponentsGoWithS0) {
  Picture picture = blank(5, 3);
  for (const char* name : {"S0.500nm", "S0.510nm", "S3.500nm", "S3.510nm"}) {
    picture.add(name, Imf::FLOAT, [=](int x, int y) { return noise(x, y, name[1] + name[4]) - 0.5; });
  }
  ConvertImageOptions options;
  options.bands = *Bands::parse("495:515:20");
  convert(picture, options);
  for (const char* kind : {"S0", "S3"}) {
    const std::string start = kind;
    EXPECT_NEAR(output().at(start + ".505,000000nm", 2, 1),
                (picture.at(start + ".500nm", 2, 1) + picture.at(start + ".510nm", 2, 1)) / 2, 1e-7);
  }
}

TEST_F(ConvertBands, OfReradiationAreRefused) {
  Picture picture = blank(2, 2);
  for (const char* name : {"T.500nm", "T.510nm", "T.500nm.510nm"}) {
    picture.add(name, Imf::FLOAT, [](int, int) { return 0.5; });
  }
  write_scanlines(in_, picture);
  ConvertImageOptions options;
  options.bands = Bands();
  const Error error = error_of(options);
  EXPECT_EQ(error.code, ErrorCode::kBadArgument);
  EXPECT_THAT(error.message, HasSubstr("holds re-radiation"));
}

}  // namespace
}  // namespace spectile::test
