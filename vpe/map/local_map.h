// Maps around a place: azimuthal equidistant, in closed form on the sphere.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"

namespace vpe::map {

// Converts between places and map coordinates in metres, x east and y north at the centre. Directions and
// distances from the centre are true; across them lengths are magnified by scale_across(). It is exact at the
// poles and works for all of the planet but the antipode of the centre. Immutable.
class LocalMap {
 public:
  // Takes a valid centre and a radius above 0; throws std::invalid_argument for others. At a pole, y follows
  // the meridian of the centre's longitude.
  LocalMap(mars::LonLat centre, double radius_m);

  mars::LonLat centre() const { return centre_; }
  double radius_m() const { return radius_m_; }

  // Returns the map coordinates of a direction of any length but 0. The error is at most kError_rad * radius,
  // but for places closer than 1e-3 radians to the antipode, which is anywhere on the rim at pi * radius.
  glm::dvec2 to_map(const glm::dvec3& direction) const;
  glm::dvec2 to_map(mars::LonLat place) const { return to_map(mars::direction(place)); }

  // Returns the unit direction, or the place, at map coordinates. The error is at most kError_rad.
  glm::dvec3 to_direction(glm::dvec2 map_m) const;
  mars::LonLat to_place(glm::dvec2 map_m) const { return mars::lon_lat(to_direction(map_m)); }

  static constexpr double kError_rad = 1e-14;

  // Returns the magnification across the direction to the centre, at a distance from it on the map: 1 + (d /
  // R)^2 / 6 and more. It is the largest in any direction there.
  double scale_across(double distance_m) const;

 private:
  mars::LonLat centre_;
  double radius_m_;
  mars::LocalFrame frame_;
};

}  // namespace vpe::map
