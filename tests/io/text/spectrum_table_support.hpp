// A lamp as a table in nm, and files of it in other writings.
#pragma once

#include <fmt/format.h>

#include <array>
#include <functional>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/spectra/spectrum_table.hpp>
#include <string>
#include <vector>

#include "tests/support/exr_files.hpp"

namespace spectile::test {

/// Ten samples from 400 to 760 nm, values with two decimals.
inline constexpr std::array<double, 10> kLampNm = {400, 440, 480, 520, 560, 600, 640, 680, 720, 760};
inline constexpr std::array<double, 10> kLamp = {0.91, 12.68, 3.5, 0.25, 72.84, 1.1, 2.46, 33.94, 7.0, 0.5};

/// A line for each sample, made of its wavelength and value.
inline std::string lamp_text(const std::function<std::string(double nm, double value)>& line) {
  std::string out;
  for (std::size_t i = 0; i < kLamp.size(); ++i) out += line(kLampNm[i], kLamp[i]);
  return out;
}

inline std::string with_commas(std::string text) {
  std::ranges::replace(text, '.', ',');
  return text;
}

class SpectrumTableFile : public testing::Test {
 protected:
  Result<SpectrumTable> load(const std::string& text, const SpectrumFileOptions& options = {}) {
    write_text(path_, text);
    return load_spectrum_table(path_, options);
  }
  /// Samples of the first spectrum are those of the lamp, and of notes there is one that holds `note`, or
  /// none for an empty one.
  void expect_lamp(const std::string& text, const std::string& note = {},
                   const SpectrumFileOptions& options = {}) {
    const auto table = load(text, options);
    ASSERT_TRUE(table) << text << "\n" << table.error().message;
    ASSERT_EQ(table->spectra.size(), 1U) << text;
    const auto& linear = std::get<PiecewiseLinearSpectrum>(table->spectra.front().kind());
    ASSERT_EQ(linear.values().size(), kLamp.size()) << text;
    for (std::size_t i = 0; i < kLamp.size(); ++i) {
      EXPECT_EQ(linear.wavelengths_nm()[i], kLampNm[i]) << text;
      EXPECT_DOUBLE_EQ(linear.values()[i], kLamp[i]) << text;
    }
    std::string notes;
    for (const std::string& line : table->notes) {
      EXPECT_TRUE(line.starts_with(path_ + ": ")) << line;
      notes += line + "\n";
    }
    if (note.empty()) {
      EXPECT_EQ(notes, "") << text;
    } else {
      EXPECT_NE(notes.find(note), std::string::npos) << text << "\n" << notes;
    }
  }
  void expect_refused(const std::string& text, const std::string& part,
                      const SpectrumFileOptions& options = {}) {
    const auto table = load(text, options);
    ASSERT_FALSE(table) << text;
    EXPECT_NE(table.error().message.find(part), std::string::npos) << table.error().message;
    EXPECT_TRUE(table.error().message.starts_with(path_ + ": ")) << table.error().message;
  }
  TempFolder folder_;
  const std::string path_ = folder_ / "lamp.txt";
};

}  // namespace spectile::test
