// Whether one point sees another, what is in the way, and by how much the line passes the ground.
//
// Of S itself, in vacuum, straight lines. Two independent ways: the line is cast against S, and the section of
// S by the vertical plane of the line (paging/surface/section.h) is compared with it facet by facet. Heights are not
// exaggerated.
#pragma once

#include <optional>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace vpe::explore {

struct SightPoint {
  mars::LonLat place;
  double height_m = 0;  // above S there, 0 or more
};

struct Obstruction {
  mars::LonLat place;
  double distance_m = 0;   // along the line from its beginning
  double elevation_m = 0;  // of S there, above the sphere
};

struct LineOfSight {
  bool visible = false;
  std::optional<Obstruction> obstruction;  // the first from the beginning; exactly when not visible
  double distance_m = 0;                   // straight
  double arc_m = 0;                        // along the great circle on the planet's sphere

  // The smallest height of the line above S, straight up, over its whole length; negative where it runs below
  // the ground. It is never above the heights of the two ends.
  double clearance_m = 0;
  double clearance_error_m = 0;  // bound of its error by refinement and rounding
  mars::LonLat clearance_place;
  double clearance_distance_m = 0;  // along the line from its beginning

  // The least height of the second point above its ground from which the first is seen, all else unchanged: 0
  // when its ground is seen; infinity where the curve of the planet lets no height do.
  double needed_height_m = 0;
};

// What lies within kSightEnd_m of an end, plus a hundred millionth of the distance, is not in the way: an end
// may stand on the ground. Throws std::invalid_argument: a place that is none, a height that is negative or not
// finite, ends on opposite sides of the planet (within 1e-6 rad; no plane is defined). Throws
// paging::PlanetError. Any thread.
inline constexpr double kSightEnd_m = 1e-3;
inline constexpr double kClearance_m = 1e-6;  // refined to this, before rounding
LineOfSight line_of_sight(const paging::Surface& surface, const SightPoint& from, const SightPoint& to);

}  // namespace vpe::explore
