// load_spectrum, load_spectra, load_spectrum_csv, find_spectrum: spectra from text files.
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>
#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {
namespace {

/// Checks of a spectrum beyond those of a list of samples. Lines are named where they are given.
Result<void> check_samples(const io::TextFile& file, const io::SampleLines& samples) {
  const auto& w = samples.wavelengths_nm;
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (w[i] > 0) continue;
    return io::line_error(file, samples.lines[i], fmt::format("a wavelength of {} nm is not above 0", w[i]));
  }
  std::vector<std::size_t> order(w.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return w[i]; });
  for (std::size_t i = 2; i < order.size(); ++i) {
    if (w[order[i]] != w[order[i - 2]]) continue;
    return io::line_error(file, samples.lines[order[i]],
                          fmt::format("a third sample at {} nm; two there are a step", w[order[i]]));
  }
  if (w[order.front()] == w[order.back()]) {
    return io::line_error(
        file, samples.lines.back(),
        fmt::format("all samples are at {} nm; a spectrum needs two wavelengths", w[order.front()]));
  }
  return {};
}

Result<Spectrum> spectrum_of(const io::TextFile& file, const io::SampleLines& samples) {
  SPECTILE_TRY(check_samples(file, samples));
  SPECTILE_ASSIGN(auto spectrum,
                  PiecewiseLinearSpectrum::from_samples(samples.wavelengths_nm, samples.values));
  return Spectrum(std::move(spectrum));
}

}  // namespace

Result<MeasuredSpectrum> load_spectrum_csv(const std::string& path) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  SPECTILE_ASSIGN(const auto samples, io::read_columns(file));
  return MeasuredSpectrum::from_samples(samples.wavelengths_nm, samples.values);
}

Result<Spectrum> load_spectrum(const std::string& path, std::size_t column) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  const bool cgats = io::is_cgats(file);
  if (!cgats && column > 0) {
    return make_error(ErrorCode::kBadArgument, "{}: has one spectrum, counted from 0; there is no {}", path,
                      column);
  }
  SPECTILE_ASSIGN(const auto samples, cgats ? io::read_cgats(file, column) : io::read_columns(file));
  return spectrum_of(file, samples);
}

Result<std::vector<Spectrum>> load_spectra(const std::string& path) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  SPECTILE_ASSIGN(const auto all, io::is_cgats(file) ? io::read_all_cgats(file) : io::read_all_columns(file));
  std::vector<Spectrum> out;
  out.reserve(all.size());
  for (const io::SampleLines& samples : all) {
    SPECTILE_ASSIGN(auto spectrum, spectrum_of(file, samples));
    out.push_back(std::move(spectrum));
  }
  return out;
}

Result<Spectrum> find_spectrum(const std::string& name_or_path) {
  auto known = named_spectrum(name_or_path);
  if (known || known.error().code != ErrorCode::kUnknownName) return known;
  struct stat status {};
  const bool like_a_path = name_or_path.find_first_of("./") != std::string::npos;
  if (!like_a_path && ::stat(name_or_path.c_str(), &status) != 0) return known;
  return load_spectrum(name_or_path);
}

Result<NamedLight> find_light(const std::string& name_or_path) {
  SPECTILE_ASSIGN(const auto found, find_spectrum(name_or_path));
  const bool is_name = static_cast<bool>(named_spectrum(name_or_path));
  std::string name = is_name ? name_or_path : std::filesystem::path(name_or_path).filename().string();
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (std::ranges::equal(info.name, name_or_path, same)) name = info.name;
  }
  return named_light(std::move(name), found);
}

}  // namespace spectile
