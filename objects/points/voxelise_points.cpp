#include "objects/points/voxelise_points.h"

#include <cstdint>
#include <glm/common.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "objects/points/gap_looks.h"
#include "objects/points/point_normals.h"
#include "objects/points/point_voxels.h"
#include "objects/sticks/grid_around.h"

namespace objects {

namespace {

void check_point_options(const VoxelisePointsOptions& options) {
  if (options.voxels_longest < 1 || options.voxels_longest > kMostVoxelsLongest)
    throw std::invalid_argument("points get 1 to " + std::to_string(kMostVoxelsLongest) +
                                " voxels along their longest side, not " +
                                std::to_string(options.voxels_longest));
  if (options.close_voxels < 0 || options.close_voxels > kMostCloseVoxels)
    throw std::invalid_argument("gaps are closed by 0 to " + std::to_string(kMostCloseVoxels) +
                                " voxels, not " + std::to_string(options.close_voxels));
}

StickGrid grid_around_points(const Mesh& points, int voxels_longest) {
  glm::vec3 low = points.positions_m.front();
  glm::vec3 high = low;
  for (const glm::vec3& p : points.positions_m) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  if (low == high) throw std::invalid_argument("all of its points lie in one place");
  return grid_around(glm::dvec3(low), glm::dvec3(high), voxels_longest);
}

}  // namespace

VoxelGrid voxelise_points(const Mesh& points, const VoxelisePointsOptions& options) {
  check_point_options(options);
  if (const std::string reason = check_points(points); !reason.empty()) throw std::invalid_argument(reason);
  VoxelGrid held(grid_around_points(points, options.voxels_longest));
  const PointVoxels voxels(points, held);
  for (const std::uint64_t place : voxels.places()) {
    const glm::ivec3 at = held.voxel_of(place);
    held.set(at.x, at.y, at.z);
  }
  VoxelGrid out = held;
  close_gaps(out, options.close_voxels);

  const std::vector<glm::vec3> normals = point_normals(voxels, {held, out, options.close_voxels});
  std::vector<StickVoxel> looks;
  looks.reserve(voxels.size());
  for (std::uint32_t n = 0; n < voxels.size(); ++n) looks.push_back(stick_voxel(voxels.colour(n), normals[n]));
  out.filling = stick_voxel(voxels.mean_colour(), {0, 0, 1});
  for (std::uint32_t n = 0; n < voxels.size(); ++n) out.add_colour(voxels.places()[n], looks[n]);
  // A filled voxel beside an empty one has a point within this distance: what the erosion took is next to what the
  // dilation added.
  colour_gaps(voxels, looks, held, 2 * options.close_voxels + 1, out);
  out.tidy();
  return out;
}

}  // namespace objects
