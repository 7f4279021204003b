#include "lod/reevaluate.h"

#include <algorithm>
#include <limits>

namespace lod {

void reevaluate_for_view(const SelectView& view, const TileTree& tree, Selection& selection) {
  const cull::Camera camera = cull::make_camera(view.camera_m);
  selection.max_screen_space_error_px = 0.0;
  for (SelectedTile& tile : selection.tiles) {
    const cull::BoundingRegion region = tree.region(tile.index, selection.exaggeration, tile.geometric_error_m);
    const double chord2 = cull::nearest_chord2(region.rect, camera.direction);
    tile.min_distance_m = cull::min_distance_m(camera, chord2, region.min_radius_m, region.max_radius_m);
    tile.off_axis_magnification =
        view.plane.flat ? off_axis_magnification(view.plane, cull::bounding_hexahedron(region)) : 1.0;
    tile.screen_space_error_px = 0.0;
    if (tile.geometric_error_m > 0.0) {
      tile.screen_space_error_px =
          tile.min_distance_m > 0.0
              ? tile.off_axis_magnification * (tile.geometric_error_m * view.focal_px / tile.min_distance_m)
              : std::numeric_limits<double>::infinity();
    }
    selection.max_screen_space_error_px =
        std::max(selection.max_screen_space_error_px, tile.screen_space_error_px);
  }
}

}  // namespace lod
