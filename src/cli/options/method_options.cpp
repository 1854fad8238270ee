// Options by which colours become spectra, common to upsample, relight and verify.
#include "src/cli/options/method_options.hpp"

#include <fmt/format.h>

#include <spectile/image/nodes_file.hpp>

#include "src/cli/options/parse.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<Quantity> kQuantities[] = {{"reflectance", Quantity::kReflectance},
                                            {"unbounded", Quantity::kUnbounded},
                                            {"illuminant", Quantity::kIlluminant},
                                            {"emission", Quantity::kIlluminant}};
constexpr Choice<NegativeInput> kNegatives[] = {{"gamut", NegativeInput::kGamut},
                                                {"clip", NegativeInput::kClip},
                                                {"keep", NegativeInput::kKeep},
                                                {"error", NegativeInput::kError},
                                                {"stop", NegativeInput::kError}};
constexpr Choice<GamutPolicy> kGamutPolicies[] = {{"clip", GamutPolicy::kClip},
                                                  {"keep", GamutPolicy::kKeep},
                                                  {"error", GamutPolicy::kError},
                                                  {"stop", GamutPolicy::kError}};

constexpr Choice<AlphaMeaning> kAlphaMeanings[] = {{"premultiplied", AlphaMeaning::kPremultiplied},
                                                   {"straight", AlphaMeaning::kStraight},
                                                   {"ignore", AlphaMeaning::kIgnored}};

}  // namespace

void add_alpha_option(const Command& command, MethodArguments& a) {
  command.choice("--alpha", a.alpha, kAlphaMeanings, kColorGroup,
                 "Colour of pixels that are not opaque: premultiplied, straight, or ignore alpha");
}

void add_method_option(const Command& command, std::string& method) {
  command.option("--method", method, "NAME", kColorGroup, fmt::format("{}", fmt::join(method_names(), ", ")))
      .one_of(method_names())
      .show_default();
}

void add_rgb_input_options(const Command& command, std::string& input_space, ChannelArguments& channels) {
  command.option("--input-space", input_space, "NAME", kColorGroup,
                 fmt::format("{}", fmt::join(rgb_space_names(), ", ")));
  add_channel_options(command, channels);
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
  command.option("--nodes", a.nodes, "FILE", kColorGroup,
                 "For tetrahedral: what fit learned from measured reflectances");
  add_spectrum_options(command, a.spectra);
  add_rgb_input_options(command, a.input_space, a.channels);
  command.choice("--negative", a.negative, kNegatives, kColorGroup,
                 "Components below 0: gamut (as colours out of gamut), clip, keep or error");
  command.choice("--out-of-gamut", a.out_of_gamut, kGamutPolicies, kColorGroup,
                 "Colours the method cannot make: clip, keep or error; clip by default");
  command
      .option("--bands", a.bands, "BANDS", kBandsGroup,
              "FIRST:LAST:STEP (outer edges, width), or centres in nm, or a plan.json")
      .show_default();
}

void apply_method_options(const MethodArguments& a, MethodOptions& out) {
  out.method = take(parse_method(a.method));
  out.quantity = a.quantity;
  out.bands = take(bands_of(a.bands));
  // D65 by name is the default.
  if (!a.white.empty()) {
    out.light = take(find_light(a.white, file_options(a.spectra)));
    if (lower_case(a.white) == "d65") out.light.reset();
  }
  out.observer = a.white_observer;
  if (!a.nodes.empty()) {
    if (out.method != Method::kTetrahedral)
      throw Stop(complain_usage(fmt::format("--nodes is for --method tetrahedral, not {}", a.method)));
    out.nodes = std::make_shared<const LearnedNodes>(take(load_nodes(a.nodes)));
  }
  out.input_space = space_of(a.input_space);
  out.negative = a.negative;
  out.out_of_gamut = a.out_of_gamut;
  out.alpha = a.alpha;
  out.channels = channel_choice(a.channels);
}

std::vector<NamedFile> method_files(const MethodArguments& a) {
  return files_among({{a.white, "the reference white (--white)"},
                      {file_of_bands(a.bands), kBandsRole},
                      {a.nodes, "the nodes (--nodes)"}});
}

ColorHandling color_handling(const MethodOptions& options) {
  ColorHandling out;
  out.negative = options.negative;
  out.out_of_gamut = options.out_of_gamut.value_or(
      options.negative == NegativeInput::kKeep ? GamutPolicy::kKeep : GamutPolicy::kClip);
  out.clips_above_one = is_sigmoid(options.method) && out.out_of_gamut == GamutPolicy::kClip;
  return out;
}

}  // namespace spectile::cli
