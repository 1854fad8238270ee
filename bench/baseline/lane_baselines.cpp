// Operations on lanes beside the AoS baseline: the same lanes, array of structures, scalar code.
#include "bench/baseline/lane_baselines.hpp"

#include <algorithm>
#include <spectile/color/colorimetry.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <string_view>

#include "bench/baseline/aos_baseline.hpp"
#include "bench/operations/own_wavelengths/textures.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// The tables of all functions, for spectra on 60 bands, filled with the operations' own constants.
struct Tables {
  AosTables aos{};
  std::vector<float> even, knots, knot_values, texels;
};

/// Basis of a method, and matching functions under a light; `matrix`: applied to the colour.
Result<void> fill(AosTables& to, const Bands& bands, Method method, const char* light, bool to_srgb) {
  SPECTILE_ASSIGN(const auto upsampler, Upsampler::create(method, Quantity::kReflectance, bands));
  SPECTILE_ASSIGN(const auto spectrum, illuminant(light));
  SPECTILE_ASSIGN(const auto projector, Projector::reflective(bands, spectrum));
  for (std::size_t b = 0; b < bands.count(); ++b) {
    for (std::size_t k = 0; k < 7; ++k) to.basis[k][b] = static_cast<float>(upsampler.basis()[b][k]);
    const auto& xyz = projector.weights()[b];
    const auto rgb = times(projector.xyz_to_srgb(), xyz);
    for (std::size_t k = 0; k < 3; ++k) to.matching[k][b] = static_cast<float>(to_srgb ? rgb[k] : xyz[k]);
    to.light[b] = 1;  // the weights hold it
    to.lambda[b] = static_cast<float>((bands[b].centre_nm - 550) / 150);
  }
  return {};
}

Result<std::shared_ptr<const Tables>> make_tables(const Bands& bands, const Operation& operation) {
  auto out = std::make_shared<Tables>();
  AosTables& t = out->aos;
  const bool relights = operation.group == "relighting";
  const bool exact = operation.name.ends_with("smits-exact");
  SPECTILE_TRY(
      fill(t, bands, exact ? Method::kSmitsExact : Method::kSmits, relights ? "A" : "D65", relights));
  t.first_centre_nm = static_cast<float>(bands[0].centre_nm);
  t.per_nm = static_cast<float>(1 / (bands[1].centre_nm - bands[0].centre_nm));
  SPECTILE_ASSIGN(const auto y, named_spectrum("cie1931-y"));
  for (int nm = 360; nm <= 830; ++nm) out->even.push_back(static_cast<float>(y(nm)));
  out->knots = irregular_knots();
  for (const float nm : out->knots)
    out->knot_values.push_back(static_cast<float>(y(static_cast<double>(nm))));
  std::copy_n(kSigmoidAtWavelengths.c, 3, t.coefficients);
  t.exponent = kPowExponent;
  t.planck_nm = static_cast<float>(kSecondRadiationNmK / kPlanckTemperature);
  t.first_nm = 360;
  t.even = out->even.data();
  t.even_count = static_cast<int>(out->even.size());
  t.knots_nm = out->knots.data();
  t.knot_values = out->knot_values.data();
  t.knots = static_cast<int>(out->knots.size());
  if (operation.name.starts_with("texture")) {
    const bool colors = operation.name.ends_with("smits-exact");
    out->texels = texture_noise(colors ? 0.0F : -3.0F, colors ? 1.0F : 3.0F);
    t.texels = out->texels.data();
    t.texture_side = static_cast<int>(kTextureSide);
  }
  return std::shared_ptr<const Tables>(std::move(out));
}

struct Functions {
  const char* operation;
  AosFunction plain;
  AosFunction fused = nullptr;
};

Functions functions_for(std::string_view operation) {
  const AosBaseline& b = aos_baseline();
  const Functions all[] = {
      {"upsample, smits", b.upsample, b.upsample_fused},
      {"project to XYZ", b.project},
      {"luminance", b.luminance},
      {"multiply", b.multiply},
      {"exp", b.exp},
      {"transmittance", b.transmittance},
      {"pow", b.pow},
      {"relight, smits-exact", b.jobs[kAosJobs - 1].relight},
      {"sigmoid: evaluate", b.sigmoid},
      {"look up at 1 nm", b.interpolate_even},
      {"look up between irregular knots", b.interpolate_knots},
      {"black body", b.planck},
      {"sigmoid at wavelengths", b.sigmoid_at},
      {"colour at 4 wavelengths, smits-exact", b.mixture_at, b.mixture_at_fused},
      {"coefficients at 4 wavelengths, sigmoid", b.sigmoids_at},
      {"texture at 4 wavelengths, smits-exact", b.texture_of_colors, b.texture_of_colors_fused},
      {"texture at 4 wavelengths, sigmoid", b.texture_of_sigmoids},
      {"update throughput", b.update_throughput},
      {"draw 4 wavelengths, visible", b.draw_visible}};
  for (const Functions& f : all) {
    if (operation == f.operation) return f;
  }
  return {nullptr, nullptr};
}

}  // namespace

struct LaneBaseline::State {
  const Operation* operation = nullptr;
  std::shared_ptr<const Tables> tables;
  std::size_t lanes = 0;
  std::vector<float> in, out;  ///< [lane][values]; of samples by themselves [operand][lane]
};

Result<LaneBaseline> LaneBaseline::create(const Operation& operation, const Bands& bands,
                                          const LaneMemory& memory, std::size_t passes) {
  LaneBaseline out;
  const Functions functions = functions_for(operation.name);
  if (functions.plain == nullptr || bands.count() != kMaxAosSamples) return out;
  auto state = std::make_shared<State>();
  state->operation = &operation;
  state->lanes = memory.lanes();
  SPECTILE_ASSIGN(state->tables, make_tables(bands, operation));
  const std::size_t values = operation.in.values();
  const bool operands = operation.group == "arithmetic";
  state->in.resize(values * state->lanes);
  state->out.resize(operation.out.values() * state->lanes);
  std::vector<double> lane_values(values);
  for (std::size_t lane = 0; lane < state->lanes; ++lane) {
    memory.read_in(lane, lane_values.data());
    for (std::size_t k = 0; k < values; ++k) {
      state->in[operands ? k * state->lanes + lane : lane * values + k] = static_cast<float>(lane_values[k]);
    }
  }
  const auto repeated = [&](AosFunction f) {
    return [state, f, passes] {
      for (std::size_t i = 0; i < passes; ++i) {
        f(state->tables->aos, state->in.data(), state->out.data(), state->lanes);
      }
    };
  };
  out.plain.run = repeated(functions.plain);
  if (functions.fused != nullptr) out.fused.run = repeated(functions.fused);
  out.state_ = std::move(state);
  return out;
}

double LaneBaseline::error(std::size_t lanes, bool of_fused) const {
  (of_fused ? fused : plain).run();
  const State& s = *state_;
  const std::size_t values = s.operation->in.values();
  const std::size_t results = s.operation->out.values();
  const bool operands = s.operation->group == "arithmetic";
  std::vector<double> in(values);
  std::vector<double> out(results);
  double worst = 0;
  for (std::size_t lane = 0; lane < std::min(lanes, s.lanes); ++lane) {
    for (std::size_t k = 0; k < values; ++k) {
      in[k] = static_cast<double>(s.in[operands ? k * s.lanes + lane : lane * values + k]);
    }
    for (std::size_t k = 0; k < results; ++k) out[k] = static_cast<double>(s.out[lane * results + k]);
    const double error = s.operation->error(in.data(), out.data(), 0x1p-149);
    if (error != kOutOfDomain) worst = std::max(worst, error);
  }
  return worst;
}

}  // namespace spectile::measure
