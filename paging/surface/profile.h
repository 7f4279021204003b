// Heights along great circles.
#pragma once

#include <span>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace paging {

struct ProfilePoint {
  mars::LonLat place;
  double distance_m = 0;         // along the great circles, on the planet's sphere, from the start
  double ground_distance_m = 0;  // along S from the start, over every facet between: exact but for rounding
  double height_m = 0;           // S above the sphere
  double lowest_m = 0;           // of S on the step before the point, both ends included, above the sphere
  double highest_m = 0;
  double slope_deg = 0;  // along the way: positive uphill; of the step before the point (after, at the start)
  double cross_slope_deg = 0;  // steepest slope of the facet there, in whatever direction
  bool nodata = false;         // no source has data there; ground distance and slope go over the drawn ground
  bool waypoint = false;
};

// Points along the great circles through the places, every place one of them, equal steps of at most step_m
// between each two. Throws std::invalid_argument: fewer than two places, a step that is not positive, two
// neighbours on opposite sides of the planet (every great circle joins them), more than kMostProfilePoints
// points.
inline constexpr std::size_t kMostProfilePoints = 10'000'000;
std::vector<ProfilePoint> profile(const Surface& surface, std::span<const mars::LonLat> places, double step_m);

}  // namespace paging
