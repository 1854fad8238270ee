// The benchmark on the command line: what it prints for people and for machines, its page, its exit codes.
// That it is fast is nobody's test; that its figures belong together is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/isa.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using test::run_tool;
using testing::HasSubstr;
using testing::Not;

bool runs_here(const std::string& isa) {
  const auto isas = available_isas();
  return std::find(isas.begin(), isas.end(), isa) != isas.end();
}

/// Expects an exit code, one line on stderr that names what is wrong, and nothing on stdout.
void expect_refused(std::vector<std::string> arguments, int exit, const std::string& named) {
  arguments.insert(arguments.begin(), {"bench", "--quick", "-q"});
  const auto outcome = run_tool(arguments);
  const std::string what = testing::PrintToString(arguments);
  EXPECT_EQ(outcome.exit, exit) << what << "\n" << outcome;
  EXPECT_TRUE(outcome.one_line()) << what << "\n" << outcome;
  EXPECT_EQ(outcome.out, "") << what;
  EXPECT_THAT(outcome.err, HasSubstr(named)) << what;
}

TEST(Bench, HelpNamesEveryOptionAndTheExitCode) {
  const auto outcome = run_tool({"bench", "--help"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(outcome.err, "");
  for (const char* option :
       {"--quick", "--stress ", "--stress-only", "--json", "--report", "--threads", "--isa", "--illuminant",
        "--reflectances", "--only", "--seed", "-q,--quiet", "-h,--help"}) {
    EXPECT_THAT(outcome.out, HasSubstr(std::string("\n  ") + option));
  }
  EXPECT_THAT(outcome.out, HasSubstr("Exit code 1"));
  EXPECT_THAT(run_tool({"--help"}).out, HasSubstr("\n  bench "));
}

TEST(Bench, JsonHoldsLimitsAndTheOperationsAskedForAndThePageIsWhole) {
  if (!runs_here("avx2")) GTEST_SKIP() << "avx2 does not run here";
  const test::TempFolder folder;
  const std::string page = folder / "out.html";
  const auto outcome = run_tool({"bench", "--quick", "--only", "add", "--threads", "1", "--isa", "avx2",
                                 "--json", "-q", "--report", page});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(outcome.err, "");
  const json report = json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << outcome.out.substr(0, 200);

  const json& limits = report.at("limits");
  ASSERT_EQ(limits.size(), 2U);  // cache and memory
  for (const json& limit : limits) {
    EXPECT_EQ(limit.at("isa"), "avx2");
    EXPECT_EQ(limit.at("threads"), 1);
    for (const char* what : {"load", "store", "stream", "copy", "multiply_add", "fused_multiply_add"}) {
      EXPECT_GT(limit.at(what).get<double>(), 1e6) << limit;
    }
  }
  EXPECT_NE(limits[0].at("level"), limits[1].at("level"));

  const json& operations = report.at("operations");
  std::vector<std::string> names;
  for (const json& operation : operations) {
    const auto name = operation.at("name").get<std::string>();
    names.push_back(name);
    EXPECT_THAT(name, HasSubstr("add"));
    EXPECT_EQ(operation.at("isa"), "avx2") << operation;
    EXPECT_EQ(operation.at("threads"), 1) << operation;
    EXPECT_GE(operation.at("error").get<double>(), 0) << operation;
    EXPECT_LE(operation.at("error").get<double>(), operation.at("bound").get<double>()) << operation;
    EXPECT_GT(operation.at("fraction").get<double>(), 0.01) << operation;
    EXPECT_LT(operation.at("fraction").get<double>(), 10) << operation;
    EXPECT_GT(operation.at("items_per_second").get<double>(), 0) << operation;
    EXPECT_NE(operation.at("error_unit"), "") << operation;
  }
  EXPECT_EQ(std::count(names.begin(), names.end(), "add"), 2);
  EXPECT_EQ(std::count(names.begin(), names.end(), "multiply_add"), 2);
  // A choice of operations leaves out the rest.
  EXPECT_TRUE(report.at("ways").empty());
  EXPECT_TRUE(report.at("stress").empty());
  EXPECT_FALSE(report.at("machine").at("processor").get<std::string>().empty());
  EXPECT_GT(report.at("seconds").get<double>(), 0);

  const std::string html = test::file_bytes(page);
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>")) << html.substr(0, 100);
  EXPECT_THAT(html, HasSubstr("</html>"));
  EXPECT_THAT(html, HasSubstr("multiply_add"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
}

TEST(Bench, StressAloneHoldsEveryBound) {
  const auto outcome = run_tool({"bench", "--stress-only", "--quick", "-q"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("Numbers under stress"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("BEYOND")));
  for (const char* name : {"add", "multiply_add", "exp", "pow", "project"}) {
    EXPECT_THAT(outcome.out, HasSubstr(std::string("\n  ") + name));
  }
  EXPECT_THAT(outcome.out, Not(HasSubstr("GB/s")));  // run only the stress test
}

TEST(Bench, StressOfSomeOperationsIsOfThemAlone) {
  const auto outcome = run_tool({"bench", "--stress-only", "--quick", "-q", "--only", "film: add"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, HasSubstr("\n  film: add colours"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  film: add up"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("multiply_add")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("film: any sample")));
}

TEST(Bench, TheSameSeedStressesTheSameNumbers) {
  const auto numbers = [](const char* seed) {
    const auto outcome = run_tool({"bench", "--stress-only", "--quick", "--json", "--seed", seed});
    EXPECT_EQ(outcome.exit, 0) << outcome;
    EXPECT_EQ(outcome.err, "");  // no bar among JSON
    const json report = json::parse(outcome.out, nullptr, false);
    return report.is_object() ? report.at("stress") : json();
  };
  const json seven = numbers("7");
  ASSERT_GT(seven.size(), 20U);
  for (const json& one : seven) {
    EXPECT_EQ(one.at("beyond"), 0) << one;
    EXPECT_GT(one.at("cases").get<double>(), 0) << one;
    EXPECT_LE(one.at("worst").get<double>(), one.at("bound").get<double>()) << one;
  }
  EXPECT_EQ(numbers("7"), seven);
  EXPECT_NE(numbers("8"), seven);
}

TEST(Bench, WhatIsWrongIsSaidInOneLine) {
  expect_refused({"--isa", "avx1024"}, 2, "avx1024");
  expect_refused({"--isa", "avx1024,scalar"}, 2, "avx1024");
  expect_refused({"--illuminant", "D66"}, 2, "D66");
  expect_refused({"--threads", "0"}, 2, "not 0");
  expect_refused({"--threads", "-1"}, 2, "-1");
  expect_refused({"--threads", "1025"}, 2, "1025");
  expect_refused({"--threads", "many"}, 2, "many");
  expect_refused({"--threads"}, 2, "--threads");
  expect_refused({"--stress", "--stress-only"}, 2, "--stress-only");
  expect_refused({"--only", "no-such-operation"}, 2, "operation");
  expect_refused({"--stress-only", "--only", "no-such-operation"}, 2, "operation");
  expect_refused({"--seed", "seven"}, 2, "seven");
  expect_refused({"--differences"}, 2, "needs --json");
  expect_refused({"--no-such-option"}, 2, "--no-such-option");
  expect_refused({"more"}, 2, "more");
  const test::TempFolder folder;
  expect_refused({"--reflectances", folder / "missing.csv"}, 1, "missing.csv");
  test::write_text(folder / "words.csv", "these are words\n");
  expect_refused({"--reflectances", folder / "words.csv"}, 1, "words.csv");
}

TEST(Bench, InstructionSetsThatDoNotRunHereAreRefused) {
  for (const std::string isa : {"sse4.2", "avx2", "avx512", "neon"}) {
    if (!runs_here(isa)) expect_refused({"--isa", isa}, 2, isa);
  }
}

TEST(Bench, ReportsThatCannotBeWrittenAreSaid) {
  if (!fs::exists("/sys/kernel")) GTEST_SKIP() << "there is no /sys here, which nobody can write to";
  // Where nobody may make a file. The stress alone takes the least time.
  expect_refused({"--stress-only", "--report", "/sys/out.html"}, 3, "/sys/out.html");
}

TEST(Bench, NothingToPlotIsSaidBeforeAnyMeasurement) {
  const test::TempFolder folder;
  expect_refused({"--only", "add", "--plot", folder / "plot.svg"}, 2, "--plot draws methods");
  EXPECT_TRUE(folder.names().empty());
}

TEST(Bench, ReportsTouchNoOtherFile) {
  const test::TempFolder folder;
  const std::string page = folder / "out.html";
  test::write_text(page + ".part", "precious");
  const auto outcome = test::run_tool({"bench", "--quick", "--only", "luminance", "--threads", "1",
                                       "--cache-only", "--quiet", "--report", page});
  EXPECT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(test::file_bytes(page + ".part"), "precious");
  EXPECT_EQ(folder.names().size(), 2U);
}

TEST(Bench, InterruptEndsItWithoutOutput) {
  const test::TempFolder folder;
  const std::string page = folder / "out.html";
  test::Tool tool({"bench", "--quick", "--only", "add", "--threads", "1", "--json", "--report", page}, {});
  ASSERT_TRUE(tool.wait_until_converting());
  ASSERT_EQ(::kill(tool.pid(), SIGINT), 0);
  const auto outcome = tool.finish();
  EXPECT_EQ(outcome.exit, 130) << outcome;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.one_line()) << outcome;
  EXPECT_FALSE(fs::exists(page));
}

}  // namespace
}  // namespace spectile
