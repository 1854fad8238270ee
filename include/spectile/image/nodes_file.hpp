// Learned nodes as JSON.
#pragma once

#include <spectile/result.hpp>
#include <spectile/upsampling/learned_nodes.hpp>
#include <string>
#include <string_view>

namespace spectile {

/// Nodes as JSON text: {"method": "tetrahedral", "light": {"name": "D65"}, "observer": "1931",
/// "reflectances": 190, "levels": [..], "wavelengths_nm": [..], "offsets": [[..], ..]}, an offset for each
/// node, red before green before blue. A light that illuminant() does not know by that name has its
/// "spectrum". Numbers come back to the bit. Lines are indented, and end in a line break, where it is not to
/// be one line.
std::string nodes_to_json(const LearnedNodes& nodes, bool one_line = false);

/// Reads the text of nodes_to_json(); unknown keys are ignored. Errors: kBadFile, naming `source`, for what
/// is no JSON, and for nodes that cannot be: of other levels, wavelengths that do not ascend or are not from
/// 100 to 10000 nm, lists of different lengths, offsets beyond -1000 to 1000.
Result<LearnedNodes> parse_nodes(std::string_view json, const std::string& source);

/// The same from a file. Errors: kNoPermission too.
Result<LearnedNodes> load_nodes(const std::string& path);

/// Writes nodes, whole or not at all. Errors: kNoPermission, kNoSpace, kBadFile; kBadArgument for nodes that
/// parse_nodes() would refuse.
Result<void> save_nodes(const LearnedNodes& nodes, const std::string& path);

}  // namespace spectile
