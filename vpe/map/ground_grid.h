// The ground of a planet on a grid of a local map.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/map/height_grid.h"
#include "vpe/map/local_map.h"
#include "vpe/map/map_sampler.h"

namespace vpe::map {

// Bounds the posts of a grid: 256 MB of heights.
inline constexpr std::int64_t kMostGridPosts = 64'000'000;

// Describes posts on a local map: row 0 in the north, column 0 in the west, before any turn of the map itself.
struct GridFrame {
  LocalMap map;
  glm::dvec2 first_m{0};  // map coordinates of the post of row 0 and column 0
  double spacing_m = 1;
  int columns = 0;
  int rows = 0;

  // Returns the map coordinates of (column, row), which need not be integers.
  glm::dvec2 to_map(glm::dvec2 grid) const {
    return {first_m.x + grid.x * spacing_m, first_m.y - grid.y * spacing_m};
  }
  mars::LonLat to_place(glm::dvec2 grid) const { return map.to_place(to_map(grid)); }
  // Returns (column, row) of a place; not rounded.
  glm::dvec2 to_grid(mars::LonLat place) const;

  // Returns by how much lengths on the map may be too large, as a share, at the farthest corner.
  double scale_error() const;
};

// Returns the frame with the least number of posts that holds all directions, and `margin_m` more on each side.
// The first direction is a post. The map's centre is the mean of the directions, or the first of them if they
// have none. Throws std::invalid_argument if it needs more than kMostGridPosts, and for no directions, a
// spacing not above 0, and a margin below 0.
GridFrame frame_around(std::span<const glm::dvec3> directions, double spacing_m, double margin_m,
                       double radius_m);

// Returns the number of posts that such a frame has, without a limit.
double posts_around(std::span<const glm::dvec3> directions, double spacing_m, double margin_m, double radius_m);

// Holds heights with what they were taken from.
struct GroundGrid {
  HeightGrid heights;  // above the zero of the planet's datum; NaN at nodata
  MapGround ground;    // what lies under the posts
};

// Samples the surface at each post. Calls progress() with the share that is done, from one thread at a time; it
// may throw. The result does not depend on `threads` (0: all cores). Throws PlanetError.
GroundGrid sample_ground(const paging::Surface& surface, const GridFrame& frame, int threads,
                         const std::function<void(double)>& progress);

// Returns the places of a line on the grid, degrees east and north. Longitudes of neighbours differ by at most
// 180 degrees, so that they may leave -180..180. Places are added where a line that is straight in degrees
// would be farther than `tolerance_m` from the straight one on the map; at the poles longitudes are those of
// the line beside it. A closed line ends at its first place again.
std::vector<glm::dvec2> places_of_line(const GridFrame& frame, std::span<const glm::dvec2> line, bool is_closed,
                                       double tolerance_m);

}  // namespace vpe::map
