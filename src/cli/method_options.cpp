// Options by which colours become spectra, common to upsample, relight and verify.
#include "src/cli/method_options.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace spectile::cli {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

void add_method_options(CLI::App& command, MethodArguments& a) {
  command
      .add_option(
          "--method", a.method,
          "smits-exact: the smoothest basis spectra whose colours come back exactly, as fast as smits, "
          "and values above 1 go on linearly; sigmoid: exact, smooth, nearest to measured reflectances "
          "under other lights (16 % less error on average), also for colours outside sRGB, at seven times "
          "the arithmetic; mallett: exact and linear, so filtering before or after is the same; smits: "
          "32-sample basis spectra, some 3 % off; smits1999: the ten samples of the paper")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command
      .add_option(
          "--quantity", a.quantity,
          "reflectance (channels T.*nm), unbounded: the same on any scale, above 1 too, or illuminant: "
          "emitted light (channels S0.*nm)")
      ->check(CLI::IsMember({"reflectance", "unbounded", "illuminant"}))
      ->capture_default_str();
  command
      .add_option(
          "--bands", a.bands,
          "FIRST:LAST:STEP in nm, a list of centres, or a plan (plan.json, by spectile plan), which does "
          "with "
          "some eight bands what the default's sixty do. The default cuts off what the eye sees beyond it: a "
          "mean error of 0.14 CIEDE2000 under D65, against 0.03 for 380:780:5")
      ->capture_default_str();
  command.add_option(
      "--white", a.light,
      "Light under which RGB 1,1,1 is the white reflector (for illuminants: that light itself), "
      "for smits-exact, mallett and sigmoid: " +
          light_help() + "; D65 by default");
  command
      .add_option("--white-observer", a.observer, "Observer of the same: 1931 (2 degree) or 1964 (10 degree)")
      ->check(CLI::IsMember({"1931", "1964"}))
      ->capture_default_str();
  command
      .add_option("--input-space", a.input_space,
                  "Space of the linear RGB, whatever the file says: " + joined(rgb_space_names()) +
                      "; by default that of the attributes colorInteropID or chromaticities, else sRGB. A "
                      "reflectance's white is adapted (Bradford) from the space's to D65, light is not")
      ->check(CLI::IsMember(rgb_space_names(), CLI::ignore_case));
  command
      .add_option(
          "--negative", a.negative,
          "Components below 0 in the file: gamut (treat them as colours out of gamut), clip to 0, keep "
          "(samples may fall below 0 too) or stop")
      ->check(CLI::IsMember({"gamut", "clip", "keep", "stop"}))
      ->capture_default_str();
  command
      .add_option(
          "--out-of-gamut", a.out_of_gamut,
          "Colours that the method cannot make: clip (to the nearest at the same luminance and dominant "
          "wavelength), keep or error; clip by default, keep with --negative keep")
      ->check(CLI::IsMember({"clip", "keep", "error"}));
  command.add_option("--layer", a.layer, "Layer, view or part to take R, G, B from");
}

int apply_method_options(const MethodArguments& a, MethodOptions& out) {
  const auto method = parse_method(a.method);
  if (!method) return complain(method.error());
  out.method = *method;
  const auto quantity = parse_quantity(a.quantity);
  if (!quantity) return complain(quantity.error());
  out.quantity = *quantity;
  const auto bands = find_bands(a.bands);
  if (!bands) return complain(bands.error());
  out.bands = *bands;
  if (!a.light.empty()) {
    auto light = load_light(a.light);
    if (!light) return complain(light.error());
    // D65 by name is what there is without any.
    if (CLI::detail::to_lower(a.light) != "d65") out.light = *std::move(light);
  }
  out.observer = a.observer == "1964" ? Observer::kCie1964 : Observer::kCie1931;
  if (!a.input_space.empty()) {
    auto space = rgb_space(a.input_space);
    if (!space) return complain(space.error());
    out.input_space = *std::move(space);
  }
  out.negative = a.negative == "keep"   ? Negative::kKeep
                 : a.negative == "stop" ? Negative::kStop
                 : a.negative == "clip" ? Negative::kClip
                                        : Negative::kGamut;
  if (!a.out_of_gamut.empty()) {
    out.out_of_gamut = a.out_of_gamut == "keep"    ? GamutPolicy::kKeep
                       : a.out_of_gamut == "error" ? GamutPolicy::kStop
                                                   : GamutPolicy::kClip;
  }
  out.layer = a.layer;
  return kOk;
}

Result<NamedLight> load_light(const std::string& text) {
  auto found = find_spectrum(text);
  if (!found) return found.error();
  std::string name = named_spectrum(text) ? text : std::filesystem::path(text).filename().string();
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (CLI::detail::to_lower(info.name) == CLI::detail::to_lower(text)) name = info.name;
  }
  if (const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&found->kind())) {
    return NamedLight{std::move(name), linear->measured()};
  }
  const std::vector<double> wavelengths = tabulated_nm();
  auto table = MeasuredSpectrum::from_samples(wavelengths, found->sample(wavelengths));
  if (!table) return table.error();
  return NamedLight{std::move(name), *std::move(table)};
}

std::vector<double> tabulated_nm() {
  std::vector<double> out;
  for (int nm = 300; nm <= 830; ++nm) out.push_back(nm);
  return out;
}

std::string light_help() {
  return "a spectrum as spectile spectra takes it: blackbody:KELVIN, daylight:KELVIN, a file, or a name, of "
         "which the lights are " +
         joined(illuminant_names());
}

Adaptation adaptation_of(const std::string& text) {
  return text == "bradford" ? Adaptation::kBradford
         : text == "cat16"  ? Adaptation::kCat16
                            : Adaptation::kNone;
}

void add_adaptation_option(CLI::App& command, std::string& text) {
  command
      .add_option("--adapt", text,
                  "Chromatic adaptation from the light's white to D65: none, bradford or cat16")
      ->check(CLI::IsMember({"none", "bradford", "cat16"}))
      ->capture_default_str();
}

}  // namespace spectile::cli
