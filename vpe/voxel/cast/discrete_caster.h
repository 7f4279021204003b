// Casts range images by the discrete column walk (discrete.h): rays.mode=discrete.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster calls it in place of SectorCaster. A pixel has the range of the
// nearest sample; nothing is refined.
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/sector_batch.h"

namespace vpe::voxel {

// Selects how the image of a discrete cast is divided into columns and rays.
struct DiscreteForm {
  core::RayColumns columns = core::RayColumns::kSectors;
  int rays = 1;         // of a pixel, one above the other; they share the walk of their column
  bool blends = false;  // CellRule::blends
  bool operator==(const DiscreteForm&) const = default;
};

// Returns the view with `rays` times as many rows and columns of pixels over the same image.
core::View with_finer_pixels(core::View view, int rays);

// Writes the ranges of a perspective view's drawn part: `form.rays` rows for each row of pixels, the upper first. `samples` is
// memory that is kept from image to image. The walk's rule must be discrete.
//
// kSectors: columns are the vertical planes of SectorPlan, and a ray has the range of the nearest one, half a pixel away at most.
// kLines: columns are parallel lines of pixels along the vertical of the image's centre, each taken as one vertical plane, as
// Cohen-Or 1996 (section 2.1) takes columns of pixels; with roll they are those of PixelLines (Wan 1999, section 5). Rays are off
// their planes the more, the farther the camera is pitched. Requires form.rays == 1. Throws std::runtime_error where a line passes
// the point straight below or above.
//
// Throws paging::PlanetError for tiles that cannot be read.
void cast_discretely(const core::View& view, const ColumnWalk& walk, const DiscreteForm& form,
                     ScratchPool& scratches, base::ThreadPool& pool, SectorSamples& samples,
                     std::span<float> range_m);

}  // namespace vpe::voxel
