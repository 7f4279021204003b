#include "objects/sticks/grid_around.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

StickGrid grid_around(const glm::dvec3& low_m, const glm::dvec3& high_m, int voxels_longest) {
  const glm::dvec3 size_m = high_m - low_m;
  const double far_m = std::max({glm::length(low_m), glm::length(high_m), 1e-6});
  // Coordinates of the grid are floats.
  const double slack_m = far_m * 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon());
  const double longest_m = std::max({size_m.x, size_m.y, size_m.z}) + 4.0 * slack_m;
  StickGrid grid;
  grid.voxel_m = std::nextafter(static_cast<float>(longest_m * (1.0 + 1e-6) / voxels_longest),
                                std::numeric_limits<float>::infinity());
  const double edge_m = static_cast<double>(grid.voxel_m);
  const auto side = [&](double extent_m) {
    const double count = std::ceil((extent_m + 2.0 * slack_m) / edge_m);
    return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(voxels_longest)));
  };
  grid.columns_x = side(size_m.x);
  grid.columns_y = side(size_m.y);
  grid.height = side(size_m.z);
  grid.corner_m = glm::vec3(0.5 * (low_m + high_m) -
                            0.5 * edge_m * glm::dvec3(grid.columns_x, grid.columns_y, grid.height));
  return grid;
}

}  // namespace objects
