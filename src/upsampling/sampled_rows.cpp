// SampledRows: tables that turn a method's coefficients into samples at chosen places of the spectrum.
#include "src/upsampling/sampled_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"
#include "src/color/working_space.hpp"
#include "src/spectra/band_weights.hpp"
#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile::rows {
namespace {

using kernels::kSigmoidP;
using kernels::kSigmoidQ;
using kernels::kSigmoidRow;
using kernels::kSigmoidWhite;

/// A place between two bands: share `t` of the way from the centre of `band` to the next one's.
struct Place {
  std::size_t band = 0;
  double t = 0;
};

Place locate(const Bands& bands, double wavelength_nm) {
  const auto list = bands.list();
  const auto after = std::upper_bound(list.begin(), list.end(), wavelength_nm,
                                      [](double nm, const Band& band) { return nm < band.centre_nm; });
  if (after == list.begin()) return {};
  const auto at = static_cast<std::size_t>(after - list.begin()) - 1;
  if (after == list.end()) return {at, 0};
  return {at, (wavelength_nm - list[at].centre_nm) / (list[at + 1].centre_nm - list[at].centre_nm)};
}

/// Linear between the values of two bands; the first's own where the place is its centre.
double interpolate(const Place& place, double first, double next) {
  return place.t == 0 ? first : (1 - place.t) * first + place.t * next;
}

/// A light of luminance 1 in bands that need not be those the method was made for. A plan's emission values
/// are on a scale of their own, where luminance is 1 over the plan's.
Result<std::vector<double>> white_in(const Bands& bands, const Upsampler& upsampler,
                                     const MeasuredSpectrum& light) {
  const UpsamplerOptions& made = upsampler.options();
  const bool planned = bands.weights() != nullptr || upsampler.bands().weights() != nullptr;
  SPECTILE_ASSIGN(const auto space, working_space(planned ? bands : upsampler.bands(),
                                                  upsampler.quantity() == Quantity::kIlluminant,
                                                  made.primaries, light, made.observer));
  if (planned) return space.white;
  SPECTILE_ASSIGN(auto out, light_samples(light, bands));
  for (double& v : out) v /= space.luminance;
  return out;
}

/// Bound of the sum of a lane's weights above 0, and of those below, over its largest magnitude or 1: a
/// component below 0 is taken into the first cell, so many of its widths away.
float extrapolation(const GridModel& model) {
  return 2 + model.table.per_width[0];
}

}  // namespace

Result<SampledRows> SampledRows::sized(const Upsampler& upsampler, std::size_t count) {
  SampledRows out;
  out.count_ = count;
  out.sigmoid_ = !stores_rgb(upsampler);
  out.has_scale_ = rows::has_scale(upsampler);
  out.white_ = out.sigmoid_ && upsampler.quantity() == Quantity::kIlluminant;
  if (out.sigmoid_) out.form_ = UpsamplerAccess::sigmoid(upsampler)->table.form;
  out.lowest_ = upsampler.lowest();
  if (upsampler.method() == Method::kTetrahedral) return out;
  out.row_floats_ = out.sigmoid_ ? kSigmoidRow : kernels::kSmitsRow;
  SPECTILE_ASSIGN(out.table_, FloatBuffer::create(count * out.row_floats_));
  std::fill_n(out.table_.data(), out.table_.size(), 0.0F);
  return out;
}

void SampledRows::copy(const Upsampler& upsampler) {
  grid_ = UpsamplerAccess::grid(upsampler);
  if (grid_) return;
  const float* const from =
      sigmoid_ ? UpsamplerAccess::sigmoid(upsampler)->table.rows : UpsamplerAccess::table(upsampler);
  std::copy_n(from, count_ * row_floats_, table_.data());
}

void SampledRows::set_limits() {
  if (grid_) {
    for (const double v : grid_->grid.nodes) largest_ = std::max(largest_, std::abs(static_cast<float>(v)));
    const float most = std::numeric_limits<float>::max() / (extrapolation(*grid_) * std::max(largest_, 1.0F));
    limits_ = {most, most, most, 1};  // alpha, or what stands for it, is the only scale that there is
    return;
  }
  const std::size_t first = sigmoid_ ? kSigmoidWhite : 0;
  const std::size_t end = sigmoid_ ? kSigmoidWhite + 1 : kernels::kSmitsRow;
  float p = 1;  // largest magnitudes
  float q = 1;
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t k = first; k < end; ++k) largest_ = std::max(largest_, std::abs(row(i)[k]));
    if (!sigmoid_) continue;
    p = std::max(p, std::abs(row(i)[kSigmoidP]));
    q = std::max(q, std::abs(row(i)[kSigmoidQ]));
  }
  const float most = std::numeric_limits<float>::max() / std::max(largest_, 1.0F);
  if (!sigmoid_) {
    // Weights are differences of two components.
    limits_ = {most / 2, most / 2, most / 2, 0};
    return;
  }
  // The argument stays below 3 * 2^61, its square finite.
  limits_ = {0x1p61F / p, 0x1p61F / q, 0x1p61F, most};
  black_ = {0, 0, -kernels::kSigmoidFar, 0};
}

Result<SampledRows> SampledRows::over(const Upsampler& upsampler, const Bands& bands) {
  SPECTILE_ASSIGN(auto out, sized(upsampler, bands.count()));
  if (bands == upsampler.bands()) {
    out.copy(upsampler);
  } else if (!out.sigmoid_) {
    SPECTILE_ASSIGN(const auto other,
                    Upsampler::create(upsampler.method(), upsampler.quantity(), bands, upsampler.options()));
    out.copy(other);
  } else {
    const UpsamplerOptions& made = upsampler.options();
    const MeasuredSpectrum light = made.light ? *made.light : *illuminant("D65");
    std::vector<double> white(bands.count(), 1.0);
    if (out.white_) {
      SPECTILE_ASSIGN(white, white_in(bands, upsampler, light));
    }
    for (std::size_t b = 0; b < bands.count(); ++b) {
      set_functions(*UpsamplerAccess::sigmoid(upsampler), bands[b].centre_nm, out.row(b));
      out.row(b)[kSigmoidWhite] = static_cast<float>(white[b]);
    }
  }
  out.set_limits();
  return out;
}

Result<SampledRows> SampledRows::at(const Upsampler& upsampler, std::span<const double> wavelengths_nm) {
  SPECTILE_ASSIGN(auto out, sized(upsampler, wavelengths_nm.size()));
  const std::size_t last = upsampler.bands().count() - 1;
  std::vector<GridPlaceAt> grid_places;
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i) {
    const Place place = locate(upsampler.bands(), wavelengths_nm[i]);
    const std::size_t next = std::min(place.band + 1, last);
    grid_places.push_back({place.band, place.t});
    float* const row = out.row(i);
    if (out.sigmoid_) {
      const float* const own = UpsamplerAccess::sigmoid(upsampler)->table.rows;
      const auto white = [own](std::size_t b) {
        return static_cast<double>(own[b * kSigmoidRow + kSigmoidWhite]);
      };
      set_functions(*UpsamplerAccess::sigmoid(upsampler), wavelengths_nm[i], row);
      row[kSigmoidWhite] = static_cast<float>(interpolate(place, white(place.band), white(next)));
    } else if (!UpsamplerAccess::grid(upsampler)) {
      const auto basis = upsampler.basis();
      for (std::size_t k = 0; k < 7; ++k) {
        row[k] = static_cast<float>(interpolate(place, basis[place.band][k], basis[next][k]));
      }
    }
  }
  if (const auto& grid = UpsamplerAccess::grid(upsampler)) {
    SPECTILE_ASSIGN(
        out.grid_, grid_model(grid_at(grid->grid, grid_places), grid->table.lowest, grid->table.homogeneous));
  }
  out.set_limits();
  return out;
}

float SampledRows::bound(const std::array<float, 4>& largest) const noexcept {
  // With room for rounding.
  if (grid_) return extrapolation(*grid_) * std::max({largest[0], largest[1], largest[2], 1.0F}) * largest_;
  if (!sigmoid_) return 3 * std::max({largest[0], largest[1], largest[2]}) * largest_;
  return 1.5F * (has_scale_ ? largest[3] : 1.0F) * largest_;
}

bool SampledRows::linear(bool any_component) const noexcept {
  if (sigmoid_ || grid_) return false;
  if (std::isinf(lowest_)) return true;
  if (any_component) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::any_of(basis(i), basis(i) + kernels::kSmitsRow, [](float sample) { return sample < 0; }))
      return false;
  }
  return true;
}

void SampledRows::expand_rows(const kernels::KernelTable& kernels, const float* const c[3],
                              const float* scale, void* const* out, bool half, std::size_t n) const {
  if (sigmoid_) {
    const auto kernel = half ? kernels.sigmoid_rows_half : kernels.sigmoid_rows_float;
    kernel(out, {c, scale, table_.data(), count_, white_, form_}, n);
    return;
  }
  if (grid_) {
    kernels::GridSpectra spectra = {c, scale, grid_->table};
    if (half) spectra.table.lowest = std::max(lowest_, -kernels::kHalfMax);
    (half ? kernels.grid_rows_half : kernels.grid_rows_float)(out, spectra, n);
    return;
  }
  const auto kernel = half ? kernels.smits_rows_half : kernels.smits_rows_float;
  const float lowest = half ? std::max(lowest_, -kernels::kHalfMax) : lowest_;
  kernel(out, c, {table_.data(), count_, lowest}, n);
}

void SampledRows::expand_blocks(const kernels::KernelTable& kernels, const float* const c[3],
                                const float* scale, float* spectra, std::size_t blocks) const {
  if (sigmoid_) {
    kernels.sigmoid_blocks(spectra, {c, scale, table_.data(), count_, white_, form_}, blocks, false);
  } else if (grid_) {
    kernels.grid_blocks(spectra, {c, scale, grid_->table}, blocks, false);
  } else {
    kernels.smits_blocks(spectra, c, {table_.data(), count_, lowest_}, blocks, false);
  }
}

}  // namespace spectile::rows
