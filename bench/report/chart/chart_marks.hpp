// The marks of charts: a colour and a shape for each style, so that neither alone tells series apart.
#pragma once

#include <string>

namespace spectile::report {

/// "#0072b2": of the palette of Okabe and Ito, "Color Universal Design", 2008, which most eyes can tell
/// apart.
std::string style_color(int style);

/// Shape round (0, 0), its outline included; `radius`: about that of a circle of the same area.
std::string style_shape(int style, double radius);

}  // namespace spectile::report
