// Casts images of the terrain volumes of a planet: rays.mode=volume and boundary.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster calls it in place of SectorCaster, through VolumeTerrain.
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/volume_rays.h"

namespace vpe::voxel {

// Holds what the rays of an image found.
struct VolumesSeen {
  VolumeTiles tiles;
  VolumeTile bricks;
};

// Writes the ranges of a view's drawn part, in any projection; of `only`, unless its width is 0, those alone. They are those of
// VolumeRays::cast(), rounded to float, and do not depend on the pool. Returns what rays found. Throws paging::PlanetError, and std::invalid_argument for options beyond their limits.
VolumesSeen cast_volumes(const core::View& view, const ColumnWalk& walk, const GridVolumeStore& store,
                         const VolumeForm& form, ScratchPool& scratches, base::ThreadPool& pool,
                         const core::SubRectangle& only, std::span<float> range_m);

// Adds to the errors of the tiles of an image how far their volumes are from the reference surface, and to its totals how far bricks are
// from what they are made of.
void add_deviations(const VolumesSeen& found, double focal_px, const lod::TileTree& tree, TileUsage& usage);

}  // namespace vpe::voxel
