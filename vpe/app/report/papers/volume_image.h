// Images of terrain volumes with a photograph: what the tables of Wan, Qu and Kaufman (1999) time.
#pragma once

#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"
#include "vpe/voxel/volume/volume_caster.h"

namespace vpe::app {

// Holds a volume and a colour for each of its columns.
struct PhotographedVolume {
  voxel::TerrainVolume volume;
  voxel::BoundaryCells cells;
  std::vector<base::Rgb> photograph;  // as large as a level of the volume, row by row along x
};

struct VolumeImage {
  core::RgbImage colours;
  voxel::VolumeCounts counts;
};

// Casts a view, and colours hits by the photograph, bilinear between columns; the rest is sky. Throws what cast_volume() throws.
VolumeImage draw_volume(const PhotographedVolume& scene, const core::View& view,
                        const voxel::VolumeCastOptions& options, base::ThreadPool& pool);

// Returns invented hills as a volume of `side` x `side` x 64 voxels with a photograph of them: eight octaves of noise, in light
// from the north-west.
PhotographedVolume hills_volume(int side, voxel::VolumeFilter filter);

}  // namespace vpe::app
