// Which of the textbook's compilations runs here.
#include "bench/methods/aos_baseline.hpp"

#include <string_view>

#include "src/dispatch/dispatch.hpp"

namespace spectile::measure {

extern const Textbook textbook_baseline;
#if defined(__x86_64__)
extern const Textbook textbook_v2;
extern const Textbook textbook_v3;
extern const Textbook textbook_v4;
#endif

const Textbook& textbook() {
#if defined(__x86_64__)
  // The levels ask for what the kernels of these names ask for.
  const char* widest = dispatch::available().back()->name;
  if (std::string_view(widest) == "avx512") return textbook_v4;
  if (std::string_view(widest) == "avx2") return textbook_v3;
  if (std::string_view(widest) == "sse4.2") return textbook_v2;
#endif
  return textbook_baseline;
}

}  // namespace spectile::measure
