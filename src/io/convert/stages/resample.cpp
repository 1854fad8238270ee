// Averages of sampled spectra over other bands, as weighted sums of samples side by side.
#include "src/io/convert/stages/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace spectile::io {
namespace {

/// The range that a sample stands for.
struct Range {
  double lower_nm = 0;
  double upper_nm = 0;
};

double overlap(const Range& range, const Band& band) {
  return std::max(0.0, std::min(range.upper_nm, band.upper_nm) - std::max(range.lower_nm, band.lower_nm));
}

std::vector<Range> ranges_of(const Bands& bands, bool held) {
  std::vector<Range> out;
  for (const Band& band : bands.list()) out.push_back({band.lower_nm, band.upper_nm});
  if (!held) return out;
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    const double middle = (out[i].upper_nm + out[i + 1].lower_nm) / 2;
    out[i].upper_nm = out[i + 1].lower_nm = middle;
  }
  out.front().lower_nm = 0;
  out.back().upper_nm = std::numeric_limits<double>::max();
  return out;
}

BandAverage average_over(const Band& band, const std::vector<Range>& ranges) {
  BandAverage out;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double part = overlap(ranges[i], band);
    // Edges that are the same but for rounding share nothing.
    if (part <= 1e-9 * band.width_nm()) continue;
    if (out.weights.empty()) out.first = i;
    // A band within one of the old ones is that, to the bit.
    out.weights.push_back(part >= (1 - 1e-9) * band.width_nm() ? 1.0 : part / band.width_nm());
  }
  if (out.weights.empty()) out.weights.push_back(0);
  return out;
}

void note_uncovered(const Bands& from, const Bands& to, bool held, std::vector<std::string>& notes) {
  // Names of channels have six decimals.
  constexpr double kRounded = 1e-5;
  const std::vector<Range> ranges = ranges_of(from, false);
  const Range all = {ranges.front().lower_nm, ranges.back().upper_nm};
  std::size_t beyond = 0;
  std::size_t in_gaps = 0;
  for (const Band& band : to.list()) {
    const double inside = overlap(all, band);
    double covered = 0;
    for (const Range& range : ranges) covered += overlap(range, band);
    beyond += band.width_nm() - inside > kRounded ? 1 : 0;
    in_gaps += inside - covered > kRounded ? 1 : 0;
  }
  const char* const value = held ? "reflectance keeps the nearest band's value" : "light is 0";
  const auto note = [&](std::size_t count, const std::string& where) {
    if (count == 0) return;
    notes.push_back(fmt::format("{} of {} new bands lie, in part or whole, {}, where {}", count, to.count(),
                                where, value));
  };
  note(beyond, fmt::format("beyond the input's {:g} to {:g} nm", all.lower_nm, all.upper_nm));
  note(in_gaps, "between the input's bands");
}

}  // namespace

std::vector<BandAverage> band_averages(const Bands& from, const Bands& to, Quantity quantity,
                                       std::vector<std::string>& notes) {
  const bool held = quantity != Quantity::kIlluminant;
  const std::vector<Range> ranges = ranges_of(from, held);
  std::vector<BandAverage> out;
  for (const Band& band : to.list()) out.push_back(average_over(band, ranges));
  note_uncovered(from, to, held, notes);
  return out;
}

}  // namespace spectile::io
