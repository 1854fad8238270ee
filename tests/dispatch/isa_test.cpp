// Choice of the instruction set: forcing, undoing, errors, the environment variable.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <spectile/isa.hpp>
#include <spectile/lanes/arithmetic.hpp>

#include "src/dispatch/dispatch.hpp"
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

class Isa : public testing::Test {
 protected:
  void TearDown() override { ASSERT_TRUE(force_isa("")); }
};

TEST_F(Isa, ReferenceComesFirstAndIsAlwaysThere) {
  const auto tables = dispatch::available();
  ASSERT_FALSE(tables.empty());
  EXPECT_EQ(tables.front(), &reference::kKernelTable);
  EXPECT_EQ(available_isas().front(), "scalar");
  EXPECT_EQ(available_isas().size(), tables.size());
}

TEST_F(Isa, WiderVectorsComeLater) {
  const auto tables = dispatch::available();
  for (std::size_t i = 1; i < tables.size(); ++i) EXPECT_GT(tables[i]->lanes, tables[i - 1]->lanes);
}

TEST_F(Isa, ForcedOneIsTheOneInForce) {
  for (const std::string& name : available_isas()) {
    ASSERT_TRUE(force_isa(name)) << name;
    EXPECT_EQ(*active_isa(), name);
    ASSERT_TRUE(dispatch::active());
    EXPECT_EQ((*dispatch::active())->name, name);
    EXPECT_EQ(*dispatch::active(), *dispatch::find(name));
  }
}

TEST_F(Isa, ForcedOneStaysAfterAFailedAttempt) {
  ASSERT_TRUE(force_isa("scalar"));
  EXPECT_FALSE(force_isa("sse9"));
  EXPECT_EQ(*active_isa(), "scalar");
}

TEST_F(Isa, EmptyNameUndoes) {
  const std::string before = *active_isa();
  ASSERT_TRUE(force_isa("scalar"));
  ASSERT_TRUE(force_isa(""));
  EXPECT_EQ(*active_isa(), before);
}

TEST_F(Isa, UnknownNamesAreSaidToBeUnknown) {
  for (const char* name : {"sse9", "AVX2", " avx2", "avx", "sse42"}) {
    const auto result = force_isa(name);
    EXPECT_EQ(code_of(result), code(ErrorCode::kUnknownName)) << name;
    EXPECT_THAT(result.error().message, testing::HasSubstr(name));
    EXPECT_THAT(result.error().message, testing::HasSubstr("scalar"));
  }
}

TEST_F(Isa, NamesOfOtherMachinesAreSaidToBeUnavailable) {
  std::size_t elsewhere = 0;
  const auto here = available_isas();
  for (const char* name : {"sse4.2", "avx2", "avx512", "neon"}) {
    if (std::find(here.begin(), here.end(), name) != here.end()) continue;
    ++elsewhere;
    EXPECT_EQ(code_of(force_isa(name)), code(ErrorCode::kUnavailable)) << name;
    EXPECT_EQ(code_of(dispatch::find(name)), code(ErrorCode::kUnavailable)) << name;
  }
  EXPECT_GT(elsewhere, 0U) << "no machine has both architectures";
}

TEST_F(Isa, ResultsDoNotDependOnIt) {
  const Bands bands;
  const auto a = batch_from(bands, 4099, arbitrary_floats(10007, 5));
  auto want = *SampledSpectra::create(bands, 4099);
  ASSERT_TRUE(force_isa("scalar"));
  ASSERT_TRUE(pow(a.view(), 2.4F, want.span()));
  for (const std::string& name : available_isas()) {
    ASSERT_TRUE(force_isa(name));
    auto got = *SampledSpectra::create(bands, 4099);
    ASSERT_TRUE(pow(a.view(), 2.4F, got.span()));
    EXPECT_TRUE(same_lanes(got, want)) << name;
  }
}

// The variable is read once a process, so each case runs in its own.
class IsaEnvironmentDeathTest : public testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
  static void exit_with(const char* name, bool (*right)(const Result<std::string>&)) {
    ::setenv("SPECTILE_ISA", name, 1);
    const auto active = active_isa();
    std::_Exit(right(active) ? 0 : 1);
  }
};

TEST_F(IsaEnvironmentDeathTest, VariableChooses) {
  EXPECT_EXIT(exit_with("scalar", [](const Result<std::string>& r) { return r && *r == "scalar"; }),
              testing::ExitedWithCode(0), "");
}

TEST_F(IsaEnvironmentDeathTest, UnknownVariableIsAnErrorOfEveryOperation) {
  EXPECT_EXIT(exit_with("sse9",
                        [](const Result<std::string>& r) {
                          auto batch = *SampledSpectra::create(Bands(), 1);
                          return code_of(r) == code(ErrorCode::kUnknownName) &&
                                 r.error().message.find("SPECTILE_ISA") != std::string::npos &&
                                 code_of(negate(batch.view(), batch.span())) == code(ErrorCode::kUnknownName);
                        }),
              testing::ExitedWithCode(0), "");
}

TEST_F(IsaEnvironmentDeathTest, ForcingGoesBeforeTheVariable) {
  EXPECT_EXIT(
      {
        const bool forced = static_cast<bool>(force_isa(available_isas().back()));
        exit_with(
            "sse9", forced ? [](const Result<std::string>& r) { return r && *r == available_isas().back(); }
                           : [](const Result<std::string>&) { return false; });
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace spectile::test
