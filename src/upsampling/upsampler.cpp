// Upsampler: a method prepared for given bands, light, observer and primaries.
#include <algorithm>
#include <limits>
#include <spectile/upsampling/learned_nodes.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "kernels/abi.hpp"
#include "src/base/enum_names.hpp"
#include "src/color/working_space.hpp"
#include "src/data/tables.hpp"
#include "src/spectra/band_weights.hpp"
#include "src/upsampling/exact_basis.hpp"
#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile {
namespace {

constexpr EnumName<Method> kMethods[] = {{Method::kSmits, "smits"},
                                         {Method::kSmits1999, "smits1999"},
                                         {Method::kSmitsExact, "smits-exact"},
                                         {Method::kMallett, "mallett"},
                                         {Method::kSigmoid, "sigmoid"},
                                         {Method::kSigmoidObserver, "sigmoid-observer"},
                                         {Method::kTetrahedral, "tetrahedral"}};

constexpr EnumName<Quantity> kQuantities[] = {{Quantity::kReflectance, "reflectance"},
                                              {Quantity::kUnbounded, "unbounded"},
                                              {Quantity::kIlluminant, "illuminant"}};

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

/// The published bases of Smits, averaged over the bands.
Result<BasisTable> published_basis(Method method, Quantity quantity, const Bands& bands) {
  const data::SmitsData& data = data_for(method, quantity);
  const bool times_light = method == Method::kSmits1999 && quantity == Quantity::kIlluminant;
  const MeasuredSpectrum light = d65_of_luminance_one();
  BasisTable out(bands.count());
  for (std::size_t k = 0; k < 7; ++k) {
    SPECTILE_ASSIGN(const auto basis, MeasuredSpectrum::from_samples(data.wavelengths_nm, data.basis[k]));
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const Band& band = bands[b];
      const bool averages = times_light && !bands.are_points();
      const double sample =
          averages ? product_integral(basis, light, band.lower_nm, band.upper_nm) / band.width_nm()
                   : sample_in(basis, bands, b) * (times_light ? light.at(band.centre_nm) : 1);
      out[b][k] = data.scale * sample;
    }
  }
  return out;
}

/// Luminance of red, green and blue, for the light's white as the whole visible range shows it.
Result<std::array<float, 3>> luminance_weights(const UpsamplerOptions& options,
                                               const MeasuredSpectrum& light) {
  SPECTILE_ASSIGN(const auto visible, Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 1));
  SPECTILE_ASSIGN(const auto space,
                  working_space(visible, false, options.primaries, light, options.observer));
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(space.rgb_to_xyz[3 + k]);
  return out;
}

/// True if the tables in src/data are those asked for.
bool is_precomputed(Quantity quantity, const Bands& bands, const UpsamplerOptions& options) {
  return quantity != Quantity::kIlluminant && bands == Bands() && options.primaries == kRec709 &&
         !options.light && options.observer == Observer::kCie1931;
}

BasisTable from_rows(data::BasisRows rows) {
  BasisTable out;
  for (const double(&row)[7] : rows) out.push_back(std::to_array(row));
  return out;
}

Result<BasisTable> exact_basis(Method method, Quantity quantity, const Bands& bands,
                               const UpsamplerOptions& options, const WorkingSpace& space) {
  const bool smits = method == Method::kSmitsExact;
  if (is_precomputed(quantity, bands, options)) {
    return from_rows(smits ? data::kSmitsExact : data::kMallettExact);
  }
  auto basis = smits ? smoothest_basis(bands, space) : primary_decomposition(bands, space);
  if (basis) return *std::move(basis);
  return make_error(ErrorCode::kBadArgument,
                    "{} has no spectra between 0 and 1 with the colours of this RGB space's corners over the "
                    "bands {}; sigmoid makes every colour that is possible{}",
                    to_string(method), bands.description(),
                    options.primaries == kRec709 ? ", smits takes any bands" : "");
}

/// Errors: kBadArgument for nodes of another method, white or observer, or of other primaries than sRGB's.
Result<void> check_nodes(Method method, const LearnedNodes& nodes, const MeasuredSpectrum& light,
                         const UpsamplerOptions& options) {
  if (method != Method::kTetrahedral) {
    return make_error(ErrorCode::kBadArgument, "learned nodes are for tetrahedral, not for {}",
                      to_string(method));
  }
  if (const std::string what = nodes_flaw(nodes); !what.empty())
    return make_error(ErrorCode::kBadArgument, "the learned nodes cannot be: {}", what);
  if (!(options.primaries == kRec709)) {
    return make_error(ErrorCode::kBadArgument, "nodes are learned for the primaries of sRGB");
  }
  if (nodes.observer != options.observer || !same_light(nodes.light.spectrum, light)) {
    return make_error(
        ErrorCode::kBadArgument,
        "the nodes were learned for the white {} and the observer of {}; for another white or observer "
        "they are learned anew (spectile fit --white, --white-observer)",
        nodes.light.name, to_string(nodes.observer));
  }
  return {};
}

}  // namespace

Result<Method> parse_method(std::string_view name) {
  return parse_enum(kMethods, "method", name);
}

Result<Quantity> parse_quantity(std::string_view name) {
  return parse_enum(kQuantities, "quantity", name);
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& method : kMethods) names.emplace_back(method.name);
  return names;
}

std::string_view to_string(Method method) {
  return enum_name(kMethods, method);
}

std::string_view to_string(Quantity quantity) {
  return enum_name(kQuantities, quantity);
}

Result<Upsampler> Upsampler::create(Method method, Quantity quantity, const Bands& bands,
                                    NegativeSamples negative) {
  UpsamplerOptions options;
  options.negative = negative;
  return create(method, quantity, bands, options);
}

Result<Upsampler> Upsampler::create(Method method, Quantity quantity, const Bands& bands,
                                    const UpsamplerOptions& options) {
  const bool published = method == Method::kSmits || method == Method::kSmits1999;
  if (published && (options.light || options.observer != Observer::kCie1931)) {
    return make_error(ErrorCode::kBadArgument,
                      "{} is published for D65 and the 2 degree observer; smits-exact, mallett, sigmoid, "
                      "sigmoid-observer and tetrahedral take others",
                      to_string(method));
  }
  if ((published || method == Method::kMallett) && !(options.primaries == kRec709)) {
    return make_error(ErrorCode::kBadArgument,
                      "{} is published for the primaries of sRGB; smits-exact, sigmoid, sigmoid-observer and "
                      "tetrahedral take others",
                      to_string(method));
  }
  const MeasuredSpectrum light = options.light ? *options.light : *illuminant("D65");
  if (options.nodes) SPECTILE_TRY(check_nodes(method, *options.nodes, light, options));
  const auto space =
      working_space(bands, quantity == Quantity::kIlluminant, options.primaries, light, options.observer);
  if (!space && !published) return space.error();
  Upsampler out;
  out.method_ = method;
  out.quantity_ = quantity;
  out.bands_ = bands;
  out.options_ = options;
  out.rgb_to_xyz_ = space ? space->rgb_to_xyz : srgb_to_xyz_matrix();
  SPECTILE_ASSIGN(out.luminance_, luminance_weights(options, light));
  out.lowest_ = options.negative == NegativeSamples::kKeep ? -std::numeric_limits<float>::infinity() : 0.0F;
  if (is_sigmoid(method)) {
    const auto functions = method == Method::kSigmoid ? std::nullopt : std::optional(options.observer);
    SPECTILE_ASSIGN(out.sigmoid_, sigmoid_model(bands, *space, SigmoidFunctions::of(functions)));
    SPECTILE_ASSIGN(out.at_wavelengths_, wavelength_tables(out));
    return out;
  }
  if (method == Method::kTetrahedral) {
    SPECTILE_ASSIGN(auto grid, sigmoid_grid(bands, *space, options.observer, options.nodes.get()));
    SPECTILE_ASSIGN(out.grid_, grid_model(std::move(grid), out.lowest_, quantity != Quantity::kReflectance));
    SPECTILE_ASSIGN(out.at_wavelengths_, wavelength_tables(out));
    return out;
  }
  SPECTILE_ASSIGN(out.basis_, published ? published_basis(method, quantity, bands)
                                        : exact_basis(method, quantity, bands, options, *space));
  SPECTILE_ASSIGN(auto table, FloatBuffer::create(bands.count() * kernels::kSmitsRow));
  std::fill_n(table.data(), table.size(), 0.0F);
  for (std::size_t b = 0; b < bands.count(); ++b) {
    for (std::size_t k = 0; k < 7; ++k) {
      table.data()[b * kernels::kSmitsRow + k] = static_cast<float>(out.basis_[b][k]);
    }
  }
  out.table_ = std::make_shared<const FloatBuffer>(std::move(table));
  SPECTILE_ASSIGN(out.at_wavelengths_, wavelength_tables(out));
  return out;
}

}  // namespace spectile
