// Profiles of the surface along great circles.
//
// Typical usage:
//   const std::array places{mars::LonLat{-74, -13}, mars::LonLat{-68, -13}};
//   for (const ProfilePoint& point : profile(surface, places, 1000)) plot(point.distance_m, point.height_m);
#pragma once

#include <span>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace paging {

struct ProfilePoint {
  mars::LonLat place;
  double distance_m = 0;         // along the great circles, on the planet's sphere, from the start
  double ground_distance_m = 0;  // along the reference surface from the start, exact but for rounding
  double height_m = 0;           // of the reference surface above the sphere
  double lowest_m = 0;           // on the step before the point, both ends included, above the sphere
  double highest_m = 0;          // likewise
  double slope_deg = 0;          // along the profile, positive uphill; of the step before (first point: after)
  double cross_slope_deg = 0;    // steepest slope of the facet there, in any direction
  bool nodata = false;           // no source has data there; other values are those of the drawn surface
  bool waypoint = false;
};

// Returns points along the great circles through the places. Every place is one of them; between two places
// all steps are equal and at most step_m long. Throws std::invalid_argument for fewer than two places, a step
// that is not positive, two successive places on opposite sides of the planet (every great circle joins them),
// and more than kMostProfilePoints points.
inline constexpr std::size_t kMostProfilePoints = 10'000'000;
std::vector<ProfilePoint> profile(const Surface& surface, std::span<const mars::LonLat> places, double step_m);

}  // namespace paging
