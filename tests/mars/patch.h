#pragma once

#include <glm/geometric.hpp>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace mars {

// Returns a patch of side x side posts, `spacing_m` apart, around a place.
inline std::vector<glm::dvec3> patch(LonLat p, int side, double spacing_m) {
  const LocalFrame f = local_frame(p);
  std::vector<glm::dvec3> directions;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const double e = (i - 0.5 * side) * spacing_m / kMarsRadius_m;
      const double n = (j - 0.5 * side) * spacing_m / kMarsRadius_m;
      directions.push_back(glm::normalize(f.up + e * f.east + n * f.north));
    }
  }
  return directions;
}

}  // namespace mars
