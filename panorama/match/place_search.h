// The place of a photograph within a radius, with its attitude.
#pragma once

#include <functional>
#include <glm/vec2.hpp>

#include "panorama/match/skyline_match.h"

namespace panorama {

// Returns the skyline of the planet at a place, in metres to the east and to the north of the middle. Samples are at
// most step_deg apart.
using ProfileAt = std::function<SkylineProfile(const glm::dvec2& offset_m, double step_deg)>;

// Holds the best place. `match` says whether attitude and place are sure, and holds the attitude there.
struct PlaceMatch {
  glm::dvec2 offset_m{0, 0};  // east, north
  double spread_m = 0;        // the farthest place tried that is as good, at least the last step of the search
  int places = 0;             // whose skylines were compared
  SkylineMatch match;
};

// Bounds the radius from above, and from below.
inline constexpr double kMostRadius_m = 100000;
inline constexpr double kLeastRadius_m = 1;

// Searches places within a circle: first a grid of a quarter of the radius (49 places), each with the whole search for the
// attitude on a skyline of half a degree; then the six best ones on a fine skyline, and about the best of these, in steps
// that are halved six times. The attitude of
// match_skyline() at the best place is the answer. Its sigma is enlarged by how far the attitude differs among places
// that are as good: whose loss (0 to 1) is larger by less than 0.02, or than twice its own standard deviation over blocks of columns. Throws
// std::invalid_argument for a radius outside of its limits and what match_skyline() throws; passes on what profile_at
// throws. `tell` is called with the share of the work that is done.
PlaceMatch search_place(const SkyLine& line, const PhotoShape& shape, double radius_m,
                        const ProfileAt& profile_at, const MatchOptions& options,
                        const std::function<void(double)>& tell = {});

}  // namespace panorama
