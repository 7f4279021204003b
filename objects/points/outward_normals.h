// Decides which of the two sides of planes is outside, for point_normals.h.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/points/point_normals.h"
#include "objects/points/point_voxels.h"

namespace objects {

enum class NormalState : std::uint8_t {
  kTwoSided,  // of a plane; its opposite is as good
  kOutward,
  kAlone,  // no plane: is left as it is, and says nothing of others
};

struct VoxelNormal {
  glm::dvec3 normal{0, 0, 1};
  int reach = 1;  // voxels up to this distance along each axis are neighbours
  NormalState state = NormalState::kTwoSided;
};

// Turns the two-sided ones of the normals, one for each number of `points`, outward. Outside is, by the first of these
// rules that decides:
// 1. what neighbours say that are outward already, and their neighbours, beginning where surfaces bend least (Hoppe and
//    others 1992);
// 2. the side on which the filled voxels end, where they are thicker on the other side than gaps are wide;
// 3. the side from which at least six more of nine upward directions reach the sky (sky_view.h);
// 4. what neighbours say that know by 2 or 3, as in 1: walls and the undersides of overhangs follow the ground around;
// 5. for a part without neighbours that know, at its highest voxel: up, or away from the middle of all points where the
//    normal is within 12 degrees of level.
void turn_outward(const PointVoxels& points, const PointSurroundings& around,
                  std::vector<VoxelNormal>& normals);

}  // namespace objects
