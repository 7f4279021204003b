#include "vpe/gl/camera_clearance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "lod/tree/posts.h"

namespace vpe::gl {

namespace {

// Nearer than this the near plane depends on the ground below the camera.
constexpr double kGroundMatters_m = 1000.0;

const lod::SelectedTile* tile_over(const lod::Selection& cover, const lod::TileKey& finest) {
  const std::int64_t at = lod::morton_position(finest);
  const auto after =
      std::partition_point(cover.tiles.begin(), cover.tiles.end(),
                           [&](const lod::SelectedTile& t) { return lod::morton_position(t.key) <= at; });
  if (after == cover.tiles.begin() || !lod::contains((after - 1)->key, finest)) return nullptr;
  return &*(after - 1);
}

}  // namespace

double CameraClearance::camera_height_m(const core::View& view) const {
  return glm::length(view.camera.position_m) - planet_.radius_m();
}

const lod::TileInfo& CameraClearance::finest_tile(const core::View& view) const {
  return *planet_.tree().find(streamer_.ground_page(view.camera.position_m).tile);
}

// Above the sphere; nullopt while the posts are not resident.
std::optional<double> CameraClearance::ground_m(const core::View& view) const {
  const lod::TileKey key = finest_tile(view).key;
  const paging::TileHeights* tile = streamer_.ground(key);
  if (tile == nullptr) return std::nullopt;
  const mars::ChartPoint at = mars::chart_point(view.camera.position_m);
  const lod::Posts& posts = tile->posts;
  return lod::surface_height(posts, lod::grid_lines(key, posts.intervals), at.u, at.v, planet_.radius_m(),
                             nullptr, streamer_.exaggeration());
}

std::optional<PageKey> CameraClearance::needed_page(const core::View& view) const {
  const lod::TileInfo& tile = finest_tile(view);
  if (camera_height_m(view) >= streamer_.exaggeration() * tile.max_height_m + kGroundMatters_m)
    return std::nullopt;
  if (!streamer_.is_readable(tile.key)) return std::nullopt;
  return streamer_.ground_page(view.camera.position_m);
}

bool CameraClearance::is_above_ground(const lod::Selection& cover, const core::View& view) const {
  const lod::TileInfo& tile = finest_tile(view);
  const lod::SelectedTile* drawn = tile_over(cover, tile.key);
  const double geometric_error_m = drawn == nullptr ? 0.0 : drawn->geometric_error_m;
  const double height = camera_height_m(view);
  if (height > streamer_.exaggeration() * tile.max_height_m + geometric_error_m) return true;
  const auto ground = ground_m(view);
  return ground && height > *ground + geometric_error_m;
}

void CameraClearance::update(const core::View& view) {
  const double height = camera_height_m(view);
  if (const auto ground = ground_m(view)) {
    clearance_m_ = std::abs(height - *ground);
    return;
  }
  const double x = streamer_.exaggeration();
  const lod::TileInfo& tile = finest_tile(view);
  clearance_m_ = std::max({0.0, height - x * tile.max_height_m, x * tile.min_height_m - height});
}

// Depth interpolation loses precision on triangles that reach from the near plane to far away, so the near
// plane is as far out as the ground allows. Ground of slope s that lies h below the camera is no nearer than
// h / sqrt(1 + s^2). A fiftieth of the height is only passed by slopes over 88 degrees.
double CameraClearance::near_plane_m(const lod::Selection& cover, const core::View& view) const {
  // In the image's corners depth is less than distance.
  const double f = core::focal_px(view);
  const double x = 0.5 * view.width + std::abs(view.principal_offset_px.x);
  const double y = 0.5 * view.height + std::abs(view.principal_offset_px.y);
  const double cosine = f / std::sqrt(f * f + x * x + y * y);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const lod::SelectedTile& tile : cover.tiles) nearest_m = std::min(nearest_m, tile.min_distance_m);
  if (std::isfinite(nearest_m) && nearest_m > 1000.0) return 0.5 * cosine * nearest_m;
  const double exaggeration = streamer_.exaggeration();
  const double usual_m = 0.03 * clearance_m_ / std::max(1.0, exaggeration);
  double slope = 0;
  for (const lod::SelectedTile& tile : cover.tiles)
    if (tile.min_distance_m < usual_m)
      slope = std::max(slope, planet_.tree().steepest_slope(planet_.tree()[tile.index], exaggeration));
  // Meshes within their error of the ground may be steeper than it.
  const double above_walls_m = 0.5 * clearance_m_ / std::hypot(1.0, slope);
  // 3 mm, and less on bodies smaller than Mars.
  const double least_m = std::min(0.003, 1e-9 * planet_.radius_m());
  return std::clamp(cosine * std::min(usual_m, above_walls_m), least_m, 1000.0);
}

}  // namespace vpe::gl
