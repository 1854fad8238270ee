// load_spectrum_csv: what a two-column text file may look like, and what its errors say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <spectile/spectra/measured_spectrum.hpp>
#include <string>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SpectrumCsv : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  Result<MeasuredSpectrum> load(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return load_spectrum_csv(path_);
  }
  void expect_samples(const std::string& text) {
    const auto s = load(text);
    ASSERT_TRUE(s) << s.error().message;
    EXPECT_THAT(s->wavelengths_nm(), ElementsAre(400, 500)) << text;
    EXPECT_THAT(s->values(), ElementsAre(0.5, 1.25)) << text;
  }
  void expect_bad_line(const std::string& text, const std::string& line) {
    const auto s = load(text);
    ASSERT_FALSE(s) << text;
    EXPECT_EQ(code_of(s), code(ErrorCode::kBadFile)) << text;
    EXPECT_THAT(s.error().message, HasSubstr("line " + line)) << text;
    EXPECT_THAT(s.error().message, HasSubstr(path_));
  }
  const std::string path_ = testing::TempDir() + "spectrum_" + std::to_string(::getpid()) + "_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
};

TEST_F(SpectrumCsv, ReadsTwoColumns) {
  expect_samples("400,0.5\n500,1.25\n");
}
TEST_F(SpectrumCsv, ReadsALastLineWithoutItsEnd) {
  expect_samples("400,0.5\n500,1.25");
}
TEST_F(SpectrumCsv, ReadsLinesThatEndWithCarriageReturns) {
  expect_samples("400,0.5\r\n500,1.25\r\n\r\n");
}
TEST_F(SpectrumCsv, SortsLines) {
  expect_samples("500,1.25\n400,0.5\n");
}
TEST_F(SpectrumCsv, ReadsExponents) {
  expect_samples("4e2,5E-1\n5.0e+2,125e-2\n");
}

TEST_F(SpectrumCsv, PassesOverBlankLinesCommentsAndAHeading) {
  expect_samples("# a comment\n\nwavelength_nm,value\n400,0.5\n   \n# 450,9\n500,1.25\n\n");
}

TEST_F(SpectrumCsv, ReadsEverySeparator) {
  for (const char* separator : {",", ";", "\t", " ", ", ", " ; ", "   "}) {
    expect_samples(std::string("nm") + separator + "v\n400" + separator + "0.5\n 500" + separator +
                   "1.25 \n");
  }
}

TEST_F(SpectrumCsv, NumbersAreIndependentOfTheLocale) {
  expect_samples("400;0,5\n500;1,25\n");  // a semicolon separates, so that a comma does not
}

TEST_F(SpectrumCsv, BadLineIsNamedByItsNumber) {
  expect_bad_line("400,0.5\n500\n", "2");
  expect_bad_line("nm,v\n# c\n400,0.5\n\n500,abc\n", "5");
  expect_bad_line("400,0.5\nabc,1\n", "2");
  expect_bad_line("400,0.5,7\n500,1,7\n", "1");
  expect_bad_line("400\n", "1");
  expect_bad_line("400,0.5x\n", "1");
  expect_bad_line("400,0.5\n500,1e999\n", "2");
}

TEST_F(SpectrumCsv, SampleThatIsNotFiniteIsNamedByItsLine) {
  expect_bad_line("# a comment\nnm,v\n400,0.5\n500,nan\n", "4");
  expect_bad_line("400,0.5\n500,inf\n", "2");
}

TEST_F(SpectrumCsv, OnlyOneHeadingIsPassedOver) {
  // A damaged first sample under a heading must not vanish.
  expect_bad_line("nm,v\n4o0,0.5\n500,1.25\n", "2");
}

TEST_F(SpectrumCsv, ByteOrderMarkDoesNotHideTheFirstSample) {
  expect_samples(
      "\xEF\xBB\xBF"
      "400,0.5\n500,1.25\n");
}

TEST_F(SpectrumCsv, FileWithoutSamplesIsAnError) {
  for (const char* text : {"", "\n\n", "# nothing\n", "nm,value\n"}) {
    const auto s = load(text);
    EXPECT_EQ(code_of(s), code(ErrorCode::kBadFile)) << text;
    EXPECT_THAT(s.error().message, HasSubstr(path_));
  }
}

TEST_F(SpectrumCsv, MissingFileIsAnErrorThatNamesIt) {
  const auto s = load_spectrum_csv(path_ + ".missing");
  EXPECT_EQ(code_of(s), code(ErrorCode::kBadFile));
  EXPECT_THAT(s.error().message, HasSubstr(path_ + ".missing"));
}

TEST_F(SpectrumCsv, DirectoryIsAnError) {
  EXPECT_EQ(code_of(load_spectrum_csv(testing::TempDir())), code(ErrorCode::kBadFile));
}

TEST_F(SpectrumCsv, FileThatMayNotBeReadIsNoPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may read everything";
  ASSERT_TRUE(load("400,1\n500,1\n"));
  ASSERT_EQ(::chmod(path_.c_str(), 0), 0);
  EXPECT_EQ(code_of(load_spectrum_csv(path_)), code(ErrorCode::kNoPermission));
}

}  // namespace
}  // namespace spectile::test
