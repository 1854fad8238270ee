// Attributes of every type as text, to be shown.
#include "src/io/exr/attribute_texts.hpp"

#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfHeader.h>
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

#include <set>

#include "src/base/errors.hpp"
#include "src/io/exr/memory_stream.hpp"

namespace spectile::io {
namespace {

/// Those that PartHeader has members for, or that say nothing.
bool is_shown_elsewhere(std::string_view name) {
  static const std::set<std::string_view> kNames = {"channels",   "chunkCount",    "compression",
                                                    "dataWindow", "displayWindow", "lineOrder",
                                                    "tiles",      "type",          "version"};
  return kNames.contains(name);
}

template <class List>
std::string numbers(const List& list) {
  return fmt::format("{:.9g}", fmt::join(list, " "));
}

template <class Vector>
std::string vector_text(const Vector& v) {
  std::string out;
  for (unsigned i = 0; i < Vector::dimensions(); ++i) out += fmt::format("{}{}", i > 0 ? " " : "", v[i]);
  return out;
}

template <class Matrix>
std::string matrix_text(const Matrix& m) {
  std::string out;
  for (unsigned i = 0; i < Matrix::dimensions(); ++i) {
    for (unsigned k = 0; k < Matrix::dimensions(); ++k)
      out += fmt::format("{}{:.9g}", i + k > 0 ? " " : "", m[i][k]);
  }
  return out;
}

/// The text of an attribute of one type, if it is of that.
template <class Attribute, class Text>
bool show(const Imf::Attribute& a, std::string& out, Text text) {
  const auto* const typed = dynamic_cast<const Attribute*>(&a);
  if (typed != nullptr) out = text(typed->value());
  return typed != nullptr;
}

std::string text_of(const Imf::Attribute& a) {
  std::string out;
  const auto plain = [](const auto& v) { return fmt::format("{}", v); };
  const auto vec = [](const auto& v) { return vector_text(v); };
  const auto box = [](const auto& b) {
    return fmt::format("({}) to ({})", vector_text(b.min), vector_text(b.max));
  };
  const auto matrix = [](const auto& m) { return matrix_text(m); };
  const bool known =
      show<Imf::StringAttribute>(a, out, plain) || show<Imf::IntAttribute>(a, out, plain) ||
      show<Imf::FloatAttribute>(a, out, plain) || show<Imf::DoubleAttribute>(a, out, plain) ||
      show<Imf::V2iAttribute>(a, out, vec) || show<Imf::V2fAttribute>(a, out, vec) ||
      show<Imf::V2dAttribute>(a, out, vec) || show<Imf::V3iAttribute>(a, out, vec) ||
      show<Imf::V3fAttribute>(a, out, vec) || show<Imf::V3dAttribute>(a, out, vec) ||
      show<Imf::Box2iAttribute>(a, out, box) || show<Imf::Box2fAttribute>(a, out, box) ||
      show<Imf::M33fAttribute>(a, out, matrix) || show<Imf::M33dAttribute>(a, out, matrix) ||
      show<Imf::M44fAttribute>(a, out, matrix) || show<Imf::M44dAttribute>(a, out, matrix) ||
      show<Imf::StringVectorAttribute>(a, out,
                                       [](const auto& v) { return fmt::format("{}", fmt::join(v, ", ")); }) ||
      show<Imf::FloatVectorAttribute>(a, out, [](const auto& v) { return numbers(v); }) ||
      show<Imf::RationalAttribute>(a, out, [](const auto& r) { return fmt::format("{}/{}", r.n, r.d); }) ||
      show<Imf::EnvmapAttribute>(a, out,
                                 [](const auto& e) { return e == Imf::ENVMAP_CUBE ? "cube" : "latlong"; }) ||
      show<Imf::TimeCodeAttribute>(a, out,
                                   [](const auto& t) {
                                     return fmt::format("{:02}:{:02}:{:02}:{:02}", t.hours(), t.minutes(),
                                                        t.seconds(), t.frame());
                                   }) ||
      show<Imf::ChromaticitiesAttribute>(a, out,
                                         [](const auto& c) {
                                           return fmt::format("red {} {} green {} {} blue {} {} white {} {}",
                                                              c.red.x, c.red.y, c.green.x, c.green.y,
                                                              c.blue.x, c.blue.y, c.white.x, c.white.y);
                                         }) ||
      show<Imf::PreviewImageAttribute>(
          a, out, [](const auto& p) { return fmt::format("preview, {} x {}", p.width(), p.height()); });
  if (known) return out;
  MemoryStream stream;
  a.writeValueTo(stream, Imf::EXR_VERSION);
  return fmt::format("{}, {} bytes", a.typeName(), stream.bytes().size());
}

}  // namespace

std::vector<std::pair<std::string, std::string>> attribute_texts(const PartHeader& header) {
  std::vector<std::pair<std::string, std::string>> out;
  const Imf::Header& imf = header.imf();
  for (auto it = imf.begin(); it != imf.end(); ++it) {
    if (!is_shown_elsewhere(it.name())) out.emplace_back(it.name(), text_of(it.attribute()));
  }
  return out;
}

}  // namespace spectile::io
