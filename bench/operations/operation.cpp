// Common to operations: evaluating errors, typical values.
#include "bench/operations/operation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

constexpr double kU = 0x1p-24;
constexpr double kLargest = std::numeric_limits<float>::max();
/// From here on float rounds to infinity: half a step beyond its largest number.
constexpr double kOverflow = 0x1.ffffffp127;

/// Error of one value in units of u of the scale.
double value_error(double value, double reference, double scale, double allowance, bool single,
                   double bound) {
  // Where an intermediate result may overflow, an infinity may become no number, and no number stays none.
  if (!single && !std::isfinite(reference)) {
    return std::isfinite(value) || (std::isnan(reference) && !std::isnan(value)) ? kBeyond : 0;
  }
  if (std::isnan(reference)) return std::isnan(value) ? 0 : kBeyond;
  if (std::isinf(reference)) return value == reference ? 0 : kBeyond;
  if (single && std::abs(reference) >= kOverflow) {
    return std::isinf(value) && std::signbit(value) == std::signbit(reference) ? 0 : kBeyond;
  }
  if (!single && scale * (1 + bound * kU) > kLargest) return kOutOfDomain;
  if (!std::isfinite(value)) return kBeyond;
  const double off = std::abs(value - reference);
  if (off <= allowance) return 0;
  return scale > 0 ? (off - allowance) / (kU * scale) : kBeyond;
}

}  // namespace

Operation& add_operation(std::vector<Operation>& to, const char* group, std::string name, const char* item,
                         Shape in, Shape out) {
  Operation& op = to.emplace_back();
  op.group = group;
  op.name = std::move(name);
  op.item = item;
  op.in = in;
  op.out = out;
  return op;
}

PathRows::PathRows(const Arrays& a, std::size_t block) {
  for (std::size_t i = 0; i < kWavelengths; ++i) {
    values[i] = a.in(i) + block * kernels::kLanes;
    lambda[i] = a.in(kWavelengths + i) + block * kernels::kLanes;
    density[i] = a.in(2 * kWavelengths + i) + block * kernels::kLanes;
  }
}

void fill_path(Random& random, float* values) {
  for (std::size_t k = 0; k < kWavelengths; ++k) {
    values[k] = uniform(random, 0.0F, 2.0F);
    values[kWavelengths + k] = uniform(random, 360.0F, 830.0F);
    values[2 * kWavelengths + k] = uniform(random, 1e-3F, 5e-3F);
  }
}

std::function<double(const double*, const double*, double)> error_against(std::size_t outputs,
                                                                          double roundings, bool single,
                                                                          double bound, Oracle oracle) {
  return [=, oracle = std::move(oracle)](const double* in, const double* out, double tiny) {
    thread_local std::vector<double> reference;
    thread_local std::vector<double> scale;
    reference.assign(outputs, 0.0);
    scale.assign(outputs, 0.0);
    oracle(in, reference.data(), scale.data());
    double worst = kOutOfDomain;
    for (std::size_t i = 0; i < outputs; ++i) {
      if (single) scale[i] = std::abs(reference[i]);
      worst = std::max(worst, value_error(out[i], reference[i], scale[i], roundings * tiny, single, bound));
    }
    return worst;
  };
}

void* const* line_rows(const Arrays& arrays, std::size_t bands) {
  thread_local std::vector<void*> rows;
  rows.resize(bands);
  for (std::size_t b = 0; b < bands; ++b) rows[b] = arrays.out<std::byte>(b);
  return rows.data();
}

float uniform(Random& random, float low, float high) {
  const auto unit = static_cast<float>(random() >> 40U) * 0x1p-24F;
  return low + (high - low) * unit;
}

bool is_chosen(const std::string& name, const std::vector<std::string>& only) {
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

bool finite3(const double* v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

bool oracle_of_strange(const double* v, std::size_t results, double* reference, double* scale) {
  if (finite3(v)) return false;
  const bool nan = std::isnan(v[0]) || std::isnan(v[1]) || std::isnan(v[2]);
  std::fill_n(reference, results, nan ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  std::fill_n(scale, results, std::numeric_limits<double>::max());
  return true;
}

double half_of_half_step(double value) {
  // Half has eleven bits, and steps of 2^-24 below 2^-14.
  return std::ldexp(0.5, std::max(-24, std::ilogb(std::max(value, 0x1p-14)) - 10));
}

std::function<void(Random&, float*)> uniform_values(std::size_t count, float low, float high) {
  return [=](Random& random, float* values) {
    for (std::size_t i = 0; i < count; ++i) values[i] = uniform(random, low, high);
  };
}

Result<std::vector<Operation>> lane_operations(const Bands& bands) {
  std::vector<Operation> out;
  add_arithmetic(out);
  SPECTILE_TRY(add_reductions(out, bands));
  SPECTILE_TRY(add_upsampling(out, bands));
  SPECTILE_TRY(add_wavelengths(out));
  SPECTILE_TRY(add_film(out, bands));
  SPECTILE_TRY(add_film_sums(out, bands));
  add_differences(out);
  add_conversions(out);
  return out;
}

}  // namespace spectile::measure
