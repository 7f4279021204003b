// Describes a sector of an image as a batch of columns.
#pragma once

#include <vector>

#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/columns/view_sector.h"

namespace vpe::voxel {

// Holds ranges by sector, step and line. They grow alone: images of two sizes in turn would be filled with zeros again and again.
using SectorSamples = std::vector<std::vector<float>>;

// Returns the columns of the lines in the window, whose ranges go to samples[step * sector.lines + line]. Steps after the window,
// in the order of rising slopes, are left out; those before are resolved too, as where a run of rows begins decides how its
// ranges are rounded. Enlarges `samples` if needed. The plan and `samples` must outlive the batch. The window must not be empty.
ColumnBatch sector_batch(const SectorPlan& plan, const ViewSector& sector, const SectorPlan::Window& window,
                         std::vector<float>& samples);

}  // namespace vpe::voxel
