// Channel names of the spectral layout: strict when written, liberal when read.
#include <gtest/gtest.h>

#include <clocale>

#include "src/io/channels/spectral_layout.hpp"

namespace spectile::io {
namespace {

TEST(ChannelNames, AreWrittenWithSixDecimalsAndAComma) {
  EXPECT_EQ(spectral_channel_name(SpectralKind::kReflective, 402.5), "T.402,500000nm");
  EXPECT_EQ(spectral_channel_name(SpectralKind::kEmissive, 402.5), "S0.402,500000nm");
  EXPECT_EQ(spectral_channel_name(SpectralKind::kReflective, 1000), "T.1000,000000nm");
  EXPECT_EQ(spectral_channel_name(SpectralKind::kReflective, 0.5), "T.0,500000nm");
}

TEST(ChannelNames, WrittenOnesAreReadBackExactly) {
  for (const double nm : {380.0, 402.5, 409.375, 550.123456, 781.000001}) {
    for (const auto kind : {SpectralKind::kReflective, SpectralKind::kEmissive}) {
      const auto channel = parse_spectral_channel(spectral_channel_name(kind, nm), {});
      ASSERT_TRUE(channel) << nm;
      EXPECT_EQ(channel->kind, kind);
      EXPECT_EQ(channel->wavelength_nm, nm);
    }
  }
}

TEST(ChannelNames, AreReadLiberally) {
  constexpr auto kT = SpectralKind::kReflective;
  constexpr auto kS0 = SpectralKind::kEmissive;
  constexpr auto kOther = SpectralKind::kPolarised;
  // 545 THz by the exact speed of light, 299792458 m/s.
  constexpr double kNmOf545THz = 299792458.0 / 545e12 * 1e9;
  struct Form {
    const char* name;
    SpectralKind kind;
    double nm;
  };
  const Form forms[] = {
      {"T.550nm", kT, 550},
      {"T.550,0nm", kT, 550},
      {"T.550.25nm", kT, 550.25},
      {"T.,5um", kT, 500},
      {"T.550,nm", kT, 550},
      {"S0.380,000000nm", kS0, 380},
      {"S0.5,5e2nm", kS0, 550},
      {"S0.5.5E+2nm", kS0, 550},
      {"S0.0,55um", kS0, 550},
      {"S0.5,5e-7m", kS0, 550},
      {"T.0.00055mm", kT, 550},
      {"T.0,000055cm", kT, 550},
      {"T.5,5e-9hm", kT, 550},
      {"T.5,5e-8dam", kT, 550},
      {"T.5,5e-6dm", kT, 550},
      {"T.550000pm", kT, 550},
      {"T.5,5e-10km", kT, 550},
      {"S0.545THz", kS0, kNmOf545THz},
      {"S0.545000GHz", kS0, kNmOf545THz},
      {"S0.0,545PHz", kS0, kNmOf545THz},
      {"S0.5,45e14Hz", kS0, kNmOf545THz},
      {"T.545000000MHz", kT, kNmOf545THz},
      {"S1.550,0nm", kOther, 550},
      {"S2.550,0nm", kOther, 550},
      {"S3.550,0nm", kOther, 550},
  };
  for (const Form& form : forms) {
    const auto channel = parse_spectral_channel(form.name, {});
    ASSERT_TRUE(channel) << form.name;
    EXPECT_EQ(channel->kind, form.kind) << form.name;
    // Prefix, division and product each round once or twice.
    EXPECT_NEAR(channel->wavelength_nm, form.nm, 1e-14 * form.nm) << form.name;
  }
}

TEST(ChannelNames, OthersAreNotSpectral) {
  for (const char* name : {"",          "R",          "Y",          "A",          "Z",         "T",
                           "T.",        "S0.",        "T.nm",       "T.,nm",      "T.550",     "T.550 nm",
                           "T.550nmx",  "T.550Nm",    "T.550n",     "T.550s",     "T.-550nm",  "T.0nm",
                           "T.infnm",   "T.nannm",    "T.0x1p9nm",  "T.+550nm",   "T.1e999nm", "T.1e-999nm",
                           "T.1e308Ym", "T.5e-324pm", "T.1e-320Hz", "T.1e308YHz", "S4.550nm",  "S.550nm",
                           "S00.550nm", "t.550nm",    "s0.550nm",   "T550nm",     "T.550xnm",  "T.550,0,0nm",
                           "T.5 50nm",  "T.550nm ",   " T.550nm",   "T.550uHzz",  "T.550dahm"}) {
    EXPECT_FALSE(parse_spectral_channel(name, {})) << name;
  }
}

TEST(ChannelNames, DoNotDependOnTheLocale) {
  const char* const before = std::setlocale(LC_ALL, nullptr);
  const std::string kept = before != nullptr ? before : "C";
  // Where no such locale is installed the test still holds.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    EXPECT_EQ(spectral_channel_name(SpectralKind::kReflective, 1234.5), "T.1234,500000nm") << name;
    const auto channel = parse_spectral_channel("T.550.25nm", {});
    EXPECT_TRUE(channel && channel->wavelength_nm == 550.25) << name;
  }
  std::setlocale(LC_ALL, kept.c_str());
}

}  // namespace
}  // namespace spectile::io
