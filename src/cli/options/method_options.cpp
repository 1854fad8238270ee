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
  command
      .add_option("--method", method, "smits-exact, sigmoid, mallett, smits or smits1999 (docs/methods.md)")
      ->type_name("NAME")
      ->check(CLI::IsMember(method_names()).description(""))
      ->capture_default_str()
      ->group(kColorGroup);
}

void add_rgb_input_options(CLI::App& command, std::string& input_space, std::string& layer) {
  std::string names;
  for (const std::string& name : rgb_space_names()) names += (names.empty() ? "" : ", ") + name;
  command.add_option("--input-space", input_space, names)
      ->type_name("NAME")
      ->check(CLI::IsMember(rgb_space_names(), CLI::ignore_case).description(""))
      ->group(kColorGroup);
  command.add_option("--layer", layer, "Layer, view or part to take R, G, B from")
      ->type_name("NAME")
      ->group(kFilesGroup);
}

int take_space(const std::string& name, std::optional<RgbSpace>& out) {
  return name.empty() ? kOk : take(rgb_space(name), out);
}

void add_method_options(CLI::App& command, MethodArguments& a) {
  add_method_option(command, a.method);
  add_choice(command, "--quantity", a.quantity, kQuantities,
             "reflectance, unbounded (of any scale) or illuminant (emission)")
      ->group(kColorGroup);
  command
      .add_option("--white", a.white,
                  "Reference white: RGB 1,1,1 is the perfect diffuser under it; D65 by default")
      ->type_name("SPECTRUM")
      ->group(kColorGroup);
  add_observer_option(command, a.white_observer, "--white-observer");
  add_rgb_input_options(command, a.input_space, a.layer);
  add_choice(command, "--negative", a.negative, kNegatives,
             "Components below 0: gamut (as colours out of gamut), clip, keep or error")
      ->group(kColorGroup);
  add_choice(command, "--out-of-gamut", a.out_of_gamut, kGamutPolicies,
             "Colours the method cannot make: clip, keep or error; clip by default")
      ->group(kColorGroup);
  command.add_option("--bands", a.bands, "FIRST:LAST:STEP or a list of centres in nm, or a plan (plan.json)")
      ->type_name("BANDS")
      ->capture_default_str()
      ->group(kBandsGroup);
}

int apply_method_options(const MethodArguments& a, MethodOptions& out) {
  if (const int bad = take(parse_method(a.method), out.method)) return bad;
  out.quantity = a.quantity;
  if (const int bad = take(find_bands(a.bands), out.bands)) return bad;
  // D65 by name is the default.
  if (!a.white.empty()) {
    if (const int bad = take(find_light(a.white), out.light)) return bad;
    if (CLI::detail::to_lower(a.white) == "d65") out.light.reset();
  }
  out.observer = a.white_observer;
  if (const int bad = take_space(a.input_space, out.input_space)) return bad;
  out.negative = a.negative;
  out.out_of_gamut = a.out_of_gamut;
  out.layer = a.layer;
  return kOk;
}

}  // namespace spectile::cli
