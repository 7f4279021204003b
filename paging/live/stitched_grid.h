// A mesh of every second post, with borders of any posts.
#pragma once

#include "lod/mesh/mesh.h"

namespace paging {

// Returns the grid of every second post of a grid of `intervals` (even, at least 4), whose outermost cells are triangulated
// between these posts and the border posts. Borders must be ascending with both ends. With every second post on all borders
// it is the full grid of these posts, with the diagonals of planets' grids.
lod::TileMesh stitched_grid(int intervals, const lod::BorderPosts& borders);

}  // namespace paging
