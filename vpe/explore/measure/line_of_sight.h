// Lines of sight: whether one point sees another, what obstructs the view, and the clearance above the ground.
//
// Computed on the reference surface, in vacuum, along straight lines, without exaggeration. Two independent
// methods are used: a ray is cast against the surface, and the section of the surface by the line's vertical
// plane (paging/surface/section.h) is compared with the line facet by facet. Objects that stand on the ground are
// found by a function of the caller.
//
// Typical usage:
//   const LineOfSight sight = line_of_sight(surface, {from, 2}, {to, 0}, scene.first_object);
//   if (sight.obstruction) tell(sight.obstruction->object, sight.obstruction->distance_m);
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace vpe::explore {

struct SightPoint {
  mars::LonLat place;
  double height_m = 0;  // above the reference surface there, 0 or more
};

// Describes where a line of sight is obstructed.
struct Obstruction {
  mars::LonLat place;
  double distance_m = 0;   // along the line from its beginning
  double elevation_m = 0;  // of the ground or of the object there, above the sphere
  std::string object;      // its name; empty: ground
};

// Holds an object that a ray meets.
struct SightObject {
  double range_m = 0;  // along the ray
  std::string name;    // not empty
};

// Returns the first object that a ray meets before until_m, or nullopt. The ray begins at `from_m` (body-fixed frame,
// metres from the planet's centre) and has a unit direction. The objects stand on ground without exaggeration.
using FirstObject = std::function<std::optional<SightObject>(const glm::dvec3& from_m,
                                                             const glm::dvec3& direction, double until_m)>;

struct LineOfSight {
  bool visible = false;
  std::optional<Obstruction> obstruction;  // the first from the beginning; has a value exactly if not visible
  double distance_m = 0;                   // straight
  double arc_m = 0;                        // along the great circle on the planet's sphere

  // Clearance and needed height are those of the ground alone, whatever objects there are.
  //
  // Smallest vertical height of the line above the reference surface over its whole length; negative where it
  // runs below the ground. Never above the heights of the two ends.
  double clearance_m = 0;
  double clearance_error_m = 0;  // bound of its error by refinement and rounding
  mars::LonLat clearance_place;
  double clearance_distance_m = 0;  // along the line from its beginning

  // Least height of the second point above its ground from which the first is seen, all else unchanged: 0 if
  // its ground is seen; infinity if the curvature of the planet hides the first point from every height.
  double needed_height_m = 0;
};

// Computes the line of sight. Ground and objects within kSightEnd_m of an end, plus 1e-8 of the distance, do not
// obstruct it, so that an end may stand on the ground or on an object. At the same distance it is the ground that
// obstructs, not the object. first_object is called once at most; empty: there are no objects. Throws
// std::invalid_argument for an invalid place, a height that is negative or not finite, and ends on opposite sides of
// the planet (within 1e-6 rad, where no plane is defined). Throws paging::PlanetError, and what first_object throws.
// May be called from any thread from which first_object may.
inline constexpr double kSightEnd_m = 1e-3;
inline constexpr double kClearance_m = 1e-6;  // refined to this, before rounding
LineOfSight line_of_sight(const paging::Surface& surface, const SightPoint& from, const SightPoint& to,
                          const FirstObject& first_object = {});

}  // namespace vpe::explore
