// The attributes by which a file says how its spectra, or its coefficients, were made.
#include "src/io/convert/sources/method_attributes.hpp"

#include <charconv>
#include <optional>
#include <spectile/image/nodes_file.hpp>

#include "src/base/errors.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::io {
namespace {

// Says which rules the coefficients follow: those of kernels/abi/upsampling.hpp.
constexpr const char* kLayout = "1.0";
// Says what alpha means to spectra and coefficients.
constexpr const char* kAlpha = "spectileAlpha";
// Learned nodes, as JSON.
constexpr const char* kNodesAttribute = "spectileNodes";
// In their place in spectral images: the number of reflectances that they were learned from.
constexpr const char* kLearnedAttribute = "spectileLearnedFrom";

std::string bands_text(const Bands& bands) {
  std::string out;
  for (const Band& band : bands.list()) {
    if (!out.empty()) out += ' ';
    out += fmt::format("{}:{}:{}", band.lower_nm, band.centre_nm, band.upper_nm);
  }
  return out;
}

std::string samples_text(const MeasuredSpectrum& spectrum) {
  std::string out;
  for (std::size_t i = 0; i < spectrum.values().size(); ++i) {
    if (!out.empty()) out += ' ';
    out += fmt::format("{}:{}", spectrum.wavelengths_nm()[i], spectrum.values()[i]);
  }
  return out;
}

/// Tuples of `size` numbers, separated by colons within and spaces between; nothing for other text.
std::optional<std::vector<double>> parse_tuples(const std::string& text, std::size_t size) {
  std::vector<double> out;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return {};
    out.push_back(value);
    at = next;
    const bool last = out.size() % size == 0;
    if (at == end) return last ? std::optional(std::move(out)) : std::nullopt;
    if (*at != (last ? ' ' : ':')) return {};
    ++at;
  }
  return {};
}

Error damaged(const std::string& path, const char* name) {
  return make_error(ErrorCode::kBadFile, "{}: attribute {} is missing or damaged", path, name);
}

}  // namespace

std::vector<std::string> coefficient_channels(const Upsampler& upsampler, bool premultiplied) {
  std::vector<std::string> names = {"spectile.c0", "spectile.c1", "spectile.c2"};
  if (rows::has_scale(upsampler) || premultiplied) names.emplace_back("spectile.scale");
  return names;
}

bool has_straight_coefficients(const PartHeader& header, const Upsampler& upsampler) {
  return !rows::is_homogeneous(upsampler) && header.text(kAlpha) == to_string(AlphaMeaning::kPremultiplied);
}

void add_alpha_attribute(TextAttributes& texts, AlphaMeaning meaning) {
  texts.emplace_back(kAlpha, std::string(to_string(meaning)));
}

void pass_alpha_attribute(TextAttributes& texts, const PartHeader& source) {
  if (auto text = source.text(kAlpha)) texts.emplace_back(kAlpha, *std::move(text));
}

std::vector<std::string> method_attribute_names() {
  return {"spectileMethod", "spectileLight",        "spectileObserver",     "spectileQuantity",
          "spectileBands",  "spectileLightSamples", "spectileKeepNegative", "spectileCoefficients",
          kAlpha,           kPlanAttribute,         kNodesAttribute,        kLearnedAttribute};
}

TextAttributes method_attributes(const Upsampler& upsampler, const MethodOptions& options,
                                 bool coefficients) {
  TextAttributes out;
  out.emplace_back("spectileMethod", std::string(to_string(upsampler.method())));
  out.emplace_back("spectileLight", options.light ? options.light->name : "D65");
  out.emplace_back("spectileObserver", upsampler.options().observer == Observer::kCie1964 ? "1964" : "1931");
  if (!coefficients) {
    if (options.nodes) out.emplace_back(kLearnedAttribute, std::to_string(options.nodes->reflectances));
    return out;
  }
  add_plan_attribute(out, upsampler.bands());
  out.emplace_back("spectileCoefficients", kLayout);
  out.emplace_back("spectileQuantity", std::string(to_string(upsampler.quantity())));
  out.emplace_back("spectileBands", bands_text(upsampler.bands()));
  if (options.light) out.emplace_back("spectileLightSamples", samples_text(options.light->spectrum));
  if (options.nodes) out.emplace_back(kNodesAttribute, nodes_to_json(*options.nodes, true));
  if (upsampler.options().negative == NegativeSamples::kKeep) out.emplace_back("spectileKeepNegative", "yes");
  return out;
}

Result<Upsampler> upsampler_of(const PartHeader& header, const std::string& path) {
  const auto layout = header.text("spectileCoefficients");
  if (layout != kLayout) return damaged(path, "spectileCoefficients");
  const auto method = parse_method(header.text("spectileMethod").value_or(""));
  if (!method) return damaged(path, "spectileMethod");
  const auto quantity = parse_quantity(header.text("spectileQuantity").value_or(""));
  if (!quantity) return damaged(path, "spectileQuantity");
  const auto edges = parse_tuples(header.text("spectileBands").value_or(""), 3);
  if (!edges) return damaged(path, "spectileBands");
  std::vector<Band> list;
  for (std::size_t i = 0; i < edges->size(); i += 3) {
    list.push_back({(*edges)[i], (*edges)[i + 1], (*edges)[i + 2]});
  }
  // The default bands keep their own identity, for which tables are at hand.
  const Bands usual;
  const bool is_usual = std::equal(list.begin(), list.end(), usual.list().begin(), usual.list().end());
  const auto stored = is_usual ? Result<Bands>(usual) : Bands::from_overlapping(std::move(list));
  if (!stored) return damaged(path, "spectileBands");
  SPECTILE_ASSIGN(const auto bands, with_plan(header, *stored, path));
  UpsamplerOptions options;
  const auto observer = header.text("spectileObserver");
  if (observer != "1931" && observer != "1964") return damaged(path, "spectileObserver");
  if (observer == "1964") options.observer = Observer::kCie1964;
  if (const auto keep = header.text("spectileKeepNegative")) {
    if (keep != "yes") return damaged(path, "spectileKeepNegative");
    options.negative = NegativeSamples::kKeep;
  }
  if (const auto nodes = header.text(kNodesAttribute)) {
    SPECTILE_ASSIGN(auto read, parse_nodes(*nodes, path + ": attribute " + kNodesAttribute));
    options.nodes = std::make_shared<const LearnedNodes>(std::move(read));
  }
  if (const auto alpha = header.text(kAlpha)) {
    const bool known = alpha == to_string(AlphaMeaning::kPremultiplied) ||
                       alpha == to_string(AlphaMeaning::kStraight) ||
                       alpha == to_string(AlphaMeaning::kIgnored);
    if (!known) return damaged(path, kAlpha);
  }
  const std::string light_name = light_name_of(header);
  if (light_name.empty()) return damaged(path, "spectileLight");
  if (const auto samples = header.text("spectileLightSamples")) {
    const auto pairs = parse_tuples(*samples, 2);
    if (!pairs) return damaged(path, "spectileLightSamples");
    std::vector<double> wavelengths;
    std::vector<double> values;
    for (std::size_t i = 0; i < pairs->size(); i += 2) {
      wavelengths.push_back((*pairs)[i]);
      values.push_back((*pairs)[i + 1]);
    }
    const auto light = MeasuredSpectrum::from_samples(wavelengths, values, Ends::kZero);
    if (!light) return damaged(path, "spectileLightSamples");
    options.light = *light;
  } else if (light_name != "D65") {
    return damaged(path, "spectileLightSamples");
  }
  auto upsampler = Upsampler::create(*method, *quantity, bands, options);
  if (!upsampler && upsampler.error().code == ErrorCode::kBadArgument) {
    return make_error(ErrorCode::kBadFile, "{}: {}", path, upsampler.error().message);
  }
  return upsampler;
}

std::string light_name_of(const PartHeader& header) {
  return header.text("spectileLight").value_or("");
}

}  // namespace spectile::io
