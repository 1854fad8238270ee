// Options by which colours become spectra, common to upsample, relight and verify.
#include "src/cli/options/method_options.hpp"

#include <fmt/format.h>

#include "src/cli/options/parse.hpp"

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

void add_method_option(const Command& command, std::string& method) {
  command
      .option("--method", method, "NAME", kColorGroup,
              "smits-exact, sigmoid, mallett, smits or smits1999 (docs/methods.md)")
      .one_of(method_names())
      .show_default();
}

void add_rgb_input_options(const Command& command, std::string& input_space, std::string& layer) {
  command
      .option("--input-space", input_space, "NAME", kColorGroup,
              fmt::format("{}", fmt::join(rgb_space_names(), ", ")))
      .one_of(rgb_space_names(), Option::Case::kIgnored);
  command.option("--layer", layer, "NAME", kFilesGroup, "Layer, view or part to take R, G, B from");
}

std::optional<RgbSpace> space_of(const std::string& name) {
  return name.empty() ? std::nullopt : std::optional(take(rgb_space(name)));
}

void add_method_options(const Command& command, MethodArguments& a) {
  add_method_option(command, a.method);
  command.choice("--quantity", a.quantity, kQuantities, kColorGroup,
                 "reflectance, unbounded (of any scale) or illuminant (emission)");
  command.option("--white", a.white, "SPECTRUM", kColorGroup,
                 "Reference white: RGB 1,1,1 is the perfect diffuser under it; D65 by default");
  add_observer_option(command, a.white_observer, "--white-observer");
  add_spectrum_options(command, a.spectra);
  add_rgb_input_options(command, a.input_space, a.layer);
  command.choice("--negative", a.negative, kNegatives, kColorGroup,
                 "Components below 0: gamut (as colours out of gamut), clip, keep or error");
  command.choice("--out-of-gamut", a.out_of_gamut, kGamutPolicies, kColorGroup,
                 "Colours the method cannot make: clip, keep or error; clip by default");
  command
      .option("--bands", a.bands, "BANDS", kBandsGroup,
              "FIRST:LAST:STEP or a list of centres in nm, or a plan (plan.json)")
      .show_default();
}

void apply_method_options(const MethodArguments& a, MethodOptions& out) {
  out.method = take(parse_method(a.method));
  out.quantity = a.quantity;
  out.bands = take(find_bands(a.bands));
  // D65 by name is the default.
  if (!a.white.empty()) {
    out.light = take(find_light(a.white, file_options(a.spectra)));
    if (lower_case(a.white) == "d65") out.light.reset();
  }
  out.observer = a.white_observer;
  out.input_space = space_of(a.input_space);
  out.negative = a.negative;
  out.out_of_gamut = a.out_of_gamut;
  out.layer = a.layer;
}

}  // namespace spectile::cli
