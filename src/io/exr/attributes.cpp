// Attributes of an image: what each describes, and what becomes of it in an image made of that one.
#include "src/io/exr/attributes.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>

#include <algorithm>
#include <string_view>

#include "src/io/exr/attributes/values.hpp"
#include "src/io/exr/part_header.hpp"

namespace spectile::io {
namespace {

/// Subject of an attribute.
enum class Describes {
  kFrame,       // camera, time, owner, the image's place: holds whatever becomes of the pixels
  kStorage,     // how pixels are stored, which the writer says itself
  kPixels,      // the samples as they were
  kPicture,     // R, G, B as they were
  kSpectra,     // spectral channels
  kColorSpace,  // what R, G, B mean
};

/// The one list of attributes that are not of the frame. Sources: Technical Introduction to OpenEXR and its
/// ImfStandardAttributes.h; OpenImageIO 2.4's maketx; Fichet, Pacanowski, Wilkie, JCGT 10(3), 2021;
/// SMPTE ST 2065-4.
constexpr struct {
  std::string_view name;
  Describes describes;
} kKnown[] = {
    {"channels", Describes::kStorage},
    {"chunkCount", Describes::kStorage},
    {"compression", Describes::kStorage},
    {"dataWindow", Describes::kStorage},
    {"displayWindow", Describes::kStorage},
    {"dwaCompressionLevel", Describes::kStorage},
    {"lineOrder", Describes::kStorage},
    {"maxSamplesPerPixel", Describes::kStorage},
    {"name", Describes::kStorage},
    {"pixelAspectRatio", Describes::kStorage},
    {"screenWindowCenter", Describes::kStorage},
    {"screenWindowWidth", Describes::kStorage},
    {"tiles", Describes::kStorage},
    {"type", Describes::kStorage},
    {"version", Describes::kStorage},
    {kSettingsAttribute, Describes::kStorage},
    {"oiio:SHA-1", Describes::kPixels},
    {"oiio:AverageColor", Describes::kPixels},
    {"oiio:ConstantColor", Describes::kPixels},
    {"acesImageContainerFlag", Describes::kPixels},
    {"preview", Describes::kPicture},
    {"adoptedNeutral", Describes::kPicture},
    {"whiteLuminance", Describes::kPicture},
    {"renderingTransform", Describes::kPicture},
    {"lookModTransform", Describes::kPicture},
    {"spectralLayoutVersion", Describes::kSpectra},
    {"emissiveUnits", Describes::kSpectra},
    {"polarisationHandedness", Describes::kSpectra},
    {"EV", Describes::kSpectra},
    {"lensTransmission", Describes::kSpectra},
    {"cameraResponse", Describes::kSpectra},
    {"chromaticities", Describes::kColorSpace},
    {"colorInteropID", Describes::kColorSpace},
    {"oiio:ColorSpace", Describes::kColorSpace},
    {"ICCProfile", Describes::kColorSpace},
};

/// True for the name of a spectral channel, after which the layout names the curve of a channel's filter.
bool names_a_spectral_channel(std::string_view name) {
  const std::size_t point = name.find('.');
  if (point == std::string_view::npos || point + 1 == name.size()) return false;
  const std::string_view kind = name.substr(0, point);
  const bool digit = name[point + 1] >= '0' && name[point + 1] <= '9';
  return digit && (kind == "T" || (kind.size() == 2 && kind[0] == 'S' && kind[1] >= '0' && kind[1] <= '3'));
}

Describes described_by(std::string_view name, std::string_view type) {
  for (const auto& known : kKnown) {
    if (known.name == name) return known.describes;
  }
  if (names_a_spectral_channel(name)) return Describes::kSpectra;
  return type == "preview" ? Describes::kPicture : Describes::kFrame;
}

/// True for an attribute that is named after a channel, or begins with its name and a point, if the source
/// or the output alone has that channel.
bool belongs_to_one_alone(std::string_view name, const Imf::ChannelList& source,
                          const std::set<std::string>& output) {
  for (std::size_t end = name.size(); end != std::string_view::npos && end > 0;
       end = name.rfind('.', end - 1)) {
    const std::string channel(name.substr(0, end));
    const bool before = source.findChannel(channel) != nullptr;
    const bool after = output.contains(channel);
    if (before || after) return before != after;
  }
  return false;
}

/// True for an entry of a Cryptomatte manifest, "cryptomatte/KEY/...", whose channels are all gone.
bool is_manifest_of_nothing(const Imf::Header& from, const std::string& name,
                            const std::set<std::string>& output) {
  if (!name.starts_with(kManifestStart)) return false;
  const std::size_t end = name.find('/', kManifestStart.size());
  const auto* const layer =
      from.findTypedAttribute<Imf::StringAttribute>(name.substr(0, end) + std::string(kManifestName));
  if (layer == nullptr || layer->value().empty()) return false;
  const auto first = output.lower_bound(layer->value());
  return first == output.end() || !first->starts_with(layer->value());
}

/// The views of a file, the default one first, of which the output has channels; none where its plain R, G,
/// B are of another view than the default.
std::vector<std::string> remaining_views(const std::vector<std::string>& views, const AttributeRules& rules) {
  if (views.empty() || (!rules.view.empty() && rules.view != views[0] &&
                        std::find(views.begin(), views.end(), rules.view) != views.end())) {
    return {};
  }
  std::vector<std::string> out = {views[0]};
  for (std::size_t i = 1; i < views.size(); ++i) {
    const bool there =
        std::any_of(rules.channels.begin(), rules.channels.end(),
                    [&](const std::string& channel) { return possible_view(channel) == views[i]; });
    if (there) out.push_back(views[i]);
  }
  return out;
}

/// A text without the words in which maketx describes the pixels, where files have no place for attributes.
std::string without_hints(const std::string& text) {
  constexpr std::string_view kHints[] = {
      "oiio:SHA-1=", "SHA-1=", "oiio:AverageColor=", "oiio:ConstantColor="};
  std::string out = text;
  for (const std::string_view hint : kHints) {
    for (std::size_t at = out.find(hint); at != std::string::npos; at = out.find(hint)) {
      const std::size_t end = std::min(out.find_first_of(" \n", at), out.size());
      out.erase(at, end - at);
      if (at > 0 && out[at - 1] == ' ') out.erase(at - 1, 1);
    }
  }
  return out;
}

enum class Fate { kKept, kLeftOut, kMadeAnew };

Fate fate_of(const Imf::Header& from, const std::string& name, const Imf::Attribute& attribute,
             const AttributeRules& rules) {
  if (std::find(rules.replaced.begin(), rules.replaced.end(), name) != rules.replaced.end()) {
    return Fate::kMadeAnew;
  }
  const bool spectra_stay = rules.change == PixelChange::kAverage || rules.change == PixelChange::kRenamed;
  switch (described_by(name, attribute.typeName())) {
    case Describes::kStorage:
      return Fate::kMadeAnew;
    case Describes::kPixels:
      return Fate::kLeftOut;
    case Describes::kPicture:
      // The thumbnail alone shows samples; the others say how they are meant.
      if (rules.change == PixelChange::kAverage) {
        return std::string_view(attribute.typeName()) == "preview" ? Fate::kLeftOut : Fate::kKept;
      }
      return rules.change == PixelChange::kColor ? Fate::kLeftOut : Fate::kKept;
    case Describes::kSpectra:
      if (rules.change == PixelChange::kRenamed && names_a_spectral_channel(name)) {
        return rules.channels.contains(name) ? Fate::kKept : Fate::kLeftOut;
      }
      return spectra_stay ? Fate::kKept : Fate::kLeftOut;
    case Describes::kColorSpace:
      return rules.change == PixelChange::kColor ? Fate::kMadeAnew : Fate::kKept;
    case Describes::kFrame:
      break;
  }
  if (name == "multiView") {
    const auto* const views = dynamic_cast<const Imf::StringVectorAttribute*>(&attribute);
    return views != nullptr && !remaining_views(views->value(), rules).empty() ? Fate::kKept : Fate::kLeftOut;
  }
  const bool stale = belongs_to_one_alone(name, from.channels(), rules.channels) ||
                     is_manifest_of_nothing(from, name, rules.channels);
  return stale ? Fate::kLeftOut : Fate::kKept;
}

/// Attributes of which a part holds no more.
bool set_changed(const Imf::Attribute& from, const AttributePlace& at, const AttributeRules& rules,
                 exr_result_t& result) {
  const std::string_view name = at.name;
  const auto* const views = dynamic_cast<const Imf::StringVectorAttribute*>(&from);
  const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&from);
  if (name == "multiView" && views != nullptr) {
    result = set_texts(remaining_views(views->value(), rules), at);
  } else if ((name == "comments" || name == "ImageDescription") && text != nullptr) {
    result = exr_attr_set_string(at.to, at.part, at.name, without_hints(text->value()).c_str());
  } else {
    return false;
  }
  return true;
}

}  // namespace

exr_result_t copy_attributes(const Imf::Header& from, exr_context_t to, int part,
                             const AttributeRules& rules) {
  for (auto it = from.begin(); it != from.end(); ++it) {
    const Imf::Attribute& attribute = it.attribute();
    if (is_of_storage(attribute)) continue;
    if (fate_of(from, it.name(), attribute, rules) != Fate::kKept) continue;
    const AttributePlace at = {to, part, it.name()};
    exr_result_t result = EXR_ERR_SUCCESS;
    if (!set_changed(attribute, at, rules, result)) result = copy_value(attribute, at);
    if (result != EXR_ERR_SUCCESS) return result;
  }
  return EXR_ERR_SUCCESS;
}

std::vector<std::string> attributes_left_out(const Imf::Header& from, const AttributeRules& rules) {
  std::vector<std::string> out;
  for (auto it = from.begin(); it != from.end(); ++it) {
    if (fate_of(from, it.name(), it.attribute(), rules) == Fate::kLeftOut) out.emplace_back(it.name());
  }
  return out;
}

}  // namespace spectile::io
