// Text that the tool prints: names and values from files and from the command line are one line of plain
// characters.
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

// Red, a bell, a line break, a carriage return, a C1 control character and a byte that is not UTF-8; and
// letters that stay.
const std::string kHostile = "x\x1b[31m\a\nspectile: done\r\xc2\x9b\xff\x7fü";
const std::string kEscaped = "x\\x1b[31m\\x07\\nspectile: done\\r\\xc2\\x9b\\xff\\x7fü";

class PrintedText : public testing::Test {
 protected:
  static void expect_plain(const test::Outcome& outcome) {
    for (const std::string& text : {outcome.out, outcome.err}) {
      for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        EXPECT_TRUE(c == '\n' || (c >= 0x20 && c != 0x7F && c != 0xFF))
            << static_cast<int>(c) << " in " << text;
      }
      EXPECT_EQ(text.find("\xc2\x9b"), std::string::npos);
      EXPECT_EQ(text.find("\nspectile: done"), std::string::npos) << text;
    }
  }
  void write(const std::string& path) {
    test::Picture picture = test::blank(6, 4);
    test::add_rgb_noise(picture, Imf::HALF);
    picture.add(kHostile, Imf::HALF, [](int, int) { return 0.5; });
    picture.add(kHostile + ".R", Imf::HALF, [](int, int) { return 0.5; });
    picture.header.insert(kHostile, Imf::StringAttribute("value " + kHostile));
    test::write_scanlines(path, picture);
  }
  test::TempFolder folder_;
};

TEST_F(PrintedText, OfAFilesNamesAndValuesIsEscaped) {
  write(folder_ / "in.exr");
  const auto info = run_tool({"info", folder_ / "in.exr", "--pixel", "1,1"});
  EXPECT_EQ(info.exit, 0) << info;
  expect_plain(info);
  EXPECT_THAT(info.out, HasSubstr("  " + kEscaped));
  EXPECT_THAT(info.out, HasSubstr("value " + kEscaped));
  const auto json = run_tool({"info", folder_ / "in.exr", "--json"});
  expect_plain(json);
  EXPECT_EQ(test::json_lines(json.out).size(), 1U) << json;
  const auto layer =
      run_tool({"upsample", folder_ / "in.exr", "-o", folder_ / "out.exr", "--layer", kHostile});
  EXPECT_NE(layer.exit, 0);
  EXPECT_TRUE(layer.one_line()) << layer;
  expect_plain(layer);
}

TEST_F(PrintedText, OfTheCommandLineIsEscaped) {
  const std::string in = folder_ / (kHostile + ".exr");
  const std::string out = folder_ / (kHostile + "-out.exr");
  write(in);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"upsample", in, "-o", out},
        {"upsample", in, "-o", out, "--json"},
        {"upsample", in, "-o", out, "-u"},
        {"project", out, "-o", in + "2.exr"},
        {"verify", in},
        {"info", in},
        {"info", folder_ / kHostile},
        {"upsample", in, "-o", in},
        {"upsample", in, "-o", out, "--method", kHostile},
        {"upsample", in, "-o", out, "--" + kHostile},
        {"upsample", in, "-o", out, "--white", kHostile},
        {"upsample", in, "-o", out, "--region", kHostile},
        {"upsample", in, "-o", out, "--shard", kHostile},
        {"upsample", in, "-o", out, "--input-space", kHostile},
        {"spectra", kHostile},
        {kHostile},
        {"film", kHostile},
        {"film", "simulate", "-o", out, "--size", "4", "4", "--samples", "1"},
        {"film", "develop", out, "-o", in + "3.exr"}}) {
    const auto outcome = run_tool(arguments);
    expect_plain(outcome);
    EXPECT_TRUE(outcome.exit == 0 || outcome.one_line()) << outcome;
  }
}

TEST_F(PrintedText, OfTheEnvironmentIsEscaped) {
  write(folder_ / "in.exr");
  const auto isa = run_tool({"verify", folder_ / "in.exr"}, {.environment = {{"SPECTILE_ISA", kHostile}}});
  EXPECT_EQ(isa.exit, 2) << isa;
  EXPECT_TRUE(isa.one_line()) << isa;
  expect_plain(isa);
  const auto slurm =
      run_tool({"upsample", folder_ / "in.exr", "-o", folder_ / "out/"},
               {.environment = {{"SLURM_ARRAY_TASK_ID", kHostile}, {"SLURM_ARRAY_TASK_COUNT", "2"}}});
  EXPECT_EQ(slurm.exit, 2) << slurm;
  EXPECT_TRUE(slurm.one_line()) << slurm;
  expect_plain(slurm);
}

}  // namespace
}  // namespace spectile
