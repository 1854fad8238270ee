// Response curves of a film, and which of two films' options differ.
#include "src/film/responses.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"

namespace spectile {
namespace {

constexpr auto kIntervals = static_cast<std::size_t>(kLastVisibleNm - kFirstVisibleNm);
constexpr std::size_t kRows = kIntervals + 2;  // of kernels::FilmCurves

const char* observer_name(Observer observer) {
  return observer == Observer::kCie1931 ? "cie1931" : "cie1964";
}

/// Rows of three values and three differences from the tables of each curve.
Result<FloatBuffer> curve_rows(const ResponseCurves& curves) {
  SPECTILE_ASSIGN(auto out, FloatBuffer::create(8 * kRows));
  std::fill_n(out.data(), out.size(), 0.0F);
  for (std::size_t i = 0; i < kIntervals; ++i) {
    float* const row = out.data() + 8 * i;
    for (std::size_t c = 0; c < 3; ++c) {
      const float* const pair = ResponseCurvesAccess::table(curves) + 2 * (c * kIntervals + i);
      row[c] = pair[0];
      row[4 + c] = pair[1];
    }
  }
  float* const last = out.data() + 8 * kIntervals;
  for (std::size_t c = 0; c < 3; ++c) last[c] = (last - 8)[c] + (last - 8)[4 + c];
  return out;
}

Result<FloatBuffer> copied(const float* values, std::size_t count) {
  auto out = FloatBuffer::create(count);
  if (out) std::copy_n(values, count, out->data());
  return out;
}

Result<FloatBuffer> observer_table(Observer observer, const FilmOptions& o) {
  if (o.input == FilmInput::kWavelengths) {
    SPECTILE_ASSIGN(const auto curves, ResponseCurves::of_observer(observer));
    return curve_rows(curves);
  }
  SPECTILE_ASSIGN(const auto projector, Projector::emissive(o.bands, observer));
  return copied(ProjectorAccess::weights(projector), film_response_floats(o));
}

Result<FloatBuffer> sensor_table(const Sensor& sensor, const FilmOptions& o) {
  if (o.input == FilmInput::kWavelengths) {
    SPECTILE_ASSIGN(const auto curves, sensor.response_curves());
    return curve_rows(curves);
  }
  SPECTILE_ASSIGN(const auto projector, Projector::emissive(o.bands, sensor));
  return copied(ProjectorAccess::weights(projector), film_response_floats(o));
}

std::string window_text(const PixelWindow& w) {
  return fmt::format("{},{} to {},{}", w.x0, w.y0, w.x1, w.y1);
}

const char* statistics_text(PixelStatistics s) {
  return s == PixelStatistics::kNone ? "none" : s == PixelStatistics::kCounts ? "counts" : "variance";
}

std::string bands_text(const FilmOptions& o) {
  return o.spectral || o.input == FilmInput::kBands ? o.bands.description() : "none";
}

template <class Value>
std::string differ(const char* what, const Value& a, const Value& b) {
  return fmt::format("{}: {} and {}", what, a, b);
}

}  // namespace

float largest_in_rows(const float* table) {
  float out = 0;
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t c = 0; c < 3; ++c) {
      out = std::max(out, std::abs(table[8 * row + c]) + std::abs(table[8 * row + 4 + c]));
    }
  }
  return out;
}

std::size_t film_response_floats(const FilmOptions& options) {
  return options.input == FilmInput::kWavelengths ? 8 * kRows : 4 * options.bands.count();
}

Result<void> make_film_responses(FilmAccess::State& s) {
  const FilmOptions& o = s.options;
  const auto add = [&](std::string name, Result<FloatBuffer> table) -> Result<void> {
    if (!table) return table.error();
    const float largest = o.input == FilmInput::kWavelengths ? largest_in_rows(table->data()) : 0.0F;
    s.responses.push_back({std::move(name), *std::move(table), largest});
    return {};
  };
  if (o.xyz) SPECTILE_TRY(add(observer_name(*o.xyz), observer_table(*o.xyz, o)));
  for (const NamedSensor& sensor : o.sensors) {
    SPECTILE_TRY(add(sensor.name, sensor_table(sensor.sensor, o)));
  }
  if (s.responses.empty()) {
    // The weight needs a quad of its own; its colour is black.
    const std::vector<float> zeros(film_response_floats(o), 0.0F);
    SPECTILE_TRY(add("none", copied(zeros.data(), zeros.size())));
  }
  return {};
}

std::optional<std::string> film_difference(const FilmAccess::State& a, const FilmAccess::State& b) {
  const FilmOptions& p = a.options;
  const FilmOptions& q = b.options;
  if (p.width != q.width || p.height != q.height) {
    return differ("size", fmt::format("{} x {}", p.width, p.height),
                  fmt::format("{} x {}", q.width, q.height));
  }
  if (!(a.window == b.window)) return differ("crop window", window_text(a.window), window_text(b.window));
  if (p.input != q.input) {
    const auto text = [](FilmInput i) { return i == FilmInput::kBands ? "bands" : "wavelengths"; };
    return differ("input", text(p.input), text(q.input));
  }
  const auto kept = [](bool is_kept) { return is_kept ? "kept" : "not kept"; };
  if (p.spectral != q.spectral) return differ("spectrum", kept(p.spectral), kept(q.spectral));
  if ((p.spectral || p.input == FilmInput::kBands) && !(p.bands == q.bands)) {
    const bool same_text = bands_text(p) == bands_text(q);
    return differ("bands", bands_text(p), bands_text(q) + (same_text ? " (other edges)" : ""));
  }
  if (a.responses.size() != b.responses.size()) {
    return differ("number of sensors", a.responses.size(), b.responses.size());
  }
  if (p.xyz.has_value() != q.xyz.has_value()) {
    return differ("XYZ", kept(p.xyz.has_value()), kept(q.xyz.has_value()));
  }
  for (std::size_t i = 0; i < a.responses.size(); ++i) {
    const FilmResponse& r = a.responses[i];
    const FilmResponse& t = b.responses[i];
    if (r.name != t.name) return differ("sensor", r.name, t.name);
    if (std::memcmp(r.table.data(), t.table.data(), film_response_floats(p) * sizeof(float)) != 0) {
      return differ("sensor", r.name, t.name + " with other curves");
    }
  }
  if (!(p.filter == q.filter)) return differ("filter", p.filter.to_text(), q.filter.to_text());
  if (p.placement != q.placement) {
    const auto text = [](SamplePlacement s) { return s == SamplePlacement::kSplat ? "splat" : "one pixel"; };
    return differ("placement", text(p.placement), text(q.placement));
  }
  if (p.statistics != q.statistics) {
    return differ("statistics", statistics_text(p.statistics), statistics_text(q.statistics));
  }
  if (p.range != q.range) return differ("range", fmt::format("2^{}", p.range), fmt::format("2^{}", q.range));
  if (p.weight_range != q.weight_range) {
    return differ("range of weights", fmt::format("2^{}", p.weight_range),
                  fmt::format("2^{}", q.weight_range));
  }
  if (p.maximum_component != q.maximum_component) {
    return differ("maximum component", p.maximum_component, q.maximum_component);
  }
  if (p.negative_weights != q.negative_weights) {
    return differ("negative weights", p.negative_weights ? "kept" : "refused",
                  q.negative_weights ? "kept" : "refused");
  }
  return {};
}

}  // namespace spectile
