// Lines of sight: whether one point sees another, what obstructs the view, and the clearance above the ground.
//
// Computed on the reference surface, in vacuum, along straight lines, without exaggeration. Two independent
// methods are used: a ray is cast against the surface, and the section of the surface by the line's vertical
// plane (paging/surface/section.h) is compared with the line facet by facet.
#pragma once

#include <optional>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace vpe::explore {

struct SightPoint {
  mars::LonLat place;
  double height_m = 0;  // above the reference surface there, 0 or more
};

struct Obstruction {
  mars::LonLat place;
  double distance_m = 0;   // along the line from its beginning
  double elevation_m = 0;  // of the reference surface there, above the sphere
};

struct LineOfSight {
  bool visible = false;
  std::optional<Obstruction> obstruction;  // the first from the beginning; has a value exactly if not visible
  double distance_m = 0;                   // straight
  double arc_m = 0;                        // along the great circle on the planet's sphere

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

// Computes the line of sight. Surface within kSightEnd_m of an end, plus 1e-8 of the distance, does not
// obstruct it, so that an end may stand on the ground. Throws std::invalid_argument for an invalid place, a
// height that is negative or not finite, and ends on opposite sides of the planet (within 1e-6 rad, where no
// plane is defined). Throws paging::PlanetError. May be called from any thread.
inline constexpr double kSightEnd_m = 1e-3;
inline constexpr double kClearance_m = 1e-6;  // refined to this, before rounding
LineOfSight line_of_sight(const paging::Surface& surface, const SightPoint& from, const SightPoint& to);

}  // namespace vpe::explore
