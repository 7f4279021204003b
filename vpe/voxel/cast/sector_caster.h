// Casts range images of perspective views.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster calls it. It plans the image's sectors
// (view_sector.h), casts their columns (column_batch.h), and refines the samples to pixels (refine.h) or takes the nearest
// ones (nearest_samples.h).
#pragma once

#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/sector_batch.h"
#include "vpe/voxel/cast/single_rays.h"
#include "vpe/voxel/columns/view_sector.h"

namespace vpe::voxel {

// Selects the rays that pixels show.
struct SectorForm {
  // A pixel has the range of the nearest sample, which is up to half of spacing_px away along its row or column. Faster, and misses
  // what lies between samples.
  bool is_nearest = false;
  // Distance between columns where they are farthest apart, in pixels. Smaller: finds narrower ridges, slower.
  double spacing_px = 1;
  // The most sets of lines (rings) on one side of the vertical's vanishing point, where one set would be crowded. More: fewer samples, none
  // of them farther from a pixel than distance_px().
  int most_rings = SectorPlan::kMostRings;
  // Returns the largest distance in the image between a pixel's centre and the ray whose range it has.
  double distance_px() const { return is_nearest ? 0.5 * spacing_px : 0; }
  bool operator==(const SectorForm&) const = default;
};

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
  // With form.is_nearest, a pixel has the range of the sample nearest to it instead: that of the ray at most
  // form.distance_px() away along the pixel's row or column. One pixel, where the vertical's vanishing point lies in its middle, is
  // cast by itself.
  //
  // With `only`, a rectangle of the full image, it casts the samples and rays of that rectangle alone (its width 0:
  // all of the drawn part). Its ranges are the same to the bit; those beside it are left alone, except that it is
  // widened to whole blocks of kRayBlockColumns x kRayBlockRows pixels (columns/refine.h), counted from the corner of the drawn part.
  void cast(const core::View& view, const SectorForm& form, const ColumnWalk& walk, ScratchPool& scratches,
            const SingleRays* single_rays, base::ThreadPool& pool, std::span<float> range_m,
            const core::SubRectangle& only = {});

  // Lends the memory of the samples to casts of another kind.
  SectorSamples& samples() { return samples_; }

  // Returns the bytes of the samples that are kept.
  std::size_t bytes() const;

 private:
  void cast_sectors(const SectorPlan& plan, const core::SubRectangle& pixels, const ColumnWalk& walk,
                    ScratchPool& scratches, base::ThreadPool& pool);
  void take_nearest(const core::View& view, const SectorPlan& plan, const core::SubRectangle& pixels,
                    const ColumnWalk& walk, ScratchPool& scratches, const SingleRays* single_rays,
                    base::ThreadPool& pool, std::span<float> range_m) const;
  // Asks for the samples beside V of a block of pixels of the full image. They lie far apart in memory, and would be waited for one
  // after the other.
  void prefetch_beside(const SectorPlan& plan, const core::SubRectangle& block) const;
  // Finds the samples on either side of pixels [first_pixel, last_pixel) of a row of the drawn part.
  void find_hints(const SectorPlan& plan, const core::SubRectangle& part, int row, int first_pixel,
                  int last_pixel, float* a, float* b, float* share) const;

  SectorSamples samples_;  // of the last image
};

}  // namespace vpe::voxel
