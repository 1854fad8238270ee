// One thread, 60 bands, in the second-level cache: the exact methods, the sigmoid's search and relighting,
// against the textbook's way and the best public figures, with the error against double beside every speed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <spectile/spectile.hpp>
#include <vector>

#include "bench/micro/machine.hpp"
#include "bench/micro/report.hpp"
#include "bench/micro/textbook.hpp"
#include "src/data/tables.hpp"
#include "src/upsampling/sigmoid_search.hpp"

namespace {

using namespace spectile;
using report::Line;
using report::need;

constexpr std::size_t kBands = 60;
// 46 blocks of 15 KiB: with their RGB within a second-level cache of 1 MiB and more.
constexpr std::size_t kLanes = 46 * kLanesPerBlock;
constexpr std::size_t kMultiplyAdds = std::size_t{1} << 20;
// Of rgb2spec on an AVX-512 machine like this one: a look-up with interpolation, then 60 wavelengths at once.
constexpr double kPublicEvaluationNs = 86;

const Execution kOneThread = {1, std::size_t{1} << 31};

/// A method, and what it takes to relight with it.
struct Way {
  Upsampler upsampler;
  Relighter relighter;
  Way(Method method, const Projector& under, const Matrix3& matrix)
      : upsampler(need(Upsampler::create(method, Quantity::kReflectance, Bands()))),
        relighter(need(Relighter::create(upsampler, under, matrix))) {}
};

/// Everything the benchmarks work on.
struct Bench {
  Bands bands;
  MeasuredSpectrum light = need(illuminant("A"));
  Projector under = need(Projector::reflective(bands, light));
  Projector matching = need(Projector::emissive(bands));
  Way smits{Method::kSmits, under, under.xyz_to_srgb()};
  Way exact{Method::kSmitsExact, under, under.xyz_to_srgb()};
  Way mallett{Method::kMallett, under, under.xyz_to_srgb()};
  Way sigmoid{Method::kSigmoid, under, under.xyz_to_srgb()};
  ColorLanes rgb = need(ColorLanes::create(kLanes));
  ColorLanes out = need(ColorLanes::create(kLanes));
  SampledSpectra spectra = need(SampledSpectra::create(bands, kLanes));
  CoefficientLanes found = need(CoefficientLanes::create(sigmoid.upsampler, kLanes));
  textbook::Tables tables{};
  textbook::SampledSpectrum lit{};
  float matrix[9];
  std::vector<float> aos_rgb, aos_out;

  Bench() {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    for (std::size_t i = 0; i < kLanes; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        rgb.at(i, k) = uniform(engine);
        aos_rgb.push_back(rgb.at(i, k));
      }
    }
    aos_out.resize(3 * kLanes);
    need(coefficients(sigmoid.upsampler, rgb.view(), found, kOneThread));
    for (std::size_t k = 0; k < 9; ++k) matrix[k] = static_cast<float>(under.xyz_to_srgb()[k]);
    const double scale = data::kSmitsReflectance.scale;
    textbook::SampledSpectrum* const spectra_of[7] = {&tables.white,  &tables.cyan, &tables.magenta,
                                                      &tables.yellow, &tables.red,  &tables.green,
                                                      &tables.blue};
    const std::vector<float> averages = light.average_over(bands);
    double luminance = 0;
    for (std::size_t b = 0; b < kBands; ++b) luminance += matching.weights()[b][1] * averages[b];
    for (std::size_t b = 0; b < kBands; ++b) {
      for (std::size_t k = 0; k < 7; ++k) {
        spectra_of[k]->c[b] = static_cast<float>(smits.upsampler.basis()[b][k] / scale);
      }
      lit.c[b] = static_cast<float>(averages[b] / luminance);
      tables.x.c[b] = static_cast<float>(matching.weights()[b][0]);
      tables.y.c[b] = static_cast<float>(matching.weights()[b][1]);
      tables.z.c[b] = static_cast<float>(matching.weights()[b][2]);
    }
    tables.scale = static_cast<float>(scale);
  }
};

Bench& bench() {
  static Bench* const instance = new Bench;
  return *instance;
}

/// A colour under the light in double: the spectrum by the method's definition, then its sums.
std::array<double, 3> relit(const Way& way, const std::array<double, 3>& rgb) {
  Bench& s = bench();
  std::vector<double> spectrum(kBands);
  if (way.upsampler.method() == Method::kSigmoid) {
    static const WorkingSpace space = need(
        working_space(s.bands, Quantity::kReflectance, kRec709, need(illuminant("D65")), Observer::kCie1931));
    static const SigmoidSums sums(s.bands, space);
    Triple c{};
    sums.solve_from_grey(rgb, c);
    for (std::size_t b = 0; b < kBands; ++b) {
      const double l = (s.bands[b].centre_nm - 550) / 150;
      const double x = (c[0] * l + c[1]) * l + c[2];
      spectrum[b] = 0.5 + x / (2 * std::sqrt(1 + x * x));
    }
  } else {
    std::array<double, 3> sorted = rgb;
    std::sort(sorted.begin(), sorted.end());
    const auto least = static_cast<std::size_t>(std::min_element(rgb.begin(), rgb.end()) - rgb.begin());
    const auto most = static_cast<std::size_t>(std::max_element(rgb.begin(), rgb.end()) - rgb.begin());
    for (std::size_t b = 0; b < kBands; ++b) {
      const auto& row = way.upsampler.basis()[b];
      const double v = sorted[0] * row[0] + (sorted[1] - sorted[0]) * row[1 + least] +
                       (sorted[2] - sorted[1]) * row[4 + most];
      spectrum[b] = std::max(0.0, v);
    }
  }
  std::array<double, 3> xyz{};
  for (std::size_t b = 0; b < kBands; ++b) {
    for (std::size_t k = 0; k < 3; ++k) xyz[k] += s.under.weights()[b][k] * spectrum[b];
  }
  return times(s.under.xyz_to_srgb(), xyz);
}

/// Largest error of a component over the largest component.
template <class Got>
double error_of(const Way& way, Got got) {
  double most = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::array<double, 3> rgb = {bench().rgb.at(i, 0), bench().rgb.at(i, 1), bench().rgb.at(i, 2)};
    const auto truth = relit(way, rgb);
    const double size = *std::max_element(truth.begin(), truth.end());
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max(most, std::abs(static_cast<double>(got(i, k)) - truth[k]) / size);
    }
  }
  return most;
}

template <Way Bench::*way>
void run_relight() {
  need(relight((bench().*way).relighter, bench().rgb.view(), bench().out.span(), kOneThread));
}
template <Way Bench::*way>
double error_of_relight() {
  return error_of(bench().*way, [](std::size_t i, std::size_t k) { return bench().out.at(i, k); });
}
template <Way Bench::*way>
void run_upsample() {
  need(upsample_srgb((bench().*way).upsampler, bench().rgb.view(), bench().spectra.span(), StoreHint::kCached,
                     kOneThread));
}

/// Largest distance of the RGB that the spectra come back as, in double.
double error_of_round_trip() {
  Bench& s = bench();
  static const Projector d65 = need(Projector::reflective(s.bands, need(illuminant("D65"))));
  double most = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    std::array<double, 3> xyz{};
    for (std::size_t b = 0; b < kBands; ++b) {
      for (std::size_t k = 0; k < 3; ++k) {
        xyz[k] += d65.weights()[b][k] * static_cast<double>(s.spectra.at(i, b));
      }
    }
    const auto back = times(d65.xyz_to_srgb(), xyz);
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max(most, std::abs(back[k] - static_cast<double>(s.rgb.at(i, k))));
    }
  }
  return most;
}

double error_of_solve() {
  need(expand(bench().sigmoid.upsampler, bench().found, bench().spectra.span(), StoreHint::kCached,
              kOneThread));
  return error_of_round_trip();
}

std::vector<Line> lines() {
  const auto n = static_cast<double>(kLanes);
  const double spectrum = kBands * sizeof(float);
  return {
      {"machine: multiply-adds", static_cast<double>(kMultiplyAdds), 0,
       [] {
         volatile float sink = machine::multiply_adds(kMultiplyAdds);
         static_cast<void>(sink);
       },
       nullptr, "", false, 0},
      {"textbook relight", n, n * 24,
       [] {
         textbook::relight(bench().tables, bench().lit, bench().matrix, bench().aos_rgb.data(),
                           bench().aos_out.data(), kLanes);
       },
       [] {
         return error_of(bench().smits,
                         [](std::size_t i, std::size_t k) { return bench().aos_out[3 * i + k]; });
       },
       "", false, 0},
      {"relight smits-exact", n, n * 24, run_relight<&Bench::exact>, error_of_relight<&Bench::exact>,
       "textbook relight", false, 80},
      {"relight smits", n, n * 24, run_relight<&Bench::smits>, error_of_relight<&Bench::smits>,
       "textbook relight", false, 80},
      {"relight mallett", n, n * 24, run_relight<&Bench::mallett>, error_of_relight<&Bench::mallett>,
       "textbook relight", false, 80},
      {"relight sigmoid", n, n * 24, run_relight<&Bench::sigmoid>, error_of_relight<&Bench::sigmoid>,
       "textbook relight", false, 0},
      {"upsample smits", n, n * (spectrum + 12), run_upsample<&Bench::smits>, error_of_round_trip, "", false,
       0},
      {"upsample smits-exact", n, n * (spectrum + 12), run_upsample<&Bench::exact>, error_of_round_trip,
       "upsample smits", false, 0.95},
      {"upsample mallett", n, n * (spectrum + 12), run_upsample<&Bench::mallett>, error_of_round_trip,
       "upsample smits", false, 0},
      {"upsample sigmoid", n, n * (spectrum + 12), run_upsample<&Bench::sigmoid>, error_of_round_trip,
       "upsample smits", false, 0},
      {"sigmoid: solve", n, n * 24,
       [] { need(coefficients(bench().sigmoid.upsampler, bench().rgb.view(), bench().found, kOneThread)); },
       error_of_solve, "", false, 0, 50},
      {"sigmoid: evaluate", n, n * (spectrum + 12),
       [] {
         need(expand(bench().sigmoid.upsampler, bench().found, bench().spectra.span(), StoreHint::kCached,
                     kOneThread));
       },
       error_of_round_trip, "", false, 0, kPublicEvaluationNs / 4},
  };
}

}  // namespace

int main(int argc, char** argv) {
  bench();
  return report::run(argc, argv, lines(),
                     fmt::format("one thread, {} bands, kernels {}, {} lanes in L2, random colours", kBands,
                                 need(active_isa()), kLanes));
}
