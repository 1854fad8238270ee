// Values of attributes, from OpenEXR's C++ classes into a part that its C library writes.
#include "src/io/exr/attributes/values.hpp"

#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfKeyCodeAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfPreviewImageAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <OpenEXR/ImfVersion.h>

#include <cstdint>
#include <cstring>
#include <string_view>

#include "src/io/exr/memory_stream.hpp"

namespace spectile::io {
namespace {

/// Sets an attribute whose C struct has the same layout as the C++ value.
template <class Attribute, class Plain>
bool set_plain(const Imf::Attribute& from, const AttributePlace& at, exr_result_t& result,
               exr_result_t (*set)(exr_context_t, int, const char*, const Plain*)) {
  const auto* typed = dynamic_cast<const Attribute*>(&from);
  if (typed == nullptr) return false;
  static_assert(sizeof(typed->value()) == sizeof(Plain));
  Plain plain;
  // Both are plain numbers in the same order, though the C++ classes have constructors of their own.
  std::memcpy(static_cast<void*>(&plain), static_cast<const void*>(&typed->value()), sizeof(Plain));
  result = set(at.to, at.part, at.name, &plain);
  return true;
}

bool set_numbers(const Imf::Attribute& from, const AttributePlace& at, exr_result_t& result) {
  return set_plain<Imf::Box2iAttribute>(from, at, result, exr_attr_set_box2i) ||
         set_plain<Imf::Box2fAttribute>(from, at, result, exr_attr_set_box2f) ||
         set_plain<Imf::V2iAttribute>(from, at, result, exr_attr_set_v2i) ||
         set_plain<Imf::V2fAttribute>(from, at, result, exr_attr_set_v2f) ||
         set_plain<Imf::V2dAttribute>(from, at, result, exr_attr_set_v2d) ||
         set_plain<Imf::V3iAttribute>(from, at, result, exr_attr_set_v3i) ||
         set_plain<Imf::V3fAttribute>(from, at, result, exr_attr_set_v3f) ||
         set_plain<Imf::V3dAttribute>(from, at, result, exr_attr_set_v3d) ||
         set_plain<Imf::M33fAttribute>(from, at, result, exr_attr_set_m33f) ||
         set_plain<Imf::M33dAttribute>(from, at, result, exr_attr_set_m33d) ||
         set_plain<Imf::M44fAttribute>(from, at, result, exr_attr_set_m44f) ||
         set_plain<Imf::M44dAttribute>(from, at, result, exr_attr_set_m44d) ||
         set_plain<Imf::RationalAttribute>(from, at, result, exr_attr_set_rational) ||
         set_plain<Imf::ChromaticitiesAttribute>(from, at, result, exr_attr_set_chromaticities);
}

bool set_scalar(const Imf::Attribute& from, const AttributePlace& at, exr_result_t& result) {
  if (const auto* a = dynamic_cast<const Imf::IntAttribute*>(&from)) {
    result = exr_attr_set_int(at.to, at.part, at.name, a->value());
  } else if (const auto* f = dynamic_cast<const Imf::FloatAttribute*>(&from)) {
    result = exr_attr_set_float(at.to, at.part, at.name, f->value());
  } else if (const auto* d = dynamic_cast<const Imf::DoubleAttribute*>(&from)) {
    result = exr_attr_set_double(at.to, at.part, at.name, d->value());
  } else if (const auto* s = dynamic_cast<const Imf::StringAttribute*>(&from)) {
    result = exr_attr_set_string(at.to, at.part, at.name, s->value().c_str());
  } else if (const auto* e = dynamic_cast<const Imf::EnvmapAttribute*>(&from)) {
    result = exr_attr_set_envmap(at.to, at.part, at.name, static_cast<exr_envmap_t>(e->value()));
  } else if (const auto* t = dynamic_cast<const Imf::TimeCodeAttribute*>(&from)) {
    const exr_attr_timecode_t value = {t->value().timeAndFlags(), t->value().userData()};
    result = exr_attr_set_timecode(at.to, at.part, at.name, &value);
  } else if (const auto* k = dynamic_cast<const Imf::KeyCodeAttribute*>(&from)) {
    const Imf::KeyCode& v = k->value();
    const exr_attr_keycode_t value = {v.filmMfcCode(), v.filmType(),      v.prefix(),       v.count(),
                                      v.perfOffset(),  v.perfsPerFrame(), v.perfsPerCount()};
    result = exr_attr_set_keycode(at.to, at.part, at.name, &value);
  } else {
    return false;
  }
  return true;
}

bool set_list(const Imf::Attribute& from, const AttributePlace& at, exr_result_t& result) {
  if (const auto* f = dynamic_cast<const Imf::FloatVectorAttribute*>(&from)) {
    const float none = 0;  // an empty list needs an address too
    result = exr_attr_set_float_vector(at.to, at.part, at.name, static_cast<int>(f->value().size()),
                                       f->value().empty() ? &none : f->value().data());
  } else if (const auto* s = dynamic_cast<const Imf::StringVectorAttribute*>(&from)) {
    result = set_texts(s->value(), at);
  } else if (const auto* p = dynamic_cast<const Imf::PreviewImageAttribute*>(&from)) {
    static_assert(sizeof(Imf::PreviewRgba) == 4);
    const exr_attr_preview_t value = {p->value().width(), p->value().height(), 0,
                                      reinterpret_cast<const std::uint8_t*>(p->value().pixels())};
    result = exr_attr_set_preview(at.to, at.part, at.name, &value);
  } else {
    return false;
  }
  return true;
}

}  // namespace

bool is_of_storage(const Imf::Attribute& attribute) {
  const std::string_view type = attribute.typeName();
  return type.empty() || type == "chlist" || type == "compression" || type == "lineOrder" ||
         type == "tiledesc";
}

exr_result_t set_texts(const std::vector<std::string>& values, const AttributePlace& at) {
  std::vector<const char*> texts;
  for (const std::string& text : values) texts.push_back(text.c_str());
  const char* none = "";
  return exr_attr_set_string_vector(at.to, at.part, at.name, static_cast<int>(texts.size()),
                                    texts.empty() ? &none : texts.data());
}

exr_result_t copy_value(const Imf::Attribute& from, const AttributePlace& at) {
  exr_result_t result = EXR_ERR_SUCCESS;
  if (set_scalar(from, at, result) || set_numbers(from, at, result) || set_list(from, at, result)) {
    return result;
  }
  MemoryStream stream;
  from.writeValueTo(stream, Imf::EXR_VERSION);
  return exr_attr_set_user(at.to, at.part, at.name, from.typeName(), static_cast<int>(stream.bytes().size()),
                           stream.bytes().data());
}

}  // namespace spectile::io
