// Explains why every tile that an image was cast with is no finer.
#pragma once

#include <vector>

#include "lod/explain.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/cast/tile_usage.h"

namespace vpe::voxel {

// Returns an explanation for every tile of the usage, in its order, by the rule of ColumnWalk (CellRule): errors are
// those that the certificate bounds. Terms are evaluated whatever their weights. `request` must be the one that was
// drawn, and `tree` that of its planet.
std::vector<lod::TileExplanation> explain_tiles(const core::DrawRequest& request, const lod::TileTree& tree,
                                                const TileUsage& usage);

}  // namespace vpe::voxel
