// Construction, validation and text forms of Bands.
#include <algorithm>
#include <cmath>
#include <optional>
#include <spectile/spectra/bands.hpp>

#include "src/base/errors.hpp"
#include "src/base/text.hpp"

namespace spectile {
namespace {

std::vector<Band> uniform_list(double first_nm, double step_nm, std::size_t count) {
  std::vector<Band> list(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double lower = first_nm + static_cast<double>(i) * step_nm;
    const double upper = first_nm + static_cast<double>(i + 1) * step_nm;
    list[i] = {lower, 0.5 * (lower + upper), upper};
  }
  return list;
}

std::optional<double> to_number(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return parse_number<double>(text);
}

}  // namespace

Bands::Bands(std::vector<Band> bands) : bands_(std::make_shared<const std::vector<Band>>(std::move(bands))) {}

Bands::Bands() {
  static const auto kDefault = std::make_shared<const std::vector<Band>>(uniform_list(400.0, 5.0, 60));
  bands_ = kDefault;
}

Result<Bands> Bands::uniform(double first_nm, double last_nm, double step_nm) {
  if (!std::isfinite(first_nm) || !std::isfinite(last_nm) || !std::isfinite(step_nm) || first_nm <= 0 ||
      step_nm <= 0 || last_nm <= first_nm) {
    return make_error(ErrorCode::kBadArgument,
                      "from {} to {} nm by {} nm: edges must be positive and ascending, the step positive",
                      first_nm, last_nm, step_nm);
  }
  const double steps = (last_nm - first_nm) / step_nm;
  if (steps > static_cast<double>(kMaxBands) + 0.5) {
    return make_error(ErrorCode::kBadArgument, "from {} to {} nm by {} nm are more than {} bands", first_nm,
                      last_nm, step_nm, kMaxBands);
  }
  const double whole = std::round(steps);
  if (whole < 1 || std::abs(steps - whole) > 1e-6) {
    return make_error(ErrorCode::kBadArgument, "a step of {} nm does not divide the range from {} to {} nm",
                      step_nm, first_nm, last_nm);
  }
  return from_list(uniform_list(first_nm, step_nm, static_cast<std::size_t>(whole)));
}

namespace {

/// Errors: those of from_list(), or of from_overlapping().
Result<void> check_list(const std::vector<Band>& bands, bool may_overlap) {
  if (bands.empty() || bands.size() > Bands::kMaxBands) {
    return make_error(ErrorCode::kBadArgument, "{} bands: there must be 1 to {}", bands.size(),
                      Bands::kMaxBands);
  }
  double last_upper = 0;
  double last_centre = 0;
  for (const Band& band : bands) {
    const bool ordered = band.lower_nm >= 0 && band.lower_nm < band.centre_nm &&
                         band.centre_nm < band.upper_nm && std::isfinite(band.upper_nm);
    if (!ordered || !(band.centre_nm > last_centre) || !(may_overlap || band.lower_nm >= last_upper)) {
      return make_error(ErrorCode::kBadArgument, "band [{}, {}] nm around {} nm: bands must be positive{}",
                        band.lower_nm, band.upper_nm, band.centre_nm,
                        may_overlap ? " and their centres ascending" : ", ascending and not overlap");
    }
    last_upper = band.upper_nm;
    last_centre = band.centre_nm;
  }
  return {};
}

}  // namespace

Result<Bands> Bands::from_list(std::vector<Band> bands) {
  SPECTILE_TRY(check_list(bands, false));
  return Bands(std::move(bands));
}

Result<Bands> Bands::from_overlapping(std::vector<Band> bands) {
  SPECTILE_TRY(check_list(bands, true));
  return Bands(std::move(bands));
}

std::pair<double, double> Bands::range_nm() const noexcept {
  std::pair<double, double> out = {bands_->front().lower_nm, bands_->front().upper_nm};
  for (const Band& band : *bands_) {
    out.first = std::min(out.first, band.lower_nm);
    out.second = std::max(out.second, band.upper_nm);
  }
  return out;
}

bool Bands::overlap() const noexcept {
  double last = 0;
  for (const Band& band : *bands_) {
    if (band.lower_nm < last) return true;
    last = std::max(last, band.upper_nm);
  }
  return false;
}

Result<Bands> Bands::from_centres(std::span<const double> centres_nm) {
  const std::size_t n = centres_nm.size();
  if (n == 1) return from_list({{centres_nm[0] - 0.5, centres_nm[0], centres_nm[0] + 0.5}});
  std::vector<Band> list(n);
  for (std::size_t i = 0; i < n; ++i) list[i].centre_nm = centres_nm[i];
  for (std::size_t i = 0; i + 1 < n; ++i) {
    list[i].upper_nm = list[i + 1].lower_nm = 0.5 * (centres_nm[i] + centres_nm[i + 1]);
  }
  if (n > 1) {
    list.front().lower_nm = 2 * list.front().centre_nm - list.front().upper_nm;
    list.back().upper_nm = 2 * list.back().centre_nm - list.back().lower_nm;
  }
  return from_list(std::move(list));
}

Result<Bands> Bands::parse(std::string_view text) {
  const bool range = text.find(':') != std::string_view::npos;
  std::vector<double> numbers;
  for (const std::string_view part : split(text, range ? ':' : ',')) {
    const auto number = to_number(part);
    if (!number) {
      return make_error(ErrorCode::kBadArgument,
                        "bands \"{}\": \"{}\" is not a number; use FIRST:LAST:STEP in nm", text, part);
    }
    numbers.push_back(*number);
  }
  if (range && numbers.size() != 3) {
    return make_error(ErrorCode::kBadArgument, "bands \"{}\" are not FIRST:LAST:STEP in nm, as in 400:700:5",
                      text);
  }
  auto bands = range ? uniform(numbers[0], numbers[1], numbers[2]) : from_centres(numbers);
  if (!bands) return make_error(bands.error().code, "bands \"{}\": {}", text, bands.error().message);
  return bands;
}

std::string Bands::description() const {
  const auto list = this->list();
  const auto [first, last] = range_nm();
  const double step = (last - first) / static_cast<double>(list.size());
  bool even = true;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double lower = first + static_cast<double>(i) * step;
    even =
        even && std::abs(list[i].lower_nm - lower) < 1e-6 && std::abs(list[i].upper_nm - lower - step) < 1e-6;
  }
  if (even) return fmt::format("{:g}:{:g}:{:g}", first, last, step);
  return fmt::format("{} bands from {:g} to {:g} nm", list.size(), first, last);
}

}  // namespace spectile
