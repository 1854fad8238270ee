// Upsampling, relighting and gamut: from three numbers to spectra and colours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/upsampling/relight.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "bench/operations/operation.hpp"
#include "bench/operations/own_wavelengths/textures.hpp"
#include "src/base/errors.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"

namespace spectile::measure {
namespace {

using kernels::kSmitsRow;

/// Cost of a mixture of bases before its first band: ordering three numbers and finding their bases.
constexpr double kMixture = 22;
/// And a band: two permutes, three products, two sums, the limit from below.
constexpr double kMixtureBand = 8;

/// The row of bases that least, middle and greatest component of an RGB go to, and their weights.
struct Mixture {
  double weight[3];
  std::size_t basis[3];
};

Mixture find_mixture(const double* rgb) {
  // In float, as the kernel must choose by the very numbers it was given; differences in double.
  const double least = std::min({rgb[0], rgb[1], rgb[2]});
  const double most = std::max({rgb[0], rgb[1], rgb[2]});
  const double middle = std::max(std::min(rgb[0], rgb[1]), std::min(std::max(rgb[0], rgb[1]), rgb[2]));
  const auto low = static_cast<std::size_t>(std::min_element(rgb, rgb + 3) - rgb);
  const auto high = static_cast<std::size_t>(std::max_element(rgb, rgb + 3) - rgb);
  // White; cyan, magenta, yellow for what red, green, blue have least of; red, green, blue.
  return {{least, middle - least, most - middle}, {0, 1 + low, 4 + high}};
}

/// Rows of a float table [rows][kSmitsRow] mixed, limited from below: 6 u of the sum of the weights'
/// magnitudes times the largest basis value.
struct MixtureOracle {
  MixtureOracle(std::shared_ptr<const std::vector<double>> of, std::size_t count, double least)
      : basis(std::move(of)), rows(count), lowest(least) {
    for (const double v : *basis) largest = std::max(largest, std::abs(v));
  }
  /// Two differences and three products, each times a basis.
  double roundings() const { return 5 * std::max(1.0, largest); }
  void operator()(const double* rgb, double* reference, double* scale) const {
    if (oracle_of_strange(rgb, rows, reference, scale)) return;
    const Mixture m = find_mixture(rgb);
    double sum = 0;
    for (const double w : m.weight) sum += std::abs(w);
    for (std::size_t row = 0; row < rows; ++row) {
      double v = 0;
      for (std::size_t k = 0; k < 3; ++k) v += m.weight[k] * (*basis)[row * 7 + m.basis[k]];
      reference[row] = std::max(v, lowest);
      scale[row] = sum * largest;
    }
  }
  std::shared_ptr<const std::vector<double>> basis;
  std::size_t rows;
  double lowest;
  double largest = 0;
};

std::function<double(const double*, const double*, double)> mixture_error(
    const std::shared_ptr<const std::vector<double>>& basis, std::size_t rows, double lowest) {
  const MixtureOracle oracle(basis, rows, lowest);
  return error_against(rows, oracle.roundings(), false, 6, oracle);
}

std::shared_ptr<const std::vector<double>> flat_basis(const Upsampler& upsampler) {
  auto out = std::make_shared<std::vector<double>>();
  for (const auto& row : upsampler.basis()) out->insert(out->end(), row.begin(), row.end());
  return out;
}

/// The colour at a few wavelengths of its own.
void add_mixture_at_wavelengths(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler,
                                const std::string& name) {
  Operation& op = add_own_wavelengths(
      to, "colour at 4 wavelengths, " + name, "colour",
      [=](const KernelTable& k, const float* const rgb[3], const float* lambda_nm, float* samples) {
        const WavelengthTables& tables = UpsamplerAccess::at_wavelengths(*upsampler);
        k.mixtures_at(samples, rgb, {tables.ends.data(), upsampler->lowest()}, tables.centres, lambda_nm,
                      kWavelengths, 1);
      });
  // A wavelength: held (4), its place (7), two samples (6 each), between them (3), NaN (2).
  op.operations = kMixture + kWavelengths * (4 + 7 + 2 * 6 + 3 + 2);
  op.bottleneck = "gathers: six loads a wavelength from the basis spectra";
  op.bound = 9;
  const MixtureOracle oracle(flat_basis(*upsampler), upsampler->bands().count(), 0);
  op.error = error_between_bands(upsampler->bands(), oracle.roundings() + 3, op.bound, oracle);
}

/// Colours of the texels of a texture.
Result<void> add_mixture_texture(std::vector<Operation>& to,
                                 const std::shared_ptr<const Upsampler>& upsampler) {
  TextureCost cost;
  // Seven weights of four texels, then a wavelength: its place (11), two samples (13 each), between, NaN (5).
  cost.operations = kPlaces + 4 * 7 * 2 + kWavelengths * (11 + 2 * 13 + 5);
  cost.bottleneck =
      "four texels a lane, copied one by one; fourteen gathers a wavelength from the basis spectra";
  cost.bound = 24;
  const auto& bands = upsampler->bands();
  const MixtureOracle oracle(flat_basis(*upsampler), bands.count(), 0);
  cost.sample = [oracle, first = bands[0].centre_nm, last = bands[bands.count() - 1].centre_nm,
                 count = bands.count()](const float* texel, double lambda) -> SampleAndScale {
    const double rgb[3] = {static_cast<double>(texel[0]), static_cast<double>(texel[1]),
                           static_cast<double>(texel[2])};
    thread_local std::vector<double> samples;
    thread_local std::vector<double> scales;
    samples.assign(count, 0.0);
    scales.assign(count, 0.0);
    oracle(rgb, samples.data(), scales.data());
    const auto intervals = static_cast<double>(count - 1);
    const double t = (std::clamp(lambda, first, last) - first) / (last - first) * intervals;
    const auto i = static_cast<std::size_t>(std::min(t, intervals - 1));
    const double rise = samples[i + 1] - samples[i];
    // The place is rounded twice, as in error_between_bands().
    return {samples[i] + (t - static_cast<double>(i)) * rise,
            std::max(scales[i], scales[i + 1]) + 2 * t * std::abs(rise) / 24};
  };
  return add_texture(to, upsampler, cost);
}

void add_mixture(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler,
                 const std::string& name) {
  const std::size_t bands = upsampler->bands().count();
  Operation& op = add_operation(to, "upsampling", "upsample, " + name, "colour", {3, 1}, {1, bands});
  op.operations = kMixture + kMixtureBand * static_cast<double>(bands);
  op.can_stream = true;
  op.bound = 6;
  op.fill = uniform_values(3, 0.0F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.smits_blocks(a.out(), a.in3().data(), {UpsamplerAccess::table(*upsampler), bands, upsampler->lowest()},
                   a.blocks, a.non_temporal);
  };
  op.error = mixture_error(flat_basis(*upsampler), bands, 0);

  // A line of an image: a row a band, as OpenEXR packs them.
  for (const bool half : {false, true}) {
    Operation& line = to.emplace_back(Operation(to.back()));
    line.name = fmt::format("upsample to a line of {}, {}", half ? "halves" : "floats", name);
    line.out = {bands, 1, half ? Element::kHalf : Element::kFloat};
    line.can_stream = false;
    line.cache_only = true;
    line.run = [=](const KernelTable& k, const Arrays& a) {
      (half ? k.smits_rows_half : k.smits_rows_float)(
          line_rows(a, bands), a.in3().data(),
          {UpsamplerAccess::table(*upsampler), bands, upsampler->lowest()}, a.n());
    };
  }
  Operation& halves = to.back();
  halves.operations = kMixture + (kMixtureBand + 3) * static_cast<double>(bands);
  halves.unit = "half ULP of half";
  halves.bound = 1.001;  // rounding to half, and the float before it
  const auto basis = flat_basis(*upsampler);
  halves.error = [=](const double* rgb, const double* out, double /*tiny*/) {
    if (!finite3(rgb)) return kOutOfDomain;
    const Mixture m = find_mixture(rgb);
    double worst = 0;
    for (std::size_t row = 0; row < bands; ++row) {
      double v = 0;
      double magnitudes = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        v += m.weight[k] * (*basis)[row * 7 + m.basis[k]];
        magnitudes += std::abs(m.weight[k]) * 2;
      }
      if (magnitudes > 1e37) return kOutOfDomain;
      v = std::clamp(v, 0.0, static_cast<double>(kernels::kHalfMax));
      const double rounding = 6 * 0x1p-24 * magnitudes;
      if (!std::isfinite(out[row])) return kBeyond;
      worst = std::max(worst, std::max(0.0, std::abs(out[row] - v) - rounding) / half_of_half_step(v));
    }
    return worst;
  };
}

void add_relight(std::vector<Operation>& to, const std::shared_ptr<const Relighter>& relighter) {
  Operation& op = add_operation(to, "relighting", "relight, smits-exact", "colour", {3, 1}, {3, 1});
  op.operations = kMixture + 3 * (kMixtureBand - 1);
  op.bound = 6;
  op.bottleneck =
      "ordering the components and choosing bases: selections, of which AVX2's take three micro-operations";
  op.fill = uniform_values(3, 0.0F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.smits_fold(a.out3().data(), a.in3().data(), RelighterAccess::table(*relighter), a.n());
  };
  auto basis = std::make_shared<std::vector<double>>();
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 7; ++k)
      basis->push_back(RelighterAccess::table(*relighter)[row * kSmitsRow + k]);
  }
  op.error = mixture_error(basis, 3, -kBeyond);
}

void add_gamut(std::vector<Operation>& to, const Upsampler& upsampler) {
  const std::array<float, 3> weights = upsampler.luminance();
  Operation& op = add_operation(to, "relighting", "limit to the gamut", "colour", {3, 1}, {3, 1});
  op.unit = "1e-6 of the largest component";
  op.bound = 1;
  // Half of the colours are outside.
  op.fill = uniform_values(3, -0.15F, 1.15F);
  op.operations = 3 + 8 + 8 + 3 * 10 + 3 * 6;
  op.divisions = 6;
  op.cache_only = true;  // it works in place: the copy here would be another operation
  op.bottleneck = "copied first, as it works in place; six divisions a colour";
  op.run = [=](const KernelTable& k, const Arrays& a) {
    float* const rgb[3] = {a.out(0), a.out(1), a.out(2)};
    for (std::size_t c = 0; c < 3; ++c) k.peak_copy(rgb[c], a.in(c), a.n());
    thread_local std::vector<std::uint64_t> moved;
    moved.resize(a.blocks);
    k.gamut_clip(rgb, weights.data(), 0.0F, 1.0F, moved.data(), a.n());
  };
  op.error = [=](const double* rgb, const double* out, double tiny) {
    if (!finite3(rgb)) return kOutOfDomain;
    const double most = std::max({std::abs(rgb[0]), std::abs(rgb[1]), std::abs(rgb[2]), 1.0});
    if (most > 1e30) return kOutOfDomain;
    double before = 0;
    double after = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(out[k] >= (rgb[k] < 0 ? 0 : -tiny) && out[k] <= 1)) return kBeyond;
      before += static_cast<double>(weights[k]) * rgb[k];
      after += static_cast<double>(weights[k]) * out[k];
    }
    return std::abs(std::clamp(before, 0.0, 1.0) - after) / (1e-6 * most);
  };
}

/// Under illuminant A.
Result<std::shared_ptr<const Relighter>> relighter_of(const std::shared_ptr<const Upsampler>& upsampler) {
  SPECTILE_ASSIGN(auto light, illuminant("A"));
  SPECTILE_ASSIGN(auto under, Projector::reflective(upsampler->bands(), light));
  SPECTILE_ASSIGN(auto out, Relighter::create(*upsampler, under, under.xyz_to_srgb()));
  return std::make_shared<const Relighter>(std::move(out));
}

}  // namespace

Result<void> add_upsampling(std::vector<Operation>& to, const Bands& bands) {
  const auto create_upsampler = [&](Method method) -> std::shared_ptr<const Upsampler> {
    auto made = Upsampler::create(method, Quantity::kReflectance, bands);
    if (!made) return nullptr;
    return std::make_shared<const Upsampler>(*std::move(made));
  };
  const auto smits = create_upsampler(Method::kSmits);
  if (smits == nullptr) return make_error(ErrorCode::kOutOfMemory, "no memory for a table of bases");
  add_mixture(to, smits, "smits");
  // The exact methods need bands that tell colours apart: where there are none, there is nothing to measure.
  // Finding them for hundreds of bands takes minutes.
  constexpr std::size_t kMaxBands = 100;
  if (bands.count() > kMaxBands) {
    add_gamut(to, *smits);
    return {};
  }
  if (const auto exact = create_upsampler(Method::kSmitsExact)) {
    add_mixture(to, exact, "smits-exact");
    add_mixture_at_wavelengths(to, exact, "smits-exact");
    SPECTILE_TRY(add_mixture_texture(to, exact));
    SPECTILE_ASSIGN(const auto relighter, relighter_of(exact));
    add_relight(to, relighter);
  }
  if (const auto grid = create_upsampler(Method::kTetrahedral)) {
    SPECTILE_ASSIGN(const auto relighter, relighter_of(grid));
    add_grids(to, grid, relighter);
  }
  for (const Method method : {Method::kSigmoid, Method::kSigmoidObserver}) {
    if (const auto sigmoids = create_upsampler(method)) SPECTILE_TRY(add_sigmoids(to, sigmoids));
  }
  add_gamut(to, *smits);
  return {};
}

}  // namespace spectile::measure
