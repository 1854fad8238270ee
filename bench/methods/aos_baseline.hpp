// The textbook's way, to be measured beside the engine's: a struct of samples a pixel with its operators, one
// pixel after the other, in plain C++ for the compiler to do its best with. Compiled once per level of the
// processor.
#pragma once

#include <cstddef>

namespace spectile::measure {

inline constexpr std::size_t kMaxBaseline = 60;

/// What the functions need, for a number of samples. Shapes: basis [7][samples]: white, cyan, magenta,
/// yellow, red, green, blue; light [samples]; matching [3][samples].
struct TextbookScene {
  float basis[7][kMaxBaseline];
  float light[kMaxBaseline];
  float matching[3][kMaxBaseline];
};

struct TextbookPixel {
  double xyz[3];
  double weight;
};

/// For one number of samples.
struct TextbookWay {
  std::size_t samples;
  /// n pixels [n][3] to XYZ [n][3]: each upsampled, times the light, summed with the matching functions.
  void (*relight)(const TextbookScene& scene, const float* rgb, float* xyz, std::size_t n);
  /// n samples of radiance [n][samples], each to the pixel of its number, with a weight.
  void (*add)(const TextbookScene& scene, const float* radiance, const float* weight,
              const std::size_t* pixel, TextbookPixel* film, std::size_t n);
};

inline constexpr std::size_t kTextbookWays = 3;  // 16, 30 and 60 samples

struct Textbook {
  const char* compiled_for;
  TextbookWay ways[kTextbookWays];
};

/// The one compiled for the widest level that the processor has.
const Textbook& textbook();

}  // namespace spectile::measure
