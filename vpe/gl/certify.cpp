#include "vpe/gl/certify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mars/geodesy/cube.h"
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

namespace {

double steepness(std::span<const CertifiedTile> tiles, const lod::TileTree& tree, double exaggeration) {
  double slope = 0;
  for (const CertifiedTile& t : tiles)
    slope = std::max(slope, tree.steepest_slope(tree[t.tile->index], exaggeration));
  return std::sqrt(1.0 + slope * slope);
}

// What all pixels of an image have in common.
struct ImageTerms {
  FrameOptics optics;
  double range_error = 0;
  double nearest_m = 0;
  double steep = 1;

  double distance_m(double range_m) const {
    return std::max(range_m * (1.0 - range_error * (1.0 + range_m / nearest_m)), nearest_m);
  }
  double snap_px(TilePart part) const {
    return part == TilePart::kSurface ? std::min(optics.snap_px, optics.surface_snap_px) : optics.snap_px;
  }
  // The bound of what appears at a distance, with a geometric error.
  double bound_px(const CertifiedTile& tile, TilePart part, double geometric_error_m, double distance_m) const {
    return geometric_error_m * optics.focal_px / distance_m +
           (storage_px(tile, distance_m, optics.focal_px) + snap_px(part)) * steep;
  }
};

// Nearest ranges by part of each tile.
struct NearestRanges {
  std::vector<std::array<float, kTileParts>> of;
  float all = core::kSkyRange;
};

NearestRanges nearest_ranges(std::size_t tiles, const DrawnPixels& pixels) {
  NearestRanges nearest{{tiles, {core::kSkyRange, core::kSkyRange, core::kSkyRange}}};
  for (std::size_t k = 0; k < pixels.range_m.size(); ++k) {
    if (pixels.id[k] == kNoTile) continue;
    const TileId drawn = unpack(pixels.id[k]);
    float& least = nearest.of[drawn.tile][static_cast<std::size_t>(drawn.part)];
    least = std::min(least, pixels.range_m[k]);
    nearest.all = std::min(nearest.all, pixels.range_m[k]);
  }
  return nearest;
}

// Visits the parts of tiles in the image with their nearest distances.
template <typename Visit>
void for_parts(const NearestRanges& nearest, const ImageTerms& terms, const Visit& visit) {
  for (std::size_t k = 0; k < nearest.of.size(); ++k) {
    for (std::size_t part = 0; part < kTileParts; ++part) {
      const auto range_m = static_cast<double>(nearest.of[k][part]);
      if (!std::isinf(range_m)) visit(k, static_cast<TilePart>(part), terms.distance_m(range_m));
    }
  }
}

// Returns the bound of the error of the tiles across the skirts of a tile.
double most_across_m(const CertifiedTile& tile) {
  return std::max(0.0, tile.deepest_skirt_m - tile.tile->geometric_error_m);
}

// Finds the geometric errors of ground where pixels show it.
class GroundErrors {
 public:
  GroundErrors(std::span<const CertifiedTile> tiles, const core::View& view, const ImageTerms& terms,
               const BlockErrorsOf& errors)
      : tiles_(tiles), view_(view), terms_(terms), errors_(errors), blocks_(tiles.size()) {
    for (std::size_t k = 0; k < tiles.size(); ++k) drawn_.emplace(tiles[k].tile->key, k);
  }

  double at(std::size_t tile, TilePart part, const glm::dvec2& pixel, double range_m) {
    const double moved_px = terms_.snap_px(part) + storage_px(tiles_[tile], range_m, terms_.optics.focal_px);
    const double moved_m =
        1.01 * range_m *
        (moved_px / terms_.optics.focal_px + terms_.range_error * (1.0 + range_m / terms_.nearest_m));
    const glm::dvec3 place = view_.camera.position_m + range_m * core::pixel_ray(view_, pixel.x, pixel.y);
    const double own_m = bound_m(tile, place, moved_m);
    return part == TilePart::kSkirt ? std::max(own_m, across_m(tile, place, moved_m)) : own_m;
  }

 private:
  // The error of a tile within a distance of a place.
  double bound_m(std::size_t tile, const glm::dvec3& place, double moved_m) {
    const lod::SelectedTile& t = *tiles_[tile].tile;
    std::optional<std::shared_ptr<const lod::BlockErrors>>& blocks = blocks_[tile];
    if (!blocks) blocks = errors_(t);
    const double out_m = glm::dot(mars::face_axes(t.key.face).out, place) - moved_m;
    if (*blocks == nullptr || !(out_m > 0)) return t.geometric_error_m;
    const mars::ChartPoint p = mars::chart_on(t.key.face, place);
    // A coordinate is a ratio of two that are moved by at most that each.
    const double reach = moved_m * (1.0 + std::max(std::abs(p.u), std::abs(p.v))) / out_m;
    return std::min((*blocks)->largest_m(p.u, p.v, reach), t.geometric_error_m);
  }

  // The errors of the tiles across the border at a place, which are found by steps over it.
  double across_m(std::size_t tile, const glm::dvec3& place, double moved_m) {
    const double most_m = most_across_m(tiles_[tile]);
    const mars::FaceAxes& axes = mars::face_axes(tiles_[tile].tile->key.face);
    double error = 0;
    bool any = false;
    for (int n = 0; n < 9; ++n) {
      const glm::dvec3 step =
          static_cast<double>(n % 3 - 1) * axes.right + static_cast<double>(n / 3 - 1) * axes.up;
      const std::optional<std::size_t> there = drawn_at(mars::chart_point(place + 3.0 * moved_m * step));
      if (there == tile) continue;
      if (!there) return most_m;
      error = std::max(error, bound_m(*there, place, moved_m));
      any = true;
    }
    return any ? std::min(error, most_m) : most_m;
  }

  std::optional<std::size_t> drawn_at(const mars::ChartPoint& point) const {
    for (int level = lod::kMaxLevel; level >= 0; --level) {
      const auto found = drawn_.find(lod::tile_at(point, level));
      if (found != drawn_.end()) return found->second;
    }
    return std::nullopt;
  }

  std::span<const CertifiedTile> tiles_;
  const core::View& view_;
  const ImageTerms& terms_;
  const BlockErrorsOf& errors_;
  std::vector<std::optional<std::shared_ptr<const lod::BlockErrors>>> blocks_;  // nullopt: not asked for yet
  std::unordered_map<lod::TileKey, std::size_t, lod::TileKeyHash> drawn_;
};

}  // namespace

double bound_in_image(std::span<const CertifiedTile> tiles, const lod::TileTree& tree,
                      const DrawnPixels& pixels, const FrameOptics& optics) {
  const NearestRanges nearest = nearest_ranges(tiles.size(), pixels);
  const ImageTerms terms{optics, pixels.range_error, nearest.all, steepness(tiles, tree, optics.exaggeration)};
  double bound_px = 0;
  for_parts(nearest, terms, [&](std::size_t k, TilePart part, double distance_m) {
    const double skirt_m = part == TilePart::kSkirt ? tiles[k].deepest_skirt_m : 0.0;
    bound_px = std::max(bound_px,
                        terms.bound_px(tiles[k], part, tiles[k].tile->geometric_error_m + skirt_m, distance_m));
  });
  return bound_px;
}

double bound_in_image(std::span<const CertifiedTile> tiles, const lod::TileTree& tree,
                      const DrawnPixels& pixels, const FrameOptics& optics, const core::View& view,
                      const BlockErrorsOf& errors) {
  const NearestRanges nearest = nearest_ranges(tiles.size(), pixels);
  const ImageTerms terms{optics, pixels.range_error, nearest.all, steepness(tiles, tree, optics.exaggeration)};
  std::vector<double> most_px(tiles.size(), 0.0);  // with the whole errors of tiles
  double bound_px = 0;                             // without any, and with those that were looked at
  for_parts(nearest, terms, [&](std::size_t k, TilePart part, double distance_m) {
    const double beside_m = part == TilePart::kSkirt ? most_across_m(tiles[k]) : 0.0;
    const double bound_m = std::max(tiles[k].tile->geometric_error_m, beside_m);
    most_px[k] = std::max(most_px[k], terms.bound_px(tiles[k], part, bound_m, distance_m));
    bound_px = std::max(bound_px, terms.bound_px(tiles[k], part, 0.0, distance_m));
  });
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < tiles.size(); ++k)
    if (most_px[k] > bound_px) order.push_back(k);
  if (order.empty()) return bound_px;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return most_px[a] > most_px[b]; });
  // The pixels of each of these tiles.
  std::vector<std::vector<std::uint32_t>> shown(tiles.size());
  for (std::size_t n = 0; n < pixels.id.size(); ++n) {
    if (pixels.id[n] == kNoTile) continue;
    const std::size_t k = unpack(pixels.id[n]).tile;
    if (most_px[k] > bound_px) shown[k].push_back(static_cast<std::uint32_t>(n));
  }
  const core::SubRectangle drawn = core::drawn_part(view);
  const auto width = static_cast<std::uint32_t>(drawn.width);
  GroundErrors ground(tiles, view, terms, errors);
  for (const std::size_t k : order) {
    if (most_px[k] <= bound_px) break;
    for (const std::uint32_t n : shown[k]) {
      const TilePart part = unpack(pixels.id[n]).part;
      const auto range_m = static_cast<double>(pixels.range_m[n]);
      const double distance_m = terms.distance_m(range_m);
      const double beside_m = part == TilePart::kSkirt ? most_across_m(tiles[k]) : 0.0;
      const double most_m = std::max(tiles[k].tile->geometric_error_m, beside_m);
      if (terms.bound_px(tiles[k], part, most_m, distance_m) <= bound_px) continue;
      const glm::dvec2 pixel(drawn.x + 0.5 + n % width, drawn.y + 0.5 + n / width);
      const double bound_m = ground.at(k, part, pixel, range_m);
      bound_px = std::max(bound_px, terms.bound_px(tiles[k], part, bound_m, distance_m));
    }
  }
  return bound_px;
}

}  // namespace vpe::gl
