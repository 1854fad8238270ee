// A film's samples a second by the order in which they arrive, beside the AoS baseline's film and plain sums.
#include "bench/baseline/film_orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <spectile/color/sensor.hpp>
#include <spectile/lanes/wavelengths.hpp>

#include "bench/baseline/film_workload.hpp"
#include "bench/baseline/plain_film.hpp"
#include "bench/operations/operation.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// One method of adding a batch: samples from i on, of which the first is pool sample `at`.
using Add = std::function<void(const ArrivalOrder& order, std::size_t i, std::size_t n)>;

/// Films of one size and what they are fed with.
class Films {
 public:
  static Result<std::unique_ptr<Films>> create(int width, int height, bool buckets,
                                               const FilmOrderSettings& s) {
    auto out = std::make_unique<Films>();
    out->options.width = width;
    out->options.height = height;
    out->options.spectral = buckets;
    out->table_ = s.table;
    SPECTILE_ASSIGN(out->pool, make_sample_pool(s.seed));
    SPECTILE_ASSIGN(const auto sensor, Sensor::named("cie1931"));
    for (std::size_t c = 0; c < 3; ++c) {
      for (int nm = static_cast<int>(kFirstVisibleNm); nm <= static_cast<int>(kLastVisibleNm); ++nm) {
        out->curves_[c].push_back(static_cast<float>(sensor.factors()[c] * sensor.curves()[c](nm)));
      }
    }
    SPECTILE_ASSIGN(auto u, ScalarLanes::create(kSamplePool));
    std::copy(out->pool.u.begin(), out->pool.u.end(), u.span().data);
    out->u_ = std::move(u);
    SPECTILE_ASSIGN(out->drawn_, SampledWavelengths::create(kSamplePool, kPoolWavelengths));
    SPECTILE_ASSIGN(out->radiance_, SampledSpectra::create(out->drawn_.axis(), kSamplePool));
    for (std::size_t i = 0; i < kSamplePool; ++i) {
      for (std::size_t k = 0; k < kPoolWavelengths; ++k)
        out->radiance_.at(i, k) = out->pool.radiance[k * out->pool.stride + i];
    }
    SPECTILE_TRY(out->clear());
    return out;
  }

  /// Empties all films.
  Result<void> clear() {
    SPECTILE_ASSIGN(auto film, Film::create(options));
    engine = std::make_unique<Film>(std::move(film));
    const auto count = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
    pixels.assign(count, {});
    const Bands& bands = options.bands;
    buckets.assign(options.spectral ? count * bands.count() : 0, {});
    aos_ = {options.width,
            options.height,
            {curves_[0].data(), curves_[1].data(), curves_[2].data()},
            std::numeric_limits<float>::infinity(),
            pixels.data(),
            buckets.data(),
            static_cast<int>(bands.count()),
            static_cast<float>(bands.list().front().lower_nm),
            static_cast<float>(bands.list().back().upper_nm)};
    plain.reset();
    if (options.spectral) return {};
    SPECTILE_ASSIGN(plain, PlainFilm::create(*engine, *table_));
    return {};
  }

  WavelengthSamples samples(const ArrivalOrder& order, std::size_t i, std::size_t n) const {
    const auto rows = [&](const std::vector<float>& of) {
      return RowsView{of.data(), kPoolWavelengths, pool.stride};
    };
    return {{&order.x[i], n},    {&order.y[i], n},     {},
            rows(pool.radiance), rows(pool.lambda_nm), rows(pool.density)};
  }
  Add engine_add() {
    return [this](const ArrivalOrder& order, std::size_t i, std::size_t n) {
      static_cast<void>(engine->add(samples(order, i, n)));
    };
  }
  Add engine_draw() {
    return [this](const ArrivalOrder& order, std::size_t i, std::size_t n) {
      static_cast<void>(sample_wavelengths(WavelengthSampling::kVisible, u_.view(), drawn_, kFirstVisibleNm,
                                           kLastVisibleNm, {1}));
      static_cast<void>(engine->add({{&order.x[i], n}, {&order.y[i], n}, {}}, radiance_.view().range(0, n),
                                    drawn_.view().range(0, n)));
    };
  }
  Add plain_add() {
    return
        [this](const ArrivalOrder& order, std::size_t i, std::size_t n) { plain->add(samples(order, i, n)); };
  }
  Add aos_add(AosFilmFunction f) {
    return [this, f](const ArrivalOrder& order, std::size_t i, std::size_t n) {
      f(aos_, &order.x[i], &order.y[i], pool.u.data(), pool.samples.data(), n);
    };
  }
  double aos_luminance(int x, int y) const {
    const AosPixel& p = pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(options.width) +
                               static_cast<std::size_t>(x)];
    return p.xyz[1] / p.weight;
  }

  FilmOptions options;
  SamplePool pool;
  std::unique_ptr<Film> engine;
  std::unique_ptr<PlainFilm> plain;
  std::vector<AosPixel> pixels;
  std::vector<AosBucket> buckets;

 private:
  const kernels::KernelTable* table_ = nullptr;
  std::vector<float> curves_[3];
  AosFilm aos_{};
  ScalarLanes u_;
  SampledWavelengths drawn_;
  SampledSpectra radiance_;
};

enum class Comparison { kFilm, kPlainSums, kDrawing, kBuckets };

std::string row_name(Comparison comparison, const std::string& order) {
  const char* const names[] = {"film", "film against plain double sums", "film, wavelengths drawn",
                               "film, 60 buckets"};
  return fmt::format("{}, {}", names[static_cast<int>(comparison)], order);
}

/// True if a row's name contains one of these, or there are none.
bool any_chosen(const std::vector<std::string>& only) {
  for (const Comparison c :
       {Comparison::kFilm, Comparison::kPlainSums, Comparison::kDrawing, Comparison::kBuckets}) {
    for (const char* order :
         {"tile, 1 a visit", "tile, 4 a visit", "tile, 16 a visit", "scanline", "random"}) {
      if (is_chosen(row_name(c, order), only)) return true;
    }
  }
  return false;
}

/// A row of the report while it is measured.
struct Row {
  std::string name;
  Films* films = nullptr;
  const ArrivalOrder* order = nullptr;
  Comparison comparison = Comparison::kFilm;
  Timed engine = {}, baseline = {}, tuned = {};
};

void pass(const ArrivalOrder& order, const Add& add) {
  for (std::size_t i = 0; i < order.size(); i += kSamplePool)
    add(order, i, std::min(kSamplePool, order.size() - i));
}

void add_row(std::deque<Row>& rows, Films& films, const ArrivalOrder& order, Comparison comparison,
             const std::vector<std::string>& only) {
  const std::string name = row_name(comparison, order.name);
  if (!is_chosen(name, only)) return;
  const AosBaseline& aos = aos_baseline();
  const auto passes = [&order](Add add) { return [&order, add = std::move(add)] { pass(order, add); }; };
  Row& row = rows.emplace_back(Row{name, &films, &order, comparison});
  row.engine.run = passes(comparison == Comparison::kDrawing ? films.engine_draw() : films.engine_add());
  switch (comparison) {
    case Comparison::kFilm:
      row.baseline.run = passes(films.aos_add(aos.film_add));
      row.tuned.run = passes(films.aos_add(aos.film_add_tuned));
      break;
    case Comparison::kPlainSums:
      row.baseline.run = passes(films.plain_add());
      break;
    case Comparison::kDrawing:
      row.baseline.run = passes(films.aos_add(aos.film_add_drawing));
      break;
    case Comparison::kBuckets:
      row.baseline.run = passes(films.aos_add(aos.film_add_buckets));
      break;
  }
}

/// Errors of engine and baseline after one pass over empty films.
Result<std::pair<double, double>> errors(const Row& row) {
  Films& f = *row.films;
  SPECTILE_TRY(f.clear());
  row.engine.run();
  row.baseline.run();
  if (row.comparison == Comparison::kBuckets) {
    const Bands& bands = f.options.bands;
    SPECTILE_ASSIGN(auto spectrum, FilmDevelopment::create(*f.engine, FilmLayer::kSpectrum));
    SPECTILE_TRY(spectrum.update({1}));
    return std::pair{
        bucket_error(*row.order, f.pool, bands, true,
                     [&](int x, int y, std::size_t b) { return static_cast<double>(spectrum.at(b, x, y)); }),
        bucket_error(*row.order, f.pool, bands, false, [&](int x, int y, std::size_t b) {
          const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(f.options.width) +
                             static_cast<std::size_t>(x);
          const AosBucket& bucket = f.buckets[pixel * bands.count() + b];
          return bucket.sum / bucket.weight;
        })};
  }
  const auto& luminance = row.comparison == Comparison::kDrawing ? f.pool.drawn_luminance : f.pool.luminance;
  SPECTILE_ASSIGN(auto y, FilmDevelopment::create(*f.engine, FilmLayer::kLuminance));
  SPECTILE_TRY(y.update({1}));
  const bool plain = row.comparison == Comparison::kPlainSums;
  return std::pair{luminance_error(*row.order, luminance,
                                   [&](int px, int py) { return static_cast<double>(y.at(0, px, py)); }),
                   luminance_error(*row.order, luminance, [&](int px, int py) {
                     return plain ? f.plain->luminance(px, py) : f.aos_luminance(px, py);
                   })};
}

/// Bytes that a sample moves to and from memory: its position, and its pixel's cache lines read and written
/// back. Samples at random move whole lines; others share them with their neighbours.
double moved_bytes(const Row& row) {
  constexpr double kPositionBytes = 2 * sizeof(float);
  constexpr double kLineBytes = 64;
  const double lines = row.comparison == Comparison::kBuckets ? 1 + kPoolWavelengths : 1;
  const auto shared = static_cast<double>(row.films->engine->stats().bytes_per_pixel) /
                      static_cast<double>(row.order->per_visit);
  return kPositionBytes +
         2 * (row.order->name == "random" ? lines * kLineBytes : std::min(lines * kLineBytes, shared));
}

}  // namespace

Result<std::vector<BaselineSpeed>> measure_film_orders(const FilmOrderSettings& s) {
  if (!any_chosen(s.only)) return std::vector<BaselineSpeed>();
  const int part = s.quick ? 3 : 1;
  const int width = 1920 / part;
  const int height = 1080 / part;
  const std::size_t count =
      std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<ArrivalOrder> orders;
  for (const std::size_t visits : {1, 4, 16}) orders.push_back(by_tile(width, height, visits, 4, count));
  orders.push_back(by_scanline(width, height, 4));
  orders.push_back(at_random(orders[1]));
  // 60 buckets take 1984 bytes a pixel: a ninth of the pixels, with nine times the samples each.
  std::vector<ArrivalOrder> spectral = {by_tile(width / 3, height / 3, 4, 9, count)};
  spectral.push_back(at_random(spectral.front()));
  SPECTILE_ASSIGN(const auto films, Films::create(width, height, false, s));
  SPECTILE_ASSIGN(const auto buckets, Films::create(width / 3, height / 3, true, s));
  std::deque<Row> rows;
  for (const ArrivalOrder& order : orders) {
    add_row(rows, *films, order, Comparison::kFilm, s.only);
    add_row(rows, *films, order, Comparison::kPlainSums, s.only);
  }
  for (const std::size_t i : {1U, 4U}) add_row(rows, *films, orders[i], Comparison::kDrawing, s.only);
  for (const ArrivalOrder& order : spectral) add_row(rows, *buckets, order, Comparison::kBuckets, s.only);
  std::vector<Timed*> work;
  for (Row& row : rows) {
    for (Timed* t : {&row.engine, &row.baseline, &row.tuned}) {
      if (t->run) work.push_back(t);
    }
  }
  time_in_turn(work, s.timing);
  std::vector<BaselineSpeed> out;
  for (const Row& row : rows) {
    if (row.engine.rounds.empty()) break;
    const auto samples = static_cast<double>(row.order->size());
    BaselineSpeed speed;
    speed.group = "film";
    speed.name = row.name;
    speed.item = "sample";
    speed.nanoseconds = 1e9 * row.engine.seconds / samples;
    speed.baseline_nanoseconds = 1e9 * row.baseline.seconds / samples;
    speed.fused_nanoseconds = 1e9 * row.tuned.seconds / samples;
    speed.ratio = median_ratio(row.baseline, row.engine);
    speed.fused_ratio = median_ratio(row.tuned, row.engine);
    speed.spread = row.engine.spread;
    speed.limit = "copy, memory";
    if (s.copy > 0) speed.fraction = moved_bytes(row) * samples / row.engine.seconds / s.copy;
    SPECTILE_ASSIGN(const auto error, errors(row));
    speed.error = error.first;
    speed.baseline_error = error.second;
    speed.error_unit = "relative";
    out.push_back(std::move(speed));
  }
  return out;
}

}  // namespace spectile::measure
