// Casts rays one by one in fixed steps (rays.mode=reference): an independent check of the column kernel.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): takes the place of batches, walk and refinement in mode
// reference, and casts single rays in mode multires that refinement cannot resolve. It is conventional ray casting over the
// reference surface, tuned as far as it goes without coherence between rays: a height grid is looked up once for all
// samples in it, and a sample takes one division, in float relative to where the ray enters the grid. It is not the caster
// of a paper: neither over densities (Wan 1999) nor over integer cells (Cohen-Or 1996).
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/facet_finder.h"

namespace vpe::voxel {

// Writes the range of every pixel of the view's drawn part, row by row from the top; infinite for the sky. A
// ray advances by kReferenceStep times the post spacing where it enters a height grid, from where it comes below the highest
// ground until it is below the ground or above the highest ground again. Bisection between its last two samples, in
// double, then gives the range within 1e-8 of it. Passes through ridges that are narrower than a step. Uses the tiles of
// `walk`. Throws paging::PlanetError for tiles that cannot be read.
void march_fixed_steps(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
                       base::ThreadPool& pool, std::span<float> range_m);
inline constexpr double kReferenceStep = 0.6;  // as the samples of Wan 1999, section 3

// Returns the range where the ray (unit) comes below the ground of the finder's height grids, from `begin_m`
// on; infinite if it leaves the sphere of radius `top_m` first. Returns the first sample's range if that is
// below ground already.
double march(const glm::dvec3& camera_m, const glm::dvec3& ray, double begin_m, double top_m,
             FacetFinder& finder, double radius_m);

}  // namespace vpe::voxel
