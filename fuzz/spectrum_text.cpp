// Fuzzes text files of spectra: columns, pairs, rows, lists by name, CGATS, XML.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <spectile/spectra/named_spectra.hpp>

#include "fuzz/support.hpp"

namespace {

using namespace spectile;

/// A spectrum of a file, written as columns, is read as the same samples.
void require_spectrum(const Spectrum& spectrum) {
  const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&spectrum.kind());
  fuzz::require(linear != nullptr, "a spectrum of a file is piecewise linear");
  const auto nm = linear->wavelengths_nm();
  const auto values = linear->values();
  fuzz::require(nm.size() >= 2 && nm.size() == values.size(), "a spectrum has two samples or more");
  fuzz::require(std::is_sorted(nm.begin(), nm.end()) && nm.front() > 0 && nm.front() < nm.back(),
                "wavelengths are positive and ascend");
  const auto finite = [](double v) { return std::isfinite(v); };
  fuzz::require(std::ranges::all_of(nm, finite) && std::ranges::all_of(values, finite), "samples are finite");
  std::string text = "wavelength_nm value\n";
  for (std::size_t i = 0; i < nm.size(); ++i) text += fmt::format("{} {}\n", nm[i], values[i]);
  const fuzz::CaseFolder written({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const auto again = load_spectrum(written.input());
  fuzz::require(static_cast<bool>(again), "samples written as columns can be read", text);
  const auto& back = std::get<PiecewiseLinearSpectrum>(again->kind());
  fuzz::require(std::ranges::equal(back.wavelengths_nm(), nm) && std::ranges::equal(back.values(), values),
                "samples written as columns come back", text);
}

template <class T>
bool names_its_file(const Result<T>& result, const fuzz::CaseFolder& folder) {
  if (fuzz::is_value(result)) return true;
  fuzz::require(result.error().message.starts_with(folder.input()), "an error names its file",
                result.error().message);
  return false;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::CaseFolder folder({data, size});
  const auto one = load_spectrum(folder.input());
  const auto second = load_spectrum(folder.input(), 1);
  const auto all = load_spectra(folder.input());
  const auto measured = load_spectrum_csv(folder.input());
  SpectrumFileOptions reflectance;
  reflectance.use = SpectrumUse::kReflectance;
  names_its_file(load_spectrum_table(folder.input(), reflectance), folder);
  folder.require_tidy(false);
  names_its_file(measured, folder);
  const bool has_all = names_its_file(all, folder);
  const bool has_second = names_its_file(second, folder);
  if (has_all && all->size() > 1) {
    // A row of CGATS by its number is the row in the list.
    fuzz::require(!has_second || (*second)(550) == (*all)[1](550) ||
                      (std::isnan((*second)(550)) && std::isnan((*all)[1](550))),
                  "a row by its number is that of the list");
  }
  if (has_all) {
    fuzz::require(!all->empty(), "a file that can be read holds a spectrum");
    constexpr std::size_t kMost = 4;
    for (std::size_t i = 0; i < std::min(all->size(), kMost); ++i) require_spectrum((*all)[i]);
  }
  if (names_its_file(one, folder)) require_spectrum(*one);
  return 0;
}
