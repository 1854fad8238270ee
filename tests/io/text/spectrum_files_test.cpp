// load_spectrum: what files of columns and CGATS may look like, and what is said of those that cannot be
// read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <spectile/spectra/named_spectra.hpp>
#include <string>

namespace spectile {
namespace {

class SpectrumFiles : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  Result<Spectrum> load(const std::string& text, std::optional<std::size_t> column = {}) {
    std::ofstream(path_, std::ios::binary) << text;
    return load_spectrum(path_, column);
  }
  void expect_samples(const std::string& text, const std::vector<double>& wavelengths,
                      const std::vector<double>& values, std::optional<std::size_t> column = {}) {
    const auto s = load(text, column);
    ASSERT_TRUE(s) << text << "\n" << s.error().message;
    const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&s->kind());
    ASSERT_NE(linear, nullptr);
    EXPECT_THAT(linear->wavelengths_nm(), testing::ElementsAreArray(wavelengths)) << text;
    EXPECT_THAT(linear->values(), testing::ElementsAreArray(values)) << text;
  }
  void expect_two(const std::string& text) { expect_samples(text, {400, 500}, {0.5, 1.25}); }
  /// `message` is what follows "PATH: ".
  void expect_error(const std::string& text, const std::string& message,
                    std::optional<std::size_t> column = {}, ErrorCode code = ErrorCode::kBadFile) {
    const auto s = load(text, column);
    ASSERT_FALSE(s) << text;
    EXPECT_EQ(s.error().code, code) << text;
    EXPECT_EQ(s.error().message, path_ + ": " + message) << text;
  }
  const std::string path_ = testing::TempDir() + "spectrum_" + std::to_string(::getpid()) + "_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name();
};

/// A CGATS file of three bands, 400, 450, 500 nm. Line 8 begins the format, line 11 the data, line 12 is the
/// first row, and each of the words may be exchanged.
std::string cgats(const std::string& from = "", const std::string& to = "") {
  std::string text =
      "SPECT  \n"
      "DESCRIPTOR\t\"a lamp, \"\"new\"\"\"\n"
      "SPECTRAL_START_NM\t400.0\n"
      "SPECTRAL_END_NM\t500.0\n"
      "SPECTRAL_BANDS\t3\n"
      "NUMBER_OF_FIELDS\t4\n"
      "NUMBER_OF_SETS\t2\n"
      "BEGIN_DATA_FORMAT\n"
      "SAMPLE_ID\tSPEC_400\tSPEC_450\tSPEC_500\n"
      "END_DATA_FORMAT\n"
      "BEGIN_DATA\n"
      "one\t0.25\t5e-1\t1.0\n"
      "\"number two\"\t2\t3\t4\n"
      "END_DATA\n";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

const std::vector<double> kThree_nm = {400, 450, 500};

TEST_F(SpectrumFiles, ColumnsAreReadWhateverSeparatesThem) {
  for (const char* separator : {",", ";", "\t", " ", ", ", " ; "}) {
    const std::string s = separator;
    expect_two("nm" + s + "value\n400" + s + "0.5\n500" + s + "1.25\n");
  }
}

TEST_F(SpectrumFiles, AnyLineEndIsRead) {
  expect_two("400,0.5\r\n500,1.25\r\n");
  expect_two("400,0.5\r500,1.25");
  expect_two("400,0.5\n500,1.25");
}

TEST_F(SpectrumFiles, ByteOrderMarkIsPassedOver) {
  expect_two(
      "\xEF\xBB\xBF"
      "400,0.5\n500,1.25\n");
  expect_samples("\xEF\xBB\xBF" + cgats(), kThree_nm, {0.25, 0.5, 1});
}

TEST_F(SpectrumFiles, SeveralHeadingsArePassedOver) {
  expect_two("Lamp 7\nmeasured at noon\n\xCE\xBB [nm];W/m2\n# a comment\n400;0.5\n500;1.25\n");
}

TEST_F(SpectrumFiles, SamplesOutOfOrderAreSorted) {
  expect_two("500,1.25\n400,0.5\n");
}

TEST_F(SpectrumFiles, TwoSamplesOfOneWavelengthAreAStep) {
  expect_samples("400,1\n450,2\n450,3\n500,4\n", {400, 450, 450, 500}, {1, 2, 3, 4});
}

TEST_F(SpectrumFiles, SpectrumIsZeroOutsideItsSamples) {
  const auto s = load("400,1\n500,2\n");
  ASSERT_TRUE(s);
  EXPECT_EQ((*s)(399.999), 0);
  EXPECT_EQ((*s)(450), 1.5);
  EXPECT_EQ((*s)(500.001), 0);
}

TEST_F(SpectrumFiles, ThirdSampleOfAWavelengthIsNamedByItsLine) {
  expect_error("450,1\n400,1\n450,2\n500,1\n450,3\n",
               "line 5: a third sample at 450 nm; two there are a step");
}

TEST_F(SpectrumFiles, SpectrumWithoutWidthIsAnError) {
  expect_error("# one\n400,1\n", "line 2: all samples are at 400 nm; a spectrum needs two wavelengths");
  expect_error("400,1\n400,2\n", "line 2: all samples are at 400 nm; a spectrum needs two wavelengths");
}

TEST_F(SpectrumFiles, NoSampleIsAnError) {
  for (const char* text :
       {"", "\n\n", "\xEF\xBB\xBF", "# nothing\n", "nm,value\n", "Only words.\nAnd more.\n"}) {
    expect_error(
        text, "holds no sample, which is a line \"wavelength_nm,value,...\" or \"name,wavelength_nm,value\"");
  }
}

TEST_F(SpectrumFiles, NumberThatIsNotFiniteIsNamedByItsLine) {
  expect_error("400,1\n500,nan\n", "line 2, column 5: \"500,nan\" is not finite");
  expect_error("400,1\ninf,1\n", "line 2, column 1: \"inf,1\" is not finite");
  expect_error("400,1\n500,1e999\n", "line 2, column 5: \"500,1e999\" is not a wavelength in nm and a value");
}

TEST_F(SpectrumFiles, WavelengthNotAboveZeroIsNamedByItsLine) {
  expect_error("400,1\n0,1\n", "line 2: a wavelength of 0 nm is not above 0");
  expect_error("-5,1\n400,1\n", "line 1: a wavelength of -5 nm is not above 0");
}

TEST_F(SpectrumFiles, LineThatIsNoSampleIsNamedByItsNumber) {
  expect_error("400,1\n500\n", "line 2, column 1: \"500\" is not a wavelength in nm and a value");
  expect_error("400,1,2\n500,1,2\n",
               "line 1: the file holds 2 spectra: 0, 1; choose one as FILE:NAME or FILE:NUMBER, from 0");
  expect_error("nm,v\n4o0,1\n500,2\n", "line 2, column 1: \"4o0,1\" is not a wavelength in nm and a value");
  expect_error("400,1\nwords\n", "line 2, column 1: \"words\" is not a wavelength in nm and a value");
  expect_error("400,1\r\n\r\n500,x\r\n", "line 3, column 5: \"500,x\" is not a wavelength in nm and a value");
}

TEST_F(SpectrumFiles, LongLineIsNotQuotedWhole) {
  std::string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "\xC3\xA4";
  const auto s = load("400,1\n5" + umlauts + "\n");
  ASSERT_FALSE(s);
  EXPECT_LT(s.error().message.size(), path_.size() + 150);
  EXPECT_THAT(s.error().message, testing::HasSubstr("\xA4...\""));
}

TEST_F(SpectrumFiles, ManySamplesAreRead) {
  std::string text;
  for (int i = 0; i < 500000; ++i) text += std::to_string(300 + i * 1e-3) + " 1\n";
  const auto s = load(text);
  ASSERT_TRUE(s) << s.error().message;
  EXPECT_EQ((*s)(500), 1);
}

TEST_F(SpectrumFiles, BinaryIsAnErrorThatNamesTheByte) {
  expect_error(std::string("400,1\n\0\0\x7F", 9), "line 2: holds a byte of value 0; this is no text");
  expect_error("\x89PNG\r\n\x1A\n", "line 2: holds a byte of value 26; this is no text");
  // Half a character of UTF-16.
  expect_error(std::string("\xFF\xFE"
                           "4\0"
                           "0",
                           5),
               "line 1: holds a byte of value 0; this is no text");
}

TEST_F(SpectrumFiles, FileAbove64MiBIsAnError) {
  std::ofstream(path_) << "400,1\n";
  std::filesystem::resize_file(path_, std::uintmax_t{1} << 40U);
  const auto s = load_spectrum(path_);
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().message, path_ + ": is larger than 64 MiB, which no spectrum's text is");
}

TEST_F(SpectrumFiles, WhatIsNoPlainFileIsAnError) {
  const auto folder = load_spectrum(testing::TempDir());
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().message, testing::TempDir() + ": cannot read: not a plain file");
  const auto missing = load_spectrum(path_ + ".missing");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kBadFile);
  EXPECT_THAT(missing.error().message, testing::StartsWith(path_ + ".missing: cannot read: "));
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  const auto pipe = load_spectrum(path_);
  ASSERT_FALSE(pipe);
  EXPECT_EQ(pipe.error().message, path_ + ": cannot read: not a plain file");
}

TEST_F(SpectrumFiles, FileThatMayNotBeReadIsNoPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may read everything";
  ASSERT_TRUE(load("400,1\n500,1\n"));
  ASSERT_EQ(::chmod(path_.c_str(), 0), 0);
  const auto s = load_spectrum(path_);
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().code, ErrorCode::kNoPermission);
}

TEST_F(SpectrumFiles, ColumnsHaveOneSpectrum) {
  expect_error("400,1\n500,1\n", "has one spectrum, counted from 0; there is no 1", 1,
               ErrorCode::kBadArgument);
}

TEST_F(SpectrumFiles, CgatsRowsArePicked) {
  expect_samples(cgats(), kThree_nm, {0.25, 0.5, 1});
  expect_samples(cgats(), kThree_nm, {2, 3, 4}, 1);
  expect_error(cgats(), "has 2 data rows, counted from 0; there is no 2", 2, ErrorCode::kBadArgument);
}

TEST_F(SpectrumFiles, CgatsIsToldByItsText) {
  expect_samples(cgats("SPECT  \n", "CMF    \n"), kThree_nm, {0.25, 0.5, 1});
  expect_samples(cgats("SPECT  \n", "CGATS.17\n"), kThree_nm, {0.25, 0.5, 1});
  expect_samples(cgats("SPECT  \n", "# from nowhere\n"), kThree_nm, {0.25, 0.5, 1});
}

TEST_F(SpectrumFiles, CgatsAsArgyllWritesIt) {
  // Keywords that are declared, numbers in quotation marks, bands that are no whole nanometres apart.
  expect_samples(
      "SPECT   \n\nDESCRIPTOR \"Argyll Spectral power/reflectance information\"\nKEYWORD \"SPECTRAL_BANDS\"\n"
      "SPECTRAL_BANDS \"3\"\nKEYWORD \"SPECTRAL_NORM\"\nSPECTRAL_START_NM \"380.000000\"\n"
      "SPECTRAL_END_NM \"387.000000\"\nSPECTRAL_NORM \"100.000000\"\n\nNUMBER_OF_FIELDS "
      "3\nBEGIN_DATA_FORMAT\n"
      "SPEC_380 SPEC_384 SPEC_387 \nEND_DATA_FORMAT\n\nNUMBER_OF_SETS 1\nBEGIN_DATA\n50 100 "
      "\n200\nEND_DATA\n",
      {380, 383.5, 387}, {0.5, 1, 2});
}

TEST_F(SpectrumFiles, CgatsNeedsNoFormat) {
  expect_samples(
      "SPECTRAL_BANDS 2\nSPECTRAL_START_NM 400\nSPECTRAL_END_NM 500\nBEGIN_DATA\n0.5 1.25\nEND_DATA\n"
      "BEGIN_DATA\nanything\n",
      {400, 500}, {0.5, 1.25});
}

TEST_F(SpectrumFiles, CgatsThatEndsEarlyIsAnError) {
  expect_error(cgats("END_DATA\n", ""), "line 13: the file ends without END_DATA");
  expect_error(cgats("END_DATA_FORMAT\n", ""), "line 13: the file ends without END_DATA_FORMAT");
  expect_error("SPECT\nSPECTRAL_BANDS 3\n", "line 2: the file ends without BEGIN_DATA");
  expect_error("SPECT\n\nDESCRIPTOR \"open\n", "line 3: a quotation mark is not closed");
}

TEST_F(SpectrumFiles, CgatsKeywordThatIsMissingIsNamed) {
  expect_error(cgats("SPECTRAL_BANDS\t3\n", ""), "has no SPECTRAL_BANDS");
  expect_error(cgats("SPECTRAL_START_NM\t400.0\n", ""), "has no SPECTRAL_START_NM");
  expect_error(cgats("SPECTRAL_END_NM\t500.0\n", ""), "has no SPECTRAL_END_NM");
}

TEST_F(SpectrumFiles, CgatsBandsAreAWholeNumberFromTwoOn) {
  for (const char* bands : {"0", "1", "-3", "2.5", "1e18", "nan", "three", "100001"}) {
    expect_error(cgats("BANDS\t3", std::string("BANDS\t") + bands),
                 "line 5: SPECTRAL_BANDS \"" + std::string(bands) + "\" is not an integer, 2 to 100000");
  }
}

TEST_F(SpectrumFiles, CgatsCountsAgree) {
  expect_error(cgats("BANDS\t3", "BANDS\t4"),
               "line 8: the data have 3 fields SPEC_*, but SPECTRAL_BANDS is 4");
  expect_error(cgats("FIELDS\t4", "FIELDS\t5"), "line 6: NUMBER_OF_FIELDS is 5, but a row has 4");
  expect_error(cgats("SETS\t2", "SETS\t3"), "line 7: NUMBER_OF_SETS is 3, but there are 2 rows");
  expect_error(cgats("\t4\nEND", "\nEND"),
               "line 14: the data that begin on line 11 have 7 values, which is not one row or more of 4");
  expect_error(cgats("one\t0.25\t5e-1\t1.0\n\"number two\"\t2\t3\t4\n", ""),
               "line 12: the data that begin on line 11 have 0 values, which is not one row or more of 4");
  expect_error(cgats("SETS\t2\n", "SETS\t2\nSPECTRAL_BANDS 4\n"),
               "line 8: SPECTRAL_BANDS is \"4\" here and \"3\" on line 5");
}

TEST_F(SpectrumFiles, CgatsRangeGoesUp) {
  expect_error(cgats("END_NM\t500.0", "END_NM\t400"),
               "line 4: SPECTRAL_END_NM 400 is not above SPECTRAL_START_NM 400");
  expect_error(cgats("START_NM\t400.0", "START_NM\t0"),
               "line 3: SPECTRAL_START_NM \"0\" is not a number, 0.001 to 1000000000");
}

TEST_F(SpectrumFiles, CgatsNormIsAboveZero) {
  for (const char* norm : {"0", "-1", "nan", "inf", "x", ""}) {
    expect_error(cgats("SETS\t2\n", "SETS\t2\nSPECTRAL_NORM " + std::string(norm) + "\n"),
                 "line 8: SPECTRAL_NORM \"" + std::string(norm) + "\" is not a number, 1e-300 to 1e+300");
  }
}

TEST_F(SpectrumFiles, CgatsValueThatIsNoFiniteNumberIsNamedByItsLine) {
  expect_error(cgats("\t0.25", "\tx"), "line 12, column 5: \"x\" is not a number");
  expect_error(cgats("\t0.25", "\tnan"), "line 12, column 5: \"nan\" is not finite");
  // Of another row.
  expect_samples(cgats("\t3\t", "\tx\t"), kThree_nm, {0.25, 0.5, 1}, 0);
  expect_error(cgats("\t3\t", "\tx\t"), "line 13, column 16: \"x\" is not a number", 1);
}

TEST_F(SpectrumFiles, AnyTextIsReadOrAnErrorOfOneLine) {
  const std::string whole = cgats();
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    for (const std::string& text :
         {whole.substr(0, cut), whole.substr(cut), whole.substr(0, cut) + "\"" + whole.substr(cut)}) {
      const auto s = load(text);
      if (!s) {
        EXPECT_EQ(s.error().message.find('\n'), std::string::npos) << text;
        EXPECT_THAT(s.error().message, testing::StartsWith(path_ + ": ")) << text;
      }
    }
  }
}

TEST_F(SpectrumFiles, FindingTakesNamesBeforeFiles) {
  ASSERT_TRUE(find_spectrum("D65"));
  std::ofstream(path_) << "400,1\n500,2\n";
  const auto file = find_spectrum(path_);
  ASSERT_TRUE(file);
  EXPECT_EQ((*file)(450), 1.5);
  const auto missing = find_spectrum("no-such.csv");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kBadFile);
  const auto unknown = find_spectrum("D66");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::kUnknownName);
}

}  // namespace
}  // namespace spectile
