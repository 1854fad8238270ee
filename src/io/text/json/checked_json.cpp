// JSON of files from anywhere, and the parts that several of them share.
#include "src/io/text/json/checked_json.hpp"

#include <algorithm>
#include <set>

#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
// Far beyond anything written here: more is built to use up memory or time.
constexpr std::size_t kDeepest = 16;
constexpr std::size_t kMaxValues = 4'000'000;
constexpr std::size_t kMaxKeys = 1024;  // of one object, whose keys are searched one by one

/// Refuses text that is built to use up memory or time, before anything is made of it. (The library's own
/// callback, while it parses, looks through a whole list at each object's end.)
class Guard : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return value(); }
  bool boolean(bool /*value*/) override { return value(); }
  bool number_integer(number_integer_t /*value*/) override { return value(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return value(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return value(); }
  bool string(string_t& /*value*/) override { return value(); }
  bool binary(binary_t& /*value*/) override { return value(); }
  bool start_object(std::size_t /*elements*/) override { return open(); }
  bool key(string_t& name) override {
    if (keys_.back().size() == kMaxKeys)
      throw Refused(fmt::format("has an object of more than {} keys", kMaxKeys));
    if (!keys_.back().insert(name).second)
      throw Refused(fmt::format("has the key \"{}\" twice in one object", name));
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*elements*/) override { return open(); }
  bool end_array() override { return close(); }
  /// The parser proper says what is wrong.
  bool parse_error(std::size_t /*at*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    return false;
  }

 private:
  bool value() {
    if (++values_ > kMaxValues) throw Refused(fmt::format("holds more than {} values", kMaxValues));
    return true;
  }
  bool open() {
    if (keys_.size() > kDeepest) throw Refused(fmt::format("is nested more than {} deep", kDeepest));
    keys_.emplace_back();
    return value();
  }
  bool close() {
    keys_.pop_back();
    return true;
  }
  std::vector<std::set<std::string>> keys_ =
      std::vector<std::set<std::string>>(1);  // of each object or list that is open
  std::size_t values_ = 0;
};

bool is_published(const NamedLight& light) {
  const auto known = illuminant(light.name);
  return known && std::ranges::equal(known->wavelengths_nm(), light.spectrum.wavelengths_nm()) &&
         std::ranges::equal(known->values(), light.spectrum.values());
}

}  // namespace

std::string json_text(const Json& json, bool one_line) {
  // Text that is no UTF-8 is mended rather than refused: names are for people.
  const auto mend = Json::error_handler_t::replace;
  return one_line ? json.dump(-1, ' ', false, mend) : json.dump(1, ' ', false, mend) + "\n";
}

Json parse_json(std::string_view text, const char* kind) {
  if (text.size() > kMaxBytes) throw Refused(fmt::format("is larger than 64 MiB, which no {} is", kind));
  Guard guard;
  Json::sax_parse(text, &guard);
  return Json::parse(text);
}

std::string json_error(const std::string& what) {
  // "[json.exception.parse_error.101] parse error at line 1, column 3: syntax error while ... - last read:
  // ..."
  const std::size_t at = what.find("] ");
  std::string text = at == std::string::npos ? what : what.substr(at + 2);
  if (const std::size_t tail = text.find("; last read"); tail != std::string::npos) text.resize(tail);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  }
  constexpr std::size_t kMost = 200;
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

const Json& member(const Json& object, const char* key, const std::string& where) {
  if (!object.is_object()) throw Refused(where + " is no object");
  const auto found = object.find(key);
  if (found == object.end()) throw Refused(fmt::format("{} has no \"{}\"", where, key));
  return *found;
}

std::vector<double> numbers(const Json& list, const std::string& what, std::size_t most) {
  if (!list.is_array()) throw Refused(fmt::format("{} is no list", what));
  if (list.size() > most) {
    throw Refused(fmt::format("{} has {} entries, more than {}", what, list.size(), most));
  }
  std::vector<double> out;
  out.reserve(list.size());
  for (const Json& entry : list) {
    if (!entry.is_number()) throw Refused(fmt::format("{} holds what is no number", what));
    out.push_back(entry.get<double>());
  }
  return out;
}

std::vector<double> numbers(const Json& object, const char* key, const std::string& where, std::size_t most) {
  return numbers(member(object, key, where), fmt::format("\"{}\" of {}", key, where), most);
}

void add_spectrum(Json& object, const NamedLight& light) {
  if (is_published(light)) return;
  const auto wavelengths = light.spectrum.wavelengths_nm();
  const auto values = light.spectrum.values();
  object["spectrum"] = {{"wavelengths_nm", std::vector<double>(wavelengths.begin(), wavelengths.end())},
                        {"values", std::vector<double>(values.begin(), values.end())}};
}

NamedLight light_from(const Json& object) {
  const Json& name = member(object, "name", "a light");
  if (!name.is_string()) throw Refused("the name of a light is no text");
  const auto text = name.get<std::string>();
  const std::string named = "the light " + io::quoted(text);
  if (!object.contains("spectrum")) {
    auto known = illuminant(text);
    if (!known) throw Refused(named + " has no spectrum, and no illuminant is called so");
    return {text, *std::move(known), {}};
  }
  const Json& spectrum = object["spectrum"];
  const std::string of = "the spectrum of " + named;
  auto samples = MeasuredSpectrum::from_samples(numbers(spectrum, "wavelengths_nm", of, kMaxValues),
                                                numbers(spectrum, "values", of, kMaxValues), Ends::kZero);
  if (!samples) throw Refused(of + ": " + samples.error().message);
  return {text, *std::move(samples), {}};
}

}  // namespace spectile::io
