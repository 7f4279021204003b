// Casts range images of perspective views.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster calls it. It plans the image's sectors
// (view_sector.h), casts their columns (column_batch.h), and refines the samples to pixels (refine.h).
#pragma once

#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/sector_batch.h"
#include "vpe/voxel/cast/single_rays.h"
#include "vpe/voxel/cast/view_sector.h"

namespace vpe::voxel {

// Keeps the samples of the last image, so that the next one need not allocate them. One thread at a time may
// call it.
class SectorCaster {
 public:
  // Writes the ranges of the view's drawn part, row by row from the top. Casts the columns of all sectors, then
  // intersects each pixel's own ray with the facet at its nearest samples. Where these belong to different
  // surfaces (ridges, the skyline) the ray is cast by itself: against the reference surface by `single_rays`; if
  // that is null, or lacks a tile, in fixed steps over the height grids of `walk`. Throws paging::PlanetError for
  // tiles that cannot be read.
  //
  // With `only`, a rectangle of the full image, it casts the samples and rays of that rectangle alone (its width 0:
  // all of the drawn part). Its ranges are the same to the bit; those beside it are left alone, except that it is
  // widened to where blocks of columns begin.
  void cast(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
            const SingleRays* single_rays, base::ThreadPool& pool, std::span<float> range_m,
            const core::SubRectangle& only = {});

  // Lends the memory of the samples to casts of another kind.
  SectorSamples& samples() { return samples_; }

  // Returns the bytes of the samples that are kept.
  std::size_t bytes() const;

 private:
  void cast_sectors(const SectorPlan& plan, const core::SubRectangle& pixels, const ColumnWalk& walk,
                    ScratchPool& scratches, base::ThreadPool& pool);
  // Finds the samples on either side of pixels [first_pixel, last_pixel) of a row of the drawn part.
  void find_hints(const SectorPlan& plan, const core::SubRectangle& part, int row, int first_pixel,
                  int last_pixel, float* a, float* b, float* share) const;

  SectorSamples samples_;  // of the last image
};

}  // namespace vpe::voxel
