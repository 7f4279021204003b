// Bodies by name and size.
#pragma once

#include <span>
#include <string_view>

namespace mars {

// Radius of the sphere that a body's maps are drawn on: IAU 2015 where it gives one for maps, else the mean
// radius.
struct Body {
  std::string_view name;
  double radius_m = 0;
};
std::span<const Body> bodies();

// By name, in any case; null when there is none.
const Body* find_body(std::string_view name);

// The body whose radius is nearest to an equatorial radius and within 1 % of it; null when none is.
const Body* find_body(double equatorial_m);

}  // namespace mars
