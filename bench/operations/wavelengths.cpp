// Spectra at single wavelengths, and wavelengths drawn at random.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "bench/operations/operation.hpp"
#include "kernels/exponential_constants.hpp"
#include "src/base/errors.hpp"
#include "src/lanes/knot_index.hpp"
#include "src/lanes/wavelength_bins.hpp"

namespace spectile::measure {
namespace {

using kernels::EvenTable;

constexpr float kFirstNm = 360;
constexpr std::int32_t kIntervals = 470;  // to 830 nm

Operation& wavelength_operation(std::vector<Operation>& to, std::string name) {
  Operation& out = add_operation(to, "wavelengths", std::move(name), "wavelength", {});
  out.fill = uniform_values(1, 360.0F, 830.0F);
  return out;
}

/// Pairs of a value and the difference to the next one, of a spectrum at every nanometre.
std::shared_ptr<const std::vector<float>> value_pairs(const Spectrum& spectrum) {
  auto out = std::make_shared<std::vector<float>>();
  for (std::int32_t i = 0; i < kIntervals; ++i) {
    const auto a = static_cast<float>(spectrum(kFirstNm + static_cast<double>(i)));
    const auto b = static_cast<float>(spectrum(kFirstNm + static_cast<double>(i) + 1));
    out->push_back(a);
    out->push_back(b - a);
  }
  return out;
}

EvenTable even_table(const std::vector<float>& pairs) {
  return {pairs.data(), kFirstNm, 1.0F, kIntervals};
}

/// Value of the table at a wavelength in double, and the larger neighbour's magnitude.
std::array<double, 2> at_wavelength(const std::vector<float>& pairs, double lambda) {
  if (std::isnan(lambda)) return {lambda, 0};
  const double t = lambda - static_cast<double>(kFirstNm);
  if (!(t >= 0 && t <= kIntervals)) return {0, 0};
  const auto i = static_cast<std::size_t>(std::min(t, static_cast<double>(kIntervals - 1)));
  const auto a = static_cast<double>(pairs[2 * i]);
  const auto d = static_cast<double>(pairs[2 * i + 1]);
  return {a + (t - static_cast<double>(i)) * d, std::max(std::abs(a), std::abs(a + d))};
}

void add_tables(std::vector<Operation>& to, const Spectrum& spectrum) {
  const auto pairs = value_pairs(spectrum);
  Operation& even = wavelength_operation(to, "look up at 1 nm");
  // Place (8), a gather of a pair (two of its loads a lane), the line (2), what is outside (1), NaN (2).
  even.operations = 13;
  even.bottleneck = "gathers: two loads a lane from the table";
  even.bound = 4;
  even.run = [=](const KernelTable& k, const Arrays& a) {
    k.interpolate_even(a.out(), a.in(), even_table(*pairs), a.n());
  };
  even.error = error_against(1, 1, false, even.bound, [=](const double* v, double* reference, double* scale) {
    const auto found = at_wavelength(*pairs, v[0]);
    reference[0] = found[0];
    scale[0] = found[1];
  });

  Operation& project = wavelength_operation(to, "project wavelengths to XYZ");
  project.item = "sample of 4 wavelengths";
  project.in = {3, kWavelengths};
  project.out = {3, 1};
  project.operations = kWavelengths * (8 + 1 + 3 * 7) + 3;
  project.divisions = kWavelengths;
  project.bottleneck = "gathers: six loads a lane and wavelength from the curves";
  project.bound = kWavelengths + 6;
  project.fill = fill_path;
  project.run = [=](const KernelTable& k, const Arrays& a) {
    const EvenTable curves[3] = {even_table(*pairs), even_table(*pairs), even_table(*pairs)};
    k.project_wavelengths(a.out3().data(), {a.in(0), a.in(1), a.in(2), kWavelengths}, curves, 0.25F,
                          a.blocks);
  };
  const Oracle color = [=](const double* v, double* reference, double* scale) {
    double sum = 0;
    double magnitudes = 0;
    for (std::size_t i = 0; i < kWavelengths; ++i) {
      const double lambda = v[kWavelengths + i];
      const double density = v[2 * kWavelengths + i];
      if (density == 0) continue;
      const auto found = at_wavelength(*pairs, lambda);
      sum += found[0] * (v[i] / density);
      magnitudes += found[1] * std::abs(v[i] / density);
      // A ratio beyond float's range is an infinity, and times 0 no number: out of the bound's domain.
      if (std::abs(v[i] / density) > 0x1p127) magnitudes = std::numeric_limits<double>::max();
    }
    for (std::size_t c = 0; c < 3; ++c) {
      reference[c] = 0.25 * sum;
      scale[c] = 0.25 * magnitudes;
    }
  };
  project.error = error_against(3, 2 * kWavelengths, false, project.bound, color);
}

/// A spectrum between irregular knots.
Result<void> add_knots(std::vector<Operation>& to, const Spectrum& spectrum) {
  struct Table {
    KnotIndex index;
    std::vector<float> nm;
    std::vector<float> pairs;
  };
  auto table = std::make_shared<Table>();
  table->nm = irregular_knots();
  for (std::size_t i = 0; i < table->nm.size(); ++i) {
    const double here = spectrum(static_cast<double>(table->nm[i]));
    const std::size_t next = std::min(i + 1, table->nm.size() - 1);
    const double there = spectrum(static_cast<double>(table->nm[next]));
    const double apart = static_cast<double>(table->nm[next]) - static_cast<double>(table->nm[i]);
    table->pairs.push_back(static_cast<float>(here));
    table->pairs.push_back(apart > 0 ? static_cast<float>((there - here) / apart) : 0.0F);
  }
  SPECTILE_ASSIGN(table->index, index_knots(table->nm));
  Operation& op = wavelength_operation(to, "look up between irregular knots");
  // The bucket (4), a gather and a comparison a halving (3 each), the line (3), what is outside (4), NaN (2).
  op.operations = 13 + 3.0 * table->index.halvings;
  op.bottleneck = "gathers: of the bucket's knot, of each knot that is compared, of value and slope";
  op.bound = 3;
  op.run = [table](const KernelTable& k, const Arrays& a) {
    const KnotIndex& index = table->index;
    const kernels::KnotTable knots = {
        index.knots.data(), table->pairs.data(),  static_cast<std::int32_t>(table->nm.size()),
        index.start.data(), index.buckets_per_nm, static_cast<std::int32_t>(index.start.size()),
        index.halvings};
    k.interpolate_knots(a.out(), a.in(), knots, a.n());
  };
  op.error = error_against(1, 2, false, op.bound, [table](const double* v, double* reference, double* scale) {
    if (std::isnan(v[0])) {
      reference[0] = v[0];
      return;
    }
    const auto& nm = table->nm;
    const auto above = std::upper_bound(nm.begin(), nm.end(), v[0],
                                        [](double x, float knot) { return x < static_cast<double>(knot); });
    if (above == nm.begin() || v[0] > static_cast<double>(nm.back())) return;
    const auto i = static_cast<std::size_t>(above - nm.begin()) - 1;
    const double from = (v[0] - static_cast<double>(nm[i])) * static_cast<double>(table->pairs[2 * i + 1]);
    reference[0] = static_cast<double>(table->pairs[2 * i]) + from;
    scale[0] = std::abs(static_cast<double>(table->pairs[2 * i])) + std::abs(from);
  });
  return {};
}

void add_planck(std::vector<Operation>& to) {
  constexpr double kUnitNm = 1024;
  const double exponent = kSecondRadiationNmK / kPlanckTemperature * std::numbers::log2e / kUnitNm;
  kernels::PlanckTable table;
  table.factor = 1;
  table.exponent = static_cast<float>(exponent);
  table.exponent_rest = static_cast<float>(exponent - static_cast<double>(table.exponent));
  Operation& op = wavelength_operation(to, "black body");
  // Finite and positive (5), units, the exponent and its rest (7), the series, its factors (12), NaN (3).
  op.operations = 5 + 2 + 7 + kernels::kPlanckTerms + 14 + 3;
  op.divisions = 2;
  op.bottleneck = "two divisions and a chain of dependent multiplications";
  op.bound = 6;
  op.run = [=](const KernelTable& k, const Arrays& a) { k.planck(a.out(), a.in(), table, a.n()); };
  op.error = [=](const double* v, const double* out, double tiny) {
    const double lambda = v[0];
    if (std::isnan(lambda)) return std::isnan(out[0]) ? 0.0 : kBeyond;
    // Domain of the bound: 0.1 to 10^7 nm; elsewhere it must be a number that is not below 0.
    if (!(lambda >= 0.1 && lambda <= 1e7)) {
      return out[0] >= 0 ? 0.0 : kBeyond;
    }
    const double l = lambda / kUnitNm;
    const double x = exponent / l;
    const double reference = x > 252 ? 0 : 1 / (std::pow(l, 5) * std::expm1(x * std::numbers::ln2));
    const double off = std::max(0.0, std::abs(out[0] - reference) - 2 * tiny);
    if (off == 0) return 0.0;
    return reference > 0 ? off / (0x1p-24 * reference) : kBeyond;
  };
}

void add_gaussians(std::vector<Operation>& to) {
  // The lobes of an observer's x. Source: Wyman, Sloan, Shirley, Simple Analytic Approximations to the CIE
  // XYZ Color Matching Functions, J. Computer Graphics Techniques 2(2), 2013.
  const std::vector<kernels::GaussianLobe> lobes = {
      {0.362, 442.0, 0.0624, 0.0374}, {1.056, 599.8, 0.0264, 0.0323}, {-0.065, 501.1, 0.0490, 0.0382}};
  Operation& op = wavelength_operation(to, "sum of 3 Gaussians");
  // In double, a lobe: place (4), its square and factor (2), hold (4), the power of two, amplitude and sum.
  op.operations = 4 + 6.0 * (4 + 2 + 4 + 4 + 2 * kernels::kExpTerms - 1 + 2 + 2);
  op.bottleneck = "three series, chains of dependent multiply-adds in double";
  op.bound = 1.002;
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.gaussians(a.out(), a.in(), lobes.data(), lobes.size(), a.n());
  };
  op.error = error_against(1, 1, false, op.bound, [=](const double* v, double* reference, double* scale) {
    for (const auto& lobe : lobes) {
      const double from = v[0] - lobe.mean_nm;
      const double z = from * (from < 0 ? lobe.per_sigma_left : lobe.per_sigma_right);
      const double term = lobe.amplitude * std::exp(-0.5 * z * z);
      reference[0] += term;
      scale[0] += std::abs(term);
    }
  });
}

/// The k-th number that a random one stands for, as the kernels have it: a sum in float that reaches 1 starts
/// anew at 0, and its rounding with it.
double spread(double u, std::size_t k) {
  if (std::isnan(u)) return u;
  const double first = std::clamp(u, 0.0, 1 - 0x1p-24);
  const float moved = static_cast<float>(first) + static_cast<float>(k) / static_cast<float>(kWavelengths);
  return moved >= 1.0F ? static_cast<double>(moved - 1.0F) : static_cast<double>(moved);
}

/// As FL11 falls on the eye.
Result<void> add_draws_of_a_light(std::vector<Operation>& to) {
  SPECTILE_ASSIGN(const auto light, named_spectrum("FL11"));
  SPECTILE_ASSIGN(const auto distribution, WavelengthDistribution::of_light(light));
  Operation& op = wavelength_operation(to, "draw 4 wavelengths, of a light");
  op.item = "draw";
  op.out = {2, kWavelengths};
  op.fill = uniform_values(1, 0.0F, 1.0F);
  const auto table = [=]() -> const kernels::BinTable& {
    return WavelengthDistributionAccess::tables(distribution).table;
  };
  // A wavelength: its number (5), its bucket (3), steps (3 each), its place (6), NaN (4).
  op.operations = 2 + kWavelengths * (5 + 3 + 3.0 * table().halvings + 6 + 4);
  op.bottleneck = "gathers: four loads a wavelength, and one for each step of the search";
  op.bound = 2;
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.table_wavelengths(a.out(0), a.out(1), a.in(), table(), kWavelengths, a.blocks);
  };
  op.error = error_against(
      2 * kWavelengths, 0, false, op.bound, [=](const double* v, double* reference, double* scale) {
        const kernels::BinTable& t = table();
        for (std::size_t i = 0; i < kWavelengths; ++i) {
          const double u = spread(v[0], i);
          const double share = std::isnan(u) ? 0 : u;
          const float* const end = t.knots + t.count;
          const float* const after = std::upper_bound(t.knots, end, static_cast<float>(share));
          const auto bin = after - t.knots - 1;
          const double low = static_cast<double>(t.first_nm) + static_cast<double>(bin);
          const double start = static_cast<double>(t.knots[bin]);
          const double next = after < end ? static_cast<double>(*after) : 1;
          reference[i] = std::isnan(u) ? u : low + (share - start) / (next - start);
          reference[kWavelengths + i] = next - start;
          scale[i] = std::abs(reference[i]);
          scale[kWavelengths + i] = next - start;
        }
      });
  return {};
}

void add_draws(std::vector<Operation>& to) {
  // The density tanh'(0.0072 (lambda - 538)). Source: see wavelengths.hpp.
  constexpr double kSteepness = 0.0072;
  constexpr double kCentre = 538;
  kernels::WavelengthDensity d{};
  d.first_nm = kFirstNm;
  d.range_nm = kIntervals;
  d.centre_nm = kCentre;
  d.per_steepness_nm = 1 / kSteepness;
  d.from = std::tanh(kSteepness * (kCentre - 360));
  d.by = std::tanh(kSteepness * (830 - kCentre)) + d.from;
  d.peak = kSteepness / d.by;
  for (const bool visible : {false, true}) {
    Operation& op =
        wavelength_operation(to, visible ? "draw 4 wavelengths, visible" : "draw 4 wavelengths, even");
    op.item = "draw";
    op.out = {2, kWavelengths};
    op.fill = uniform_values(1, 0.0F, 1.0F);
    op.operations = 2 + kWavelengths * (5 + 2);
    op.bottleneck = "selections, of which AVX2's take three micro-operations, and stores";
    if (visible) {
      // In double: y (2), the logarithm of a ratio, twice a product and a sum.
      op.operations += kWavelengths * 2 * (2 + 2 + 15 + 2 * kernels::kAtanhTerms - 1 + 6);
      op.divisions = 8 * kWavelengths;
      op.bottleneck = "two divisions in double a wavelength, and a series of dependent multiplications";
    }
    op.bound = 2;
    op.run = [=](const KernelTable& k, const Arrays& a) {
      (visible ? k.visible_wavelengths : k.even_wavelengths)(a.out(0), a.out(1), a.in(), d, kWavelengths,
                                                             a.blocks);
    };
    op.error = error_against(
        2 * kWavelengths, 0, false, op.bound, [=](const double* v, double* reference, double* scale) {
          for (std::size_t i = 0; i < kWavelengths; ++i) {
            const double u = spread(v[0], i);
            const double y = d.from - u * d.by;
            reference[i] = visible ? kCentre - std::atanh(y) / kSteepness : 360 + u * 470;
            reference[kWavelengths + i] = visible ? d.peak * (1 - y * y) : 1.0 / 470;
            if (std::isnan(v[0]) && !visible) reference[kWavelengths + i] = 1.0 / 470;
            scale[i] = std::abs(reference[i]);
            scale[kWavelengths + i] = std::abs(reference[kWavelengths + i]);
          }
        });
  }
}

}  // namespace

std::vector<float> irregular_knots() {
  constexpr int kKnots = 95;
  std::vector<float> out;
  for (int i = 0; i < kKnots; ++i) {
    // Up to two nanometres off an even place, by the golden ratio's multiples.
    const double golden = static_cast<double>(i) / std::numbers::phi;
    out.push_back(static_cast<float>(360 + 5.0 * i + 4 * (golden - std::floor(golden)) - 2));
  }
  return out;
}

Result<void> add_wavelengths(std::vector<Operation>& to) {
  SPECTILE_ASSIGN(const auto y, named_spectrum("cie1931-y"));
  add_tables(to, y);
  SPECTILE_TRY(add_knots(to, y));
  add_planck(to);
  add_gaussians(to);
  add_draws(to);
  add_throughput(to);
  return add_draws_of_a_light(to);
}

}  // namespace spectile::measure
