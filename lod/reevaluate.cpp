#include "lod/reevaluate.h"

#include <algorithm>
#include <limits>

namespace lod {

void look_from(const SelectView& view, const TileTree& tree, Selection& selection) {
  const cull::Eye eye = cull::make_eye(view.eye_m);
  selection.max_error_px = 0.0;
  for (SelectedTile& tile : selection.tiles) {
    const cull::Shell shell = tree.shell(tile.index, selection.exaggeration, tile.error_m);
    const double chord2 = cull::nearest_chord2(shell.rect, eye.direction);
    tile.min_distance_m = cull::min_distance_m(eye, chord2, shell.min_radius_m, shell.max_radius_m);
    tile.stretch = view.plane.flat ? stretch(view.plane, cull::make_volume(shell)) : 1.0;
    tile.error_px = 0.0;
    if (tile.error_m > 0.0) {
      tile.error_px = tile.min_distance_m > 0.0
                          ? tile.stretch * (tile.error_m * view.focal_px / tile.min_distance_m)
                          : std::numeric_limits<double>::infinity();
    }
    selection.max_error_px = std::max(selection.max_error_px, tile.error_px);
  }
}

}  // namespace lod
