// Images whose samples mean different things make no average, and the error names both.
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "tests/io/average/average_files.hpp"

namespace spectile {
namespace {

using test::kPlain;

class AverageMeaning : public test::AverageFiles {
 protected:
  using Change = std::function<void(Imf::Header&)>;
  std::string with(const std::string& name, const Change& change) {
    test::Picture picture = render(name[0]);
    change(picture.header);
    return write(name, picture);
  }
  static Change text(const std::string& name, const std::string& value) {
    return [=](Imf::Header& header) { header.insert(name, Imf::StringAttribute(value)); };
  }
  static Change number(const std::string& name, float value) {
    return [=](Imf::Header& header) { header.insert(name, Imf::FloatAttribute(value)); };
  }
  static Change primaries(const Imf::Chromaticities& value) {
    return [=](Imf::Header& header) { header.insert("chromaticities", Imf::ChromaticitiesAttribute(value)); };
  }
  static void nothing(Imf::Header& /*header*/) {}
  void refused(const Change& a, const Change& b, const std::string& what) {
    const std::string first = with("a.exr", a);
    const std::string other = with("b.exr", b);
    expect_error({first, other}, kPlain, ErrorCode::kBadFile, {other + ": its " + what, first});
  }
  void accepted(const Change& a, const Change& b) { average({with("a.exr", a), with("b.exr", b)}); }
};

const Imf::Chromaticities kAp1({0.713F, 0.293F}, {0.165F, 0.83F}, {0.128F, 0.044F}, {0.32168F, 0.33767F});

TEST_F(AverageMeaning, ColourSpacesMustBeTheSame) {
  refused(primaries(kAp1), nothing, "colour space is ");
  refused(text("colorInteropID", "lin_rec2020_scene"), text("colorInteropID", "lin_ap1_scene"),
          "colour space is ");
  refused(text("oiio:ColorSpace", "Linear"), text("oiio:ColorSpace", "ACEScg"), "colour space is ACEScg");
  refused(text("colorInteropID", "data"), text("colorInteropID", "srgb_rec709_scene"), "colorInteropID is ");
}

TEST_F(AverageMeaning, ColourSpacesOfTheSameMeaningAre) {
  accepted(nothing, primaries(Imf::Chromaticities()));
  accepted(text("colorInteropID", "lin_rec709_scene"), nothing);
  accepted(text("oiio:ColorSpace", "Linear"), text("oiio:ColorSpace", "lin_srgb"));
  accepted(text("colorInteropID", "data"), text("colorInteropID", "data"));
}

TEST_F(AverageMeaning, ExposuresMustBeTheSame) {
  refused(number("EV", 1.5F), number("EV", -1), "exposure value (EV) is -1, but that of ");
  refused(number("EV", 1.5F), nothing, "exposure value (EV) is 0, but that of ");
  refused(number("whiteLuminance", 80), number("whiteLuminance", 100), "whiteLuminance is 100, but that of ");
  accepted(number("EV", 0), nothing);
  accepted(number("EV", 1.5F), [](Imf::Header& header) { header.insert("EV", Imf::DoubleAttribute(1.5)); });
}

TEST_F(AverageMeaning, UnitsAndFiltersMustBeTheSame) {
  refused(nothing, text("emissiveUnits", "W.m^-2.nm^-1"), "emissiveUnits is \"W.m^-2.nm^-1\", but that of ");
  refused(text("polarisationHandedness", "left"), text("polarisationHandedness", "right"),
          "polarisationHandedness is \"right\", but that of ");
  refused(text("lensTransmission", "400nm:1;"), nothing, "lensTransmission is none, but that of ");
  refused(text("S0.402,500000nm", "400nm:1;"), text("S0.402,500000nm", "400nm:0.5;"),
          "S0.402,500000nm is \"400nm:0.5;\", but that of ");
  accepted(nothing, text("emissiveUnits", "W.m^-2.sr^-1"));
}

}  // namespace
}  // namespace spectile
