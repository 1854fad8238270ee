// Names of an enumeration's values: one table serves to_string(), parsing, and the list of names in an error.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "src/base/errors.hpp"

namespace spectile {

template <class Enum>
struct EnumName {
  Enum value;
  std::string_view name;
};

/// The name of a value; that of the table's first for a value that it lacks.
template <class Enum, std::size_t n>
constexpr std::string_view enum_name(const EnumName<Enum> (&table)[n], Enum value) {
  for (const auto& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return table[0].name;
}

/// The value of a name. `kind` says what the names are of, for the error. Errors: kUnknownName, with all
/// names.
template <class Enum, std::size_t n>
Result<Enum> parse_enum(const EnumName<Enum> (&table)[n], std::string_view kind, std::string_view name) {
  std::string known;
  for (const auto& entry : table) {
    if (entry.name == name) return entry.value;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  return make_error(ErrorCode::kUnknownName, "{} \"{}\" is unknown; there are {}", kind, name, known);
}

}  // namespace spectile
