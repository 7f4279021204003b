// Names and radii of planets and moons.
#pragma once

#include <span>
#include <string_view>

namespace mars {

struct Body {
  std::string_view name;
  // Radius of the sphere on which maps of the body are drawn: the value of IAU 2015 for maps where it gives
  // one, else the mean radius.
  double radius_m = 0;
};

// Returns all known bodies. Mars is the first.
std::span<const Body> bodies();

// Returns the body of this name, in upper or lower case, or null if there is none.
const Body* find_body(std::string_view name);

// Returns the body whose radius is nearest to `equatorial_m`, or null if none is within 1 % of it.
const Body* find_body(double equatorial_m);

}  // namespace mars
