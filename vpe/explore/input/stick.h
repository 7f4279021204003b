// Sticks that do not rest at zero, made into rates.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace vpe::explore {

// How far a stick is pushed, 0..1, as a rate 0..1: nothing within the dead zone (0..1), from its edge on the
// share of the rest to the power of the curve. Increasing, continuous, and 1 at 1. A number that is not finite
// is rest.
inline double stick_rate(double pushed, double dead_zone, double curve) {
  if (!std::isfinite(pushed) || pushed <= dead_zone || dead_zone >= 1) return 0;
  return std::pow((std::min(pushed, 1.0) - dead_zone) / (1.0 - dead_zone), curve);
}

// The same of one that goes both ways, -1..1.
inline double axis_rate(double pushed, double dead_zone, double curve) {
  return std::copysign(stick_rate(std::abs(pushed), dead_zone, curve), pushed);
}

// Of two axes together: the dead zone is round, the direction is kept, so nothing snaps to the axes.
inline glm::dvec2 stick_rates(const glm::dvec2& pushed, double dead_zone, double curve) {
  const double length = std::hypot(pushed.x, pushed.y);
  const double rate = stick_rate(length, dead_zone, curve);
  return rate > 0 ? pushed * (rate / length) : glm::dvec2(0);
}

}  // namespace vpe::explore
