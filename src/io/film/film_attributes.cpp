// A film's options and counts as attributes of its file.

#include <algorithm>
#include <charconv>
#include <optional>

#include "src/base/errors.hpp"
#include "src/film/responses.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/film/film_channels.hpp"

namespace spectile::io {
namespace {

template <class Range>
std::string joined(const Range& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

/// Integers or floats, spaces between; nothing for other text.
template <class T>
std::optional<std::vector<T>> parse_numbers(const std::string& text) {
  std::vector<T> out;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    T value{};
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (next != end && *next != ' ')) return {};
    out.push_back(value);
    at = next == end ? end : next + 1;
    if (next != end && at == end) return {};
  }
  return out;
}

/// Reads a header's texts one by one, and keeps the first thing that is wrong.
class Reader {
 public:
  Reader(const PartHeader& header, const std::string& path) : header_(header), path_(path) {}

  std::string text(const std::string& name) {
    if (auto found = header_.text(name)) return *std::move(found);
    fail(name);
    return {};
  }
  template <class T>
  std::vector<T> numbers(const std::string& name, std::size_t count) {
    const auto out = parse_numbers<T>(text(name));
    if (out && out->size() == count) return *out;
    fail(name);
    return std::vector<T>(count, T{});
  }
  /// The place of a text among those that it may be.
  std::size_t one_of(const std::string& name, std::initializer_list<const char*> choices) {
    const std::string found = text(name);
    const auto* const it = std::find(choices.begin(), choices.end(), found);
    if (it != choices.end()) return static_cast<std::size_t>(it - choices.begin());
    fail(name);
    return 0;
  }
  void fail(const std::string& name) {
    if (wrong_.empty()) wrong_ = name;
  }
  Result<void> result() const {
    if (wrong_.empty()) return {};
    return make_error(ErrorCode::kBadFile, "{}: attribute {} is missing or damaged", path_, wrong_);
  }

 private:
  const PartHeader& header_;
  const std::string& path_;
  std::string wrong_;
};

std::string response_name(std::size_t i) {
  return fmt::format("spectileFilmResponse{}", i);
}

std::string table_name(std::size_t i) {
  return fmt::format("spectileFilmResponseTable{}", i);
}

/// A sensor like the one whose table a film keeps. The film itself goes on with the table.
Result<Sensor> sensor_like(const std::string& name, const float* table, const FilmOptions& o) {
  if (auto known = Sensor::named(name)) return known;
  std::vector<Spectrum> curves;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> nm;
    std::vector<double> values;
    if (o.input == FilmInput::kWavelengths) {
      for (std::size_t i = 0; 8 * (i + 1) < film_response_floats(o); ++i) {
        nm.push_back(kFirstVisibleNm + static_cast<double>(i));
        values.push_back(static_cast<double>(table[8 * i + c]));
      }
    } else {
      for (std::size_t b = 0; b < o.bands.count(); ++b) {
        nm.push_back(o.bands[b].centre_nm);
        values.push_back(static_cast<double>(table[4 * b + c]) / o.bands[b].width_nm());
      }
      if (nm.size() == 1) return Sensor::named("cie1931");
    }
    SPECTILE_ASSIGN(auto curve, PiecewiseLinearSpectrum::from_samples(nm, values));
    curves.emplace_back(std::move(curve));
  }
  return Sensor::create({curves[0], curves[1], curves[2]});
}

Result<void> read_responses(Reader& reader, FilmAccess::State& s, std::size_t count) {
  FilmOptions& o = s.options;
  const std::size_t floats = film_response_floats(o);
  for (std::size_t i = 0; i < count; ++i) {
    FilmResponse response;
    response.name = reader.text(response_name(i));
    const std::vector<float> table = reader.numbers<float>(table_name(i), floats);
    SPECTILE_TRY(reader.result());
    SPECTILE_ASSIGN(response.table, FloatBuffer::create(floats));
    std::copy(table.begin(), table.end(), response.table.data());
    const bool finite = std::all_of(table.begin(), table.end(), [](float v) { return v - v == 0; });
    if (!finite) reader.fail(table_name(i));
    const bool black = std::all_of(table.begin(), table.end(), [](float v) { return v == 0; });
    if (i >= (o.xyz ? 1U : 0U) && !(count == 1 && black && response.name == "none")) {
      auto sensor = sensor_like(response.name, table.data(), o);
      // Of the bands alone a sensor cannot always be told: it may see none of them with one of its curves.
      if (!sensor) sensor = Sensor::named("cie1931");
      if (!sensor) return sensor.error();
      o.sensors.push_back({response.name, *std::move(sensor)});
    }
    if (o.input == FilmInput::kWavelengths) response.largest = largest_in_rows(response.table.data());
    s.responses.push_back(std::move(response));
  }
  return reader.result();
}

}  // namespace

TextAttributes film_attributes(const FilmAccess::State& s, const std::string& progress) {
  const FilmOptions& o = s.options;
  TextAttributes out = {{kFilmAttribute, kFilmVersion}};
  const auto add = [&](const char* name, std::string text) { out.emplace_back(name, std::move(text)); };
  add("spectileFilmProgress", progress);
  add("spectileFilmCrop", joined(std::array{s.window.x0, s.window.y0, s.window.x1, s.window.y1}));
  add("spectileFilmFilter", o.filter.to_text());
  add("spectileFilmPlacement", o.placement == SamplePlacement::kSplat ? "splat" : "one pixel");
  add("spectileFilmInput", o.input == FilmInput::kBands ? "bands" : "wavelengths");
  add("spectileFilmSpectral", o.spectral ? "yes" : "no");
  std::vector<double> edges;
  for (const Band& band : o.bands.list()) {
    edges.insert(edges.end(), {band.lower_nm, band.centre_nm, band.upper_nm});
  }
  add("spectileFilmBands", joined(edges));
  add_plan_attribute(out, o.bands);
  add("spectileFilmXyz", !o.xyz ? "no" : *o.xyz == Observer::kCie1964 ? "1964" : "1931");
  add("spectileFilmResponses", fmt::to_string(s.responses.size()));
  for (std::size_t i = 0; i < s.responses.size(); ++i) {
    add(response_name(i).c_str(), s.responses[i].name);
    const float* const table = s.responses[i].table.data();
    add(table_name(i).c_str(), joined(std::span(table, film_response_floats(o))));
  }
  add("spectileFilmStatistics", o.statistics == PixelStatistics::kNone     ? "none"
                                : o.statistics == PixelStatistics::kCounts ? "counts"
                                                                           : "variance");
  add("spectileFilmRange", joined(std::array{o.range, o.weight_range}));
  add("spectileFilmMaximum", fmt::to_string(o.maximum_component));
  add("spectileFilmNegativeWeights", o.negative_weights ? "yes" : "no");
  std::vector<std::uint64_t> counts;
  for (const auto& count : s.counts) counts.push_back(count);
  add("spectileFilmCounts", joined(counts));
  return out;
}

Result<FilmDescription> film_of(const PartHeader& header, const std::string& path) {
  const auto version = header.text(kFilmAttribute);
  if (!version)
    return make_error(ErrorCode::kBadFile,
                      "{}: not a partial film, as film simulate writes; film average averages images", path);
  if (*version != kFilmVersion) {
    return make_error(ErrorCode::kBadFile, "{}: a partial film of version \"{}\"; this tool reads {}", path,
                      *version, kFilmVersion);
  }
  Reader reader(header, path);
  FilmOptions o;
  FilmDescription out;
  out.progress = reader.text("spectileFilmProgress");
  const PixelWindow& display = header.display_window();
  if (display.x0 != 0 || display.y0 != 0) {
    return make_error(ErrorCode::kBadFile, "{}: a film whose display window begins at {}, {}, not 0, 0", path,
                      display.x0, display.y0);
  }
  o.width = display.x1;
  o.height = display.y1;
  const auto crop = reader.numbers<int>("spectileFilmCrop", 4);
  o.crop = PixelWindow{crop[0], crop[1], crop[2], crop[3]};
  const auto filter = PixelFilter::parse(reader.text("spectileFilmFilter"));
  if (filter) {
    o.filter = *filter;
  } else {
    reader.fail("spectileFilmFilter");
  }
  o.placement = reader.one_of("spectileFilmPlacement", {"one pixel", "splat"}) == 1
                    ? SamplePlacement::kSplat
                    : SamplePlacement::kOnePixel;
  o.input = reader.one_of("spectileFilmInput", {"wavelengths", "bands"}) == 1 ? FilmInput::kBands
                                                                              : FilmInput::kWavelengths;
  o.spectral = reader.one_of("spectileFilmSpectral", {"no", "yes"}) == 1;
  const auto edges = parse_numbers<double>(reader.text("spectileFilmBands"));
  std::vector<Band> list;
  for (std::size_t i = 0; edges && i + 2 < edges->size(); i += 3) {
    list.push_back({(*edges)[i], (*edges)[i + 1], (*edges)[i + 2]});
  }
  const auto bands = Bands::from_overlapping(std::move(list));
  if (bands && edges->size() % 3 == 0) {
    SPECTILE_ASSIGN(o.bands, with_plan(header, *bands, path));
  } else {
    reader.fail("spectileFilmBands");
  }
  const std::size_t xyz = reader.one_of("spectileFilmXyz", {"no", "1931", "1964"});
  o.xyz.reset();
  if (xyz > 0) o.xyz = xyz == 2 ? Observer::kCie1964 : Observer::kCie1931;
  o.statistics =
      static_cast<PixelStatistics>(reader.one_of("spectileFilmStatistics", {"none", "counts", "variance"}));
  const auto ranges = reader.numbers<int>("spectileFilmRange", 2);
  o.range = ranges[0];
  o.weight_range = ranges[1];
  o.maximum_component = reader.numbers<float>("spectileFilmMaximum", 1)[0];
  o.negative_weights = reader.one_of("spectileFilmNegativeWeights", {"no", "yes"}) == 1;
  const auto counts = reader.numbers<std::uint64_t>("spectileFilmCounts", kernels::kFilmReasons);
  const auto responses = reader.numbers<std::uint32_t>("spectileFilmResponses", 1)[0];
  SPECTILE_TRY(reader.result());
  // So many responses of this size cannot be in a header; and a film without any has one quad all the same.
  constexpr std::uint32_t kMaxResponses = 256;
  if (responses < 1 || responses > kMaxResponses) {
    reader.fail("spectileFilmResponses");
    return reader.result().error();
  }
  FilmAccess::State described;
  described.options = o;
  SPECTILE_TRY(read_responses(reader, described, responses));
  auto state = prepare_film(described.options);
  if (!state) return make_error(ErrorCode::kBadFile, "{}: {}", path, state.error().message);
  if ((*state)->layout.quads != responses) {
    return make_error(ErrorCode::kBadFile, "{}: attribute spectileFilmResponses is missing or damaged", path);
  }
  (*state)->responses = std::move(described.responses);
  for (std::size_t r = 0; r < kernels::kFilmReasons; ++r) (*state)->counts[r] = counts[r];
  out.state = *std::move(state);
  return out;
}

}  // namespace spectile::io
