// Values of attributes, from OpenEXR's C++ classes into a part that its C library writes.
#pragma once

#include <OpenEXR/ImfAttribute.h>
#include <OpenEXR/openexr.h>

#include <string>
#include <vector>

namespace spectile::io {

/// A target attribute's place.
struct AttributePlace {
  exr_context_t to;
  int part;
  const char* name;
};

/// True for types that say nothing but how pixels are stored, whatever the attribute's name, and for none at
/// all, which only damaged files have. OpenEXR 3.1.5's C library, which would be given them like those of
/// other types that are not known here, takes neither: it crashes.
bool is_of_storage(const Imf::Attribute& attribute);

/// Writes a value; a type that this build does not know as it is.
exr_result_t copy_value(const Imf::Attribute& from, const AttributePlace& at);
/// Writes a list of texts.
exr_result_t set_texts(const std::vector<std::string>& values, const AttributePlace& at);

}  // namespace spectile::io
