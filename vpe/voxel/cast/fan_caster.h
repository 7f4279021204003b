// Casts range images of round views whose camera is tilted.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster calls it for cylindrical and equirectangular views whose columns
// are not vertical planes. It plans a fan of vertical planes (view_fan.h), casts its columns (column_batch.h), and refines the
// samples to pixels (round_refine.h).
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/sector_batch.h"
#include "vpe/voxel/cast/single_rays.h"

namespace vpe::voxel {

// Writes the ranges of the view's drawn part, row by row from the top, as SectorCaster::cast() does for perspective views. Returns
// false, and writes nothing, where a fan would need far more samples than the image has pixels. Throws paging::PlanetError for
// tiles that cannot be read.
bool cast_by_fan(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
                 const SingleRays* single_rays, base::ThreadPool& pool, SectorSamples& samples,
                 std::span<float> range_m);

}  // namespace vpe::voxel
