// Figures as panels say them.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace vpe::window {

// "12.3 km", "340 m", "2.54 m".
inline std::string metres(double m) {
  char text[48];
  const double size = std::abs(m);
  if (size >= 1e6)
    std::snprintf(text, sizeof text, "%.0f km", m / 1e3);
  else if (size >= 1e4)
    std::snprintf(text, sizeof text, "%.1f km", m / 1e3);
  else if (size >= 100)
    std::snprintf(text, sizeof text, "%.0f m", m);
  else
    std::snprintf(text, sizeof text, "%.2f m", m);
  return text;
}

}  // namespace vpe::window
