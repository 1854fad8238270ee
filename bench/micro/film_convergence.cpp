// How the film's error falls with samples: procedural scenes of known truth, for 1, 4 and 8 wavelengths a
// sample, drawn evenly and as the eye sees. Without bias errors fall as one over the root of the samples: 1
// is returned where a slope is another. usage: spectile_bench_convergence [PLOT.svg]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <spectile/spectile.hpp>

#include "bench/micro/line_plot.hpp"
#include "bench/micro/or_exit.hpp"
#include "bench/micro/report.hpp"

namespace {

using namespace spectile;
using report::need;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr std::uint64_t kPixels = std::uint64_t{kWidth} * kHeight;
constexpr int kMaxLog2 = 12;  // 4096 samples a pixel
constexpr std::uint64_t kBatch = 16384;
/// Unbiased and independent, errors have slope -0.5; what is left is the chance in 3072 pixels.
constexpr double kSlope = -0.5;
constexpr double kSlopeTolerance = 0.03;
/// Films a line, so that chance leaves well below that; more for the scene whose brightest few pixels, of
/// nine decades, make up all of its error.
constexpr std::uint64_t kRuns = 3;
constexpr std::uint64_t kWideRuns = 16;
constexpr const char* kWideScene = "mixed";
/// Bands of the spectrum, wide ones: a band's value is a mean of those samples that fell into it, for which
/// the law holds where there are more than a few.
constexpr double kBandNm = 30;
constexpr double kFewHits = 60;

/// One way of sampling one scene: an error for each power of two.
struct Series {
  std::string scene;
  WavelengthSampling density;
  std::size_t wavelengths;
  std::vector<double> samples, xyz;
  std::size_t first_bucket = 0;  ///< number of samples that the bands' errors begin at
  std::vector<double> buckets;
  double xyz_slope = 0, bucket_slope = 0;
};

const char* name_of(WavelengthSampling density) {
  return density == WavelengthSampling::kUniform ? "uniform" : "visible";
}

/// Of log y over log x, by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0;
  double mean_y = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double xy = 0;
  double xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
    xx += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
  }
  return xy / xx;
}

/// Exact planes of a scene: XYZ, and bands.
struct Truth {
  std::vector<std::vector<double>> xyz, spectrum;
  double luminance = 0, radiance = 0;  // means

  Truth(const ProceduralScene& scene, const FilmOptions& options) : xyz(3), spectrum(options.bands.count()) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto color = scene.xyz(options, x, y);
        for (std::size_t c = 0; c < 3; ++c) xyz[c].push_back(color[c]);
        luminance += color[1] / kPixels;
        const auto bands = scene.spectrum(options, x, y);
        for (std::size_t b = 0; b < bands.size(); ++b) {
          spectrum[b].push_back(bands[b]);
          radiance += bands[b] / static_cast<double>(kPixels * bands.size());
        }
      }
    }
  }
};

/// Mean square over pixels and planes.
double square_error(const Film& film, FilmLayer layer, const std::vector<std::vector<double>>& truth) {
  FilmDevelopment developed = need(FilmDevelopment::create(film, layer));
  need(developed.update());
  double squares = 0;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    for (std::size_t i = 0; i < kPixels; ++i) {
      const double d =
          developed.at(p, static_cast<int>(i % kWidth), static_cast<int>(i / kWidth)) - truth[p][i];
      squares += d * d;
    }
  }
  return squares / static_cast<double>(kPixels * truth.size());
}

/// Adds `count` samples a pixel.
void add(Film& film, const ProceduralScene& scene, const SceneSampling& base, std::uint64_t count,
         std::uint64_t seed, SceneBatch& batch) {
  SceneSampling sampling = base;
  sampling.samples_per_pixel = count;
  sampling.seed = seed;
  const std::uint64_t run = std::min(kPixels, kBatch / count);
  for (std::uint64_t first = 0; first < kPixels; first += run) {
    need(scene.draw(film.options(), sampling, first, std::min(run, kPixels - first), batch));
    need(film.add(batch.wavelength_samples()));
  }
}

/// One film from the first sample to the last, adding its errors' squares to the series.
void run(const ProceduralScene& scene, const Truth& truth, const FilmOptions& options, std::uint64_t number,
         Series& s) {
  Film film = need(Film::create(options));
  SceneBatch batch = need(SceneBatch::create(kBatch, s.wavelengths, true));
  SceneSampling sampling;
  sampling.wavelengths = s.wavelengths;
  sampling.density = s.density;
  for (std::size_t step = 0; step < s.samples.size(); ++step) {
    // Each step doubles what is there, by samples of a seed of their own.
    const auto now = static_cast<std::uint64_t>(s.samples[step]);
    const std::uint64_t before = step == 0 ? 0 : now / 2;
    add(film, scene, sampling, now - before, 1 + number * s.samples.size() + step, batch);
    s.xyz[step] += square_error(film, FilmLayer::kXyz, truth.xyz);
    if (step < s.first_bucket) continue;
    s.buckets[step - s.first_bucket] += square_error(film, FilmLayer::kSpectrum, truth.spectrum);
  }
}

void measure(const ProceduralScene& scene, const Truth& truth, const FilmOptions& options, Series& s) {
  for (int log2 = 0; log2 <= kMaxLog2; ++log2) {
    s.samples.push_back(std::ldexp(1.0, log2));
    const double hits =
        s.samples.back() * static_cast<double>(s.wavelengths) * kBandNm / (kLastVisibleNm - kFirstVisibleNm);
    if (hits < kFewHits) ++s.first_bucket;
  }
  s.xyz.resize(s.samples.size());
  s.buckets.resize(s.samples.size() - s.first_bucket);
  const std::uint64_t runs = s.scene == kWideScene ? kWideRuns : kRuns;
  for (std::uint64_t number = 0; number < runs; ++number) run(scene, truth, options, number, s);
  for (double& v : s.xyz) v = std::sqrt(v / static_cast<double>(runs)) / truth.luminance;
  for (double& v : s.buckets) v = std::sqrt(v / static_cast<double>(runs)) / truth.radiance;
  s.xyz_slope = slope(s.samples, s.xyz);
  s.bucket_slope =
      slope({s.samples.begin() + static_cast<std::ptrdiff_t>(s.first_bucket), s.samples.end()}, s.buckets);
}

bool within(double v) {
  return std::abs(v - kSlope) <= kSlopeTolerance;
}

void print(const Series& s) {
  fmt::print("{:<10} {:<8} {:>2} ", s.scene, name_of(s.density), s.wavelengths);
  for (const int log2 : {0, 4, 8, kMaxLog2}) fmt::print(" {:>9.2e}", s.xyz[static_cast<std::size_t>(log2)]);
  fmt::print(" {:>7.3f} {:<6}   {:>9.2e} {:>7.3f} {:<6}\n", s.xyz_slope,
             within(s.xyz_slope) ? "met" : "MISSED", s.buckets.back(), s.bucket_slope,
             within(s.bucket_slope) ? "met" : "MISSED");
}

/// How many times fewer samples the better density needs, by the mean over all counts.
void compare(const Series& uniform, const Series& visible) {
  double log_ratio = 0;
  for (std::size_t i = 0; i < uniform.xyz.size(); ++i) {
    log_ratio += 2 * std::log(uniform.xyz[i] / visible.xyz[i]) / static_cast<double>(uniform.xyz.size());
  }
  const double ratio = std::exp(log_ratio);
  fmt::print("{:<10} {:>2} wavelengths: {} is better, its variance {:.2f} times lower\n", uniform.scene,
             uniform.wavelengths, ratio >= 1 ? "visible" : "uniform", std::max(ratio, 1 / ratio));
}

// Colours that are told apart by those who see red and green alike. Source: Okabe, Ito, Color Universal
// Design, 2008.
const char* color_of(std::size_t wavelengths) {
  return wavelengths == 1 ? "#0072b2" : wavelengths == 4 ? "#d55e00" : "#009e73";
}

void write_plot(const char* path, const std::vector<Series>& all) {
  bench::Plot plot;
  plot.title = "Error of XYZ against the exact picture";
  plot.x_label = "samples a pixel";
  plot.y_label = "root mean square error / mean luminance";
  plot.x1 = std::ldexp(1.0, kMaxLog2);
  plot.y0 = plot.y1 = all[0].xyz[0];
  for (const Series& s : all) {
    plot.y0 = std::min(plot.y0, *std::min_element(s.xyz.begin(), s.xyz.end()));
    plot.y1 = std::max(plot.y1, *std::max_element(s.xyz.begin(), s.xyz.end()));
  }
  plot.y0 /= 1.4;
  plot.y1 *= 1.4;
  for (const std::size_t k : {1, 4, 8}) {
    plot.keys.push_back(
        {fmt::format("{} wavelength{}", k, k == 1 ? "" : "s"), {color_of(k), false, false, {}, {}}});
  }
  plot.keys.push_back({"uniform", {"#202020", false, false, {}, {}}});
  plot.keys.push_back({"visible", {"#202020", true, false, {}, {}}});
  // Below the lines, down to the picture's end.
  constexpr double kGuide = 0.02;
  const double guide_end = std::min(plot.x1, std::pow(kGuide / plot.y0, 2));
  const bench::PlotLine guide{
      "#606060", false, true, {1.0, guide_end}, {kGuide, kGuide / std::sqrt(guide_end)}};
  plot.keys.push_back({"slope \xE2\x88\x92\xC2\xBD", guide});
  for (const Series& s : all) {
    if (plot.panels.empty() || plot.panels.back().title != s.scene) plot.panels.push_back({s.scene, {guide}});
    plot.panels.back().lines.push_back(
        {color_of(s.wavelengths), s.density == WavelengthSampling::kVisible, false, s.samples, s.xyz});
  }
  bench::write_or_exit(path, bench::to_svg(plot));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    fmt::print(stderr, "usage: {} [PLOT.svg]\n", argv[0]);
    return 2;
  }
  FilmOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.spectral = true;
  options.bands = need(Bands::uniform(400, 700, kBandNm));
  fmt::print(
      "{} x {} pixels; errors of XYZ relative to the mean luminance, of bands of {} nm to the mean "
      "radiance; slopes of log error over log samples, {} +- {} expected\n\n",
      kWidth, kHeight, kBandNm, kSlope, kSlopeTolerance);
  fmt::print("{:<10} {:<8} {:>2}  {:>9} {:>9} {:>9} {:>9} {:>7} {:<6}   {:>9} {:>7}\n", "scene", "drawn", "K",
             "1", "16", "256", "4096", "slope", "", "bands", "slope");
  std::vector<Series> all;
  int missed = 0;
  for (const char* const name : {"gradients", "edges", "spikes", "mixed"}) {
    const ProceduralScene scene = need(ProceduralScene::named(name));
    const Truth truth(scene, options);
    for (const std::size_t k : {1, 4, 8}) {
      for (const auto density : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
        Series s{name, density, k, {}, {}, 0, {}};
        measure(scene, truth, options, s);
        print(s);
        std::fflush(stdout);
        missed += (within(s.xyz_slope) ? 0 : 1) + (within(s.bucket_slope) ? 0 : 1);
        all.push_back(std::move(s));
      }
    }
  }
  fmt::print("\n");
  for (std::size_t i = 0; i < all.size(); i += 2) compare(all[i], all[i + 1]);
  if (argc == 2) write_plot(argv[1], all);
  return missed == 0 ? 0 : 1;
}
