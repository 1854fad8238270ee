// Film, fed in every way.
#include "bench/micro/film_lines.hpp"

#include <thread>

namespace bench {
namespace {

using namespace spectile;
using report::need;

double film_error(const Film& film, const Order& order, const std::vector<double>& luminance) {
  FilmDevelopment y = need(FilmDevelopment::create(film, FilmLayer::kLuminance));
  need(y.update({1}));
  return worst_error(order, luminance, [&](int px, int py) { return y.at(0, px, py); });
}

/// Lines of Film: `add` takes (order, first sample, pool sample, samples). Every film is made of its options.
template <class Add>
Line film_line(std::string name, const Order& order, std::unique_ptr<Film>& film, const FilmOptions& options,
               std::size_t batch, Add add, std::size_t lines = 1) {
  Film probe = need(Film::create(options));
  if (options.input == FilmInput::kWavelengths) need(probe.add(samples_of(order, bench().pool, 0, 0, 1)));
  Line out = line_of(std::move(name), order, probe.stats().bytes_per_pixel, lines);
  out.fresh = [&film, options] { film = std::make_unique<Film>(need(Film::create(options))); };
  out.pass = [&order, batch, add] {
    batches(0, order.size(), batch,
            [&](std::size_t i, std::size_t at, std::size_t n) { add(order, i, at, n); });
  };
  out.error = [&film, &order] { return film_error(*film, order, bench().pool.luminance); };
  return out;
}

Line color_line(std::string name, const Order& order, std::size_t batch = kBatch) {
  return film_line(std::move(name), order, bench().color, options_of(kWidth, kHeight), batch,
                   [](const Order& o, std::size_t i, std::size_t at, std::size_t n) {
                     const Pool& pool = n > kPool ? bench().large_pool : bench().pool;
                     need(bench().color->add(samples_of(o, pool, i, at, n)));
                   });
}

Line threads_line(const Order& order) {
  Line out = color_line("spectile, 2 threads", order);
  out.pass = [&order] {
    const auto half = [&](std::size_t first, std::size_t end) {
      batches(first, end, kBatch, [&](std::size_t i, std::size_t at, std::size_t n) {
        need(bench().color->add(samples_of(order, bench().pool, i, at, n)));
      });
    };
    // Whole batches, so that the samples are those of one thread.
    const std::size_t middle = order.size() / kBatch / 2 * kBatch;
    std::thread other(half, std::size_t{0}, middle);
    half(middle, order.size());
    other.join();
  };
  return out;
}

Line drawing_line(const Order& order) {
  Line out = film_line("spectile, drawing", order, bench().color, options_of(kWidth, kHeight), kBatch,
                       [](const Order& o, std::size_t i, std::size_t, std::size_t n) {
                         Bench& b = bench();
                         need(sample_wavelengths(WavelengthSampling::kVisible, b.u.view(), b.drawn,
                                                 kFirstVisibleNm, kLastVisibleNm, {1}));
                         const WavelengthView lambda = b.drawn.lambda_nm.view();
                         const WavelengthView density = b.drawn.density.view();
                         WavelengthSamples samples = samples_of(o, b.pool, i, 0, n);
                         samples.lambda_nm = {lambda.data, lambda.count, lambda.stride};
                         samples.density = {density.data, density.count, density.stride};
                         need(b.color->add(samples));
                       });
  out.error = [&order] { return film_error(*bench().color, order, bench().pool.drawn_luminance); };
  return out;
}

Line variance_line(const Order& order) {
  FilmOptions options = options_of(kWidth, kHeight);
  options.statistics = PixelStatistics::kVariance;
  return film_line(
      "spectile, variance", order, bench().variance, options, kBatch,
      [](const Order& o, std::size_t i, std::size_t at, std::size_t n) {
        need(bench().variance->add(samples_of(o, bench().pool, i, at, n)));
      },
      2);
}

Line bucket_line(const Order& order) {
  FilmOptions options = options_of(kBucketWidth, kBucketHeight);
  options.spectral = true;
  Line out = film_line(
      "spectile, 60 buckets", order, bench().buckets, options, kBatch,
      [](const Order& o, std::size_t i, std::size_t at, std::size_t n) {
        need(bench().buckets->add(samples_of(o, bench().pool, i, at, n)));
      },
      1 + kWavelengths);
  out.error = [&order, bands = options.bands] {
    FilmDevelopment spectrum = need(FilmDevelopment::create(*bench().buckets, FilmLayer::kSpectrum));
    need(spectrum.update({1}));
    return worst_bucket_error(order, bench().pool, bands, true,
                              [&](int x, int y, std::size_t b) { return spectrum.at(b, x, y); });
  };
  return out;
}

Line splat_line(const Order& order) {
  FilmOptions options = options_of(kWidth, kHeight);
  options.placement = SamplePlacement::kSplat;
  options.filter = bench().mitchell;
  Line out = film_line("spectile, splat mitchell 2", order, bench().splat, options, kBatch,
                       [](const Order& o, std::size_t i, std::size_t at, std::size_t n) {
                         need(bench().splat->add(samples_of(o, bench().pool, i, at, n)));
                       });
  out.error = [&order] {
    FilmDevelopment y = need(FilmDevelopment::create(*bench().splat, FilmLayer::kLuminance));
    need(y.update({1}));
    return worst_splat_error(order, bench().pool.luminance, bench().mitchell,
                             [&](int px, int py) { return y.at(0, px, py); });
  };
  return out;
}

Line band_input_line(const Order& order) {
  FilmOptions options = options_of(kWidth, kHeight);
  options.input = FilmInput::kBands;
  Line out =
      film_line("spectile, 60-band input", order, bench().band_input, options, kBatch,
                [](const Order& o, std::size_t i, std::size_t at, std::size_t n) {
                  const BandPool& pool = bench().bands;
                  need(bench().band_input->add(BandSamples{
                      {&o.x[i], n}, {&o.y[i], n}, {}, {&pool.radiance[at], pool.bands.count(), kPool}}));
                });
  out.error = [&order] { return film_error(*bench().band_input, order, bench().bands.luminance); };
  return out;
}

}  // namespace

void add_films(std::vector<Line>& lines) {
  Bench& b = bench();
  for (const Order* const order : {&b.tile1, &b.tile4, &b.tile16, &b.scanline, &b.random}) {
    lines.push_back(color_line("spectile", *order));
  }
  for (const Order* const order : {&b.tile4, &b.random}) {
    lines.push_back(color_line("spectile, batches of 512", *order, kSmallBatch));
    lines.push_back(color_line("spectile, batches of 65536", *order, kLargeBatch));
    lines.push_back(drawing_line(*order));
    lines.push_back(variance_line(*order));
    if (std::thread::hardware_concurrency() > 1) lines.push_back(threads_line(*order));
  }
  for (const Order* const order : {&b.bucket_tile, &b.bucket_random}) lines.push_back(bucket_line(*order));
  lines.push_back(band_input_line(b.quarter));
  lines.push_back(splat_line(b.quarter));
}

}  // namespace bench
