// Help texts: one short line an option, options in groups, an example at the end of each command's help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::vector<std::string>> kCommands = {{},
                                                         {"demo"},
                                                         {"upsample"},
                                                         {"expand"},
                                                         {"relight"},
                                                         {"project"},
                                                         {"convert"},
                                                         {"validate"},
                                                         {"info"},
                                                         {"verify"},
                                                         {"spectra"},
                                                         {"plan"},
                                                         {"fit"},
                                                         {"bench"},
                                                         {"film"},
                                                         {"film", "merge"},
                                                         {"film", "develop"},
                                                         {"film", "average"},
                                                         {"film", "simulate"}};

std::string help_of(std::vector<std::string> command) {
  command.emplace_back("--help");
  const auto outcome = run_tool(command);
  EXPECT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(outcome.err, "");
  return outcome.out;
}

TEST(Help, LinesAreShort) {
  for (const auto& command : kCommands) {
    std::istringstream lines(help_of(command));
    for (std::string line; std::getline(lines, line);) {
      if (line.find("Usage: ") == std::string::npos) {
        EXPECT_LE(line.size(), 118U) << testing::PrintToString(command) << "\n" << line;
      }
    }
  }
}

TEST(Help, EndsWithAnExample) {
  for (const auto& command : kCommands) {
    std::string call = "\nExample:\n  spectile ";
    for (const std::string& word : command) call += word + " ";
    EXPECT_THAT(help_of(command), HasSubstr(call));
  }
}

TEST(Help, OptionsAreInGroups) {
  for (const auto& command : kCommands) {
    if (command.empty() || command.back() == "film") continue;
    const std::string help = help_of(command);
    EXPECT_THAT(help, Not(HasSubstr("\nOptions:"))) << testing::PrintToString(command);
    EXPECT_THAT(help, HasSubstr("\nRun:"));
  }
}

TEST(Help, NamesEveryExitCode) {
  for (const char* code : {"0 done", "1 an input", "2 wrong usage", "3 no space", "130 or 143 interrupted"}) {
    EXPECT_THAT(help_of({}), HasSubstr(code));
  }
}

TEST(Help, ErrorAndStopAreTheSamePolicy) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(4, 4);
  picture.add("R", Imf::FLOAT, [](int, int) { return -0.5; });
  picture.add("G", Imf::FLOAT, [](int, int) { return 0.2; });
  picture.add("B", Imf::FLOAT, [](int, int) { return 0.9; });
  test::write_scanlines(folder / "in.exr", picture);
  for (const char* option : {"--negative", "--out-of-gamut"}) {
    EXPECT_THAT(help_of({"upsample"}), HasSubstr("or error"));
    std::string said;
    for (const char* policy : {"error", "stop"}) {
      const auto outcome =
          run_tool({"upsample", folder / "in.exr", "-o", folder / "out.exr", option, policy});
      EXPECT_EQ(outcome.exit, 1) << outcome;
      if (said.empty()) said = outcome.err;
      EXPECT_EQ(outcome.err, said);
    }
  }
  for (const char* policy : {"error", "stop"}) {
    const auto outcome =
        run_tool({"upsample", folder / "in.exr", "-o", folder / "out.exr", "--nonfinite", policy});
    EXPECT_EQ(outcome.exit, 0) << outcome;
  }
}

}  // namespace
}  // namespace spectile
