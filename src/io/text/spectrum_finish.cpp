// Tables of spectra in nm: units, percent, missing samples, and what is refused.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

/// Reflectances beyond these are something else: noise lies little below 0, fluorescent paper below 1.5.
constexpr double kMinReflectance = -0.05;
constexpr double kMaxReflectance = 1.5;
/// Values this large mark deleted samples: the USGS spectral library writes -1.23e34.
constexpr double kMinMark = 1e30;
/// Marks are written with few digits.
constexpr double kMarkTolerance = 1e-6;

constexpr const char* kStateUnit = "--wavelengths nm, um, m, angstrom or cm-1 states it";

/// One spectrum while it is finished.
struct Samples {
  std::vector<double> nm;
  std::vector<double> values;
  std::vector<std::uint32_t> lines;
};

/// Range of all wavelengths as they are in the file.
std::pair<double, double> range_of(const RawTable& raw) {
  double first = raw.axes.front().wavelengths.front();
  double last = first;
  for (const RawAxis& axis : raw.axes) {
    for (const double w : axis.wavelengths) {
      first = std::min(first, w);
      last = std::max(last, w);
    }
  }
  return {first, last};
}

Result<void> check_positive(const TextFile& file, const RawTable& raw, WavelengthUnit unit) {
  for (const RawAxis& axis : raw.axes) {
    for (std::size_t i = 0; i < axis.wavelengths.size(); ++i) {
      if (axis.wavelengths[i] > 0) continue;
      return line_error(
          file, axis.lines[i],
          fmt::format("a wavelength of {} {} is not above 0", axis.wavelengths[i], to_string(unit)));
    }
  }
  return {};
}

Result<WavelengthUnit> unit_of(const TextFile& file, RawTable& raw, const SpectrumFileOptions& options) {
  std::optional<WavelengthUnit> unit = options.wavelengths ? options.wavelengths : raw.unit;
  const auto [first, last] = range_of(raw);
  SPECTILE_TRY(check_positive(file, raw, unit.value_or(WavelengthUnit::kNm)));
  if (unit && *unit != WavelengthUnit::kNm && !options.wavelengths) {
    raw.notes.push_back(fmt::format("wavelengths in {}, {}", to_string(*unit), raw.unit_source));
  }
  if (!unit && !raw.sure_of_unit) {
    const UnitGuess guess = guess_unit(raw.axes.front().wavelengths);
    if (!guess.unit && guess.another) {
      return make_error(
          ErrorCode::kBadFile,
          "{}: wavelengths from {:.6g} to {:.6g} have no unit, and could be in more than one ({}, ...); {}",
          file.path, first, last, to_string(*guess.another), kStateUnit);
    }
    unit = guess.unit;
    if (unit && *unit != WavelengthUnit::kNm) {
      raw.notes.push_back(fmt::format("wavelengths taken as {}, by their numbers, {:.6g} to {:.6g}; {}",
                                      to_string(*unit), first, last, kStateUnit));
    }
  }
  if (!unit) unit = WavelengthUnit::kNm;
  if (*unit == WavelengthUnit::kPerCm) {
    raw.notes.emplace_back("values are taken as they are, not as per cm^-1");
  }
  if (std::ranges::none_of(raw.axes,
                           [&](const RawAxis& a) { return covers_visible(a.wavelengths, *unit); })) {
    const double a = in_nm(first, *unit);
    const double b = in_nm(last, *unit);
    const std::string in_file = *unit == WavelengthUnit::kNm
                                    ? fmt::format("{:.6g} to {:.6g} nm", first, last)
                                    : fmt::format("{:.6g} to {:.6g} {} ({:.6g} to {:.6g} nm)", first, last,
                                                  to_string(*unit), std::min(a, b), std::max(a, b));
    return make_error(
        ErrorCode::kBadFile,
        "{}: no sample lies within {} to {} nm; wavelengths are {}. If another unit is meant, {}", file.path,
        kFirstVisibleNm, kLastVisibleNm, in_file, kStateUnit);
  }
  return *unit;
}

/// Values that stand for a fraction, as the options or the headings say; samples that are marked as missing
/// become NaN. Returns how many were.
std::size_t scale_values(RawTable& raw, const SpectrumFileOptions& options) {
  std::size_t marked = 0;
  bool percent = false;
  for (RawSpectrum& s : raw.spectra) {
    percent = percent || s.percent;
    const double one = options.one ? *options.one : s.percent ? 100.0 : 1.0;
    for (double& v : s.values) {
      if (options.missing && std::abs(v - *options.missing) <= kMarkTolerance * std::abs(*options.missing)) {
        v = std::nan("");
        ++marked;
      } else {
        v /= one;
      }
    }
  }
  if (percent && !options.one) raw.notes.emplace_back("values in percent, as the file says, divided by 100");
  if (options.one && *options.one != 1)
    raw.notes.push_back(fmt::format("values divided by {}", *options.one));
  return marked;
}

Result<void> check_reflectances(const TextFile& file, const RawTable& raw,
                                const SpectrumFileOptions& options) {
  if (options.use != SpectrumUse::kReflectance) return {};
  std::size_t all = 0;
  std::size_t outside = 0;
  std::size_t marks = 0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  bool percent = false;
  for (const RawSpectrum& s : raw.spectra) {
    percent = percent || s.percent;
    for (const double v : s.values) {
      if (std::isnan(v)) continue;
      ++all;
      outside += v < kMinReflectance || v > kMaxReflectance ? 1 : 0;
      marks += std::abs(v) >= kMinMark ? 1 : 0;
      smallest = std::min(smallest, v);
      largest = std::max(largest, v);
    }
  }
  constexpr const char* kState =
      "--values fraction, percent, or the number that stands for 1, says what they are";
  if (percent && !options.one && largest <= 0.01) {
    return make_error(
        ErrorCode::kBadFile,
        "{}: a heading says percent, but no value is above {:.4g}; --values fraction or percent says which",
        file.path, largest * 100);
  }
  if (marks > 0) {
    const double mark = std::abs(smallest) >= kMinMark ? smallest : largest;
    return make_error(
        ErrorCode::kBadFile,
        "{}: {} of {} values are marks of missing samples, like {:.6g}; --missing {:.6g} leaves them out",
        file.path, marks, all, mark, mark);
  }
  // Fractions that are stated to be ones are those of fluorescent samples.
  if (outside > 0 && options.one != 1.0) {
    return make_error(ErrorCode::kBadFile,
                      "{}: {} of {} values lie far outside 0 to 1, from {:.6g} to {:.6g}; {}", file.path,
                      outside, all, smallest, largest, kState);
  }
  return {};
}

/// Checks of a spectrum beyond those of a list of samples.
Result<void> check_samples(const TextFile& file, const Samples& samples) {
  const auto& w = samples.nm;
  std::vector<std::size_t> order(w.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return w[i]; });
  for (std::size_t i = 2; i < order.size(); ++i) {
    if (w[order[i]] != w[order[i - 2]]) continue;
    return line_error(file, samples.lines[order[i]],
                      fmt::format("a third sample at {} nm; two there are a step", w[order[i]]));
  }
  if (w[order.front()] == w[order.back()]) {
    return line_error(
        file, samples.lines.back(),
        fmt::format("all samples are at {} nm; a spectrum needs two wavelengths", w[order.front()]));
  }
  return {};
}

Result<Samples> samples_of(const TextFile& file, const RawAxis& axis, const std::vector<double>& nm,
                           const RawSpectrum& s) {
  Samples out;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    if (std::isnan(s.values[i])) continue;
    out.nm.push_back(nm[i]);
    out.values.push_back(s.values[i]);
    out.lines.push_back(s.line != 0 ? s.line : axis.lines[i]);
  }
  if (out.nm.empty()) {
    return make_error(ErrorCode::kBadFile, "{}: all samples of {} are missing", file.path,
                      io::quoted(s.name));
  }
  if (!covers_visible(out.nm, WavelengthUnit::kNm)) {
    const auto [first, last] = std::ranges::minmax(out.nm);
    return make_error(ErrorCode::kBadFile,
                      "{}: no sample of {} lies within {} to {} nm; its wavelengths are {:.6g} to {:.6g} nm",
                      file.path, io::quoted(s.name), kFirstVisibleNm, kLastVisibleNm, first, last);
  }
  SPECTILE_TRY(check_samples(file, out));
  return out;
}

}  // namespace

Result<SpectrumTable> finish_table(const TextFile& file, RawTable raw, const SpectrumFileOptions& options) {
  SPECTILE_ASSIGN(const auto unit, unit_of(file, raw, options));
  const std::size_t missing = scale_values(raw, options) + raw.empty_cells;
  SPECTILE_TRY(check_reflectances(file, raw, options));
  if (missing > 0) {
    raw.notes.push_back(fmt::format("{} missing {}, left out; straight lines bridge gaps", missing,
                                    missing == 1 ? "sample" : "samples"));
  }
  const Ends usual = options.use == SpectrumUse::kReflectance ? Ends::kHeld : Ends::kZero;
  const Ends ends = options.ends.value_or(usual);
  if (ends != usual)
    raw.notes.emplace_back(ends == Ends::kHeld ? "held beyond its ends" : "0 beyond its ends");
  if (options.use == SpectrumUse::kLight && !raw.quantity.empty()) {
    raw.notes.push_back(fmt::format("a heading says {}; taken as a light", raw.quantity));
  }
  SpectrumTable out;
  std::vector<double> nm;
  std::size_t axis = raw.axes.size();
  for (RawSpectrum& s : raw.spectra) {
    if (s.axis != axis) {
      axis = s.axis;
      nm = raw.axes[axis].wavelengths;
      for (double& w : nm) w = in_nm(w, unit);
    }
    SPECTILE_ASSIGN(const auto samples, samples_of(file, raw.axes[axis], nm, s));
    s.values = {};
    auto spectrum = PiecewiseLinearSpectrum::from_samples(samples.nm, samples.values, ends);
    if (!spectrum) return make_error(ErrorCode::kBadFile, "{}: {}", file.path, spectrum.error().message);
    out.spectra.emplace_back(*std::move(spectrum));
    out.names.push_back(std::move(s.name));
  }
  for (const std::string& note : raw.notes) out.notes.push_back(file.path + ": " + note);
  return out;
}

}  // namespace spectile::io
