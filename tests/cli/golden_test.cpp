// Pixels of a fixed set of commands: methods, stores, compressions, tiles, planned bands and film files
// decode to the values that these commands have always given. A hash that changes on purpose is taken from
// the failure's message.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

/// Four bands under D65 and FL11, as `spectile plan --bands 4 --sample apart --folds 0` chose them.
constexpr const char* kPlan =
    R"({"wavelengths_nm":[445.403,501.173,549.981,616.915],"bands_nm":[[429.713,461.093],[484.262,518.084],
[518.087,581.875],[597.004,636.826]],"sensor":{"x":[0.141923980644052,-0.026197230990321483,
0.383146161096221,0.4808597281723387],"y":[0.022784364802152957,0.07968347156133339,
0.6741117594156398,0.22342040422087342],"z":[0.7103638037860087,0.1829004555435041,
-0.027420226042957234,-0.00010980944377985511]},"illuminants":[{"name":"D65",
"emission":[1.225754493908406,1.3404973375713483,0.9839995854838454,0.903815342407573]},
{"name":"FL11","emission":[0.7742455060915941,0.659502662428652,1.0160004145161547,
1.0961846575924272]}],"observer":"1931"})";

/// FNV-1a over bytes.
void add_bytes(std::uint64_t& hash, const void* data, std::size_t size) {
  const auto* const bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001B3U;
}

/// Of an image's channels: their names, types and samples.
std::uint64_t hash_pixels(const std::string& path) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const auto& [name, plane] : test::read_picture(path).planes) {
    add_bytes(hash, name.data(), name.size());
    const auto type = static_cast<std::uint32_t>(plane.type);
    add_bytes(hash, &type, sizeof type);
    add_bytes(hash, plane.bytes.data(), plane.bytes.size());
  }
  return hash;
}

struct Golden {
  const char* command;  ///< without "-o OUTPUT"
  const char* output;   ///< a later command may read it
  std::uint64_t pixels;
};

constexpr Golden kGolden[] = {
    {"upsample in.exr --method smits-exact", "exact.exr", 0x3C9CCF4108B70F17U},
    {"upsample in.exr --method smits --bands 400:700:10", "smits.exr", 0x844C98256A888C1EU},
    {"upsample in.exr --method smits1999 --bands 400:700:10 --pixel float", "smits1999.exr",
     0xE71A31B335E740C6U},
    {"upsample in.exr --method mallett --bands 400:700:10", "mallett.exr", 0x83531A0AEEDA11FFU},
    {"upsample in.exr --method sigmoid --bands 400:700:10", "sigmoid.exr", 0xF9791D85D61EFBD5U},
    {"upsample in.exr --quantity illuminant --pixel float --bands 400:700:20 --method smits-exact",
     "illuminant.exr", 0xF63F6287173223FAU},
    {"upsample in.exr --quantity unbounded --method sigmoid --bands 380:780:20", "unbounded.exr",
     0x342B029CF5D944CFU},
    {"upsample in.exr --store coefficients --method smits-exact", "c_exact.exr", 0xE7241137C7E3ABDBU},
    {"upsample in.exr --store coefficients --method sigmoid", "c_sigmoid.exr", 0x5CA71FD85EAFE0A1U},
    {"expand c_exact.exr", "e_exact.exr", 0x3C9CCF4108B70F17U},
    {"expand c_sigmoid.exr --bands 380:780:10", "e_sigmoid.exr", 0x231634703B082630U},
    {"upsample in.exr --compression none --bands 400:700:20 --method smits-exact", "none.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --compression rle --bands 400:700:20 --method smits-exact", "rle.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --compression zips:4 --bands 400:700:20 --method smits-exact", "zips.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --compression zip:1 --bands 400:700:20 --method smits-exact", "zip1.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --compression zip:9 --bands 400:700:20 --method smits-exact", "zip9.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --compression piz --bands 400:700:20 --method smits-exact", "piz.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --compression pxr24 --bands 400:700:20 --method smits-exact", "pxr24.exr",
     0x6A28C57DDB836351U},
    {"upsample in.exr --compression b44 --bands 400:700:20 --method smits-exact", "b44.exr",
     0x9A72DAAFDF1D80A0U},
    {"upsample in.exr --tile 64 32 --bands 400:700:20 --method smits-exact", "tiles.exr",
     0x3F3C93145297CC30U},
    {"upsample in.exr --mipmap --bands 400:700:20 --method smits-exact", "mipmap.exr", 0x3F3C93145297CC30U},
    {"upsample in.exr --region 10,5,99,60 --bands 400:700:20 --method smits-exact", "region.exr",
     0xC02CE91776DAC65AU},
    {"upsample in.exr --input-space acescg --method sigmoid --bands 400:700:20", "acescg.exr",
     0xC5196F60143E914CU},
    {"upsample in.exr --white A --white-observer 1964 --method sigmoid --bands 400:700:20", "white.exr",
     0x36E0210769768E9FU},
    {"project exact.exr --illuminant A", "project.exr", 0x188F3446930A6BDAU},
    {"project exact.exr --illuminant FL11 --observer 1964 --to xyz --adapt cat16", "project_xyz.exr",
     0x278F260150B75187U},
    {"project exact.exr --to luminance", "luminance.exr", 0x5D0D1CF17302EC91U},
    {"relight in.exr --illuminant FL11 --adapt bradford --method smits-exact", "relight.exr",
     0x17FE3530B473F083U},
    {"relight in.exr --illuminant A --method sigmoid --to xyz", "relight_sigmoid.exr", 0xA6DB283B4AC8EEA9U},
    {"upsample in.exr --bands plan.json --method smits-exact", "planned.exr", 0x9EB72B810FB620A6U},
    {"upsample in.exr --bands plan.json --method sigmoid --store coefficients", "c_planned.exr",
     0xAF86C98018039991U},
    {"expand c_planned.exr", "e_planned.exr", 0xDD0A2FCD6CCE3390U},
    {"project planned.exr --illuminant FL11", "p_planned.exr", 0x0AC5E05ED7EBC75DU},
    {"film simulate --scene mixed --samples 4 --size 40 30 --spectral --statistics variance --shard 0/2",
     "film_a.exr", 0x5EB59F7015FF05CCU},
    {"film simulate --scene mixed --samples 4 --size 40 30 --spectral --statistics variance --shard 1/2",
     "film_b.exr", 0xBD675B656DA46747U},
    {"film merge film_a.exr film_b.exr", "film.exr", 0x03493F9F238BBC0BU},
    {"film develop film.exr --to srgb", "film_srgb.exr", 0x3D3BDC687F127A4BU},
    {"film develop film.exr --to spectral", "film_spectral.exr", 0xF047D52E54FC40FFU},
    {"film develop film.exr --to variance", "film_variance.exr", 0x4826053F5AA263E1U},
    {"film average project.exr relight.exr --weights 3,1", "average.exr", 0x5D0FB4176CF4CF47U},
    {"upsample in.exr", "default.exr", 0xB7E14AF4A307BBF7U},
    {"upsample in.exr --quantity unbounded --bands 380:780:20", "default_unbounded.exr", 0x239C28096E8DEC41U},
    {"upsample in.exr --store coefficients", "c_default.exr", 0xE7241137C7E3ABDBU},
    {"expand c_default.exr", "e_default.exr", 0xB7E14AF4A307BBF7U},
    {"upsample in.exr --bands plan.json", "default_planned.exr", 0x1E2FA71E8FAD5F49U},
    {"relight in.exr --illuminant A", "relight_default.exr", 0xE7098CCB43CC4279U},
};

TEST(GoldenPixels, CommandsGiveTheValuesThatTheyAlwaysGave) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(150, 70);
  test::add_rgb_noise(picture, Imf::FLOAT, 1.1);
  test::write_scanlines(folder / "in.exr", picture);
  std::ofstream(folder / "plan.json") << kPlan;
  for (const Golden& golden : kGolden) {
    std::vector<std::string> arguments;
    std::istringstream words(golden.command);
    for (std::string word; words >> word;) {
      arguments.push_back(word.ends_with(".exr") || word.ends_with(".json") ? folder / word : word);
    }
    arguments.insert(arguments.end(), {"-o", folder / golden.output});
    const auto outcome = test::run_tool(arguments);
    ASSERT_EQ(outcome.exit, 0) << golden.command << "\n" << outcome;
    EXPECT_EQ(hash_pixels(folder / golden.output), golden.pixels) << golden.command;
  }
}

}  // namespace
}  // namespace spectile
