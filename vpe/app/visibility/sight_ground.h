// Summarises the ground along a line of sight: resolution, error, sources, gaps.
#pragma once

#include <set>
#include <string>

#include "mars/geodesy/sphere.h"
#include "paging/surface/query.h"

namespace vpe::app {

inline constexpr int kMostSightPoints = 1000;

// Describes the ground under a line by points at equal distances on the great circle, both ends among them.
struct SightGround {
  int points = 0;                     // one a post, of the finer end, but 2 to kMostSightPoints
  int nodata = 0;                     // points of nodata: the ground there is a filling
  int synthetic = 0;                  // points whose height is made up
  double finest_spacing_m = 0;        // of posts, at the points
  double coarsest_spacing_m = 0;      // of posts, at the points
  std::int64_t resampling_posts = 0;  // posts that resampling_max_m was measured on; 0: it is not known
  double resampling_max_m = 0;        // largest at the points: of the ground against the posts of its sources
  std::set<std::string> sources;      // names of those that decide at the points
};

// Computes the description between two places that are valid and not on opposite sides of the planet. Throws
// paging::PlanetError.
SightGround sight_ground(const paging::Surface& surface, mars::LonLat from, mars::LonLat to);

}  // namespace vpe::app
