// The tiles that one view needs, seen from another.
#pragma once

#include "lod/select.h"

namespace lod {

// Distances, stretch and projected errors of a selection's tiles, as select() gives them for the view that it
// selects for, made anew for a view that looks at the same tiles: each bounds what is drawn there. Tiles stay
// as they are, also those outside of the view.
void reevaluate_for_view(const SelectView& view, const TileTree& tree, Selection& selection);

}  // namespace lod
