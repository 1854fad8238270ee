// Files of many spectra: side by side, one below the other, rows of CGATS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class SpectrumTables : public testing::Test {
 protected:
  Result<std::vector<Spectrum>> load(const std::string& text) {
    test::write_text(path_, text);
    return load_spectra(path_);
  }
  void expect_refused(const std::string& text, const std::string& message) {
    const auto spectra = load(text);
    ASSERT_FALSE(spectra) << text;
    EXPECT_EQ(spectra.error().code, ErrorCode::kBadFile);
    EXPECT_EQ(spectra.error().message, path_ + ": " + message);
  }
  test::TempFolder folder_;
  const std::string path_ = folder_ / "table.csv";
};

TEST_F(SpectrumTables, ReadsSpectraSideBySide) {
  for (const char* text : {"# made up\nwavelength_nm,a,b,c\n400,1,2,3\n\n500,4,5,6\n",
                           "\t400 1\t2;3\r\n500,4 5 6", "500,4,5,6\r400,1,2,3\r"}) {
    const auto spectra = load(text);
    ASSERT_TRUE(spectra) << spectra.error().message;
    ASSERT_EQ(spectra->size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ((*spectra)[i](400), 1 + static_cast<double>(i));
      EXPECT_EQ((*spectra)[i](450), 2.5 + static_cast<double>(i));
    }
  }
}

TEST_F(SpectrumTables, ReadsSpectraUnderTheirNames) {
  const auto spectra = load(
      "name,wavelength_nm,value\ndark skin,400,1\ndark skin,500,2\n2.5 YR, 400, 3\ndark skin,450,7\n"
      "2.5 YR,500,5\n");
  ASSERT_TRUE(spectra) << spectra.error().message;
  ASSERT_EQ(spectra->size(), 2U);
  EXPECT_EQ((*spectra)[0](450), 7);
  EXPECT_EQ((*spectra)[1](450), 4);
}

TEST_F(SpectrumTables, ReadsOneSpectrumAsLoadSpectrumDoes) {
  test::write_text(path_, "400,1\n500,0.1\n500,3\n600.5,0.30000000000000004\n");
  const auto all = load_spectra(path_);
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 1U);
  EXPECT_EQ(all->front().to_text(), load_spectrum(path_)->to_text());
  EXPECT_EQ(all->front()(500), 3);
}

TEST_F(SpectrumTables, ReadsEveryRowOfCgats) {
  const auto spectra = load(
      "SPECT\nSPECTRAL_START_NM 400\nSPECTRAL_END_NM 700\nSPECTRAL_BANDS 4\nSPECTRAL_NORM 2\nBEGIN_DATA\n"
      "1 2 3 4\n8 6 4 2\nEND_DATA\n");
  ASSERT_TRUE(spectra) << spectra.error().message;
  ASSERT_EQ(spectra->size(), 2U);
  EXPECT_EQ((*spectra)[0](500), 1);
  EXPECT_EQ((*spectra)[1](500), 3);
}

TEST_F(SpectrumTables, RefusesLinesThatDoNotFit) {
  expect_refused("400,1,2\n500,1\n", "line 2: has fewer values than the first line of samples, which has 2");
  expect_refused("400,1,2\n500,1,2,3\n",
                 "line 2: has more values than the first line of samples, which has 2");
  expect_refused("400,1,2\n500,1,x\n", "line 2, column 7: \"x\" is not a number");
  expect_refused("400\n500\n", "line 1, column 1: \"400\" is not a wavelength in nm and a value");
  expect_refused("400,1,2\n500,1,inf\n", "line 2, column 7: \"500,1,inf\" is not finite");
  expect_refused("400,1,2\nnm,3,4\n", "line 2, column 1: \"nm,3,4\" is not a wavelength in nm and values");
  expect_refused("a,400,1\nb,500\n",
                 "line 2, column 1: \"b,500\" is not a name, a wavelength in nm and a value");
  expect_refused("a,400,1\n500,1,2\n",
                 "line 2, column 1: \"500,1,2\" is not a name, a wavelength in nm and a value");
  expect_refused("a,400,1\na,500,nan\n", "line 2, column 3: \"a,500,nan\" is not finite");
  expect_refused("a,400,1\n", "line 1: all samples are at 400 nm; a spectrum needs two wavelengths");
  expect_refused("400,1,2\n-1,1,2\n", "line 2: a wavelength of -1 nm is not above 0");
  expect_refused(
      "name,nm,value\n",
      "holds no sample, which is a line \"wavelength_nm,value,...\" or \"name,wavelength_nm,value\"");
  EXPECT_EQ(load_spectra(folder_ / "none").error().code, ErrorCode::kBadFile);
}

TEST_F(SpectrumTables, ReadsThePublishedTables) {
  const std::filesystem::path data = std::filesystem::path(SPECTILE_TEST_SHARED) / "data";
  if (!std::filesystem::is_directory(data)) GTEST_SKIP() << "no folder " << data;
  const auto patches = load_spectra((data / "reflectances_190_patches_5nm.csv").string());
  ASSERT_TRUE(patches) << patches.error().message;
  EXPECT_EQ(patches->size(), 190U);
  const auto chart = load_spectra((data / "colorchecker_babelcolor_10nm.csv").string());
  ASSERT_TRUE(chart) << chart.error().message;
  EXPECT_EQ(chart->size(), 24U);
  EXPECT_EQ((*chart)[0](380), 0.055);
}

}  // namespace
}  // namespace spectile
