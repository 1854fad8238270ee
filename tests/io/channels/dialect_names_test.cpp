// Names of channels as they are written: each dialect reads its own, and the strict grammar of the layout.
#include "src/io/channels/dialect_names.hpp"

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/io/channels/spectral_sets.hpp"

namespace spectile::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Bands bands(const char* text) {
  return *Bands::parse(text);
}

std::vector<std::string> names(const char* key, const Bands& of, Quantity quantity = Quantity::kIlluminant) {
  std::vector<std::string> notes;
  std::vector<std::string> out;
  const auto made = dialect_names(*find_dialect(key), of, quantity, "x.exr", notes);
  EXPECT_TRUE(made) << made.error().message;
  EXPECT_THAT(notes, IsEmpty());
  for (const WrittenChannel& channel : *made) out.push_back(channel.name);
  return out;
}

std::string refusal(const char* key, const Bands& of, Quantity quantity = Quantity::kIlluminant) {
  std::vector<std::string> notes;
  const auto made = dialect_names(*find_dialect(key), of, quantity, "x.exr", notes);
  EXPECT_FALSE(made);
  if (made) return {};
  EXPECT_EQ(made.error().code, ErrorCode::kBadArgument);
  return made.error().message;
}

TEST(DialectNames, AreThoseThatProgramsWrite) {
  const Bands of = bands("400:430:10");
  EXPECT_THAT(names("layout", of), ElementsAre("S0.405,000000nm", "S0.415,000000nm", "S0.425,000000nm"));
  EXPECT_THAT(names("layout", of, Quantity::kReflectance),
              ElementsAre("T.405,000000nm", "T.415,000000nm", "T.425,000000nm"));
  EXPECT_THAT(names("mitsuba06", of), ElementsAre("400.00-410.00nm", "410.00-420.00nm", "420.00-430.00nm"));
  EXPECT_THAT(names("indigo", of), ElementsAre("wavelength400", "wavelength410", "wavelength420"));
  EXPECT_THAT(names("indigo", bands("400.25:430.25:10")),
              ElementsAre("wavelength400_25", "wavelength410_25", "wavelength420_25"));
  EXPECT_THAT(names("ocean", of), ElementsAre("wl0", "wl1", "wl2"));
  EXPECT_EQ(stokes_channel_name(2, 500.25), "S2.500,250000nm");
  EXPECT_EQ(reradiation_channel_name(400, 500.5), "T.400,000000nm.500,500000nm");
}

TEST(DialectNames, AreReadAsTheSameBands) {
  for (const Dialect& dialect : dialects()) {
    for (const char* text : {"400:700:5", "380.125:780.125:12.5", "380:780:0.5", "360:830:10"}) {
      const Bands of = bands(text);
      std::vector<std::string> notes;
      const auto made = dialect_names(dialect, of, Quantity::kIlluminant, "x.exr", notes);
      ASSERT_TRUE(made) << made.error().message;
      Imf::Header header(1, 1);
      for (const WrittenChannel& channel : *made) {
        if (channel.metres)
          header.insert(channel.name + ".wavelength", Imf::DoubleAttribute(*channel.metres));
      }
      const PartHeader read_from(header);
      std::vector<SpectralChannel> read;
      for (const WrittenChannel& channel : *made) {
        const auto one = parse_spectral_channel(channel.name, read_from);
        ASSERT_TRUE(one) << channel.name;
        EXPECT_EQ(one->dialect, &dialect) << channel.name;
        EXPECT_EQ(one->kind, SpectralKind::kEmissive);
        read.push_back(*one);
      }
      const auto again = bands_read(read);
      ASSERT_TRUE(again) << again.error().message;
      ASSERT_EQ(again->count(), of.count());
      for (std::size_t b = 0; b < of.count(); ++b) {
        EXPECT_NEAR((*again)[b].lower_nm, of[b].lower_nm, 1e-6) << dialect.name << " " << text;
        EXPECT_NEAR((*again)[b].centre_nm, of[b].centre_nm, 1e-6) << dialect.name << " " << text;
        EXPECT_NEAR((*again)[b].upper_nm, of[b].upper_nm, 1e-6) << dialect.name << " " << text;
      }
    }
  }
}

TEST(DialectNames, RefuseWhatTheyCannotHold) {
  const Bands with_gap = *Bands::from_list({{400, 405, 410}, {420, 425, 430}, {430, 435, 440}});
  EXPECT_THAT(
      refusal("indigo", with_gap),
      HasSubstr("x.exr: Indigo's channel names would change 1 of 3 bands: 400.00 to 410.00 nm becomes "
                "400.00 to 420.00 nm"));
  EXPECT_THAT(refusal("ocean", with_gap), HasSubstr("would change"));
  EXPECT_THAT(names("mitsuba06", with_gap),
              ElementsAre("400.00-410.00nm", "420.00-430.00nm", "430.00-440.00nm"));
  for (const char* key : {"mitsuba06", "indigo", "ocean"}) {
    EXPECT_THAT(refusal(key, bands("400:700:5"), Quantity::kReflectance),
                HasSubstr("channels are light, and reflectances would be read as that"));
  }
}

TEST(DialectNames, OfTheLayoutSayWhereEdgesChange) {
  const Bands with_gap = *Bands::from_list({{400, 405, 410}, {420, 425, 430}, {430, 435, 440}});
  std::vector<std::string> notes;
  ASSERT_TRUE(dialect_names(*find_dialect("layout"), with_gap, Quantity::kIlluminant, "x.exr", notes));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("that changes 2 of 3 bands: 400.00 to 410.00 nm becomes 395.00 to "
                                           "415.00 nm")));
}

TEST(DialectNames, HaveKeysThatAreAllDifferent) {
  for (const Dialect& dialect : dialects()) EXPECT_EQ(find_dialect(dialect.key), &dialect) << dialect.key;
  EXPECT_EQ(find_dialect("Layout"), nullptr);
  EXPECT_EQ(find_dialect(""), nullptr);
}

TEST(LayoutGrammar, TakesEveryUnitAndPower) {
  for (const char* name :
       {"T.500,000000nm", "S0.500nm", "S1.5E2nm", "S2.5e-7m", "S3.0,5um", "S0.,5um", "S0.500,nm", "T.600THz",
        "T.6E14Hz", "T.6E2THz", "T.5dam", "T.400nm.500nm", "T.400,5nm.0,5um", "S0.5Em", "T.5hm"}) {
    EXPECT_TRUE(is_strict_layout_name(name)) << name;
  }
}

TEST(LayoutGrammar, RefusesWhatTheLayoutDoesNotHave) {
  for (const char* name : {"",
                           "T",
                           "T.",
                           "S0.",
                           "T.nm",
                           "T.,nm",
                           "T.500",
                           "T.500.5nm",
                           "T.500,0,0nm",
                           "S4.500nm",
                           "T.-500nm",
                           "T.500 nm",
                           "T.500nM",
                           "T.500nmx",
                           "T.500nm.",
                           "S0.400nm.500nm",
                           "T.400nm.500nm.600nm",
                           "t.500nm",
                           "a.T.500nm",
                           "T.500Qm",
                           "R",
                           "T.5e+nm"}) {
    EXPECT_FALSE(is_strict_layout_name(name)) << name;
  }
}

}  // namespace
}  // namespace spectile::io
