// Plans as JSON, and the colours of textures as what a plan is made for.
#pragma once

#include <spectile/image/image.hpp>
#include <spectile/plan/plan.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// A plan as JSON text: {"wavelengths_nm": [..], "sensor": {"x": [..], "y": [..], "z": [..]}, "illuminants":
/// [{"name": "D65", "emission": [..]}], "observer": "1931", "promise": {..}}. A light whose name
/// illuminant() knows, with that spectrum, has no spectrum of its own there; others have "spectrum":
/// {"wavelengths_nm": [..], "values": [..]}. Plans of bands have "bands_nm": [[lower, upper], ..] too.
/// Numbers come back to the bit. Lines are indented, and end in a line break, where it is not to be one line.
std::string plan_to_json(const Plan& plan, bool one_line = false);

/// Reads the text of plan_to_json(); unknown keys are ignored, "promise", the cross-validated errors, may be
/// missing. Errors: kBadFile, naming `source`, for what is no JSON, and for a plan that cannot be: lists of
/// different lengths, wavelengths that do not ascend or are not from 100 to 10000 nm, numbers that are not
/// finite, no light, a light by an unknown name without a spectrum, two lights of one name.
Result<Plan> parse_plan(std::string_view json, const std::string& source);

/// The same from a file. Errors: kNoPermission too.
Result<Plan> load_plan(const std::string& path);

/// Bands from what a user writes: as Bands::parse() takes them, or the path of a plan. Errors: those of
/// Bands::parse(), load_plan() and planned_bands().
Result<Bands> find_bands(const std::string& text);

/// Writes a plan, whole or not at all. Errors: kNoPermission, kNoSpace, kBadFile; kBadArgument for a plan
/// that parse_plan() would refuse.
Result<void> save_plan(const Plan& plan, const std::string& path);

/// Reflectances of a texture's colours: at most `most` representative ones, each upsampled by the options'
/// method over 360 to 830 nm. Deterministic. `notes`, if given, becomes what a report on the image would
/// note. Errors: those of upsample_image().
Result<std::vector<Spectrum>> texture_reflectances(const std::string& path, std::size_t most,
                                                   const MethodOptions& options = {},
                                                   std::vector<std::string>* notes = nullptr);

}  // namespace spectile
