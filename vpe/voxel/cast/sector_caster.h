// Range images of perspective views.
#pragma once

#include <span>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/view_sector.h"

namespace vpe::voxel {

// Casts fans of columns, then meets each pixel's own ray with the facet at its nearest samples. Where these
// belong to different surfaces (ridges, the skyline) the ray is cast by itself: against S, if `exact`, else in
// steps over the walk's lattices. One caller at a time.
class SectorCaster {
 public:
  void cast(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
            const paging::Surface& surface, double exaggeration, bool exact, base::ThreadPool& pool,
            std::span<float> range_m);

  std::size_t bytes() const;

 private:
  void cast_sectors(const SectorPlan& plan, const ColumnWalk& walk, ScratchPool& scratches,
                    base::ThreadPool& pool);
  void find_hints(const SectorPlan& plan, const core::SubRectangle& part, int row, int first_pixel,
                  int last_pixel, float* a, float* b, float* share) const;

  std::vector<std::vector<float>> samples_;  // of the last image's fans, by step
};

}  // namespace vpe::voxel
