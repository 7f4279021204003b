// Evaluates the tiles of one view's selection for another view.
#pragma once

#include "lod/select.h"

namespace lod {

// Recomputes distances, off-axis magnifications and screen-space errors of the selected tiles for another view.
// They are bounds of what is drawn there. Does not add or remove tiles, also not those outside the view.
void reevaluate_for_view(const SelectView& view, const TileTree& tree, Selection& selection);

}  // namespace lod
