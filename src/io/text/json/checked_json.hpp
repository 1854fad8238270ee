// JSON of files from anywhere: text that is built to use up memory or time is refused before anything is made
// of it.
#pragma once

#include <nlohmann/json.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/named_light.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/errors.hpp"

namespace spectile::io {

/// Keeps the order of what it holds.
using Json = nlohmann::ordered_json;

/// A flaw of a JSON text, in words; thrown and caught within read_json() only.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The text of a tree: one line, or indented lines that end in a line break. What is no UTF-8 is mended.
std::string json_text(const Json& json, bool one_line);

/// A tree of at most 64 MiB, 16 levels, 4 million values and 1024 keys an object, none twice in one.
/// Throws: Refused, exceptions of nlohmann-json.
Json parse_json(std::string_view text, const char* kind);

/// The line and what is wrong there, of an exception of nlohmann-json.
std::string json_error(const std::string& what);

/// Parses `text` and makes a value of it by `make`, which throws Refused. `kind`: the word for it in errors.
/// Errors: kBadFile, which begin with `source`; kOutOfMemory.
template <class Make>
auto read_json(std::string_view text, const std::string& source, const char* kind, const Make& make)
    -> Result<decltype(make(Json()))> {
  try {
    return make(parse_json(text, kind));
  } catch (const Refused& refused) {
    return make_error(ErrorCode::kBadFile, "{}: {}", source, refused.what());
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kOutOfMemory, "{}: no memory for a {} of {} bytes", source, kind,
                      text.size());
  } catch (const nlohmann::json::exception& error) {
    return make_error(ErrorCode::kBadFile, "{}: is no {}: {}", source, kind, json_error(error.what()));
  }
}

/// A member of an object; `where`: what it is a member of, in words. Throws: Refused.
const Json& member(const Json& object, const char* key, const std::string& where);

/// A list of at most `most` numbers, a member of an object or the value itself. Throws: Refused.
std::vector<double> numbers(const Json& list, const std::string& what, std::size_t most);
std::vector<double> numbers(const Json& object, const char* key, const std::string& where, std::size_t most);

/// Adds "spectrum" to the object of a light, where illuminant() does not know that very light by its name.
void add_spectrum(Json& object, const NamedLight& light);
/// Reads a light's "name" and "spectrum". Throws: Refused.
NamedLight light_from(const Json& object);

}  // namespace spectile::io
