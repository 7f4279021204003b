#include "vpe/gl/certify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vpe/core/frame.h"
#include "vpe/gl/tile_id.h"

namespace vpe::gl {

namespace {

constexpr double kRounding = 1.0 / (1 << 24);

// Roundings of the vertex stage, as a part of the distance: a few of 2^-24.
constexpr double kTransformError = 4e-7;

// Shift of a point of a tile at a distance by float storage.
double storage_px(const CertifiedTile& t, double distance_m, double focal_px) {
  const double stored_m =
      std::min(t.quantisation_m, kRounding * (distance_m + t.camera_to_centre_m + t.longest_edge_m));
  const double moved_m =
      stored_m + kRounding * t.camera_to_centre_m + kTransformError * (distance_m + t.longest_edge_m);
  return moved_m * focal_px / distance_m;
}

}  // namespace

core::Certificate certify(std::span<const CertifiedTile> tiles, const lod::TileTree& tree, int intervals,
                          const FrameOptics& optics) {
  core::Certificate c;
  c.tiles_drawn = static_cast<int>(tiles.size());
  double area = 0;
  double limited = 0;
  double slope = 0;
  for (const CertifiedTile& t : tiles) {
    const lod::SelectedTile& tile = *t.tile;
    const double distance_m = std::max(tile.min_distance_m, optics.near_m);
    const double stored_px = storage_px(t, distance_m, optics.focal_px);
    const lod::TileInfo& info = tree[tile.index];
    slope = std::max(slope, tree.steepest_slope(info, optics.exaggeration));
    c.geometric_error_m = std::max(c.geometric_error_m, tile.geometric_error_m);
    c.screen_space_error_px = std::max(c.screen_space_error_px, tile.screen_space_error_px);
    c.quantisation_m = std::max(c.quantisation_m, t.quantisation_m);
    c.quantisation_px = std::max(c.quantisation_px, stored_px);
    const double side_m = lod::nominal_side_m(tile.key.level, tree.radius_m());
    const double pixels =
        std::min(side_m * optics.focal_px / std::max(tile.min_distance_m, 0.5 * side_m), 4096.0);
    area += pixels * pixels;
    const double spacing_m = side_m / intervals;
    if (!info.has_children && spacing_m * optics.focal_px > tile.min_distance_m) limited += pixels * pixels;
  }
  const double steep = std::sqrt(1.0 + slope * slope);
  c.quantisation_px = (c.quantisation_px + optics.snap_px) * steep;
  for (const CertifiedTile& t : tiles) {
    const double distance_m = std::max(t.tile->min_distance_m, optics.near_m);
    c.shift_bound_px =
        std::max(c.shift_bound_px, t.tile->screen_space_error_px +
                                       (storage_px(t, distance_m, optics.focal_px) + optics.snap_px) * steep);
  }
  c.exaggeration = optics.exaggeration;
  c.share_at_data_limit = area > 0 ? limited / area : 0.0;
  return c;
}

double bound_in_image(std::span<const CertifiedTile> tiles, const lod::TileTree& tree,
                      const DrawnPixels& pixels, const FrameOptics& optics) {
  std::vector<std::array<float, kTileParts>> nearest(tiles.size(),
                                                     {core::kSkyRange, core::kSkyRange, core::kSkyRange});
  float nearest_m = core::kSkyRange;
  for (std::size_t k = 0; k < pixels.range_m.size(); ++k) {
    if (pixels.id[k] == kNoTile) continue;
    const TileId drawn = unpack(pixels.id[k]);
    float& least = nearest[drawn.tile][static_cast<std::size_t>(drawn.part)];
    least = std::min(least, pixels.range_m[k]);
    nearest_m = std::min(nearest_m, pixels.range_m[k]);
  }
  double slope = 0;
  for (const CertifiedTile& t : tiles)
    slope = std::max(slope, tree.steepest_slope(tree[t.tile->index], optics.exaggeration));
  const double steep = std::sqrt(1.0 + slope * slope);
  double bound_px = 0;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    for (std::size_t part = 0; part < kTileParts; ++part) {
      const auto range_m = static_cast<double>(nearest[k][part]);
      if (std::isinf(range_m)) continue;
      const double distance_m =
          std::max(range_m * (1.0 - pixels.range_error * (1.0 + range_m / nearest_m)), double{nearest_m});
      const bool skirt = part == static_cast<std::size_t>(TilePart::kSkirt);
      const double geometric_error_m =
          tiles[k].tile->geometric_error_m + (skirt ? tiles[k].deepest_skirt_m : 0.0);
      bound_px =
          std::max(bound_px, geometric_error_m * optics.focal_px / distance_m +
                                 (storage_px(tiles[k], distance_m, optics.focal_px) + optics.snap_px) * steep);
    }
  }
  return bound_px;
}

}  // namespace vpe::gl
