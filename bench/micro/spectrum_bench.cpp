// One thread, in the second-level cache: looking spectra up at 4 and 8 random wavelengths a lane, against the
// textbook's loop, with the error against double beside every speed; and drawing and projecting wavelengths.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <spectile/spectile.hpp>
#include <vector>

#include "bench/micro/report.hpp"
#include "bench/micro/textbook_spectra.hpp"

namespace {

using namespace spectile;
using report::Line;
using report::need;

constexpr std::size_t kLanes = 64 * kLanesPerBlock;
constexpr double kTemperatureK = 5000;
const Execution kOneThread = {1, std::size_t{1} << 31};

struct Bench {
  Spectrum black = need(BlackbodySpectrum::create(kTemperatureK));
  Spectrum dense = need(DenselySampledSpectrum::from(black));
  Spectrum measured = PiecewiseLinearSpectrum(need(illuminant("FL11")));
  Upsampler upsampler = need(Upsampler::create(Method::kSigmoid, Quantity::kReflectance, Bands()));
  Spectrum sigmoid = need(rgb_albedo_spectrum(upsampler, {0.7, 0.3, 0.1}));
  SpectrumSampler samplers[4] = {
      need(SpectrumSampler::create(dense)), need(SpectrumSampler::create(measured)),
      need(SpectrumSampler::create(black)), need(SpectrumSampler::create(sigmoid))};
  textbook::Dense text_dense;
  textbook::PiecewiseLinear text_measured;
  textbook::Blackbody text_black{static_cast<float>(kTemperatureK)};
  textbook::Sigmoid text_sigmoid{};
  SampledWavelengths four = need(SampledWavelengths::create(kLanes, 4));
  SampledWavelengths eight = need(SampledWavelengths::create(kLanes, 8));
  WavelengthLanes values4 = need(WavelengthLanes::create(kLanes, 4));
  WavelengthLanes values8 = need(WavelengthLanes::create(kLanes, 8));
  ScalarLanes u = need(ScalarLanes::create(kLanes));
  ColorLanes xyz = need(ColorLanes::create(kLanes));
  ResponseCurves observer = need(ResponseCurves::of_observer());
  std::vector<float> aos_lambda, aos_values;  // [lane][8], of which the first half serves for 4

  Bench() {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    for (std::size_t i = 0; i < kLanes; ++i) u[i] = uniform(engine);
    need(sample_wavelengths(WavelengthSampling::kUniform, u.view(), four));
    need(sample_wavelengths(WavelengthSampling::kUniform, u.view(), eight));
    for (std::size_t i = 0; i < 8 * kLanes; ++i) aos_lambda.push_back(eight.lambda_nm.at(i / 8, i % 8));
    aos_values.resize(8 * kLanes);
    const auto& table = std::get<DenselySampledSpectrum>(dense.kind());
    text_dense.first_nm = table.first_nm();
    for (const double v : table.values()) text_dense.values.push_back(static_cast<float>(v));
    const auto& knots = std::get<PiecewiseLinearSpectrum>(measured.kind());
    for (const double nm : knots.wavelengths_nm())
      text_measured.wavelengths_nm.push_back(static_cast<float>(nm));
    for (const double v : knots.values()) text_measured.values.push_back(static_cast<float>(v));
    std::copy_n(std::get<UpsampledSpectrum>(sigmoid.kind()).coefficients().begin(), 3, text_sigmoid.c);
  }
};

Bench& bench() {
  static Bench b;
  return b;
}

const Spectrum& truth(std::size_t kind) {
  const Spectrum* const all[] = {&bench().dense, &bench().measured, &bench().black, &bench().sigmoid};
  return *all[kind];
}

/// Largest difference from double, relative to the spectrum's maximum, within the bands of the sigmoid.
template <class At>
double error_of(std::size_t kind, std::size_t count, At at) {
  double worst = 0;
  const SampledWavelengths& w = count == 4 ? bench().four : bench().eight;
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const double nm = w.lambda_nm.at(i, k);
      if (kind == 3 && (nm < 402.5 || nm > 697.5)) continue;
      worst = std::max(worst, std::abs(static_cast<double>(at(i, k)) - truth(kind)(nm)));
    }
  }
  return worst / truth(kind).max_value();
}

template <std::size_t kKind, std::size_t kCount>
void run_batch() {
  Bench& b = bench();
  if constexpr (kCount == 4) {
    need(b.samplers[kKind].sample(b.four.lambda_nm.view(), b.values4.span(), kOneThread));
  } else {
    need(b.samplers[kKind].sample(b.eight.lambda_nm.view(), b.values8.span(), kOneThread));
  }
}

template <std::size_t kKind, std::size_t kCount>
double error_of_batch() {
  return error_of(kKind, kCount, [](std::size_t i, std::size_t k) {
    return kCount == 4 ? bench().values4.at(i, k) : bench().values8.at(i, k);
  });
}

template <std::size_t kKind, std::size_t kCount>
void run_textbook() {
  Bench& b = bench();
  const std::size_t n = kCount * kLanes;
  if constexpr (kKind == 0) textbook::sample(b.text_dense, b.aos_lambda.data(), b.aos_values.data(), n);
  if constexpr (kKind == 1) textbook::sample(b.text_measured, b.aos_lambda.data(), b.aos_values.data(), n);
  if constexpr (kKind == 2) textbook::sample(b.text_black, b.aos_lambda.data(), b.aos_values.data(), n);
  if constexpr (kKind == 3) textbook::sample(b.text_sigmoid, b.aos_lambda.data(), b.aos_values.data(), n);
}

template <std::size_t kKind>
double error_of_textbook() {
  return error_of(kKind, 8, [](std::size_t i, std::size_t k) { return bench().aos_values[8 * i + k]; });
}

template <std::size_t kKind>
void add(std::vector<Line>& lines, const std::string& name) {
  const auto n = static_cast<double>(kLanes);
  lines.push_back({"textbook " + name + ", 4", 4 * n, 4 * n * 8, run_textbook<kKind, 4>, nullptr, "", false});
  lines.push_back({name + ", 4", 4 * n, 4 * n * 8, run_batch<kKind, 4>, error_of_batch<kKind, 4>,
                   "textbook " + name + ", 4", false, 4});
  lines.push_back({"textbook " + name + ", 8", 8 * n, 8 * n * 8, run_textbook<kKind, 8>,
                   error_of_textbook<kKind>, "", false});
  lines.push_back({name + ", 8", 8 * n, 8 * n * 8, run_batch<kKind, 8>, error_of_batch<kKind, 8>,
                   "textbook " + name + ", 8", false, 4});
}

std::vector<Line> lines() {
  std::vector<Line> out;
  add<0>(out, "1 nm table");
  add<1>(out, "piecewise linear");
  add<2>(out, "blackbody");
  add<3>(out, "sigmoid");
  const auto n = static_cast<double>(kLanes);
  out.push_back({"draw 4 uniform", n, n * 36,
                 [] {
                   need(sample_wavelengths(WavelengthSampling::kUniform, bench().u.view(), bench().four, 360,
                                           830, kOneThread));
                 },
                 nullptr, "", false});
  out.push_back({"draw 4 visible", n, n * 36,
                 [] {
                   need(sample_wavelengths(WavelengthSampling::kVisible, bench().u.view(), bench().four, 360,
                                           830, kOneThread));
                 },
                 nullptr, "", false});
  out.push_back({"project 4 to XYZ", n, n * 60,
                 [] {
                   need(project(bench().observer, bench().values4.view(), bench().four, bench().xyz.span(),
                                kOneThread));
                 },
                 nullptr, "", false});
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  bench();
  return report::run(
      argc, argv, lines(),
      fmt::format("one thread, kernels {}, {} lanes of 4 or 8 random wavelengths; an item is a "
                  "look-up, or a lane",
                  need(active_isa()), kLanes));
}
