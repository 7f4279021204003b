// Rays one by one in even steps, as in the papers: what columns are measured against.
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/facet_finder.h"

namespace vpe::voxel {

// Steps of 0.6 times the post spacing about each sample (Wan 1999, section 3), from where a ray comes below the
// highest ground until it is below S or above that again; then where the line between its last two samples
// meets the ground's height. May pass through ridges that are narrower than a step. Same S, same posts as the
// walk's.
void march_fixed_steps(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
                       base::ThreadPool& pool, std::span<float> range_m);
inline constexpr double kPlainStep = 0.6;

// One such ray (unit) over the lattices that `finder` knows, from `begin_m` on: the range where it comes below
// their ground, infinite where it leaves the shell under `top_m` first.
double march(const glm::dvec3& camera_m, const glm::dvec3& ray, double begin_m, double top_m,
             FacetFinder& finder, double radius_m);

}  // namespace vpe::voxel
