// Sigmoid spectra: searched for, and evaluated in each of the forms that images and renderers need.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bench/operations/operation.hpp"
#include "bench/operations/sigmoid_oracle.hpp"
#include "kernels/sigmoid_constants.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile::measure {
namespace {

using kernels::kLanes;
using kernels::SigmoidTable;

using Shared = std::shared_ptr<const Upsampler>;
using Place = SigmoidPlace;

Place band_place(const SigmoidTable& table, std::size_t band) {
  const float* const row = table.rows + band * kernels::kSigmoidRow;
  const auto q = static_cast<double>(row[kernels::kSigmoidQ]);
  const bool quadratic = table.form == kernels::SigmoidForm::kQuadratic;
  return {quadratic ? q * q : static_cast<double>(row[kernels::kSigmoidP]), q};
}

/// The colour that coefficients have.
std::array<double, 3> sigmoid_color(const SigmoidTable& table, const double* c) {
  std::array<double, 3> sum{};
  for (std::size_t b = 0; b < table.bands; ++b) {
    const double s = sigmoid(c, band_place(table, b));
    for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(table.weights[4 * b + k]) * s;
  }
  return sum;
}

/// Allowed error of the kernel's sums: each sample's by its own rounding and by its slope times that of the
/// polynomial.
std::array<double, 3> sum_rounding(const SigmoidTable& table, const double* c) {
  std::array<double, 3> sum{};
  for (std::size_t b = 0; b < table.bands; ++b) {
    const Place at = band_place(table, b);
    const double x = argument(c, at);
    const double slope = 0.5 / std::pow(1 + x * x, 1.5);
    const double terms = terms_at(c, at);
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += std::abs(static_cast<double>(table.weights[4 * b + k])) * (0x1p-23 + 0x1p-23 * slope * terms);
    }
  }
  return sum;
}

std::string name_of(const Shared& upsampler, const char* step) {
  return fmt::format("{}: {}", to_string(upsampler->method()), step);
}

void add_search(std::vector<Operation>& to, const Shared& upsampler) {
  const SigmoidModel& model = *UpsamplerAccess::sigmoid(*upsampler);
  const std::size_t bands = upsampler->bands().count();
  const auto count = static_cast<double>(bands);
  Operation& solve =
      add_operation(to, "upsampling", name_of(upsampler, "find coefficients"), "colour", {3, 1}, {3, 1});
  solve.unit = "1e-6 of the colour";
  // Bands on which some colours have no sigmoid are bounded by 1e-5 where they are not reported; by functions
  // of tables also by the rounding of their sums, since few places of them may be nearly on a line.
  solve.bound = model.covers_unit_cube ? 1 : 10;
  solve.fill = uniform_values(3, 0.0F, 1.0F);
  // A start from the table (three gathers of 32 numbers, a polynomial of second order) and two steps, each
  // with the samples, their slopes and the nine sums of the derivatives.
  solve.operations = 2 * count * (kSigmoidBand + 20);
  solve.bottleneck =
      "further steps for the lanes of a vector that need them, gathers, and a 3 x 3 system a step";
  solve.run = [=](const KernelTable& k, const Arrays& a) {
    float* const c[3] = {a.out(0), a.out(1), a.out(2)};
    thread_local std::vector<std::uint64_t> unsolved;
    unsolved.resize(a.blocks);
    k.sigmoid_solve(c, a.in3().data(), UpsamplerAccess::sigmoid(*upsampler)->table, unsolved.data(), a.n());
    // Unsolved colours are marked for the evaluation.
    for (std::size_t i = 0; i < a.n(); ++i) {
      if (unsolved[i / kLanes] == 0) {
        i += kLanes - 1;
      } else if ((unsolved[i / kLanes] >> (i % kLanes) & 1U) != 0) {
        c[0][i] = std::numeric_limits<float>::quiet_NaN();
      }
    }
  };
  const kernels::SigmoidTable table = model.table;
  const bool covers_unit_cube = model.covers_unit_cube;
  const bool exact = covers_unit_cube || table.form == kernels::SigmoidForm::kQuadratic;
  solve.error = [=](const double* rgb, const double* c, double /*tiny*/) {
    if (!finite3(rgb)) return std::isnan(c[0]) ? 0.0 : kBeyond;
    if (*std::min_element(rgb, rgb + 3) < 0 || *std::max_element(rgb, rgb + 3) > 1) return kOutOfDomain;
    // Bands that have no sigmoid for some colours report them.
    if (std::isnan(c[0])) return covers_unit_cube ? kBeyond : kOutOfDomain;
    const auto sum = sigmoid_color(table, c);
    const auto rounding = exact ? std::array<double, 3>{} : sum_rounding(table, c);
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(sum[k] - rgb[k]) - rounding[k]);
    return worst / 1e-6;
  };
}

/// Colours that sigmoid_solve does not find, for colours outside the cube as well as in it.
void add_continuation(std::vector<Operation>& to, const Shared& upsampler) {
  const SigmoidTable table = UpsamplerAccess::sigmoid(*upsampler)->table;
  const auto count = static_cast<double>(table.bands);
  Operation& op =
      add_operation(to, "upsampling", name_of(upsampler, "the long way from grey"), "colour", {3, 1}, {4, 1});
  op.unit = "of what counts as found";
  op.bound = 1;
  op.expense = 64;
  op.cache_only = true;
  op.fill = uniform_values(3, 0.0F, 1.0F);
  // Some eight steps of the search, each as above.
  op.operations = 8 * count * (kSigmoidBand + 20);
  op.bottleneck = "steps without end for the lanes of a vector that need the most, up to 256";
  op.run = [=](const KernelTable& k, const Arrays& a) {
    k.sigmoid_continuation(a.out3().data(), a.out(3), a.in3().data(),
                           UpsamplerAccess::sigmoid(*upsampler)->table, upsampler->luminance().data(), a.n());
  };
  const std::array<float, 3> luminance = upsampler->luminance();
  op.error = [=](const double* rgb, const double* out, double tiny) {
    const double part = out[3];
    if (!finite3(rgb)) return std::isnan(out[0]) && part == 1 ? 0.0 : kBeyond;
    double y = 0;
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      y += static_cast<double>(luminance[k]) * rgb[k];
      size = std::max(size, std::abs(rgb[k]));
    }
    if (!(part >= 0 && part <= 1)) return kBeyond;
    if (size > 1e30) return kOutOfDomain;
    // Of black and white nothing is asked but their coefficients; where y rounds to either, any of the two.
    if (part == 0)
      return std::abs(out[2]) >= static_cast<double>(kernels::kSigmoidFar) || has_bound(out) ? 0.0 : kBeyond;
    const double grey = std::min(y, 1 - y);
    const auto met = std::min(static_cast<double>(kernels::kSigmoidUnsolved),
                              std::abs(grey) * static_cast<double>(kernels::kSigmoidMet));
    const double near = std::abs(grey) * static_cast<double>(kernels::kContinuationNear);
    const double found = std::max(part < 1 ? near : met, static_cast<double>(kernels::kSigmoidRounding));
    const auto sum = sigmoid_color(table, out);
    const auto rounding = sum_rounding(table, out);
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      // The goal is rounded too.
      const double allowed = found + rounding[k] + 0x1p-23 * (1 + size) + tiny;
      worst = std::max(worst, std::abs(sum[k] - (y + part * (rgb[k] - y))) / allowed);
    }
    return worst;
  };
}

Operation& evaluation(std::vector<Operation>& to, std::string name, std::size_t bands) {
  Operation& op = add_operation(to, "upsampling", std::move(name), "colour", {3, 1});
  op.operations = kSigmoidBand * static_cast<double>(bands);
  op.unit = "stated bound";
  op.bound = 1;
  op.bottleneck =
      "one chain of sixteen operations a sample, of which sixteen registers hold few side by side";
  // Coefficients as those of real colours are.
  op.fill = uniform_values(3, -8.0F, 8.0F);
  return op;
}

void add_evaluations(std::vector<Operation>& to, const Shared& upsampler) {
  const SigmoidTable table = UpsamplerAccess::sigmoid(*upsampler)->table;
  const std::size_t bands = table.bands;
  const auto samples_error = [=](bool half) {
    return [=](const double* c, const double* out, double /*tiny*/) {
      if (!has_bound(c)) return kOutOfDomain;
      double worst = 0;
      for (std::size_t b = 0; b < bands; ++b) {
        const Place l = band_place(table, b);
        const double reference = sigmoid(c, l);
        const double off = std::abs(out[b] - reference);
        const double allowed = allowed_at(c, l);
        worst = std::max(worst,
                         half ? std::max(0.0, off - allowed) / half_of_half_step(reference) : off / allowed);
      }
      return worst;
    };
  };
  Operation& blocks = evaluation(to, name_of(upsampler, "evaluate"), bands);
  blocks.out = {1, bands};
  blocks.can_stream = true;
  blocks.run = [=](const KernelTable& k, const Arrays& a) {
    k.sigmoid_blocks(a.out(), {a.in3().data(), nullptr, table.rows, bands, false, table.form}, a.blocks,
                     a.non_temporal);
  };
  blocks.error = samples_error(false);

  for (const bool half : {false, true}) {
    Operation& line = evaluation(
        to, name_of(upsampler, half ? "evaluate to a line of halves" : "evaluate to a line of floats"),
        bands);
    line.out = {bands, 1, half ? Element::kHalf : Element::kFloat};
    line.operations += half ? 3 * static_cast<double>(bands) : 0;
    line.cache_only = true;
    line.run = [=](const KernelTable& k, const Arrays& a) {
      const float* const c[3] = {a.in(0), a.in(1), a.in(2)};
      const kernels::SigmoidSpectra spectra = {c, nullptr, table.rows, bands, false, table.form};
      (half ? k.sigmoid_rows_half : k.sigmoid_rows_float)(line_rows(a, bands), spectra, a.n());
    };
    line.error = samples_error(half);
    if (half) {
      line.unit = "half ULP of half";
      line.bound = 1.001;
    }
  }

  // Colours of coefficients, as sums over the bands that are not stored.
  Operation& sums = evaluation(to, name_of(upsampler, "sum to a colour"), bands);
  sums.out = {3, 1};
  sums.operations += (6 + 3.0 / 8) * static_cast<double>(bands);
  sums.run = [=](const KernelTable& k, const Arrays& a) {
    const SigmoidTable& t = UpsamplerAccess::sigmoid(*upsampler)->table;
    k.sigmoid_project(a.out3().data(), {a.in3().data(), nullptr, t.rows, bands, false, t.form}, t.weights,
                      a.n());
  };
  sums.error = [=](const double* c, const double* out, double tiny) {
    if (!has_bound(c)) return kOutOfDomain;
    const auto reference = sigmoid_color(table, c);
    std::array<double, 3> allowed{};
    const double roundings = static_cast<double>(bands) / 8 + 11;
    for (std::size_t b = 0; b < bands; ++b) {
      const Place l = band_place(table, b);
      for (std::size_t k = 0; k < 3; ++k) {
        const double w = std::abs(static_cast<double>(table.weights[4 * b + k]));
        allowed[k] += w * (allowed_at(c, l) + roundings * 0x1p-24 * sigmoid(c, l) + tiny);
      }
    }
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(out[k] - reference[k]) / (allowed[k] + tiny));
    return worst;
  };
}

}  // namespace

Result<void> add_sigmoids(std::vector<Operation>& to, const Shared& upsampler) {
  add_search(to, upsampler);
  add_continuation(to, upsampler);
  add_evaluations(to, upsampler);
  if (upsampler->method() != Method::kSigmoid) return {};
  return add_sigmoids_at_wavelengths(to, upsampler);
}

}  // namespace spectile::measure
