// One thread, 60 bands: the library against the textbook's way and against this machine's own limits, in one
// run, its benchmarks interleaved at random, with the error against double beside every speed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <spectile/spectile.hpp>
#include <string>
#include <vector>

#include "bench/micro/machine.hpp"
#include "bench/micro/report.hpp"
#include "bench/micro/textbook.hpp"
#include "src/data/tables.hpp"
#include "src/reference/oracle/oracle.hpp"

namespace {

using namespace spectile;
using report::Line;
using report::need;

constexpr std::size_t kBands = 60;
// 46 blocks of 15 KiB: with their RGB or XYZ within a second-level cache of 1 MiB and more.
constexpr std::size_t kLanes = 46 * kLanesPerBlock;
// Three arrays (two for the copy) that together fill the same 690 KiB.
constexpr std::size_t kThirdLanes = kLanes / 3 / kLanesPerBlock * kLanesPerBlock;
constexpr std::size_t kHalfLanes = kLanes / 2 / kLanesPerBlock * kLanesPerBlock;
// 1 GiB of spectra.
constexpr std::size_t kLargeLanes = (std::size_t{1} << 30) / (kBands * sizeof(float)) / 4096 * 4096;

const Execution kOneThread = {1, std::size_t{1} << 31};

ColorLanes random_rgb(std::size_t lanes) {
  ColorLanes rgb = need(ColorLanes::create(lanes));
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = uniform(engine);
  }
  return rgb;
}

/// Everything the benchmarks work on.
struct Bench {
  Bands bands;
  Upsampler upsampler = need(Upsampler::create(Method::kSmits, Quantity::kReflectance, bands));
  Projector projector = need(Projector::reflective(bands, need(illuminant("D65"))));
  ColorLanes rgb = random_rgb(kLanes);
  SampledSpectra spectra = need(SampledSpectra::create(bands, kLanes));
  ColorLanes xyz = need(ColorLanes::create(kLanes));
  ScalarLanes y = need(ScalarLanes::create(kLanes));
  SampledSpectra a = need(SampledSpectra::create(bands, kHalfLanes));
  SampledSpectra b = need(SampledSpectra::create(bands, kHalfLanes));
  SampledSpectra c = need(SampledSpectra::create(bands, kThirdLanes));
  SampledSpectra d = need(SampledSpectra::create(bands, kThirdLanes));
  SampledSpectra e = need(SampledSpectra::create(bands, kThirdLanes));
  ColorLanes large_rgb = random_rgb(kLargeLanes);
  SampledSpectra large = need(SampledSpectra::create(bands, kLargeLanes));
  textbook::Tables tables{};
  std::vector<float> aos_rgb, aos_xyz, aos_y;
  std::vector<textbook::SampledSpectrum> aos, aos_c, aos_d, aos_e;

  Bench() {
    need(upsample_srgb(upsampler, rgb.view(), spectra.span()));
    fill_tables();
    aos_rgb.resize(3 * kLanes);
    for (std::size_t i = 0; i < kLanes; ++i) {
      for (std::size_t k = 0; k < 3; ++k) aos_rgb[3 * i + k] = rgb.at(i, k);
    }
    aos.resize(kLanes);
    aos_xyz.resize(3 * kLanes);
    aos_y.resize(kLanes);
    textbook::upsample(tables, aos_rgb.data(), aos.data(), kLanes);
    for (std::size_t i = 0; i < kThirdLanes; ++i) {
      for (std::size_t k = 0; k < kBands; ++k) {
        c.set(i, k, spectra.at(i, k));
        d.set(i, k, spectra.at(kLanes - 1 - i, k));
      }
    }
    aos_c.assign(aos.begin(), aos.begin() + kThirdLanes);
    aos_d.assign(aos.rbegin(), aos.rbegin() + kThirdLanes);
    aos_e.resize(kThirdLanes);
  }

  void fill_tables() {
    const auto basis = upsampler.basis();
    const double scale = spectile::data::kSmitsReflectance.scale;
    textbook::SampledSpectrum* const spectra_of[7] = {&tables.white,  &tables.cyan, &tables.magenta,
                                                      &tables.yellow, &tables.red,  &tables.green,
                                                      &tables.blue};
    for (std::size_t b_ = 0; b_ < kBands; ++b_) {
      for (std::size_t k = 0; k < 7; ++k) spectra_of[k]->c[b_] = static_cast<float>(basis[b_][k] / scale);
      tables.x.c[b_] = static_cast<float>(projector.weights()[b_][0]);
      tables.y.c[b_] = static_cast<float>(projector.weights()[b_][1]);
      tables.z.c[b_] = static_cast<float>(projector.weights()[b_][2]);
    }
    tables.scale = static_cast<float>(scale);
  }
};

Bench& bench() {
  static Bench* const instance = new Bench;
  return *instance;
}

double error_of_upsampling(const std::function<float(std::size_t, std::size_t)>& sample) {
  Bench& s = bench();
  const auto basis = oracle::smits_basis(Method::kSmits, Quantity::kReflectance, s.bands);
  double most = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::array<double, 3> rgb = {s.rgb.at(i, 0), s.rgb.at(i, 1), s.rgb.at(i, 2)};
    const auto truth = oracle::smits_spectrum(basis, rgb, 0.0);
    const double size = *std::max_element(rgb.begin(), rgb.end());
    for (std::size_t b = 0; b < kBands; ++b) {
      most = std::max(most, std::abs(static_cast<double>(sample(i, b)) - truth[b]) / size);
    }
  }
  return most;
}

/// Of the XYZ (or its Y alone) of the batch against double, relative to the component.
double error_of_projection(std::size_t first, std::size_t last,
                           const std::function<float(std::size_t, std::size_t)>& got) {
  Bench& s = bench();
  const MeasuredSpectrum d65 = need(illuminant("D65"));
  static const auto weights = oracle::projection_weights(s.bands, Observer::kCie1931, &d65);
  double most = 0;
  std::vector<double> spectrum(kBands);
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t b = 0; b < kBands; ++b) spectrum[b] = s.spectra.at(i, b);
    const auto truth = oracle::project(weights, spectrum);
    for (std::size_t k = first; k < last; ++k) {
      most = std::max(most, std::abs(static_cast<double>(got(i, k)) - truth[k]) / truth[k]);
    }
  }
  return most;
}

std::vector<Line> lines() {
  const auto n = static_cast<double>(kLanes);
  const double spectrum = kBands * sizeof(float);
  const auto third = static_cast<double>(kThirdLanes);
  const auto half = static_cast<double>(kHalfLanes);
  const auto large = static_cast<double>(kLargeLanes);
  return {
      {"textbook upsample", n, n * (spectrum + 12),
       [] { textbook::upsample(bench().tables, bench().aos_rgb.data(), bench().aos.data(), kLanes); },
       [] { return error_of_upsampling([](std::size_t i, std::size_t b) { return bench().aos[i].c[b]; }); },
       "", false, 0},
      {"spectile upsample", n, n * (spectrum + 12),
       [] {
         need(upsample_srgb(bench().upsampler, bench().rgb.view(), bench().spectra.span(), StoreHint::kCached,
                            kOneThread));
       },
       [] {
         return error_of_upsampling([](std::size_t i, std::size_t b) { return bench().spectra.at(i, b); });
       },
       "textbook upsample", false, 8},
      {"textbook, loops fused", n, n * (spectrum + 12),
       [] { textbook::upsample_fused(bench().tables, bench().aos_rgb.data(), bench().aos.data(), kLanes); },
       [] { return error_of_upsampling([](std::size_t i, std::size_t b) { return bench().aos[i].c[b]; }); },
       "textbook upsample", false, 0},
      {"textbook XYZ", n, n * (spectrum + 12),
       [] { textbook::project(bench().tables, bench().aos.data(), bench().aos_xyz.data(), kLanes); },
       [] {
         return error_of_projection(0, 3,
                                    [](std::size_t i, std::size_t k) { return bench().aos_xyz[3 * i + k]; });
       },
       "", false, 0},
      {"spectile XYZ", n, n * (spectrum + 12),
       [] { need(project(bench().projector, bench().spectra.view(), bench().xyz.span(), kOneThread)); },
       [] {
         return error_of_projection(0, 3, [](std::size_t i, std::size_t k) { return bench().xyz.at(i, k); });
       },
       "textbook XYZ", false, 10},
      {"textbook luminance", n, n * (spectrum + 4),
       [] { textbook::luminance(bench().tables, bench().aos.data(), bench().aos_y.data(), kLanes); },
       [] { return error_of_projection(1, 2, [](std::size_t i, std::size_t) { return bench().aos_y[i]; }); },
       "", false, 0},
      {"spectile luminance", n, n * (spectrum + 4),
       [] { need(luminance(bench().projector, bench().spectra.view(), bench().y.span(), kOneThread)); },
       [] { return error_of_projection(1, 2, [](std::size_t i, std::size_t) { return bench().y[i]; }); },
       "textbook luminance", false, 8},
      {"machine: copy in L2", half, 2 * half * spectrum,
       [] { machine::copy(bench().b.span().data, bench().a.view().data, kHalfLanes * kBands); }, nullptr, "",
       false, 0},
      {"textbook multiply", third, 3 * third * spectrum,
       [] {
         textbook::multiply(bench().aos_c.data(), bench().aos_d.data(), bench().aos_e.data(), kThirdLanes);
       },
       nullptr, "", false, 0},
      {"spectile multiply", third, 3 * third * spectrum,
       [] { need(multiply(bench().c.view(), bench().d.view(), bench().e.span(), kOneThread)); },
       [] {
         double most = 0;
         for (std::size_t i = 0; i < kThirdLanes; ++i) {
           for (std::size_t b = 0; b < kBands; ++b) {
             const double truth =
                 static_cast<double>(bench().c.at(i, b)) * static_cast<double>(bench().d.at(i, b));
             if (truth > 0) most = std::max(most, std::abs(bench().e.at(i, b) - truth) / truth);
           }
         }
         return most;
       },
       "machine: copy in L2", true, 0.8},
      {"machine: streaming stores", large, large * spectrum,
       [] { machine::stream_fill(bench().large.span().data, 0.5F, kLargeLanes * kBands); }, nullptr, "",
       false, 0},
      {"machine: ordinary stores", large, large * spectrum,
       [] { machine::fill(bench().large.span().data, 0.5F, kLargeLanes * kBands); }, nullptr, "", false, 0},
      {"upsample to DRAM, cached", large, large * spectrum,
       [] {
         need(upsample_srgb(bench().upsampler, bench().large_rgb.view(), bench().large.span(),
                            StoreHint::kCached, kOneThread));
       },
       nullptr, "machine: streaming stores", true, 0},
      {"upsample to DRAM", large, large * spectrum,
       [] {
         need(upsample_srgb(bench().upsampler, bench().large_rgb.view(), bench().large.span(),
                            StoreHint::kAuto, kOneThread));
       },
       [] {
         // The same seed starts both batches, so the first lanes are those of the small one.
         return error_of_upsampling([](std::size_t i, std::size_t b) { return bench().large.at(i, b); });
       },
       "machine: streaming stores", true, 0.8},
  };
}

}  // namespace

int main(int argc, char** argv) {
  bench();
  return report::run(argc, argv, lines(),
                     fmt::format("one thread, {} bands, kernels {}, {} lanes in L2, {} lanes in DRAM", kBands,
                                 need(active_isa()), kLanes, kLargeLanes));
}
