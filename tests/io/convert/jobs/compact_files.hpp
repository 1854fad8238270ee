// Textures in both forms for the tests: colours of every kind, upsampled to spectra and to coefficients.
#pragma once

#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <spectile/image/image.hpp>
#include <string>

#include "tests/support/exr_files.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {

/// A method and what its spectra stand for.
struct Kind {
  Method method = Method::kSmitsExact;
  Quantity quantity = Quantity::kReflectance;
};

inline std::ostream& operator<<(std::ostream& to, const Kind& kind) {
  return to << to_string(kind.method) << " " << to_string(kind.quantity);
}

inline std::string kind_name(const testing::TestParamInfo<Kind>& info) {
  return test_name(std::string(to_string(info.param.method)) + "_" +
                   std::string(to_string(info.param.quantity)));
}

inline std::vector<Kind> all_kinds() {
  std::vector<Kind> out;
  for (const std::string& name : method_names()) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      out.push_back({*parse_method(name), quantity});
    }
  }
  return out;
}

/// Those that mix basis spectra, or the others.
inline std::vector<Kind> kinds_that(bool mix_bases) {
  std::vector<Kind> out = all_kinds();
  std::erase_if(out, [=](const Kind& kind) { return is_sigmoid(kind.method) == mix_bases; });
  return out;
}

/// Noise, and among it black, white, grey, saturated, above 1, below 0, tiny, and beyond the range of halves.
inline Picture every_color(int width, int height, Imath::V2i origin = {0, 0}) {
  constexpr double kSpecial[][3] = {{0, 0, 0},       {1, 1, 1},      {0.18, 0.18, 0.18}, {1, 0, 0},
                                    {0, 0.9, 0.9},   {3, 2, 0.5},    {-0.2, 0.4, 0.3},   {1e-6, 0, 2e-6},
                                    {7e4, 9e4, 1e5}, {-0.1, -0.5, 0}};
  Picture picture = blank(width, height, origin);
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    picture.add(name, Imf::FLOAT, [=](int x, int y) {
      const int place = 3 * x + 5 * y;
      if (place % 4 == 1) return kSpecial[static_cast<std::size_t>(place / 4) % std::size(kSpecial)][c];
      return 1.2 * noise(x, y, c);
    });
  }
  return picture;
}

/// Options of a kind, 16 bands and nothing compressed.
inline UpsampleImageOptions options_of(const Kind& kind) {
  UpsampleImageOptions options;
  options.method = kind.method;
  options.quantity = kind.quantity;
  options.bands = *Bands::uniform(400, 700, 18.75);
  options.compression = {CompressionKind::kNone, -1};
  return options;
}

/// Upsamples to one of the two forms.
inline void upsample_to(Store store, const std::string& input, const std::string& output,
                        UpsampleImageOptions options) {
  options.store = store;
  const auto made = upsample_image(input, output, options);
  ASSERT_TRUE(made) << made.error().message;
}

inline std::string text_of(const Imf::Header& header, const char* name) {
  const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
  return attribute == nullptr ? "(none)" : attribute->value();
}

}  // namespace spectile::test
