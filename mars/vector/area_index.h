// Tells whether places lie within polygons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "mars/vector/feature.h"

namespace mars {

// Tells whether places lie within a polygon: after an odd number of its rings, as seen from the north pole. Edges are straight
// in degrees.
class AreaIndex {
 public:
  // Expects a polygon with closed rings and unwrapped longitudes.
  explicit AreaIndex(const Shape& shape);

  bool contains(glm::dvec2 place_deg) const;
  // Return the extent; the difference of longitudes is at most 360, but for rings that go around the planet several times.
  glm::dvec2 low_deg() const { return low_; }
  glm::dvec2 high_deg() const { return high_; }

 private:
  struct Edge {
    glm::dvec2 from;
    glm::dvec2 to;
  };
  std::size_t bin_of(double lon_deg) const;

  glm::dvec2 low_{0, 0};
  glm::dvec2 high_{0, 0};
  bool holds_north_ = false;
  std::vector<std::uint32_t> first_;  // of each bin of longitude, and the end
  std::vector<Edge> edges_;           // by bins; an edge is in each bin that it meets
};

}  // namespace mars
