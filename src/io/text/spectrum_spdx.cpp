// IES TM-27 files of spectra (.spdx): the only code that uses pugixml.
// Source: ANSI/IES TM-27-14, IES Standard Format for the Electronic Transfer of Spectral Data.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

/// Number of the line that holds a byte of the text.
std::size_t line_at(const TextFile& file, std::ptrdiff_t offset) {
  const char* const place = file.text->data() + std::max<std::ptrdiff_t>(offset, 0);
  const auto after = std::ranges::upper_bound(file.lines, place, std::less<>(),
                                              [](const std::string_view& line) { return line.data(); });
  return std::max<std::size_t>(static_cast<std::size_t>(after - file.lines.begin()), 1);
}

/// The name of an element without the prefix of its namespace.
std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kWhite = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kWhite), text.size()));
  return text.substr(0, text.find_last_not_of(kWhite) + 1);
}

pugi::xml_node child(const pugi::xml_node& parent, std::string_view name) {
  for (const pugi::xml_node& node : parent.children()) {
    if (local_name(node) == name) return node;
  }
  return {};
}

std::string lower_text(const pugi::xml_node& node) {
  std::string out(trimmed(node.text().get()));
  std::ranges::transform(out, out.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

}  // namespace

bool is_xml(const TextFile& file) {
  for (const std::string_view line : file.lines) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) continue;
    return line.substr(first).starts_with("<?xml") || line.substr(first).starts_with("<IES") ||
           line.substr(first).starts_with("<!--");
  }
  return false;
}

Result<RawTable> read_spdx(const TextFile& file) {
  pugi::xml_document document;
  const auto parsed =
      document.load_buffer(file.text->data(), file.text->size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed)
    return line_error(file, line_at(file, parsed.offset),
                      fmt::format("the XML is damaged: {}", parsed.description()));
  const pugi::xml_node distribution = child(document.document_element(), "SpectralDistribution");
  if (!distribution) {
    return make_error(ErrorCode::kBadFile, "{}: is XML without a SpectralDistribution of IES TM-27",
                      file.path);
  }
  RawTable out;
  out.sure_of_unit = true;
  out.axes.emplace_back();
  out.spectra.emplace_back();
  out.spectra.front().name = "0";
  const std::string quantity = lower_text(child(distribution, "SpectralQuantity"));
  for (const char* known : {"reflectance", "transmittance", "absorptance", "r-values", "t-values"}) {
    if (quantity == known) out.quantity = quantity;
  }
  for (const pugi::xml_node& sample : distribution.children()) {
    if (local_name(sample) != "SpectralData") continue;
    const std::size_t line = line_at(file, sample.offset_debug());
    const std::string_view at = trimmed(sample.attribute("wavelength").value());
    const std::string_view text = trimmed(sample.text().get());
    const auto nm = number_in(at);
    if (!nm || !std::isfinite(*nm))
      return line_error(file, line, io::quoted(at) + " is not a wavelength in nm");
    const auto value = number_in(text);
    if (!value || !std::isfinite(*value))
      return line_error(file, line, io::quoted(text) + " is not a finite number");
    out.axes.front().wavelengths.push_back(*nm);
    out.axes.front().lines.push_back(static_cast<std::uint32_t>(line));
    out.spectra.front().values.push_back(*value);
  }
  if (out.spectra.front().values.empty()) {
    return make_error(ErrorCode::kBadFile, "{}: holds no sample, which is a SpectralData with its wavelength",
                      file.path);
  }
  return out;
}

}  // namespace spectile::io
