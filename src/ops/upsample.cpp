// Smits upsampling of batches, from linear sRGB and from XYZ.
#include <algorithm>
#include <limits>
#include <spectile/colorimetry.hpp>
#include <spectile/measured_spectrum.hpp>
#include <spectile/upsample.hpp>

#include "src/data/tables.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/ops/color_matrix.hpp"
#include "src/ops/shape.hpp"
#include "src/ops/tiles.hpp"

namespace spectile {
namespace {

static_assert(kLanesPerBlock == kernels::kLanes);

// Larger batches than this go round the caches: they would only push out what is used next.
constexpr std::size_t kStreamingBytes = std::size_t{64} << 20;

/// D65 scaled so that its luminance equals that of a spectrum that is 1 everywhere.
MeasuredSpectrum d65_of_luminance_one() {
  const MeasuredSpectrum d65 = *illuminant("D65");
  const data::MatchingFunctions& observer = data::kCie1931;
  double of_light = 0;
  double of_one = 0;
  for (std::size_t i = 0; i < observer.y_bar.size(); ++i) {
    const double lambda_nm = observer.first_nm + static_cast<double>(i) * observer.step_nm;
    of_light += observer.y_bar[i] * d65.at(lambda_nm);
    of_one += observer.y_bar[i];
  }
  return d65.scaled(of_one / of_light);
}

const data::SmitsData& data_for(Method method, Quantity quantity) {
  if (method == Method::kSmits1999) return data::kSmits1999;
  return quantity == Quantity::kIlluminant ? data::kSmitsIlluminant : data::kSmitsReflectance;
}

/// Runs the kernel for the tile of `count` blocks that starts at block `first`.
void upsample_tile(const kernels::KernelTable& table, const Upsampler& upsampler, const ColorView& rgb,
                   float* spectra, std::size_t first, std::size_t count, bool stream) {
  const std::size_t at = first * kLanesPerBlock;
  const float* const planes[3] = {rgb.c[0] + at, rgb.c[1] + at, rgb.c[2] + at};
  const std::size_t bands = upsampler.bands().count();
  table.smits_blocks(spectra + at * bands, planes, upsampler.table(), upsampler.lowest(), bands, count,
                     stream);
}

Result<void> check(const Upsampler& upsampler, const ColorView& in, const SampledSpectraSpan& spectra) {
  SPECTILE_TRY(shape::bands_of("the upsampler", upsampler.bands(), spectra.bands));
  SPECTILE_TRY(shape::same_lanes(in.lanes, spectra.lanes));
  SPECTILE_TRY(shape::aligned(spectra.data));
  for (const float* plane : in.c) SPECTILE_TRY(shape::aligned(plane));
  return {};
}

bool streams(Stores stores, const SampledSpectraSpan& spectra) {
  const std::size_t bytes = SampledSpectraView(spectra).floats() * sizeof(float);
  return stores == Stores::kStreaming || (stores == Stores::kAuto && bytes > kStreamingBytes);
}

}  // namespace

Result<Method> parse_method(std::string_view name) {
  if (name == "smits") return Method::kSmits;
  if (name == "smits1999") return Method::kSmits1999;
  return make_error(ErrorCode::kUnknownName, "method \"{}\" is unknown; there are smits, smits1999", name);
}

Result<Quantity> parse_quantity(std::string_view name) {
  if (name == "reflectance") return Quantity::kReflectance;
  if (name == "illuminant") return Quantity::kIlluminant;
  return make_error(ErrorCode::kUnknownName, "quantity \"{}\" is unknown; there are reflectance, illuminant",
                    name);
}

std::string_view to_string(Method method) {
  return method == Method::kSmits ? "smits" : "smits1999";
}

std::string_view to_string(Quantity quantity) {
  return quantity == Quantity::kReflectance ? "reflectance" : "illuminant";
}

Result<Upsampler> Upsampler::create(Method method, Quantity quantity, const Bands& bands,
                                    NegativeSamples negative) {
  const data::SmitsData& data = data_for(method, quantity);
  const bool times_light = method == Method::kSmits1999 && quantity == Quantity::kIlluminant;
  const MeasuredSpectrum light = d65_of_luminance_one();
  Upsampler out;
  out.method_ = method;
  out.quantity_ = quantity;
  out.bands_ = bands;
  out.lowest_ = negative == NegativeSamples::kKeep ? -std::numeric_limits<float>::infinity() : 0.0F;
  out.basis_.resize(bands.count());
  auto table = FloatBuffer::create(bands.count() * kernels::kSmitsRow);
  if (!table) return table.error();
  out.table_ = *std::move(table);
  std::fill_n(out.table_.data(), out.table_.size(), 0.0F);
  for (std::size_t k = 0; k < 7; ++k) {
    const auto basis = MeasuredSpectrum::from_samples(data.wavelengths_nm, data.basis[k]);
    if (!basis) return basis.error();
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const Band& band = bands[b];
      const double total = times_light ? product_integral(*basis, light, band.lower_nm, band.upper_nm)
                                       : basis->integral(band.lower_nm, band.upper_nm);
      out.basis_[b][k] = data.scale * total / band.width_nm();
      out.table_.data()[b * kernels::kSmitsRow + k] = static_cast<float>(out.basis_[b][k]);
    }
  }
  return out;
}

Result<void> upsample_srgb(const Upsampler& upsampler, ColorView rgb, SampledSpectraSpan spectra,
                           Stores stores, const Execution& how) {
  SPECTILE_TRY(check(upsampler, rgb, spectra));
  const auto table = dispatch::active();
  if (!table) return table.error();
  const bool stream = streams(stores, spectra);
  tiles::for_blocks(blocks_for(rgb.lanes), how, [&](std::size_t first, std::size_t count) {
    upsample_tile(**table, upsampler, rgb, spectra.data, first, count, stream);
  });
  return {};
}

Result<void> upsample_xyz(const Upsampler& upsampler, ColorView xyz, SampledSpectraSpan spectra,
                          Stores stores, const Execution& how) {
  SPECTILE_TRY(check(upsampler, xyz, spectra));
  const auto table = dispatch::active();
  if (!table) return table.error();
  const bool stream = streams(stores, spectra);
  const std::array<float, 9> matrix = color::to_float(xyz_to_srgb_matrix());
  tiles::for_blocks(blocks_for(xyz.lanes), how, [&](std::size_t first, std::size_t count) {
    // A block's RGB stays in the first-level cache on its way from the matrix to the basis spectra.
    alignas(64) float rgb[3][kLanesPerBlock];
    float* const planes[3] = {rgb[0], rgb[1], rgb[2]};
    const float* const source[3] = {rgb[0], rgb[1], rgb[2]};
    const std::size_t bands = upsampler.bands().count();
    for (std::size_t block = first; block < first + count; ++block) {
      const std::size_t at = block * kLanesPerBlock;
      const float* const in[3] = {xyz.c[0] + at, xyz.c[1] + at, xyz.c[2] + at};
      (*table)->transform3(planes, in, matrix.data(), kLanesPerBlock);
      (*table)->smits_blocks(spectra.data + at * bands, source, upsampler.table(), upsampler.lowest(), bands,
                             1, stream);
    }
  });
  return {};
}

}  // namespace spectile
