// Options by which colours become spectra, common to upsample, relight and verify.
#include "src/cli/options/method_options.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<Quantity> kQuantities[] = {{"reflectance", Quantity::kReflectance},
                                            {"unbounded", Quantity::kUnbounded},
                                            {"illuminant", Quantity::kIlluminant}};
constexpr Choice<NegativeInput> kNegatives[] = {{"gamut", NegativeInput::kGamut},
                                                {"clip", NegativeInput::kClip},
                                                {"keep", NegativeInput::kKeep},
                                                {"error", NegativeInput::kError},
                                                {"stop", NegativeInput::kError}};
constexpr Choice<GamutPolicy> kGamutPolicies[] = {{"clip", GamutPolicy::kClip},
                                                  {"keep", GamutPolicy::kKeep},
                                                  {"error", GamutPolicy::kError},
                                                  {"stop", GamutPolicy::kError}};

}  // namespace

void add_method_option(CLI::App& command, std::string& method) {
  OptionAdder{command}("--method", method, "NAME", kColorGroup,
                       "smits-exact, sigmoid, mallett, smits or smits1999 (docs/methods.md)")
      ->check(CLI::IsMember(method_names()).description(""))
      ->capture_default_str();
}

void add_rgb_input_options(CLI::App& command, std::string& input_space, std::string& layer) {
  const OptionAdder option{command};
  option("--input-space", input_space, "NAME", kColorGroup, CLI::detail::join(rgb_space_names(), ", "))
      ->check(CLI::IsMember(rgb_space_names(), CLI::ignore_case).description(""));
  option("--layer", layer, "NAME", kFilesGroup, "Layer, view or part to take R, G, B from");
}

std::optional<RgbSpace> space_of(const std::string& name) {
  return name.empty() ? std::nullopt : std::optional(take(rgb_space(name)));
}

void add_method_options(CLI::App& command, MethodArguments& a) {
  add_method_option(command, a.method);
  const OptionAdder option{command};
  option.choice("--quantity", a.quantity, kQuantities, kColorGroup,
                "reflectance, unbounded (of any scale) or illuminant (emission)");
  option("--white", a.white, "SPECTRUM", kColorGroup,
         "Reference white: RGB 1,1,1 is the perfect diffuser under it; D65 by default");
  add_observer_option(command, a.white_observer, "--white-observer");
  add_rgb_input_options(command, a.input_space, a.layer);
  option.choice("--negative", a.negative, kNegatives, kColorGroup,
                "Components below 0: gamut (as colours out of gamut), clip, keep or error");
  option.choice("--out-of-gamut", a.out_of_gamut, kGamutPolicies, kColorGroup,
                "Colours the method cannot make: clip, keep or error; clip by default");
  option("--bands", a.bands, "BANDS", kBandsGroup,
         "FIRST:LAST:STEP or a list of centres in nm, or a plan (plan.json)")
      ->capture_default_str();
}

void apply_method_options(const MethodArguments& a, MethodOptions& out) {
  out.method = take(parse_method(a.method));
  out.quantity = a.quantity;
  out.bands = take(find_bands(a.bands));
  // D65 by name is the default.
  if (!a.white.empty()) {
    out.light = take(find_light(a.white));
    if (CLI::detail::to_lower(a.white) == "d65") out.light.reset();
  }
  out.observer = a.white_observer;
  out.input_space = space_of(a.input_space);
  out.negative = a.negative;
  out.out_of_gamut = a.out_of_gamut;
  out.layer = a.layer;
}

}  // namespace spectile::cli
