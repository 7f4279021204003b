#include "vpe/gl/certify.h"

#include <algorithm>
#include <cmath>

namespace vpe::gl {

namespace {

constexpr double kRounding = 1.0 / (1 << 24);

// Roundings of the vertex stage, as a part of the distance: a few of 2^-24.
constexpr double kTransformError = 4e-7;

// dr / d(angle) / r with heights times x.
double exaggerated(const lod::TileInfo& tile, double x, double radius_m) {
  return x * tile.steepest_slope * (radius_m + tile.max_height_m) /
         std::max(1.0, radius_m + x * tile.min_height_m);
}

}  // namespace

core::Certificate certify(std::span<const CertifiedTile> tiles, const lod::TileTree& tree, int intervals,
                          const FrameOptics& optics) {
  core::Certificate c;
  c.tiles_drawn = static_cast<int>(tiles.size());
  double area = 0;
  double limited = 0;
  double slope = 0;
  double surface_px = 0;
  for (const CertifiedTile& t : tiles) {
    const lod::SelectedTile& tile = *t.tile;
    const double distance_m = std::max(tile.min_distance_m, optics.near_m);
    const double stored_m =
        std::min(t.quantisation_m, kRounding * (distance_m + t.eye_to_centre_m + t.longest_edge_m));
    const double moved_m =
        stored_m + kRounding * t.eye_to_centre_m + kTransformError * (distance_m + t.longest_edge_m);
    const double storage_px = moved_m * optics.focal_px / distance_m;
    const lod::TileInfo& info = tree[tile.index];
    slope = std::max(slope, exaggerated(info, optics.exaggeration, tree.radius_m()));
    surface_px = std::max(surface_px, tile.error_px + storage_px);
    c.tile_error_m = std::max(c.tile_error_m, tile.error_m);
    c.tile_error_px = std::max(c.tile_error_px, tile.error_px);
    c.quantisation_m = std::max(c.quantisation_m, t.quantisation_m);
    c.quantisation_px = std::max(c.quantisation_px, storage_px);
    const double side_m = lod::nominal_side_m(tile.key.level, tree.radius_m());
    const double pixels =
        std::min(side_m * optics.focal_px / std::max(tile.min_distance_m, 0.5 * side_m), 4096.0);
    area += pixels * pixels;
    const double spacing_m = side_m / intervals;
    if (!info.has_children && spacing_m * optics.focal_px > tile.min_distance_m) limited += pixels * pixels;
  }
  const double snap_px = optics.snap_px * std::sqrt(1.0 + slope * slope);
  c.quantisation_px += snap_px;
  c.shift_bound_px = surface_px + snap_px;
  c.exaggeration = optics.exaggeration;
  c.share_at_data_limit = area > 0 ? limited / area : 0.0;
  return c;
}

}  // namespace vpe::gl
