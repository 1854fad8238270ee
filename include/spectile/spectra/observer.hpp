// The CIE standard observers, and the range in which they see.
#pragma once

#include <string_view>

namespace spectile {

/// The CIE standard observers.
enum class Observer {
  kCie1931,  ///< 2 degree
  kCie1964,  ///< 10 degree
};

/// "1931" or "1964".
constexpr std::string_view to_string(Observer observer) noexcept {
  return observer == Observer::kCie1964 ? "1964" : "1931";
}

/// The visible range: distributions are tabulated and integrated over it where no other is given. Units: nm.
/// Source: CIE 015:2018, range of the standard observers.
inline constexpr double kFirstVisibleNm = 360;
inline constexpr double kLastVisibleNm = 830;

}  // namespace spectile
