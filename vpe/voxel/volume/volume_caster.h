// Perspective casting of terrain volumes (Wan, Qu and Kaufman 1999, sections 4 and 5).
//
// Samples of a ray lie a fixed interval apart, at whole multiples of it from the camera. The array of boundary cells tells most of
// them apart from the ground without interpolation. Rays of one line of pixels, along which the elevation rises, begin where
// the ray below has ended. Two ways are there:
//
//   kPaper    a ray begins at the distance of the last hit, and retraces towards the camera if it begins in the ground (Fig. 4b).
//             Where the planes of lines of pixels are oblique it may miss ground that the ray below has passed.
//   kChecked  the way up to that distance is checked by maxima of blocks of boundary cells: the hits are those of kCamera.
//
// Typical usage:
//   const VolumeRanges found = cast_volume(volume, cells, view, {.start = VolumeStart::kPaper}, pool);
#pragma once

#include <cstdint>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/volume/boundary_cells.h"
#include "vpe/voxel/volume/terrain_volume.h"

namespace vpe::voxel {

enum class VolumeStart : std::uint8_t { kCamera, kPaper, kChecked };

struct VolumeCastOptions {
  double interval = 0.6;  // of samples, voxels, 0.01 to 10. Smaller: narrower ridges are met, slower
  // Ends rays in the first boundary cell that a sample lies in: the 2-D array is all that is read.
  bool is_approximate = false;
  VolumeStart start = VolumeStart::kChecked;
  // Lets the array of boundary cells decide where it can; else every sample is interpolated. The hits are the same.
  bool uses_cells = true;
  // Moves hits from the sample in the ground to the surface before it, within an interval / 500; not of approximate ones.
  bool refines = true;
};

struct VolumeCounts {
  std::int64_t rays = 0;
  std::int64_t samples = 0;
  std::int64_t interpolations = 0;
  std::int64_t retraced = 0;  // samples towards the camera
};

struct VolumeRanges {
  int width = 0;
  int height = 0;
  std::vector<float> range;  // voxels from the camera, row by row; infinite where no ground is met
  VolumeCounts counts;
};

// Casts the full image of a perspective view whose camera is in voxels. Nothing is there beyond the outer voxels. Does not
// depend on the pool. Throws std::invalid_argument for options beyond their limits, cells of another volume's size, and for
// views that core::check() refuses, that are not perspective or draw a part.
VolumeRanges cast_volume(const TerrainVolume& volume, const BoundaryCells& cells, const core::View& view,
                         const VolumeCastOptions& options, base::ThreadPool& pool);

}  // namespace vpe::voxel
