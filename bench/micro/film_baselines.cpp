// Films that ours is measured against, and what all share.
#include "bench/micro/film_lines.hpp"
#include "src/dispatch/dispatch.hpp"

namespace bench {

using namespace spectile;
using report::need;

Bench& bench() {
  static Bench b;
  return b;
}

Line line_of(std::string name, const Order& order, std::size_t bytes_per_pixel, std::size_t lines) {
  // A float each for x and y; a pixel's cache lines are read and written back. Samples at random move whole
  // lines; those that go by tile or scanline share them with their neighbours.
  constexpr double kPositionBytes = 8;
  constexpr double kLineBytes = 64;
  const double whole = static_cast<double>(lines) * kLineBytes;
  const double shared = static_cast<double>(bytes_per_pixel) / static_cast<double>(order.per_visit);
  Line out;
  out.name = std::move(name);
  out.order = order.name;
  out.samples = static_cast<double>(order.size());
  out.bytes_per_pixel = bytes_per_pixel;
  out.bytes = kPositionBytes + 2 * (order.name == "random" ? whole : std::min(whole, shared));
  return out;
}

FilmOptions options_of(int width, int height) {
  FilmOptions out;
  out.width = width;
  out.height = height;
  return out;
}

WavelengthSamples samples_of(const Order& order, const Pool& pool, std::size_t i, std::size_t at,
                             std::size_t n) {
  return {{&order.x[i], n},
          {&order.y[i], n},
          {},
          {&pool.radiance[at], kWavelengths, pool.stride},
          {&pool.lambda_nm[at], kWavelengths, pool.stride},
          {&pool.density[at], kWavelengths, pool.stride}};
}

namespace {

// The textbook's.

using TextbookAdd = void (textbook::Film::*)(const float*, const float*, const textbook::FilmSample*,
                                             std::size_t);

Line textbook_line(std::string name, const Order& order, TextbookAdd add) {
  Line out = line_of(std::move(name), order, sizeof(textbook::FilmPixel));
  out.fresh = [] { bench().text = make_textbook_film(kWidth, kHeight); };
  out.pass = [&order, add] {
    batches(0, order.size(), kBatch, [&](std::size_t i, std::size_t at, std::size_t n) {
      (bench().text.*add)(&order.x[i], &order.y[i], &bench().pool.textbook[at], n);
    });
  };
  out.error = [&order] {
    return worst_error(order, bench().pool.luminance, [](int x, int y) {
      const auto& pixel = bench().text.pixels[static_cast<std::size_t>(y * kWidth + x)];
      return pixel.rgb[1] / pixel.weight;
    });
  };
  return out;
}

Line textbook_drawing(const Order& order) {
  Line out = textbook_line("textbook, drawing", order, nullptr);
  out.pass = [&order] {
    batches(0, order.size(), kBatch, [&](std::size_t i, std::size_t at, std::size_t n) {
      bench().text.add_drawing(&order.x[i], &order.y[i], &bench().pool.u[at], &bench().pool.textbook[at], n);
    });
  };
  out.error = [&order] {
    return worst_error(order, bench().pool.drawn_luminance, [](int x, int y) {
      const auto& pixel = bench().text.pixels[static_cast<std::size_t>(y * kWidth + x)];
      return pixel.rgb[1] / pixel.weight;
    });
  };
  return out;
}

Line textbook_buckets(const Order& order) {
  const Bands bands;
  const std::size_t bytes =
      sizeof(textbook::FilmPixel) + bands.count() * sizeof(textbook::BucketFilm::Bucket);
  Line out = line_of("textbook, 60 buckets", order, bytes, 1 + kWavelengths);
  out.fresh = [bands] {
    textbook::BucketFilm& film = bench().text_buckets;
    film.color = make_textbook_film(kBucketWidth, kBucketHeight);
    film.buckets = static_cast<int>(bands.count());
    film.first_nm = static_cast<float>(bands.list().front().lower_nm);
    film.last_nm = static_cast<float>(bands.list().back().upper_nm);
    film.sums.assign(film.color.pixels.size() * bands.count(), {});
  };
  out.pass = [&order] {
    batches(0, order.size(), kBatch, [&](std::size_t i, std::size_t at, std::size_t n) {
      bench().text_buckets.add(&order.x[i], &order.y[i], &bench().pool.textbook[at], n);
    });
  };
  out.error = [&order, bands] {
    return worst_bucket_error(order, bench().pool, bands, false, [&](int x, int y, std::size_t b) {
      const auto& bucket =
          bench().text_buckets.sums[static_cast<std::size_t>(y * kBucketWidth + x) * bands.count() + b];
      return bucket.sum / bucket.weight;
    });
  };
  return out;
}

// Ours, with ordinary sums.

Line plain_line(const Order& order) {
  Line out = line_of("plain doubles", order, 4 * sizeof(double));
  out.fresh = [] {
    Bench& b = bench();
    b.like = std::make_unique<Film>(need(Film::create(options_of(kWidth, kHeight))));
    b.plain = std::make_unique<PlainFilm>(*b.like, *need(dispatch::active()));
  };
  out.pass = [&order] {
    batches(0, order.size(), kBatch, [&](std::size_t i, std::size_t at, std::size_t n) {
      bench().plain->add(samples_of(order, bench().pool, i, at, n));
    });
  };
  out.error = [&order] {
    return worst_error(order, bench().pool.luminance,
                       [](int x, int y) { return bench().plain->at(x, y, 1); });
  };
  return out;
}

}  // namespace

void add_baselines(std::vector<Line>& lines) {
  Bench& b = bench();
  for (const Order* const order : {&b.tile1, &b.tile4, &b.tile16, &b.scanline, &b.random}) {
    lines.push_back(textbook_line("textbook", *order, &textbook::Film::add));
    lines.push_back(textbook_line("textbook, hand-tuned", *order, &textbook::Film::add_tuned));
    lines.push_back(plain_line(*order));
  }
  for (const Order* const order : {&b.tile4, &b.random}) lines.push_back(textbook_drawing(*order));
  for (const Order* const order : {&b.bucket_tile, &b.bucket_random}) {
    lines.push_back(textbook_buckets(*order));
  }
}

}  // namespace bench
