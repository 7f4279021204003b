// Says where the bricks (brick.h) of the parts of a planet's ground lie, and what is solid in them.
//
// Typical usage:
//   for (const BrickPlan& plan : plan_bricks(parts, radius_m))
//     bricks.push_back(make_brick(plan.face, plan.frame, radius_m, solids_of(parts, plan, ground_m)));
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mars/geodesy/cube.h"
#include "vpe/core/ground_parts.h"
#include "vpe/voxel/columns/height_grid.h"

namespace vpe::voxel {

// Limits of the parts of one image's ground.
inline constexpr std::size_t kMostGroundParts = 256;
// Voxels between the balls of a brick's parts and its border.
inline constexpr int kBrickMargin = 6;

struct BrickPlan {
  mars::Face face = mars::Face::kPlusX;
  HeightGridFrame frame;           // may reach beyond the face
  std::vector<std::size_t> parts;  // that lie in it, ascending
};

// Returns the bricks of all parts: each part lies in one of them, and they do not overlap. Parts that are near each other share a
// brick with the smallest of their voxels. The order follows the first parts. Throws std::runtime_error with the names of parts
// that would need a brick of more than kMostVolumeSide voxels along a side, and std::invalid_argument for too many parts, balls
// that reach the planet's centre or are as wide as the planet, and numbers that are not finite. Pure.
std::vector<BrickPlan> plan_bricks(std::span<const core::GroundPart> parts, double planet_radius_m);

// Returns what is solid in a brick: the ground up to ground_m, less what is cut, and what is added. `parts` must outlive it. Any
// thread may call it if `ground_m` may be called by any.
core::SolidsAt solids_of(std::span<const core::GroundPart> parts, const BrickPlan& plan,
                         std::function<double(const glm::dvec3& up)> ground_m);

// Removes from sorted, disjoint `solids` what lies in `cut`, whose spans may overlap. What is left is sorted and disjoint. Pure.
void cut_out_of(std::vector<core::SolidSpan>& solids, std::vector<core::SolidSpan> cut);

}  // namespace vpe::voxel
