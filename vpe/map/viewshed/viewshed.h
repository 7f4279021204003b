// What an observer sees of the ground of a map.
//
// Lines of sight are straight lines of the map, so the map must be azimuthal equidistant about the observer's post.
// docs/design/viewshed.md has the method and its measured errors.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/map/height_grid.h"

namespace vpe::map {

// Describes an observer and what is looked at.
struct ViewshedOptions {
  int column = 0;  // post of the observer, the centre of the map; it may lie anywhere in the grid
  int row = 0;
  double observer_height_m = 2;  // above the ground
  double target_height_m = 0;    // above the ground; needed_heights() does not use it
  // Radius of the planet from which heights count. Infinity: a plane.
  double radius_m = std::numeric_limits<double>::infinity();
  // Distance on the map from the observer beyond which posts are unknown. A quarter of the planet's circumference
  // is a second limit.
  double reach_m = std::numeric_limits<double>::infinity();
};

// Says what is known of a post.
enum class Sight : std::uint8_t { hidden = 0, seen = 1, unknown = 255 };

// Holds what is seen from one post.
struct Viewshed {
  int columns = 0;
  int rows = 0;
  std::vector<Sight> sights;  // by rows, as those of the heights
};

// Computes which targets are seen. A target is seen if no ground between observer and target is above the line
// between both. A post of nodata is unknown and hides nothing. So does a height beyond a million kilometres. Refraction
// is not considered. All is unknown if the observer's ground is. The result is the same to the bit for any number of
// threads and on all processors. Throws std::invalid_argument if the observer is outside the grid, the grid has another
// number of heights than posts, or an option is out of range.
Viewshed viewshed(const HeightGrid& ground, const ViewshedOptions& options, base::ThreadPool& pool);

// Computes how high above the ground a target must be to be seen, in metres: 0 where viewshed() of a target on the
// ground says seen, infinity where the planet hides every height, NaN where a post is unknown. Otherwise the same as
// viewshed().
HeightGrid needed_heights(const HeightGrid& ground, const ViewshedOptions& options, base::ThreadPool& pool);

}  // namespace vpe::map
