// Closed forms of procedural scenes. A cell is a product of linear functions and a filter one of profiles, so
// a pixel is a sum over cells of products of integrals along the axes.
#include "src/scene/reference_values.hpp"

#include <algorithm>
#include <limits>
#include <variant>

#include "src/film/filter_profile.hpp"
#include "src/spectra/quadrature.hpp"

namespace spectile::scene {
namespace {

/// Integrals of the profile, and of the profile times the place in the unit square, over each interval of the
/// scene's edges that it reaches.
struct Moments {
  struct Of {
    std::size_t interval;
    double profile, times_place;
  };
  std::vector<Of> intervals;
  double whole = 0;  ///< of the profile, also beyond the scene
};

/// Where a filter and its samples are along an axis.
struct Axis {
  double centre = 0;  ///< pixels
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  int size = 0;  ///< of the film
};

template <class Profile>
Moments moments(const Edges& edges, const Axis& axis, const std::vector<double>& pieces,
                const Profile& profile) {
  const double low = std::max(axis.low, axis.centre - pieces.back());
  const double high = std::min(axis.high, axis.centre + pieces.back());
  std::vector<double> cuts = {low, high};
  const auto add_cut = [&](double at) {
    if (at > low && at < high) cuts.push_back(at);
  };
  for (const double d : pieces) {
    add_cut(axis.centre - d);
    add_cut(axis.centre + d);
  }
  for (const double edge : edges.at()) add_cut(edge * axis.size);
  std::ranges::sort(cuts);
  Moments out;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (!(cuts[i] > cuts[i - 1])) continue;
    const auto weight = [&](double at) { return profile(axis.centre - at); };
    const auto placed = [&](double at) { return profile(axis.centre - at) * (at / axis.size); };
    const double mass = quadrature::ten_points(weight, cuts[i - 1], cuts[i]);
    out.whole += mass;
    const double middle = 0.5 * (cuts[i - 1] + cuts[i]) / axis.size;
    if (!(middle >= 0 && middle < 1)) continue;
    const std::size_t interval = edges.find(middle);
    if (out.intervals.empty() || out.intervals.back().interval != interval) {
      out.intervals.push_back({interval, 0, 0});
    }
    out.intervals.back().profile += mass;
    out.intervals.back().times_place += quadrature::ten_points(placed, cuts[i - 1], cuts[i]);
  }
  return out;
}

/// True if two spectra are one table in memory, or the same formula. Others count as different.
bool same(const Spectrum& a, const Spectrum& b) {
  if (const auto* p = std::get_if<DenselySampledSpectrum>(&a.kind())) {
    const auto* q = std::get_if<DenselySampledSpectrum>(&b.kind());
    return q != nullptr && p->values().data() == q->values().data() && p->first_nm() == q->first_nm();
  }
  if (const auto* p = std::get_if<PiecewiseLinearSpectrum>(&a.kind())) {
    const auto* q = std::get_if<PiecewiseLinearSpectrum>(&b.kind());
    return q != nullptr && p->values().data() == q->values().data();
  }
  if (const auto* p = std::get_if<GaussianSumSpectrum>(&a.kind())) {
    const auto* q = std::get_if<GaussianSumSpectrum>(&b.kind());
    return q != nullptr && p->lobes().data() == q->lobes().data();
  }
  if (const auto* p = std::get_if<ConstantSpectrum>(&a.kind())) {
    const auto* q = std::get_if<ConstantSpectrum>(&b.kind());
    return q != nullptr && p->value() == q->value();
  }
  return false;
}

const Sensor& observer_sensor(Observer observer) {
  static const Sensor two = *Sensor::named("cie1931");
  static const Sensor ten = *Sensor::named("cie1964");
  return observer == Observer::kCie1931 ? two : ten;
}

}  // namespace

PixelWindow filter_window(const FilmOptions& film) {
  return film.crop.value_or(PixelWindow{0, 0, film.width, film.height});
}

std::vector<double> amounts(const Layout& layout, const FilmOptions& film, int x, int y) {
  const PixelFilter& filter = film.filter;
  Axis across{.centre = x + 0.5, .size = film.width};
  Axis down{.centre = y + 0.5, .size = film.height};
  if (film.placement == SamplePlacement::kSplat) {
    const PixelWindow window = filter_window(film);
    across.low = window.x0;
    across.high = window.x1;
    down.low = window.y0;
    down.high = window.y1;
  }
  const Moments columns = moments(layout.x(), across, FilterAccess::smooth_pieces(filter, filter.radius_x()),
                                  [&](double d) { return filter.along_x(d); });
  const Moments rows = moments(layout.y(), down, FilterAccess::smooth_pieces(filter, filter.radius_y()),
                               [&](double d) { return filter.along_y(d); });
  std::vector<double> out(layout.spectra().size());
  const double whole = columns.whole * rows.whole;
  if (whole == 0) return out;
  for (const Moments::Of& row : rows.intervals) {
    for (const Moments::Of& column : columns.intervals) {
      const Rectangle& r = layout.of_cell(column.interval, row.interval);
      const double along_x = r.along_x.at0 * column.profile + r.along_x.slope * column.times_place;
      const double along_y = r.along_y.at0 * row.profile + r.along_y.slope * row.times_place;
      out[r.spectrum] += r.scale * along_x * along_y / whole;
    }
  }
  return out;
}

bool Responses::ColorKey::operator==(const ColorKey& other) const {
  for (std::size_t c = 0; c < 3; ++c) {
    if (!same(sensor.curves()[c], other.sensor.curves()[c])) return false;
  }
  return sensor.factors() == other.sensor.factors() && observer == other.observer && bands == other.bands;
}

std::vector<Responses::Triple> Responses::computed(const ColorKey& key) {
  std::vector<Triple> out;
  if (!key.bands) {
    for (const auto& spectrum : layout_.spectra()) out.push_back(key.sensor.response(spectrum));
    return out;
  }
  std::vector<Triple> weights;
  if (const auto projector = key.observer ? Projector::emissive(*key.bands, *key.observer)
                                          : Projector::emissive(*key.bands, key.sensor)) {
    weights.assign(projector->weights().begin(), projector->weights().end());
  }
  const auto of_bands = averages(*key.bands, false);
  const std::size_t bands = key.bands->count();
  for (std::size_t s = 0; s < layout_.spectra().size(); ++s) {
    Triple sum{};
    for (std::size_t b = 0; b < weights.size(); ++b) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weights[b][c] * of_bands->exact[s * bands + b];
    }
    out.push_back(sum);
  }
  return out;
}

std::shared_ptr<const std::vector<Responses::Triple>> Responses::colors(const ColorKey& key) {
  return colors_.get(key, [&] { return computed(key); });
}

std::shared_ptr<const std::vector<Responses::Triple>> Responses::xyz(const FilmOptions& film) {
  const Observer observer = film.xyz.value_or(Observer::kCie1931);
  ColorKey key{observer_sensor(observer), observer, {}};
  if (film.input == FilmInput::kBands) key.bands = film.bands;
  return colors(key);
}

std::shared_ptr<const std::vector<Responses::Triple>> Responses::sensor(const FilmOptions& film,
                                                                        std::size_t which) {
  ColorKey key{film.sensors[which].sensor, {}, {}};
  if (film.input == FilmInput::kBands) key.bands = film.bands;
  return colors(key);
}

std::shared_ptr<const Averages> Responses::averages(const Bands& bands, bool drawn) {
  return averages_.get({bands, drawn}, [&] {
    Averages out;
    for (const auto& spectrum : layout_.spectra()) {
      for (const Band& band : bands.list()) {
        const double low = drawn ? std::max(band.lower_nm, kFirstVisibleNm) : band.lower_nm;
        const double high = drawn ? std::min(band.upper_nm, kLastVisibleNm) : band.upper_nm;
        out.exact.push_back(high > low ? spectrum.integral(low, high) / (high - low) : 0);
        out.rounded.push_back(static_cast<float>(out.exact.back()));
      }
    }
    return out;
  });
}

}  // namespace spectile::scene
