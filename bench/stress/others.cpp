// Averages over bands, weights, matrices and colour differences under stress.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <spectile/color/color_difference.hpp>
#include <spectile/color/rgb_space.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/upsampling/relight.hpp>

#include "bench/operations/operation.hpp"
#include "bench/stress/stress.hpp"
#include "src/base/errors.hpp"
#include "src/reference/oracle/oracle.hpp"

namespace spectile::measure {
namespace {

/// Averages of spectra over bands: lines of 1 nm, steps, bands of 0.1 to 470 nm.
Result<StressResult> band_averages(const StressSettings& settings) {
  StressResult out = stress_heading("lines of 1 nm, steps, 10^-6 to 10^6; bands of 0.1 to 470 nm",
                                    "u of the largest sample", 1.001);
  Random random(settings.seed);
  std::vector<const char*> lists = {"360:830:470", "400:700:5", "380:780:0.1"};
  const int spectra = settings.few_bands ? 20 : 200;
  for (const char* text : lists) {
    SPECTILE_ASSIGN(const auto bands, Bands::parse(text));
    for (int s = 0; s < spectra; ++s) {
      std::vector<double> nm;
      std::vector<double> values;
      const double scale = std::pow(10.0, static_cast<double>(static_cast<int>(random() % 13)) - 6);
      const double line = 380 + static_cast<double>(random() % 4000) * 0.1;
      switch (s % 3) {
        case 0:  // a line of 1 nm
          nm = {300, line - 0.5, line - 0.5, line + 0.5, line + 0.5, 900};
          values = {0, 0, scale, scale, 0, 0};
          break;
        case 1:  // a step
          nm = {300, line, line, 900};
          values = {0.1 * scale, 0.1 * scale, scale, scale};
          break;
        default:
          for (int i = 0; i < 100; ++i) {
            nm.push_back(350 + 5 * i + 0.01 * static_cast<double>(random() % 400));
            values.push_back(scale * static_cast<double>(uniform(random, 0.0F, 1.0F)));
          }
      }
      SPECTILE_ASSIGN(const auto spectrum, MeasuredSpectrum::from_samples(nm, values));
      const std::vector<float> found = spectrum.average_over(bands);
      const double largest = *std::max_element(values.begin(), values.end());
      for (std::size_t b = 0; b < bands.count(); ++b) {
        const double reference = oracle::average(spectrum.wavelengths_nm(), spectrum.values(),
                                                 (bands)[b].lower_nm, (bands)[b].upper_nm);
        add_case(out, std::abs(static_cast<double>(found[b]) - reference) / (0x1p-24 * largest),
                 fmt::format("a spectrum at {} nm over {}", line, text));
      }
    }
  }
  return out;
}

/// Weights of XYZ under lights with lines, on one band and on many.
Result<StressResult> projection_weights(const StressSettings& settings) {
  // The oracle sums at 0.01 nm: that is what it is off by itself.
  StressResult out = stress_heading("lights smooth and with lines, bands of 0.5 to 470 nm", "of Y", 1e-7);
  for (const char* text : {"360:830:470", "400:700:5", "380:780:0.5"}) {
    SPECTILE_ASSIGN(const auto bands, Bands::parse(text));
    for (const char* name : {"D65", "A", "FL11", "HP1", "LED-RGB1"}) {
      if (settings.few_bands && std::string_view(name) != "FL11") continue;
      SPECTILE_ASSIGN(const auto light, illuminant(name));
      SPECTILE_ASSIGN(const auto found, Projector::reflective(bands, light));
      const auto reference = oracle::projection_weights(bands, Observer::kCie1931, &light);
      for (std::size_t b = 0; b < bands.count(); ++b) {
        for (std::size_t k = 0; k < 3; ++k) {
          add_case(out, std::abs(found.weights()[b][k] - reference[b][k]),
                   fmt::format("{} on {}", name, text));
        }
      }
    }
  }
  return out;
}

/// Matrices near to singular ones: primaries that nearly coincide.
Result<StressResult> near_singular(const StressSettings& settings) {
  StressResult out =
      stress_heading("primaries as near to each other as 10^-12", "2^-52 of the condition", 16);
  Random random(settings.seed);
  const auto norm = [](const Matrix3& m) {
    double sum = 0;
    for (const double v : m) sum += v * v;
    return std::sqrt(sum);
  };
  for (int i = 0; i < 2000; ++i) {
    Matrix3 m{};
    for (double& v : m) v = static_cast<double>(uniform(random, -1.0F, 1.0F));
    const double apart = std::pow(10.0, -static_cast<double>(random() % 13));
    // The last column is nearly the mean of the others.
    for (std::size_t row = 0; row < 3; ++row) {
      m[3 * row + 2] = 0.5 * (m[3 * row] + m[3 * row + 1]) + apart * m[3 * row + 2];
    }
    if (determinant(m) == 0) continue;
    const Matrix3 inverted = inverse(m);
    const Matrix3 one = product(m, inverted);
    double off = 0;
    for (std::size_t k = 0; k < 9; ++k) off = std::max(off, std::abs(one[k] - (k % 4 == 0 ? 1.0 : 0.0)));
    add_case(out, off / (0x1p-52 * norm(m) * norm(inverted)), fmt::format("columns {:.0e} apart", apart));
  }
  return out;
}

/// CIEDE2000 of any two colours: never below 0, the same both ways, 0 for the same.
Result<StressResult> differences(const StressSettings& settings) {
  StressResult out = stress_heading("XYZ from 10^-20 to 10^10, negative ones, greys", "broken laws", 0);
  Random random(settings.seed);
  const std::array<double, 3> white = {0.95, 1, 1.09};
  const auto any = [&] {
    std::array<double, 3> xyz{};
    const double scale = std::pow(10.0, static_cast<double>(static_cast<int>(random() % 31)) - 20);
    const bool grey = random() % 4 == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      xyz[k] = scale * (grey ? white[k] : static_cast<double>(uniform(random, -0.1F, 1.0F)));
    }
    return xyz_to_lab(xyz, white);
  };
  for (std::size_t i = 0; i < std::max<std::size_t>(2000, settings.samples / 16); ++i) {
    const Lab a = any();
    const Lab b = any();
    const double there = ciede2000(a, b);
    const double back = ciede2000(b, a);
    const bool good = std::isfinite(there) && there >= 0 && there == back && ciede2000(a, a) == 0;
    add_case(out, good ? 0 : 1, fmt::format("L*a*b* {:.6g} {:.6g} {:.6g}", a.l, a.b, b.l));
  }
  return out;
}

/// Relighting by a folded table against the long way, within the bound that it states itself.
Result<StressResult> folding(const StressSettings& settings) {
  StressResult out =
      stress_heading("colours of the cube, to 10^30 and down to 10^-30", "of Relighter::bound()", 1);
  const Bands bands;
  constexpr std::size_t kLanes = 4096;
  Random random(settings.seed);
  for (const Method method : {Method::kSmits, Method::kSmitsExact, Method::kMallett}) {
    SPECTILE_ASSIGN(const auto upsampler, Upsampler::create(method, Quantity::kReflectance, bands));
    for (const char* name : {"D65", "FL11"}) {
      SPECTILE_ASSIGN(const auto light, illuminant(name));
      SPECTILE_ASSIGN(const auto under, Projector::reflective(bands, light));
      SPECTILE_ASSIGN(const auto relighter, Relighter::create(upsampler, under, under.xyz_to_srgb()));
      auto rgb = ColorLanes::create(kLanes);
      auto folded = ColorLanes::create(kLanes);
      auto spectra = SampledSpectra::create(bands, kLanes);
      if (!rgb || !folded || !spectra)
        return make_error(ErrorCode::kOutOfMemory, "no memory for {} colours", kLanes);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const float scale = i % 3 == 0 ? 1.0F : i % 3 == 1 ? 1e30F : 1e-30F;
        for (std::size_t k = 0; k < 3; ++k) rgb->at(i, k) = scale * uniform(random, 0.0F, 1.0F);
      }
      SPECTILE_TRY(relight(relighter, rgb->view(), folded->span(), {1}));
      SPECTILE_TRY(upsample_srgb(upsampler, rgb->view(), spectra->span(), StoreHint::kAuto, {1}));
      for (std::size_t i = 0; i < kLanes; ++i) {
        std::array<double, 3> xyz{};
        for (std::size_t b = 0; b < bands.count(); ++b) {
          for (std::size_t k = 0; k < 3; ++k) {
            xyz[k] += under.weights()[b][k] * static_cast<double>(spectra->at(i, b));
          }
        }
        const auto reference = times(under.xyz_to_srgb(), xyz);
        const double largest = static_cast<double>(std::max({rgb->at(i, 0), rgb->at(i, 1), rgb->at(i, 2)}));
        if (largest == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          const double off = std::abs(static_cast<double>(folded->at(i, k)) - reference[k]) / largest;
          add_case(out, off / relighter.bound()[k], fmt::format("{} under {}", to_string(method), name));
        }
      }
    }
  }
  return out;
}

}  // namespace

void add_case(StressResult& r, double error, const std::string& description) {
  ++r.cases;
  if (!(error <= r.bound)) ++r.beyond;
  if (r.worst_case.empty() || !(error <= r.worst)) {
    r.worst = error;
    r.worst_case = description;
  }
}

StressResult stress_heading(std::string inputs, std::string unit, double bound) {
  StressResult out;
  out.inputs = std::move(inputs);
  out.unit = std::move(unit);
  out.bound = bound;
  return out;
}

Result<std::vector<StressResult>> stress_others(const StressSettings& settings) {
  struct Part {
    const char* operation;  ///< as its heading calls it
    Result<StressResult> (*run)(const StressSettings&);
  };
  const Part parts[] = {
      {"film: add up", stress_film_counts},      {"film: cancellation", stress_film_cancellation},
      {"film: any sample", stress_film_samples}, {"average over bands", band_averages},
      {"weights of XYZ", projection_weights},    {"inverse of a matrix", near_singular},
      {"laws of CIEDE2000", differences},        {"relight against the long way", folding},
  };
  std::vector<StressResult> out;
  for (const Part& part : parts) {
    if (!is_chosen(part.operation, settings.only)) continue;
    if (settings.stop && settings.stop()) {
      return make_error(ErrorCode::kCancelled, "stopped at {}", part.operation);
    }
    SPECTILE_ASSIGN(auto found, part.run(settings));
    found.operation = part.operation;
    out.push_back(std::move(found));
  }
  return out;
}

}  // namespace spectile::measure
